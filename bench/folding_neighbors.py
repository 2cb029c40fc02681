#!/usr/bin/env python3
"""What finding neighbours costs while roadmaps of proteins grow, by the number of directions: Figure 20 of S. K. Nath's thesis (2013).

    python3 bench/folding_neighbors.py 1PGA 1MI0 1BDD --seeds 1-10 --nodes 1000 --variants rrt,m1,m3,m5,m7

Needs `perf`. Takes the problems that `bench/folding.py` has written with the same words (it names the variants), and builds each again while `perf`
looks at the program 499 times a CPU second. A sample counts as finding neighbours if a function of the modules `neighbor` or `finder` is on its
stack, or one that looks for near nodes in a growing graph: that is the search for the node that is extended, for the neighbours of a new
node, and those of the connection among sets. Measuring distances is part of it, checking motions is not. A row per protein and variant: CPU
seconds of the build, those of finding neighbours, and their share; mean, least and most over the seeds. The share of one build
is known to about 1 / √(samples).
"""

import argparse
import pathlib
import re
import subprocess
import sys
import tempfile

from folding import seeds_of

RATE = 499  # samples a CPU second
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
    """CPU seconds of a build, and of finding neighbours."""
    data = folder / "perf.data"
    recording = ["perf", "record", "--quiet", "--event", "cpu-clock:u", "--freq", RATE, "--call-graph", "dwarf,16384", "--output", data, "--"]
    run(recording + [roadmill, "build", problem, "--out", folder / "run", "--threads", 1, "--force"])
    # Without `--no-inline` every address is looked up in the lines of the source, which takes hours.
    stacks = run(["perf", "script", "--no-inline", "--input", data, "--fields", "ip,sym"])
    # An empty stack is one line of white space.
    stacks = [stack for stack in re.split(r"\n\s*\n", stacks) if stack.strip()]
    finding = sum(bool(FINDING.search(stack)) for stack in stacks)
    return len(stacks) / RATE, finding / RATE


def spread(values, digits):
    return f"{sum(values) / len(values):.{digits}f} ({min(values):.{digits}f} to {max(values):.{digits}f})"


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("proteins", nargs="+", metavar="ENTRY", help="as of bench/folding.py, without chains")
    parser.add_argument("--seeds", type=seeds_of, default=seeds_of("1-10"), metavar="FIRST-LAST", help="base seeds")
    parser.add_argument("--nodes", type=int, default=1000, help="nodes of each roadmap")
    parser.add_argument("--variants", default="rrt,m1,m3,m5,m7", help="names with commas between")
    parser.add_argument("--work", type=pathlib.Path, default=pathlib.Path("runs/folding"), help="where the problems are")
    parser.add_argument("--roadmill", default="target/release/roadmill", help="the program")
    args = parser.parse_args()
    print("| protein | variant | CPU seconds | finding neighbours | share |\n|" + " --- |" * 5)
    with tempfile.TemporaryDirectory() as folder:
        for entry in args.proteins:
            for variant in args.variants.split(","):
                rows = []
                for seed in args.seeds:
                    problem = args.work / f"{entry}-{variant}-{args.nodes}-{seed}.toml"
                    if not problem.exists():
                        sys.exit(f"{problem}: not found; bench/folding.py writes it")
                    rows.append(profiled(args.roadmill, problem, pathlib.Path(folder)))
                seconds, finding = zip(*rows)
                shares = [found / all_ for all_, found in rows]
                print(f"| {entry} | {variant} | {spread(seconds, 2)} | {spread(finding, 2)} | {spread(shares, 2)} |", flush=True)


if __name__ == "__main__":
    main()
