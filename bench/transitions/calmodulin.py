"""Calmodulin, 1CFD to 1CLL: strategies at equal CPU, which residues move, and what more nodes would add.

`strategies` builds with all strategies that `transition` chooses, with interpolation alone, and with all but interpolation, each
to so many CPU seconds, and compares the roadmaps of the last rounds judged before that. `residues` looks at the best
paths of these builds. `trend` builds once for longer and fits what the numbers do as the nodes grow.
"""

import math
import os

from runs import CALMODULIN, JUDGED, column, judged, read_csv, spread, table

# Ranges of residues by their numbers: the lobes, and the linker of the central helix between them.
PARTS = {"N lobe": (4, 74), "linker": (76, 81), "C lobe": (85, 147)}

VARIANTS = {
    "all": lambda label: True,
    "interpolation alone": lambda label: label == "interpolation",
    "all but interpolation": lambda label: label != "interpolation",
}


def with_strategies(tables, keep):
    """The problem with the strategies alone whose labels are kept."""
    kept = [strategy for strategy in tables["strategies"] if keep(strategy["label"])]
    # Short rounds, so that builds can be compared at numbers of CPU seconds and of nodes.
    image = {**tables["img"], "sets_per_round": 4}
    if "schedule" in image:
        image["schedule"] = [label for label in image["schedule"] if keep(label)]
    return {**tables, "strategies": kept, "img": image, "evaluators": JUDGED, "limits": {}}


def without_pairs(tables):
    """The problem without the energy of hydrophobic pairs."""
    protein = tables["protein"]
    return {**tables, "protein": {**protein, "energy": {**protein.get("energy", {}), "hydrophobic": False}}}


def ends_of(lab, name):
    """The energies of start and goal, model kJ/mol: of any path, its peak less its barriers there and back."""
    row = read_csv(lab.path(name) + "/paths.csv")[0]
    peak = column(row, "peak")
    return peak - column(row, "barrier ["), peak - column(row, "barrier_back")


def measured(lab, name, run):
    """What a roadmap has come to at its last judgement, and its best paths.

    Where the build was interrupted between a round and its judgement, the paths are out of a roadmap that has that round, too.
    """
    at = {"nodes": run.last.nodes, "components": run.last.components, "cpu": run.last.cpu, **judged(run.last)}
    for by in ("barrier", "cost"):
        _, best, _ = lab.paths(run, f"{name}-by-{by}", "--by", by, "--count", "1")
        if best:
            at[f"barrier by {by}"] = column(best[0], "barrier [")
            at[f"barrier back by {by}"] = column(best[0], "barrier_back")
            at[f"cost by {by}"] = column(best[0], "cost [")
            at[f"cost back by {by}"] = column(best[0], "cost_back")
    return at


def strategies(lab, asked, hydrophobic=True):
    """Builds at equal CPU, by all strategies and by some."""
    tables = lab.transition("calmodulin", CALMODULIN)
    mark = ""
    if not hydrophobic:
        tables, mark = without_pairs(tables), "-bare"
    variants = {variant: keep for variant, keep in VARIANTS.items() if variant in asked.only}
    found, curve = {variant: [] for variant in variants}, []
    for seed in asked.seeds:
        for variant, keep in variants.items():
            name = f"calmodulin{mark}-{variant.replace(' ', '-')}-{seed}"
            run = lab.build(name, with_strategies(tables, keep), seed, cpu_limit=asked.cpu)
            if run.rounds:
                found[variant].append(measured(lab, name, run))
            curve += [(variant, seed, r.nodes, f"{r.cpu:.1f}", *shown(judged(r))) for r in run.rounds]
    rows = []
    for variant, measures in found.items():
        of = lambda key, digits=0: spread([at.get(key) for at in measures], digits)
        rows.append(
            (
                variant,
                of("cpu", 1),
                of("nodes"),
                of("components"),
                of("barrier by barrier", 1),
                of("barrier back by barrier", 1),
                of("cost by cost"),
                of("cost back by cost"),
                of("ratio", 2),
                of("flow", 3),
                of("flow back", 3),
            )
        )
    head = [
        "strategies",
        "CPU s",
        "nodes",
        "components",
        "barrier, kJ/mol",
        "back",
        "cost, kT",
        "back",
        "flow ratio",
        "flow, 1/kT",
        "back",
    ]
    table(head, rows)
    print()
    at_nodes(found, curve)


def at_nodes(found, curve):
    """The same at numbers of nodes: medians over the seeds whose builds went so far."""
    rows = []
    for nodes in (200, 400, 800, 1600, 3200, 6400):
        for variant in found:
            line = [row for row in curve if row[0] == variant and row[2] == nodes]
            if line:
                medians = [
                    spread([float(row[at]) for row in line if row[at] != "none"], 3 if at > 6 else 1)
                    for at in range(3, 9)
                ]
                rows.append((nodes, variant, len(line), *medians))
    table(
        [
            "nodes",
            "strategies",
            "builds",
            "CPU s",
            "highest energy, kJ/mol",
            "cost, kT",
            "flow ratio",
            "flow, 1/kT",
            "back",
        ],
        rows,
    )


def shown(at):
    number = lambda value, digits: "none" if value is None or not math.isfinite(value) else f"{value:.{digits}f}"
    return (
        number(at["peak"], 1),
        number(at["cost"], 0),
        number(at["ratio"], 2),
        number(at["flow"], 3),
        number(at["flow back"], 3),
    )


def turned(before, after):
    """By how much an angle turned, radians, the shorter way."""
    return (after - before + math.pi) % (2 * math.pi) - math.pi


