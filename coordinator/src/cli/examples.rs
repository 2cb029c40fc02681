//! The examples at the end of every command's help.

use crate::exit;
use clap::Command;

/// What a line does, and the line.
type Example = (&'static str, &'static str);

/// The examples of every command, by the words that name it.
///
/// Tests parse every line, so that no example names an option that is not there.
const EXAMPLES: &[(&[&str], &[Example])] = &[
    (
        &[],
        &[
            (
                "Grow a roadmap, in as many processes as there are cores",
                "roadmill build problem.toml",
            ),
            ("Look at it in a browser", "roadmill view runs/walls"),
            ("Check what was recorded", "roadmill verify runs/walls --all"),
        ],
    ),
    (
        &["build"],
        &[
            ("Until the problem's criteria are met", "roadmill build problem.toml"),
            (
                "With another seed, in two threads",
                "roadmill build problem.toml --seed 7 --threads 2",
            ),
            (
                "In batch scripts: start it, or go on with it",
                "roadmill build problem.toml --out runs/a --or-resume --max-time 2h",
            ),
            (
                "On two machines that are reached by ssh",
                "roadmill build problem.toml --agents node1,node2",
            ),
            (
                "A scene of Parasol's",
                "roadmill build maze.env --query maze.query --max-nodes 20000",
            ),
        ],
    ),
    (
        &["generate"],
        &[
            (
                "64 sets of a strategy, on any machine",
                "roadmill generate problem.toml --sets uniform:0..64 --out part.sets",
            ),
            (
                "A build that takes them in",
                "roadmill build problem.toml --import part.sets --out runs/a",
            ),
        ],
    ),
    (
        &["agent"],
        &[(
            "Started on another machine by a build's --agent-command",
            "roadmill agent --workers 16",
        )],
    ),
    (
        &["resume"],
        &[
            ("After any crash, on any number of workers", "roadmill resume runs/a --workers 8"),
            (
                "By other criteria, limits or strategies",
                "roadmill resume runs/a --with changed.toml",
            ),
        ],
    ),
    (
        &["status"],
        &[
            ("How far it is", "roadmill status runs/a"),
            ("Until it has ended, for programs", "roadmill status runs/a --watch --json"),
        ],
    ),
    (
        &["verify"],
        &[
            ("One set in a hundred", "roadmill verify runs/a"),
            ("Everything", "roadmill verify runs/a --all --workers 4"),
            ("One set that is suspected", "roadmill verify runs/a --set uniform:17"),
        ],
    ),
    (&["diff"], &[("Where two runs part, and why", "roadmill diff runs/a runs/b")]),
    (
        &["log"],
        &[("Set by set", "roadmill log runs/a"), ("For programs", "roadmill log runs/a --json")],
    ),
    (
        &["query"],
        &[
            (
                "The problem's own query, shortened",
                "roadmill query runs/a --shorten --out path.csv",
            ),
            (
                "Between two configurations of a rigid body",
                "roadmill query runs/a --start '1 2 2 1 0 0 0' --goal '7 2 2 1 0 0 0'",
            ),
            ("A page that plays the path", "roadmill query runs/a --animate path.html"),
            ("A path per line of a file", "roadmill query runs/a --queries many.csv --out paths"),
        ],
    ),
    (
        &["deform"],
        &[
            (
                "A page that plays how the robot gives way",
                "roadmill deform runs/squeeze --html squeeze.html",
            ),
            (
                "With at most so much energy, and farther from the obstacles",
                "roadmill deform runs/squeeze --highest-energy 40 --clearance 0.015",
            ),
            (
                "Another body along a path that was found",
                "roadmill deform runs/letters --path path.csv --robot letter.obj --csv energies.csv",
            ),
        ],
    ),
    (
        &["paths"],
        &[
            ("Three ways that differ", "roadmill paths runs/a --count 3 --dissimilar --out ways"),
            (
                "The shortest way of each class around the obstacles",
                "roadmill paths runs/a --distinct",
            ),
        ],
    ),
    (&["orders"], &[("Which part of a protein forms first", "roadmill orders runs/g")]),
    (&["report"], &[("A page about a run", "roadmill report runs/a --out a.html")]),
    (
        &["view"],
        &[
            ("Look at a run in a browser", "roadmill view runs/a"),
            ("A page to be sent to others", "roadmill view runs/a --no-open --out a.html"),
            ("Watch a build grow, until Ctrl-C", "roadmill view runs/a --live"),
        ],
    ),
    (
        &["check"],
        &[
            ("What it would build", "roadmill check problem.toml"),
            ("A robot's description as it is", "roadmill check arm.urdf"),
            (
                "Why a configuration is not valid",
                "roadmill check problem.toml --at '1 2 2 1 0 0 0' --picture at.svg",
            ),
        ],
    ),
    (
        &["compare"],
        &[
            (
                "Two samplers beside the problem's own strategies, ten seeds",
                "roadmill compare problem.toml --samplers uniform halton own --seeds 1-10 --out compared",
            ),
            (
                "How values go on beyond the criteria",
                "roadmill compare problem.toml --samplers own --go-on --max-nodes 5000 --out beyond",
            ),
        ],
    ),
    (
        &["import"],
        &[("A scene as a file to edit", "roadmill import cubicles.cfg --out cubicles.toml")],
    ),
    (
        &["export"],
        &[
            ("A picture", "roadmill export runs/a --format svg --out a.svg"),
            (
                "A picture from the front, with the path shortened",
                "roadmill export runs/a --format svg --view -90,10 --shorten --out a.svg",
            ),
            (
                "For networkx and other libraries of graphs",
                "roadmill export runs/a --format graphml --out a.graphml",
            ),
            ("Arrays for numpy", "roadmill export runs/a --format npz --out a.npz"),
            ("The first nodes of a table", "roadmill export runs/a --format map --out - | head"),
        ],
    ),
    (
        &["transition"],
        &[(
            "From open to closed adenylate kinase",
            "roadmill transition 4AKE.pdb 1AKE.pdb --chain A --out runs/adk",
        )],
    ),
    (&["fold"], &[("Protein G", "roadmill fold 1PGA.pdb --out runs/g")]),
    (
        &["relax"],
        &[
            (
                "Take a part out that a build finds no way for",
                "roadmill relax removal.toml --out runs/removal",
            ),
            ("Go on after any crash", "roadmill resume runs/removal"),
            ("Check the levels and the decisions between them", "roadmill verify runs/removal"),
        ],
    ),
    (
        &["replan"],
        &[("Go on where an obstacle has come", "roadmill replan runs/a --with changed.toml")],
    ),
    (
        &["completions"],
        &[(
            "For bash, from the next shell on",
            "roadmill completions bash > ~/.local/share/bash-completion/completions/roadmill",
        )],
    ),
    (
        &["man"],
        &[(
            "All pages, for `man roadmill` and `man roadmill-build`",
            "roadmill man --out ~/.local/share/man/man1",
        )],
    ),
    (
        &["ligand"],
        &[(
            "Where benzamidine binds to trypsin, as a problem for `build`",
            "roadmill ligand problem 3PTB.pdb --ligand 3PTB_BEN.sdf --out trypsin.toml",
        )],
    ),
    (
        &["ligand", "problem"],
        &[
            (
                "A ligand that stands in the protein's own file, anywhere at the protein",
                "roadmill ligand problem 4DFR.pdb --ligand MTX --chain B --chains B --out dhfr.toml",
            ),
            (
                "In a box about its given pose",
                "roadmill ligand problem 1STP.pdb --ligand BTN --box-around-ligand --out biotin.toml",
            ),
            (
                "With poses that may be near one, and charges",
                "roadmill ligand problem 3PTB.pdb --ligand 3PTB_BEN.sdf --hints guesses.sdf --dielectric 4 --out trypsin.toml",
            ),
        ],
    ),
    (
        &["ligand", "poses"],
        &[
            (
                "Twenty poses, as a table and as files",
                "roadmill ligand poses runs/trypsin --count 20 --format sdf,pdb,csv --out trypsin-poses",
            ),
            (
                "Beside a known pose, as a page",
                "roadmill ligand poses runs/trypsin --reference 3PTB_BEN.sdf --page trypsin.html",
            ),
        ],
    ),
    (
        &["ligand", "rank"],
        &[(
            "Ligands of thrombin beside what was measured",
            "roadmill ligand rank thrombin.pdb ligands.sdf --measured ki.csv --out runs/rank --workers 2",
        )],
    ),
    (&["protein"], &[("What a file holds", "roadmill protein info 1CLL.pdb")]),
    (
        &["protein", "info"],
        &[("Its second model, one chain", "roadmill protein info 1CLL.pdb --model 2 --chain A")],
    ),
    (
        &["protein", "compare"],
        &[("How two conformations differ", "roadmill protein compare 1CFD.pdb 1CLL.pdb")],
    ),
    (
        &["protein", "problem"],
        &[(
            "A transition as a file to edit",
            "roadmill protein problem 4AKE.pdb 1AKE.pdb --chain A --out adk.toml",
        )],
    ),
];

