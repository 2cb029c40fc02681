"""What the Python package costs: arrays, queries, memory.

    python bench/python.py NODES [FOLDER]

builds problems/walls.toml to its criteria and, as one large roadmap, to NODES nodes, in FOLDER (or a folder that is removed), and
prints a table: seconds from a run folder to arrays; the median of queries on a loaded roadmap, through the roadmap and between
random configurations, with the first query apart; and by how much the memory of the process grows over 10 000 queries.
Needs an installed roadmill. Every answer of a sample is compared with the program's, to the bit. Beside wall-clock times stand the
seconds of the processor, which are what a machine with nothing else to do would take.
"""

from __future__ import annotations

import io
import os
import pathlib
import resource
import subprocess
import sys
import tempfile
import time

import numpy as np

import roadmill
from roadmill._program import find_program

WALLS = pathlib.Path(__file__).resolve().parents[1] / "problems" / "walls.toml"
LEAK_QUERIES = 10_000
# Queries that are asked before their times count.
BEFORE_LANDMARKS = 30
WARM = 40


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


class Stopwatch:
    """Wall-clock and processor seconds since it was made."""

    def __init__(self) -> None:
        self._begun = self._now()

    @staticmethod
    def _now() -> tuple[float, float]:
        return time.perf_counter(), time.process_time()

    def read(self) -> tuple[float, float]:
        wall, processor = self._now()
        return wall - self._begun[0], processor - self._begun[1]

    def say(self, what: str) -> None:
        wall, processor = self.read()
        print(f"  {what:<42} {wall:9.3f} s {processor:9.3f} s of the processor", flush=True)


def say_queries(what: str, taken: list[tuple[float, float]]) -> None:
    """Median and 90th percentile of queries."""
    for name, share in (("median", 50), ("90th percentile", 90)):
        wall, processor = (1e3 * float(np.percentile(times, share)) for times in zip(*taken))
        print(f"  {what + ', ' + name:<42} {wall:9.3f} ms {processor:8.3f} ms of the processor", flush=True)


def asked(roadmap: roadmill.Roadmap, ends: tuple[list[float], list[float]] | None) -> tuple[float, float]:
    """What a query takes."""
    watch = Stopwatch()
    roadmap.query(*ends) if ends else roadmap.query()
    return watch.read()


def measure(name: str, run: pathlib.Path, count: int, compared: int) -> None:
    watch = Stopwatch()
    roadmap = roadmill.Roadmap(run)
    print(f"{name}: {len(roadmap)} nodes")
    watch.say("ledger read and checked")
    watch = Stopwatch()
    arrays = (roadmap.nodes, roadmap.edges, roadmap.weights, roadmap.components)
    assert np.isfinite(sum(float(array[-1].sum()) for array in arrays))
    watch.say(f"arrays, {len(roadmap.edges)} edges among them")
    watch = Stopwatch()
    assert roadmap.query() is not None
    watch.say("first query")
    ends = queries(roadmap, count)
    # The first searches make the index of the nodes, and the 33rd of a large roadmap makes the landmarks.
    watch = Stopwatch()
    for each in ends[:BEFORE_LANDMARKS]:
        roadmap.query(*each)
    watch.say(f"the next {BEFORE_LANDMARKS} queries")
    watch = Stopwatch()
    for each in ends[BEFORE_LANDMARKS:WARM]:
        roadmap.query(*each)
    watch.say(f"the next {WARM - BEFORE_LANDMARKS}, which make landmarks")
    say_queries("between nodes drawn at random", [asked(roadmap, each) for each in ends[WARM:]])
    say_queries("the problem's own", [asked(roadmap, None) for _ in range(max(10, count // 10))])
    for each in ends[:compared]:
        path = roadmap.query(*each)
        assert (b"" if path is None else path.configurations.tobytes()) == by_program(roadmap, each), each
    print(f"  {compared} answers are the program's, to the bit")


def leak(run: pathlib.Path) -> None:
    roadmap = roadmill.Roadmap(run)
    drawn = queries(roadmap, 100)
    for ends in drawn * 5:
        roadmap.query(*ends)
    before = resident()
    for index in range(LEAK_QUERIES):
        roadmap.query(*drawn[index % len(drawn)])
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
        measure("large", large, WARM + 100, 2)


if __name__ == "__main__":
    main()
