use super::query::ends;
use crate::cli::{FrameFormat, PathsArguments, RankBy};
use crate::exit::{Code, Failure};
use crate::files::{make_empty, write_whole};
use crate::output::{line, note};
use crate::work::{Recorded, Run};
use roadmill::Ends;
use roadmill::export::{CannotExport, dcd, path_csv, pdb, xtc};
use roadmill::model::{Molecule, Scratch};
use roadmill::pathways::{
    DISTANCE, Dissimilar, FrameTable, KBest, Pair, Pathway, Pathways, Rank, SPACING, dissimilar,
    k_best,
};
use roadmill::query::PATH_REFINEMENT;
use std::fmt::Write;
use std::path::Path;
use std::time::Instant;

/// Finds several ways through the roadmap of a run, prints what each comes to and how far they are apart, and writes them.
pub fn paths(arguments: &PathsArguments) -> Result<Code, Failure> {
    let run = Run::at(&arguments.run).read()?;
    match run.stopped() {
        None => note("the build has not ended; its complete rounds are searched"),
        Some(stopped) => note(format_args!("the build ended: {}", stopped.reason)),
    }
    let (start, goal) = ends(&run, &arguments.start, &arguments.goal)?;
    let asked = Asked::of(&run, arguments, &start)?;
    if let Some(folder) = &arguments.out {
        make_empty(folder)?;
    }
    let begun = Instant::now();
    let found = asked.find(&run, &Ends { start, goal }, arguments);
    let seconds = begun.elapsed().as_secs_f64();
    if found.dropped_edges > 0 {
        note(format_args!(
            "{} edges failed the {PATH_REFINEMENT} times finer check and were left out",
            found.dropped_edges
        ));
    }
    if found.pathways.is_empty() {
        let why = match found.connected {
            true => {
                "every path between the ends that was tried has an edge that fails the finer check"
            }
            false => "nothing joins start and goal: neither the roadmap nor the direct motion",
        };
        return Err(Failure::new(Code::NoSuccess, format!("no path: {why} ({seconds:.3} s)")));
    }
    asked.print(&found);
    if let Some(folder) = &arguments.out {
        asked.write(&found, arguments, folder)?;
    }
    let count = found.pathways.len();
    note(format_args!(
        "{count} of {} paths, from {} candidates, in {seconds:.3} s",
        arguments.count, found.tried
    ));
    Ok(Code::Done)
}

/// What is asked for, with what the model says of it.
struct Asked<'a> {
    run: &'a Recorded,
    rank: Rank,
    spacing: f64,
    molecule: Option<&'a dyn Molecule>,
    /// Units of energies, of costs, and of lengths and distances.
    energy: &'static str,
    cost: &'static str,
    length: &'static str,
}

