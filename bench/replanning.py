#!/usr/bin/env python3
"""How directions of growth pay off when an obstacle comes: the study of m in S. K. Nath's thesis (2013, §5.2.2, Figures 8 to 11).

    python3 bench/replanning.py --seeds 10 --nodes 1000

For each scene, m and seed a graph of so many nodes grows from the start without a criterion (`roadmill build`), a cube of 2 by 2 by 2 comes
to the middle of the scene, and `roadmill replan` keeps what is left and grows it until the query is solved. Scenes are the thesis' clutters: 256
cubes of 0.2 in a square of 10 (the robot a cube of 0.2 that does not turn, or four links of 0.2 by 0.03 by 0.03), and 125 cubes in a box of 10 (the same
robots). m = 1 is an RRG, `rrt` a tree. The thesis gives each method the same time; here each gets the same number of nodes, so
that runs can be repeated. A row per scene and method: mean and standard deviation over the seeds of CPU milliseconds, by the kernel's count for
the process, of the first build, of revalidation as `replan` says it, and of all that `replan` does; nodes kept, nodes grown until the
query was solved, and the length of the path. A query that is not solved within ten times the nodes counts as not solved and is left out of the means.
"""

import argparse
import os
import pathlib
import random
import re
import statistics
import subprocess
import sys
import tempfile

MOST = 10  # times the nodes of the first build

CUBE = "[robot]\nbodies = [{ shape = { box = { size = [0.2, 0.2, 0.2] } } }]\n"


def linkage():
    """Four bars in a row, joined by axes across them."""
    bar = "bodies = [{ shape = { box = { size = [0.2, 0.03, 0.03] } }, position = [0.1, 0.0, 0.0] }]\n"
    text = "[robot]\n" + bar
    for index in range(3):
        joint = "kind = { revolute = { axis = [0, 0, 1], degrees = [-170, 170] } }, before = { position = [0.2, 0.0, 0.0] }"
        text += f"[[robot.links]]\nname = \"link{index}\"\n{bar}joint = {{ {joint} }}\n"
    return text


def box(size, at):
    return f"[[obstacles]]\nshape = {{ box = {{ size = {size} }} }}\nposition = {at}\n"


def scene(flat, robot, seed, method, nodes, comes):
    drawn = random.Random(seed)
    dims = 2 if flat else 3
    ends = [[0.5] * dims, [9.5] * dims]
    obstacles = []
    while len(obstacles) < (256 if flat else 125):
        at = [drawn.uniform(0.0, 10.0) for _ in range(dims)]
        if all(max(abs(a - e) for a, e in zip(at, end)) > 1.2 for end in ends):
            obstacles.append(box([0.2, 0.2, 0.2], at + [0.0] * (3 - dims)))
    if comes:
        obstacles.append(box([2.0, 2.0, 2.0], [5.0] * dims + [0.0] * (3 - dims)))
    if robot == "cube":
        motion, tail = ("translation-2d" if flat else "translation-3d"), ["", ""]
    elif flat:
        # The base reaches along x, into the square at either end.
        motion, tail = "rigid-2d", [", 0.0, 0.0, 0.0, 0.0", ", -3.1, 0.0, 0.0, 0.0"]
    else:
        motion, tail = "rigid-3d", [", 1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0", ", 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0"]
    start, goal = (", ".join(map(str, end)) + more for end, more in zip(ends, tail))
    generator = "rrt = { step = 0.5 }" if method == "rrt" else f"mrrg = {{ step = 0.5, directions = {method} }}"
    criteria = "" if comes else "evaluators = []\n"
    limit = MOST * nodes if comes else nodes
    return (
        f"seed = {seed}\n{criteria}[space]\nmotion = \"{motion}\"\nmin = {[0.0] * dims}\nmax = {[10.0] * dims}\nbounds = \"body\"\n"
        + (CUBE if robot == "cube" else linkage())
        + "".join(obstacles)
        + f"[query]\nstart = [{start}]\ngoal = [{goal}]\n[limits]\nnodes = {limit}\n[img]\nsets_per_round = 1\n"
        + f"[[strategies]]\nlabel = \"graph\"\nnodes = 20\ngenerator = {{ {generator} }}\namong = {{ until-joined = {{}} }}\n"
    )


def run(command):
    """What a command printed, and its CPU milliseconds; exit codes 0 and 3 (a limit ended the build) are those expected."""
    process = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    out, err = process.stdout.read(), process.stderr.read()
    _, status, usage = os.wait4(process.pid, 0)
    process.returncode = os.waitstatus_to_exitcode(status)
    if process.returncode not in (0, 3):
        sys.exit(f"{' '.join(map(str, command))}: exit code {process.returncode}\n{err}")
    return out, process.returncode, 1000 * (usage.ru_utime + usage.ru_stime)


def measured(roadmill, folder, case, seed, method, nodes):
    flat, robot = case
    before, after = folder / "before.toml", folder / "after.toml"
    before.write_text(scene(flat, robot, seed, method, nodes, False))
    after.write_text(scene(flat, robot, seed, method, nodes, True))
    old, new = folder / "old", folder / "new"
    _, _, generation = run([roadmill, "build", before, "--threads", "1", "--out", old, "--force"])
    said, code, replanning = run([roadmill, "replan", old, "--with", after, "--threads", "1", "--out", new, "--force", "--paths", "0"])
    kept = int(re.search(r"^nodes +(\d+) of", said, re.M).group(1))
    revalidation = 1000 * float(re.search(r"looked at closely \(([\d.]+) s\)", said).group(1))
    if code:
        return None
    total = int(re.findall(r"^nodes +(\d+)$", said, re.M)[-1])
    length = float(re.search(r"path of length ([\d.]+)", said).group(1))
    return generation, revalidation, replanning, kept, total - kept, length


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--seeds", type=int, default=10)
    parser.add_argument("--nodes", type=int, default=1000, help="nodes of each graph before the obstacle comes")
    parser.add_argument("--roadmill", default="target/release/roadmill", help="the program")
    args = parser.parse_args()
    print("| scene | method | solved | generation, ms | revalidation, ms | replan, ms | nodes kept | nodes grown | path |")
    print("| --- | --- | --- | --- | --- | --- | --- | --- | --- |")
    cases = [(True, "cube"), (True, "linkage"), (False, "cube"), (False, "linkage")]
    with tempfile.TemporaryDirectory() as folder:
        for case in cases:
            name = f"{'2D' if case[0] else '3D'}, {case[1]}"
            for method in ["rrt", 1, 2, 3, 4, 5, 6, 7]:
                rows = [
                    measured(args.roadmill, pathlib.Path(folder), case, seed, method, args.nodes)
                    for seed in range(1, args.seeds + 1)
                ]
                solved = [row for row in rows if row]
                columns = list(zip(*solved)) if solved else []
                spread = [
                    f"{statistics.mean(column):.1f} ± {statistics.stdev(column) if len(column) > 1 else 0:.1f}" for column in columns
                ]
                method = method if method == "rrt" else f"m = {method}"
                print(f"| {name} | {method} | {len(solved)} of {len(rows)} | " + " | ".join(spread) + " |", flush=True)


if __name__ == "__main__":
    main()
