#!/usr/bin/env python3
"""What finding neighbours costs while roadmaps of proteins grow, by the number of directions: Figure 20 of S. K. Nath's thesis (2013).

    python3 bench/folding_neighbors.py 1PGA 1MI0 1BDD --seeds 1-10 --nodes 1000 --variants rrt,m1,m3,m5,m7

Needs `perf`. Takes the problems that `bench/folding.py` has written with the same words (it names the variants), and the CPU seconds that it noted,
and builds each again while `perf` looks at the program 499 times a CPU second. A sample counts as finding neighbours if a function of the
modules `neighbor` or `finder` is on its stack, or one that looks for near nodes in a growing graph: that is the search for the node that is extended,
for the neighbours of a new node, and those of the connection among sets. Measuring distances is part of it, checking motions is not. A row per
protein and variant: the samples of all seeds, the share of them that finds neighbours, and that share of the CPU seconds, means over the seeds. A share is known
to about 1 / √(samples). On a busy machine `perf` may lose samples: a build of which it has less than four fifths is built again.
"""

import argparse
import pathlib
import re
import subprocess
import sys
import tempfile

from folding import seeds_of

RATE = 499  # samples a CPU second
TRIES = 5
FINDING = re.compile(r"roadmill::(neighbor|finder)::|GrowingTree::near|NeighborSearch::near")


def run(command):
    """What a command prints; ends the program, with what it said, if it fails."""
    try:
        done = subprocess.run([str(word) for word in command], capture_output=True, text=True)
    except OSError as error:
        sys.exit(f"{command[0]}: {error.strerror}; `perf` and the program that --roadmill names expected")
    if done.returncode != 0:
        sys.exit(f"{' '.join(map(str, command))}: exit code {done.returncode}\n{done.stderr}")
    return done.stdout


def profiled(roadmill, problem, folder):
    """Of a build the samples, and those of finding neighbours."""
    data = folder / "perf.data"
    recording = ["perf", "record", "--quiet", "--event", "cpu-clock:u", "--freq", RATE, "--call-graph", "dwarf,16384", "--mmap-pages", "32M", "--output", data, "--"]
    run(recording + [roadmill, "build", problem, "--out", folder / "run", "--threads", 1, "--force"])
    # Without `--no-inline` every address is looked up in the lines of the source, which takes hours.
    stacks = run(["perf", "script", "--no-inline", "--input", data, "--fields", "ip,sym"])
    # An empty stack is one line of white space.
    stacks = [stack for stack in re.split(r"\n\s*\n", stacks) if stack.strip()]
    finding = sum(bool(FINDING.search(stack)) for stack in stacks)
    return len(stacks), finding


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("proteins", nargs="+", metavar="ENTRY", help="as of bench/folding.py, without chains")
    parser.add_argument("--seeds", type=seeds_of, default=seeds_of("1-10"), metavar="FIRST-LAST", help="base seeds")
    parser.add_argument("--nodes", type=int, default=1000, help="nodes of each roadmap")
    parser.add_argument("--variants", default="rrt,m1,m3,m5,m7", help="names with commas between")
    parser.add_argument("--work", type=pathlib.Path, default=pathlib.Path("runs/folding"), help="where the problems are")
    parser.add_argument("--roadmill", default="target/release/roadmill", help="the program")
    args = parser.parse_args()
    print("| protein | variant | samples | share | CPU seconds | of finding neighbours |\n|" + " --- |" * 6)
    with tempfile.TemporaryDirectory() as folder:
        for entry in args.proteins:
            for variant in args.variants.split(","):
                samples, seconds = [], []
                for seed in args.seeds:
                    problem = args.work / f"{entry}-{variant}-{args.nodes}-{seed}.toml"
                    noted = problem.with_suffix(".seconds")
                    if not noted.exists():
                        sys.exit(f"{noted}: not found; bench/folding.py writes it")
                    seconds.append(float(noted.read_text(encoding="utf-8")))
                    for _ in range(TRIES):
                        found = profiled(args.roadmill, problem, pathlib.Path(folder))
                        if found[0] >= 0.8 * RATE * seconds[-1]:
                            break
                    else:
                        sys.exit(f"{problem}: {found[0]} samples found by perf; {RATE * seconds[-1]:.0f} expected")
                    samples.append(found)
                all_, finding = map(sum, zip(*samples))
                share, mean = finding / max(all_, 1), sum(seconds) / len(seconds)
                print(f"| {entry} | {variant} | {all_} | {share:.2f} | {mean:.2f} | {share * mean:.2f} |", flush=True)


if __name__ == "__main__":
    main()