impl<'a> Asked<'a> {
    fn of(
        run: &'a Recorded,
        arguments: &PathsArguments,
        start: &[f64],
    ) -> Result<Asked<'a>, Failure> {
        let (cx, description) = (run.context(), run.problem().model().description());
        let scratch = &mut Scratch::new();
        let has_energies = cx.model().energy(start, scratch).is_some();
        let has_alphas = cx.model().shape(start, scratch).is_some();
        let rank = match arguments.by {
            Some(RankBy::Barrier) if !has_energies => {
                let message = "--by: barrier found; this model has no energies, cost expected";
                return Err(Failure::usage(message));
            }
            Some(RankBy::Cost) => Rank::Cost,
            None if !has_energies => Rank::Cost,
            _ => Rank::Barrier,
        };
        let molecule = description.molecule();
        if molecule.is_none() {
            let other = arguments.format.iter().find(|format| **format != FrameFormat::Csv);
            if let Some(other) = other {
                let name = format!("{other:?}").to_lowercase();
                let message =
                    format!("--format: {name} found; this model is no molecule, csv expected");
                return Err(Failure::usage(message));
            }
            if !arguments.angles.is_empty() {
                return Err(Failure::usage("--angle: this model is no molecule"));
            }
        }
        let usual = if has_alphas { SPACING } else { cx.space().diameter() / 100.0 };
        let energy = description.node_values().iter().find(|value| value.name == "energy");
        Ok(Asked {
            run,
            rank,
            spacing: arguments.spacing.unwrap_or(usual),
            molecule,
            energy: energy.map_or("1", |value| value.unit),
            cost: description.cost_unit(),
            length: if has_alphas { "Å" } else { "length" },
        })
    }

    fn find(&self, run: &Recorded, ends: &Ends, arguments: &PathsArguments) -> Pathways {
        let (cx, roadmap, scratch) = (run.context(), run.roadmap(), &mut Scratch::new());
        let attachment = run.problem().attachment();
        let (count, rank, spacing) = (arguments.count as usize, self.rank, self.spacing);
        let Some(distance) = arguments.dissimilar else {
            let asked = KBest { count, rank, spacing };
            return k_best(cx, roadmap, ends, &attachment, &asked, scratch);
        };
        let usual = if self.length == "Å" { DISTANCE } else { cx.space().diameter() / 20.0 };
        let asked = Dissimilar {
            count,
            rank,
            distance: distance.unwrap_or(usual),
            spacing,
            tries: arguments.tries as usize,
            shortcuts: arguments.shorten_tries,
        };
        dissimilar(cx, roadmap, ends, &attachment, &asked, scratch)
    }

    /// Prints a line per path, and one per pair of paths.
    fn print(&self, found: &Pathways) {
        let Asked { energy, cost, length, .. } = self;
        if found.pathways[0].measured.peak.is_some() {
            line(format_args!(
                "energies in {energy}, above the energy at departure; costs in {cost}; lengths in {length}"
            ));
        } else {
            line(format_args!("costs and lengths in {length}"));
        }
        line("path   barrier      cost   barrier back   cost back    length  frames  nearest");
        for (index, pathway) in found.pathways.iter().enumerate() {
            let Pathway { measured, frames, .. } = pathway;
            let number = |value: Option<f64>| value.map_or("-".to_owned(), |v| format!("{v:.2}"));
            let nearest = match nearest(found, index) {
                None => "-".to_owned(),
                Some((other, pair)) => format!("{:.2} from {}", pair.frechet.value, other + 1),
            };
            line(format_args!(
                "{:>4}{:>10}{:>10.2}{:>15}{:>12.2}{:>10.2}{:>8}  {nearest}",
                index + 1,
                number(measured.there.barrier),
                measured.there.cost,
                number(measured.back.barrier),
                measured.back.cost,
                frames.length(),
                frames.len(),
            ));
        }
        if !found.pairs.is_empty() {
            line("pairs    frechet  frames that decide   hausdorff  frames that decide");
        }
        for Pair { first, second, frechet, hausdorff } in &found.pairs {
            let decided = |first: usize, second: usize| format!("{} and {}", first + 1, second + 1);
            line(format_args!(
                "{:<9}{:>7.2}  {:<18}{:>12.2}  {}",
                decided(*first, *second),
                frechet.value,
                decided(frechet.first, frechet.second),
                hausdorff.value,
                decided(hausdorff.first, hausdorff.second),
            ));
        }
    }

    /// Writes the table, the distances and the paths into a folder.
    fn write(
        &self,
        found: &Pathways,
        arguments: &PathsArguments,
        folder: &Path,
    ) -> Result<(), Failure> {
        write_whole(&folder.join("paths.csv"), self.table(found))?;
        write_whole(&folder.join("matrix.csv"), self.matrix(found))?;
        let space = self.run.context().space();
        for (index, pathway) in found.pathways.iter().enumerate() {
            let file = |end: &str| folder.join(format!("path-{}.{end}", index + 1));
            let frames = || pathway.frames.configs.iter();
            let cannot = |error: CannotExport| Failure::usage(format!("--format: {error}"));
            write_whole(&file("csv"), path_csv(space, &pathway.path))?;
            if let Some(molecule) = self.molecule {
                let table = FrameTable::of(molecule, &pathway.frames, &arguments.angles);
                write_whole(&file("frames.csv"), table.csv())?;
                write_whole(&file("contacts.csv"), table.contacts_csv())?;
                for format in &arguments.format {
                    match format {
                        FrameFormat::Csv => {}
                        FrameFormat::Pdb => {
                            write_whole(&file("pdb"), pdb(molecule, frames()).map_err(cannot)?)?;
                        }
                        FrameFormat::Dcd => {
                            write_whole(&file("dcd"), dcd(molecule, frames()).map_err(cannot)?)?;
                        }
                        FrameFormat::Xtc => {
                            write_whole(&file("xtc"), xtc(molecule, frames()).map_err(cannot)?)?;
                        }
                    }
                }
            }
        }
        Ok(())
    }

    /// `paths.csv`.
    fn table(&self, found: &Pathways) -> String {
        let Asked { energy, cost, length, .. } = self;
        let mut csv = format!(
            "path,barrier [{energy}],cost [{cost}],barrier_back [{energy}],cost_back [{cost}],peak [{energy}],\
             length [{length}],configurations,frames,nearest,frechet [{length}]\n"
        );
        for (index, pathway) in found.pathways.iter().enumerate() {
            let Pathway { path, measured, frames } = pathway;
            let number = |value: Option<f64>| value.map_or(String::new(), |v| v.to_string());
            let nearest = nearest(found, index);
            writeln!(
                csv,
                "{},{},{},{},{},{},{},{},{},{},{}",
                index + 1,
                number(measured.there.barrier),
                measured.there.cost,
                number(measured.back.barrier),
                measured.back.cost,
                number(measured.peak),
                frames.length(),
                path.configs.len(),
                frames.len(),
                nearest.map_or(String::new(), |(other, _)| (other + 1).to_string()),
                number(nearest.map(|(_, pair)| pair.frechet.value)),
            )
            .expect("writing to memory cannot fail");
        }
        csv
    }

    /// `matrix.csv`.
    fn matrix(&self, found: &Pathways) -> String {
        let length = self.length;
        let mut csv = format!(
            "first,second,frechet [{length}],frechet_frame_first,frechet_frame_second,\
             hausdorff [{length}],hausdorff_frame_first,hausdorff_frame_second\n"
        );
        for Pair { first, second, frechet, hausdorff } in &found.pairs {
            writeln!(
                csv,
                "{},{},{},{},{},{},{},{}",
                first + 1,
                second + 1,
                frechet.value,
                frechet.first + 1,
                frechet.second + 1,
                hausdorff.value,
                hausdorff.first + 1,
                hausdorff.second + 1,
            )
            .expect("writing to memory cannot fail");
        }
        csv
    }
}

/// The path whose Fréchet distance from a path is the least, the first of several.
fn nearest(found: &Pathways, index: usize) -> Option<(usize, &Pair)> {
    let pairs = found.pairs.iter().filter(|pair| pair.first == index || pair.second == index);
    let nearest = pairs.min_by(|a, b| a.frechet.value.total_cmp(&b.frechet.value))?;
    let other = if nearest.first == index { nearest.second } else { nearest.first };
    Some((other, nearest))
}
