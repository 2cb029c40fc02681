"""How many conformations a transition's build keeps per CPU second, and what a second worker is worth.

`alone` builds in one process and divides by its CPU seconds. `pairs` lets one build with two workers and two builds with one worker
each, of other seeds, take turns, so that drifts of the machine meet both; what counts are nodes per CPU second and,
where nothing else runs, nodes per second.
"""

import json
import statistics
import subprocess
import threading
import time

from img import problem_of
from runs import note, spread, table


def alone(lab, asked):
    rows = []
    for protein in asked.proteins:
        tables, found = {**problem_of(lab, protein), "evaluators": []}, []
        for seed in asked.seeds:
            run = lab.build(f"throughput-{protein}-{seed}", tables, seed, "--max-nodes", str(asked.nodes))
            sets = [json.loads(line) for line in lab.command("log", run.folder, "--json")[0].splitlines()]
            total = lambda key: sum(line[key] for line in sets)
            checked = total("configurations_checked"), total("motions_checked")
            numbers = run.summary["nodes"], run.summary["edges"], *checked
            found.append([number / run.cpu for number in numbers] + [run.summary["nodes"] / checked[0] * 100])
        of = lambda at, digits=0: spread([row[at] for row in found], digits)
        rows.append((protein, asked.nodes, of(0), of(1), of(2), of(3), of(4, 1)))
    table(
        [
            "protein",
            "nodes",
            "nodes kept per CPU s",
            "edges",
            "configurations asked about",
            "motions asked about",
            "nodes of configurations, %",
        ],
        rows,
    )


def pairs(lab, asked):
    rows = []
    for protein in asked.proteins:
        tables, rates = {**problem_of(lab, protein), "evaluators": []}, {"two workers": [], "two builds": []}
        limit = ["--max-nodes", str(asked.nodes)]
        build = lambda name, seed, workers: lab.build(name, tables, seed, *limit, workers=workers)
        for seed in asked.seeds:
            begun = time.monotonic()
            run = build(f"pair-{protein}-{seed}", seed, 2)
            wall = time.monotonic() - begun
            rates["two workers"].append((run.summary["nodes"] / run.cpu, run.summary["nodes"] / wall))
            both = [None, None]

            def one(at):
                both[at] = build(f"pair-{protein}-{seed}-{at + 1}", seed + 100 * (at + 1), 1)

            threads = [threading.Thread(target=one, args=(at,)) for at in range(2)]
            begun = time.monotonic()
            for thread in threads:
                thread.start()
            for thread in threads:
                thread.join()
            wall = time.monotonic() - begun
            nodes = sum(run.summary["nodes"] for run in both)
            rates["two builds"].append((nodes / sum(run.cpu for run in both), nodes / wall))
        by = list(zip(rates["two workers"], rates["two builds"]))
        ratio = lambda which: spread([one[which] / two[which] for one, two in by], 3)
        rows.append(
            (
                protein,
                asked.nodes,
                *(spread([r[0] for r in of]) for of in rates.values()),
                ratio(0),
                *(spread([r[1] for r in of]) for of in rates.values()),
                ratio(1),
            )
        )
    table(
        [
            "protein",
            "nodes",
            "two workers, nodes per CPU s",
            "two builds",
            "ratio",
            "two workers, nodes per s",
            "two builds",
            "ratio",
        ],
        rows,
    )


def profile(lab, asked):
    """Where the time goes, by `perf`, which has to be there: the functions of the most samples."""
    for protein in asked.proteins:
        tables = {**problem_of(lab, protein), "evaluators": []}
        file = lab.path("profile.data")
        lab.build(
            f"profile-{protein}",
            tables,
            asked.seeds[0],
            "--max-nodes",
            str(asked.nodes),
            before=["perf", "record", "-q", "-e", "cpu-clock", "-F", "199", "-o", file],
        )
        report = subprocess.run(
            ["perf", "report", "-i", file, "--stdio", "--percent-limit", "1", "--sort", "symbol"],
            capture_output=True,
            text=True,
        )
        print(f"{protein}:")
        print("\n".join(line for line in report.stdout.splitlines() if line and not line.startswith("#")))


def run(lab, asked):
    {"alone": alone, "pairs": pairs, "profile": profile}[asked.part](lab, asked)


def options(parser):
    parser.add_argument("part", nargs="?", default="alone", choices=["alone", "pairs", "profile"])
    parser.add_argument(
        "--proteins", nargs="*", default=["calmodulin", "kinase"], help="chignolin, calmodulin, kinase (the last two)"
    )
    parser.add_argument("--nodes", type=int, default=3200, help="nodes of a build (3200)")
