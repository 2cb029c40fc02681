"""Controls: what becomes of a transition's numbers where the energy, its step or the neighbours are others.

Every variant is built to the same number of nodes, over the same seeds. Constraints come from the structures; a problem file cannot
give pairs, so a control with permuted pairs is not possible. In their place stand an energy that is 0 everywhere,
constraints alone, hydrophobic pairs alone, and of a protein with two structures the constraints of the first alone, which
is an energy that knows nothing of the goal.
"""

import math

from runs import CALMODULIN, JUDGED, column, judged, spread, table


def changed(tables, energy=None, **keys):
    """The problem with other keys of its protein."""
    protein = {**tables["protein"], **keys}
    if energy is not None:
        protein["energy"] = {**protein.get("energy", {}), **energy}
    return {**tables, "protein": protein}


def neighbours(tables, count):
    """The problem with another number of neighbours at which new nodes are joined."""

    def of(strategy):
        among = strategy.get("among", {"nodes-and-components": {}})
        return {**strategy, "among": {name: {**settings, "neighbors": count} for name, settings in among.items()}}

    return {**tables, "strategies": [of(strategy) for strategy in tables["strategies"]]}


def without_target(tables):
    protein = {key: value for key, value in tables["protein"].items() if key != "target"}
    return {**tables, "protein": protein}


VARIANTS = {
    "as it is": lambda tables: tables,
    "energy 0": lambda tables: changed(tables, {"constraints": False, "hydrophobic": False}),
    "constraints alone": lambda tables: changed(tables, {"hydrophobic": False}),
    "hydrophobic pairs alone": lambda tables: changed(tables, {"constraints": False}),
    "constraints of the start alone": without_target,
    "half the step (`turn` of half a degree)": lambda tables: changed(tables, turn=math.radians(0.5)),
    "5 neighbours for 10": lambda tables: neighbours(tables, 5),
    "20 neighbours for 10": lambda tables: neighbours(tables, 20),
}


def run(lab, asked):
    tables = lab.chignolin() if asked.protein == "chignolin" else lab.transition("calmodulin", CALMODULIN)
    rows = []
    for number, (variant, change) in enumerate(VARIANTS.items()):
        if asked.variants and number not in asked.variants:
            continue
        if change is without_target and "target" not in tables["protein"]:
            continue
        found = []
        for seed in asked.seeds:
            name = f"controls-{asked.protein}-{number}-{seed}"
            run = lab.build(
                name, {**change(tables), "evaluators": JUDGED, "limits": {}}, seed, "--max-nodes", str(asked.nodes)
            )
            enough = next((r.nodes for r in run.rounds if judged(r)["is enough"]), None)
            _, best, _ = lab.paths(run, f"{name}-paths", "--by", "cost", "--count", "1")
            start = column(best[0], "peak") - column(best[0], "barrier [") if best else math.nan
            at = judged(run.last)
            found.append(
                {**at, "enough": enough, "barrier": at["peak"] - start, "edges": run.last.edges, "cpu": run.cpu}
            )
        of = lambda key, digits=0: spread([at[key] for at in found], digits)
        met = sum(at["enough"] is not None for at in found)
        enough = of("enough") + (f", {met} of {len(found)}" if met < len(found) else "")
        rows.append(
            (
                variant,
                enough,
                of("barrier", 1),
                of("cost"),
                of("ratio", 2),
                of("flow", 3),
                of("flow back", 3),
                of("edges"),
                of("cpu", 1),
            )
        )
    table(
        [
            "variant",
            "nodes until the criteria",
            "barrier, kJ/mol",
            "cost, kT",
            "flow ratio",
            "flow, 1/kT",
            "back",
            "edges",
            "CPU s",
        ],
        rows,
    )


def options(parser):
    parser.add_argument("protein", nargs="?", default="chignolin", choices=["chignolin", "calmodulin"])
    parser.add_argument("--nodes", type=int, default=3200, help="nodes of a build (3200)")
    parser.add_argument(
        "--variants", type=int, nargs="*", help=f"which, of 0 to {len(VARIANTS) - 1}; all if none is named"
    )