/// The command line with examples and exit codes behind the help of every command.
pub(super) fn with_examples(command: Command) -> Command {
    EXAMPLES.iter().fold(command, |command, (words, examples)| {
        let mut help = String::from("Examples:\n");
        for (what, line) in *examples {
            help += &format!("  # {what}\n  {line}\n");
        }
        help = format!("{help}\n{}", exit::HELP);
        at(command, words, &|command| command.after_help(help.clone()))
    })
}

/// Changes the command that `words` name.
fn at(command: Command, words: &[&str], change: &dyn Fn(Command) -> Command) -> Command {
    match words {
        [] => change(command),
        [first, rest @ ..] => command.mut_subcommand(*first, |inner| at(inner, rest, change)),
    }
}

#[cfg(test)]
mod tests {
    use super::super::Arguments;
    use super::*;

    /// Every command that is shown, by the words that name it.
    fn shown(command: &Command, words: Vec<String>, all: &mut Vec<Vec<String>>) {
        for inner in command.get_subcommands().filter(|inner| !inner.is_hide_set()) {
            let words: Vec<_> =
                words.iter().cloned().chain([inner.get_name().to_owned()]).collect();
            shown(inner, words, all);
        }
        all.push(words);
    }

    #[test]
    fn every_command_has_examples_and_each_is_understood() {
        let mut commands = Vec::new();
        shown(&Arguments::whole(), Vec::new(), &mut commands);
        for words in commands {
            let found = EXAMPLES.iter().find(|(known, _)| *known == words.as_slice());
            let (_, examples) = found.unwrap_or_else(|| panic!("{words:?} has no examples"));
            assert!(!examples.is_empty(), "{words:?}");
        }
        for (_, line) in EXAMPLES.iter().flat_map(|(_, examples)| *examples) {
            // What a shell would do with pipes and redirections is none of the program's.
            let own = line.split(['|', '>']).next().unwrap_or(line);
            let words = own.split('\'').enumerate().flat_map(|(part, text)| match part % 2 {
                0 => text.split_whitespace().map(str::to_owned).collect(),
                _ => vec![text.to_owned()],
            });
            let parsed = Arguments::whole().try_get_matches_from(words);
            assert!(parsed.is_ok(), "{line}: {}", parsed.expect_err("it is refused"));
        }
    }
}
