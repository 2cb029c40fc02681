"""What the Python package costs: arrays, queries, memory.

    python bench/python.py NODES [FOLDER]

builds problems/walls.toml to its criteria and, as one large roadmap, to NODES nodes, in FOLDER (or a folder that is removed), and
prints a table: seconds from a run folder to arrays; the median of queries on a loaded roadmap, through the roadmap and between
random configurations, with the first query apart; and by how much the memory of the process grows over 10 000 queries.
Needs an installed roadmill. Every answer of a sample is compared with the program's, to the bit.
"""

from __future__ import annotations

import io
import os
import pathlib
import resource
import statistics
import subprocess
import sys
import tempfile
import time

import numpy as np

import roadmill
from roadmill._program import find_program

WALLS = pathlib.Path(__file__).resolve().parents[1] / "problems" / "walls.toml"
LEAK_QUERIES = 10_000


def endless(folder: pathlib.Path) -> pathlib.Path:
    """`walls` without criteria, so that only a limit ends it."""
    file = folder / "endless.toml"
    file.write_text(f"evaluators = []\n{WALLS.read_text()}")
    return file


def resident() -> int:
    """Bytes of memory that the process holds."""
    pages = int(pathlib.Path("/proc/self/statm").read_text().split()[1])
    return pages * resource.getpagesize()


def queries(roadmap: roadmill.Roadmap, count: int) -> list[tuple[list[float], list[float]]]:
    """Pairs of milestones drawn at random: valid configurations all over the free space."""
    drawn = np.random.default_rng(1).integers(len(roadmap), size=(count, 2))
    nodes = roadmap.nodes
    return [(nodes[a].tolist(), nodes[b].tolist()) for a, b in drawn]


def by_program(roadmap: roadmill.Roadmap, ends: tuple[list[float], list[float]]) -> bytes:
    """The path that the program gives, as bytes; none if there is no path."""
    start, goal = (" ".join(map(repr, q)) for q in ends)
    command = [find_program(), "query", str(roadmap.run), "--start", start, "--goal", goal]
    told = subprocess.run(command, capture_output=True, text=True).stdout
    return np.loadtxt(io.StringIO(told), delimiter=",", skiprows=1, ndmin=2).tobytes() if told else b""


def measure(name: str, run: pathlib.Path, count: int, compared: int) -> None:
    begun = time.perf_counter()
    roadmap = roadmill.Roadmap(run)
    size = len(roadmap)
    loaded = time.perf_counter()
    total = sum(float(array[-1].sum()) for array in (roadmap.nodes, roadmap.edges, roadmap.weights, roadmap.components))
    assert np.isfinite(total)
    arrays = time.perf_counter()
    print(f"{name}: {size} nodes, {len(roadmap.edges)} edges")
    print(f"  ledger read and checked       {loaded - begun:9.3f} s")
    print(f"  arrays, once it is read       {arrays - loaded:9.3f} s")

    asked = queries(roadmap, count)
    own = time.perf_counter()
    first = roadmap.query()
    print(f"  first query                   {time.perf_counter() - own:9.3f} s")
    assert first is not None
    seconds, direct = [], 0
    for start, goal in asked:
        began = time.perf_counter()
        path = roadmap.query(start, goal)
        seconds.append(time.perf_counter() - began)
        direct += path is not None and len(path) == 2
    # The node index is made by the first few searches.
    later = seconds[len(seconds) // 4 :]
    print(f"  queries, median               {1e3 * statistics.median(later):9.3f} ms")
    print(f"  queries, 90th percentile      {1e3 * float(np.percentile(later, 90)):9.3f} ms")
    print(f"  of these answered by the direct motion {direct / count:.0%}")
    again = []
    for _ in range(max(5, count // 10)):
        began = time.perf_counter()
        roadmap.query()
        again.append(time.perf_counter() - began)
    print(f"  the problem's own, median     {1e3 * statistics.median(again):9.3f} ms")
    for ends in asked[:compared]:
        path = roadmap.query(*ends)
        mine = b"" if path is None else path.configurations.tobytes()
        assert mine == by_program(roadmap, ends), ends
    print(f"  {compared} answers are the program's, to the bit")


def leak(run: pathlib.Path) -> None:
    roadmap = roadmill.Roadmap(run)
    asked = queries(roadmap, 100)
    for ends in asked * 5:
        roadmap.query(*ends)
    before = resident()
    for index in range(LEAK_QUERIES):
        roadmap.query(*asked[index % len(asked)])
    print(f"memory after {LEAK_QUERIES} queries: {(resident() - before) / 1024:+.0f} KiB of {before / 2**20:.0f} MiB")


def main() -> None:
    nodes = int(sys.argv[1]) if len(sys.argv) > 1 else 1_000_000
    with tempfile.TemporaryDirectory() as scratch:
        folder = pathlib.Path(sys.argv[2] if len(sys.argv) > 2 else scratch)
        small, large = folder / "walls", folder / f"walls-{nodes}"
        if not small.exists():
            roadmill.build(WALLS, out=small)
        if not large.exists():
            roadmill.build(endless(pathlib.Path(scratch)), out=large, max_nodes=nodes)
        print(f"roadmill {roadmill.__version__}, {os.cpu_count()} cores, load {os.getloadavg()[0]:.1f}")
        measure("walls", small, 1000, 20)
        leak(small)
        measure("large", large, 60, 2)


if __name__ == "__main__":
    main()
