"""Bytes of a ledger per node, and what they come to for 100 000 conformations of 300 degrees of freedom.

A node's values are 8 bytes each and one more for its energy; everything else (edges, digests, judgements) is taken to be
what it is per node in the run that is measured.
"""

from img import problem_of
from ledgers import sizes
from runs import table


def run(lab, asked):
    rows = []
    for protein in asked.proteins:
        tables = problem_of(lab, protein)
        dofs = len(tables["query"]["start"])
        built = lab.build(
            f"size-{protein}", {**tables, "evaluators": []}, asked.seeds[0], "--max-nodes", str(asked.nodes)
        )
        found = sizes(built.folder)
        nodes, edges = built.summary["nodes"], built.summary["edges"]
        whole = found["sets"] / nodes
        rest = whole - 8 * (dofs + 1)
        scaled = 1e5 * (rest + 8 * 301) + found["rest"]
        rows.append(
            (
                protein,
                dofs,
                nodes,
                f"{edges / nodes:.2f}",
                f"{whole:.0f}",
                f"{rest:.0f}",
                found["rest"],
                f"{scaled / 1e6:.1f}",
                f"{scaled / 2**20:.1f}",
            )
        )
    table(
        [
            "protein",
            "dofs",
            "nodes",
            "edges per node",
            "bytes of sets per node",
            "of these not values",
            "all other bytes",
            "10⁵ nodes of 300 dofs, MB",
            "MiB",
        ],
        rows,
    )


def options(parser):
    parser.add_argument(
        "proteins", nargs="*", default=["calmodulin"], help="chignolin, calmodulin, kinase (calmodulin)"
    )
    parser.add_argument("--nodes", type=int, default=3200, help="nodes of the build (3200)")
