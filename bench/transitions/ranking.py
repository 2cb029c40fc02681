"""How stable the ranking of dissimilar paths is over seeds.

Each seed's roadmap is built to the default criteria, and its five dissimilar paths are looked for. Of each two seeds the discrete
Fréchet distance (Cα RMSD after superposition, Å) of their best paths is found from the exported frames, and of every path how
far the nearest of the other seed's five is. Which part moves first is read off the torsions: a part is midway where its
torsions (Euclidean distance) have come half the way to their values at the goal. Needs numpy.
"""

import itertools
import math

import numpy as np

import calmodulin
from img import problem_of
from runs import column, note, read_csv, spread, table

FAST = ["--count", "5", "--dissimilar", "--tries", "6", "--shorten-tries", "20", "--format", "csv,pdb"]

# Shares of a path's length that differ by less count as the same.
TOGETHER = 0.02
BEST = ["--count", "1", "--by", "cost", "--format", "csv,pdb"]

PARTS = {
    "chignolin": {"1–5": (1, 5), "6–10": (6, 10)},
    "calmodulin": {"N lobe": (4, 74), "linker": (76, 81), "C lobe": (85, 147)},
}


def frames_of(path):
    """The Cα of every model of a PDB file, centred: frames × residues × 3, Å."""
    frames, current = [], []
    with open(path) as file:
        for line in file:
            if line.startswith("ATOM") and line[12:16] == " CA ":
                current.append([float(line[at : at + 8]) for at in (30, 38, 46)])
            elif line.startswith("ENDMDL"):
                frames.append(current)
                current = []
    frames = np.array(frames)
    return frames - frames.mean(axis=1, keepdims=True)


def rmsds(first, second):
    """The RMSD of each frame of one path from each of another after superposition (Kabsch 1976)."""
    products = np.einsum("inx,jny->ijxy", first, second)
    values = np.linalg.svd(products, compute_uv=False)
    values[..., 2] *= np.sign(np.linalg.det(products))
    sizes = (first**2).sum(axis=(1, 2))[:, None] + (second**2).sum(axis=(1, 2))[None]
    return np.sqrt(np.maximum(0, sizes - 2 * values.sum(axis=-1)) / first.shape[1])


def frechet(first, second):
    """The discrete Fréchet distance of two paths (T. Eiter, H. Mannila 1994)."""
    apart = rmsds(first, second)
    for i, j in np.ndindex(apart.shape):
        before = [apart[i - a, j - b] for a, b in ((1, 0), (0, 1), (1, 1)) if i >= a and j >= b]
        if before:
            apart[i, j] = max(apart[i, j], min(before))
    return apart[-1, -1]


def midways(folder, path, parts):
    """The share of the path's length at which each part is midway."""
    rows = read_csv(f"{folder}/path-{path}.csv")
    shares = [float(row["share"]) for row in read_csv(f"{folder}/path-{path}.frames.csv") if row["own"] == "1"]
    found = {}
    for part, (first, last) in parts.items():
        names = [name for name in rows[0] if "_" in name and first <= int(name.split("_")[1].split()[0]) <= last]
        values = np.array([[float(row[name]) for name in names] for row in rows])
        left = np.linalg.norm((values - values[-1] + math.pi) % (2 * math.pi) - math.pi, axis=1)
        after = int(np.argmax(left <= left[0] / 2))
        # Between two configurations torsions turn evenly; what is left of the way is taken to shrink evenly, too.
        passed = (left[after - 1] - left[0] / 2) / (left[after - 1] - left[after])
        found[part] = shares[after - 1] + passed * (shares[after] - shares[after - 1])
    return found


def run(lab, asked):
    if asked.best and asked.protein != "calmodulin":
        raise SystemExit("--best: calmodulin expected")
    parts = PARTS[asked.protein]
    tables, sets = problem_of(lab, asked.protein), {}
    for seed in asked.seeds:
        name = f"ranking-{asked.protein}-{seed}"
        if asked.best:
            problem = calmodulin.with_strategies(tables, calmodulin.VARIANTS["all"])
            built = lab.build(f"calmodulin-all-{seed}", problem, seed, cpu_limit=asked.best)
            how = BEST
        else:
            built, how = lab.build(name, tables, seed, "--max-nodes", str(asked.most)), FAST
        folder, rows, _ = lab.paths(built, f"{name}-paths", *how)
        sets[seed] = folder, rows, [frames_of(f"{folder}/path-{row['path']}.pdb") for row in rows]
    listed, firsts = [], []
    for seed, (folder, rows, _) in sets.items():
        for row in rows:
            middle = midways(folder, row["path"], parts)
            first, second = sorted(parts, key=middle.get)[:2]
            first = first if middle[second] - middle[first] >= TOGETHER else "together"
            firsts.append((row["path"], first))
            shares = (f"{middle[part]:.2f}" for part in parts)
            numbers = (f"{column(row, key):.1f}" for key in ("barrier [", "cost [", "cost_back"))
            listed.append((seed, row["path"], *numbers, f"{column(row, 'length'):.2f}", *shares, first))
    table(
        [
            "seed",
            "path",
            "barrier, kJ/mol",
            "cost, kT",
            "back",
            "length, Å",
            *(f"{part} midway at" for part in parts),
            "first",
        ],
        listed,
    )
    print()
    between = []
    for one, other in itertools.combinations(sets, 2):
        left, right = sets[one], sets[other]
        apart = np.array([[frechet(a, b) for b in right[2]] for a in left[2]])
        costs = [[column(row, "cost [") for row in of[1]] for of in (left, right)]
        nearest = [int(np.argmin(line)) for line in apart]
        # Of each two paths with nearest ones that differ: whether the cheaper one's nearest is the cheaper one, too.
        pairs = [(a, b) for a, b in itertools.combinations(range(len(nearest)), 2) if nearest[a] != nearest[b]]
        agree = sum((costs[0][a] < costs[0][b]) == (costs[1][nearest[a]] < costs[1][nearest[b]]) for a, b in pairs)
        within = sum(min(line) < 1.5 for line in apart)
        between.append(
            (
                one,
                other,
                apart[0, 0],
                nearest[0] + 1,
                within,
                len(apart),
                f"{agree} of {len(pairs)}",
                float(np.median(apart.min(axis=1))),
            )
        )
        note(f"seeds {one} and {other}: {apart[0, 0]:.2f} Å")
    table(
        [
            "seeds",
            "best and best, Å",
            "nearest to the best",
            "paths with one within 1.5 Å",
            "median of the nearest, Å",
            "order of costs agrees",
        ],
        [
            (f"{a}, {b}", f"{best:.2f}", f"path {near}", f"{within} of {all_}", f"{middle:.2f}", agree)
            for a, b, best, near, within, all_, agree, middle in between
        ],
    )
    print(f"\nbest to best: {spread([row[2] for row in between], 2)} Å")
    for path in sorted({path for path, _ in firsts}):
        of = [first for which, first in firsts if which == path]
        print(
            f"path {path}: first "
            + ", ".join(f"{part} {of.count(part)}" for part in [*parts, "together"] if part in of)
        )


def options(parser):
    parser.add_argument("protein", nargs="?", default="chignolin", choices=list(PARTS))
    parser.add_argument("--most", type=int, default=40_000, help="nodes of a build at most (40000)")
    parser.add_argument(
        "--best",
        type=float,
        metavar="CPU",
        help="of calmodulin only the cheapest path, of the builds that `calmodulin strategies --cpu CPU` makes",
    )