def motions(path):
    """Of every torsion of a path: the way it went, and how far it is in the end from where it began, radians."""
    rows = read_csv(path)
    found = {}
    for name in rows[0]:
        if name.startswith(("phi_", "psi_")):
            values = [float(row[name]) for row in rows]
            steps = [turned(a, b) for a, b in zip(values, values[1:])]
            residue = int(name.split("_")[1].split()[0])
            found[residue, name[:3]] = sum(map(abs, steps)), abs(turned(values[0], values[-1]))
    return found


def residues(lab, asked):
    """Which residues turn along the cheapest path of each build with all strategies."""
    rows, most = [], {}
    for part, (first, last) in PARTS.items():
        way, net, share = [], [], []
        for seed in asked.seeds:
            moved = motions(lab.path(f"calmodulin-all-{seed}-by-cost") + "/path-1.csv")
            mine = [turns for (residue, _), turns in moved.items() if first <= residue <= last]
            way.append(math.degrees(sum(t[0] for t in mine) / len(mine)))
            net.append(math.degrees(sum(t[1] for t in mine) / len(mine)))
            share.append(100 * sum(t[1] for t in mine) / sum(t[1] for t in moved.values()))
            for key, turns in moved.items():
                most.setdefault(key, []).append(turns)
        rows.append((f"{part}, {first}–{last}", spread(way, 1), spread(net, 1), spread(share, 1)))
    table(["part", "way gone per torsion, degrees", "from end to end", "share of all turning from end to end, %"], rows)
    print()
    per_seed = len(asked.seeds)
    farthest = sorted(most.items(), key=lambda item: -max(t[1] for t in item[1]))[:12]
    table(
        ["torsion", "from end to end, degrees", "way gone, degrees"],
        [
            (
                f"{kind} {residue}",
                spread([math.degrees(t[1]) for t in turns][:per_seed], 1),
                spread([math.degrees(t[0]) for t in turns][:per_seed], 1),
            )
            for (residue, kind), turns in farthest
        ],
    )


def slope(points):
    """Of (nodes, value): the least-squares exponent of value ~ nodes^exponent, and the value at one node."""
    logs = [(math.log(nodes), math.log(value)) for nodes, value in points]
    mean = [sum(axis) / len(logs) for axis in zip(*logs)]
    over = sum((x - mean[0]) ** 2 for x, _ in logs)
    exponent = sum((x - mean[0]) * (y - mean[1]) for x, y in logs) / over if over else 0.0
    return exponent, math.exp(mean[1] - exponent * mean[0])


def trend(lab, asked):
    """One longer build: numbers against nodes, exponents over its later half, and what they come to in a day and a week."""
    tables = with_strategies(lab.transition("calmodulin", CALMODULIN), VARIANTS["all"])
    run = lab.build("calmodulin-trend", tables, asked.seeds[0], cpu_limit=asked.long)
    lab.paths(run, "calmodulin-trend-by-cost", "--by", "cost", "--count", "1")
    start, goal = ends_of(lab, "calmodulin-trend-by-cost")
    print(f"energies of the ends: {start:.1f} and {goal:.1f} model kJ/mol\n")
    rounds = [r for r in run.rounds if math.isfinite(r.verdicts[1].value)]
    shown_at, factor = [], 1.0
    for r in rounds:
        if r.nodes >= factor or r is rounds[-1]:
            shown_at.append(r)
            factor = r.nodes * 1.35
    rows = []
    for r in shown_at:
        at = judged(r)
        rows.append(
            (r.nodes, r.edges, f"{r.cpu:.1f}", f"{at['peak'] - start:.1f}", f"{at['peak'] - goal:.1f}", *shown(at)[1:])
        )
    table(
        ["nodes", "edges", "CPU s", "barrier, kJ/mol", "back", "cost, kT", "flow ratio", "flow, 1/kT", "flow back"],
        rows,
    )
    print()
    later = [r for r in rounds if r.nodes >= rounds[-1].nodes / 8]
    seconds, scale = slope([(r.nodes, r.cpu) for r in later])
    rows = [("CPU s", f"{seconds:.2f}", f"{rounds[-1].cpu:.0f}", "86400", "604800")]
    ends = [(86400 / scale) ** (1 / seconds), (604800 / scale) ** (1 / seconds)]
    rows.append(("nodes", "", str(rounds[-1].nodes), *(f"{nodes:.2g}" for nodes in ends)))
    for what, key in [
        ("cost of the cheapest path, kT", "cost"),
        ("flow there, 1/kT", "flow"),
        ("flow back, 1/kT", "flow back"),
        ("flow ratio", "ratio"),
    ]:
        exponent, one = slope([(r.nodes, judged(r)[key]) for r in later])
        rows.append(
            (
                what,
                f"{exponent:.3f}",
                f"{judged(rounds[-1])[key]:.4g}",
                *(f"{one * nodes**exponent:.4g}" for nodes in ends),
            )
        )
    table([f"over nodes {later[0].nodes} to {later[-1].nodes}", "exponent", "now", "after a day", "after a week"], rows)


def run(lab, asked):
    if asked.part in ("strategies", "every"):
        strategies(lab, asked)
    if asked.part in ("without-pairs", "every"):
        strategies(lab, asked, hydrophobic=False)
    if asked.part in ("residues", "every"):
        residues(lab, asked)
    if asked.part in ("trend", "every"):
        trend(lab, asked)


def options(parser):
    parser.add_argument(
        "part", nargs="?", default="every", choices=["strategies", "without-pairs", "residues", "trend", "every"]
    )
    parser.add_argument("--only", nargs="+", default=list(VARIANTS), choices=list(VARIANTS), help="which strategies")
    parser.add_argument("--cpu", type=float, default=40.0, help="CPU seconds of a build (40)")
    parser.add_argument("--long", type=float, default=300.0, help="CPU seconds of the longer build (300)")
