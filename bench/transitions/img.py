"""One incremental build beside rebuilding: what it saves that nobody has to know beforehand how many nodes it takes.

The incremental build stops by the default criteria. Who rebuilds makes a roadmap of n nodes, then one of 2 n from nothing, and
so on, until one meets them. The rebuilds judge nothing, which is in their favour. They have the incremental build's seed, so
that their roadmaps are those it would have come to; the last one is judged by going on with it (not counted).
"""

from runs import CALMODULIN, JUDGED, KINASE, RATIO, judged, note, spread, table

FIRST = {"chignolin": 200, "calmodulin": 800, "kinase": 800}


def problem_of(lab, name):
    return (
        lab.chignolin()
        if name == "chignolin"
        else lab.transition(name, {"calmodulin": CALMODULIN, "kinase": KINASE}[name])
    )


def run(lab, asked):
    rows = []
    for name in asked.proteins:
        tables = problem_of(lab, name)
        seeds = asked.seeds[:1] if name == "kinase" else asked.seeds
        found = []
        for seed in seeds:
            incremental = lab.build(f"img-{name}-{seed}", tables, seed, "--max-nodes", str(asked.most))
            needed, size, costs = incremental.summary["nodes"], FIRST[name], []
            while True:
                rebuilt = lab.build(
                    f"img-{name}-{seed}-of-{size}", {**tables, "evaluators": []}, seed, "--max-nodes", str(size)
                )
                costs.append(rebuilt.cpu)
                if size == needed:
                    ratio = incremental.last.verdicts[0].value
                    break
                if size > needed:
                    ratio = lab.go_on(incremental, {**tables, "evaluators": JUDGED}, size)
                    note(f"at {size} nodes the flow ratio is {ratio:.2f}")
                    if ratio >= RATIO or size >= 4 * needed:
                        break
                size *= 2
            found.append(
                (
                    needed,
                    incremental.cpu,
                    len(costs),
                    size,
                    sum(costs),
                    sum(costs) / incremental.cpu,
                    ratio,
                    incremental.summary["stop"],
                )
            )
        of = lambda at, digits=0: spread([row[at] for row in found], digits)
        met = sum(row[7] == "satisfied" for row in found)
        rows.append((name, f"{met} of {len(found)}", of(0), of(1, 1), of(2), of(3), of(4, 1), of(5, 2), of(6, 1)))
    table(
        [
            "protein",
            "criteria met",
            "nodes",
            "incremental, CPU s",
            "rebuilds",
            "last of nodes",
            "all rebuilds, CPU s",
            "times",
            "flow ratio of the last",
        ],
        rows,
    )


def options(parser):
    parser.add_argument(
        "proteins", nargs="*", default=list(FIRST), help="chignolin, calmodulin, kinase; all if none is named"
    )
    parser.add_argument("--most", type=int, default=40_000, help="nodes of an incremental build at most (40000)")
