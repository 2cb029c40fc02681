#!/usr/bin/env python3
"""In which order the parts of proteins form, over several seeds and for variants of the model, as tables.

    export ROADMILL_DATA=/path/to/data
    python3 bench/folding.py 1PGA 1BDD 1MI0:A --seeds 1-10 --nodes 5000
    python3 bench/folding.py 1PGA 1BDD 1MI0:A --seeds 1-10 --nodes 5000 --variants no-energy,scrambled --brief
    python3 bench/folding.py 1PGA 1BDD 1MI0:A --seeds 1-10 --nodes 1000 --variants rrt,m1,m3,m5,m7 --times

`roadmill fold` writes the problem of each protein; of that its criterion is replaced by a limit of nodes, so that all roadmaps are of one
size, and what the variant changes is changed. `roadmill build` grows the roadmaps, one thread each, and `roadmill orders` says the orders.
Runs that are there are not made again.

A table has a row per protein and seed: the number of pathways, the most frequent order of the helices and strands, and for every pair
of parts that is asked for the shares of pathways on which the first forms before the second, and the second before the first. With
`--brief` there is a row per protein and variant: in how many seeds the first of the pair is before the second on more pathways than the other
way round, with the 95 % interval of Clopper and Pearson, in how many the second is, and the mean shares. With `--times` it has pathways and seconds instead.
"""

import argparse
import csv
import os
import pathlib
import random
import re
import resource
import shutil
import subprocess
import sys

# Of protein G and its variants the two hairpins, of protein A the helices that Table 5.2 of S. Nath 2013 orders.
PAIRS = {
    "1PGA": [("β1–β2", "β3–β4")],
    "1MI0": [("β1–β2", "β3–β4")],
    "1BDD": [("α2", "α1"), ("α3", "α1")],
}
MRRG = re.compile(r"mrrg = \{ (step = [\d.]+), goal_bias = [\d.]+, neighbors = \d+, directions = \d+, trials = \d+, (attempts = \d+) \}")
ENERGY = "constraints = true, hydrophobic = true"


def energy(constraints, hydrophobic):
    """A variant with these terms of the energy."""
    return lambda text: replaced(text, ENERGY, f"constraints = {constraints}, hydrophobic = {hydrophobic}")


def replaced(text, old, new):
    if old not in text:
        sys.exit(f"`{old}` not found in the problem that `roadmill fold` wrote")
    return text.replace(old, new)


def trees(text):
    """RRT, as the thesis compares with: one direction, and no edges but those of the tree."""
    text = MRRG.sub(r"rrt = { \1, goal_bias = 0.0, \2 }", text)
    return re.sub(r"^among = .*$", 'among = { until-joined = { planners = ["straight-line"] } }', text, flags=re.M)


VARIANTS = {
    "fold": lambda text: text,
    "no-energy": energy("false", "false"),
    "no-hydrophobic": energy("true", "false"),
    "no-constraints": energy("false", "true"),
    "scrambled": lambda text: text,
    "rrt": trees,
    **{f"m{m}": lambda text, m=m: replaced(text, "directions = 7", f"directions = {m}") for m in (1, 3, 5, 7)},
}


def variant_of(name):
    """What is made of a problem's text; `highest-50000` allows no energy above that, model kJ/mol."""
    if name.startswith("highest-"):
        highest = float(name.removeprefix("highest-"))
        return lambda text: replaced(text, "\nturn = ", f"\nhighest = {highest}\nturn = ")
    if name not in VARIANTS:
        sys.exit(f"--variants: {name} found; {', '.join(VARIANTS)} or highest-ENERGY expected")
    return VARIANTS[name]


def seeds_of(text):
    match = re.fullmatch(r"(\d+)-(\d+)", text)
    if not match:
        raise argparse.ArgumentTypeError("the first and the last seed expected, such as 1-10")
    return range(int(match[1]), int(match[2]) + 1)


def arguments():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("proteins", nargs="+", metavar="ENTRY[:CHAIN]", help="names of files in structures/, with a chain or without")
    parser.add_argument("--seeds", type=seeds_of, default=seeds_of("1-5"), metavar="FIRST-LAST", help="base seeds")
    parser.add_argument("--nodes", type=int, default=10000, help="nodes of each roadmap")
    parser.add_argument("--variants", default="fold", help="names with commas between: fold, " + ", ".join(list(VARIANTS)[1:]) + ", highest-ENERGY")
    parser.add_argument("--unstructured", type=int, help="native contacts at which a pathway may begin [default: a twentieth, as `fold`]")
    parser.add_argument("--formed", type=float, default=0.6, help="the share of its contacts from which on a part is formed")
    parser.add_argument("--brief", action="store_true", help="a row per protein and variant")
    parser.add_argument("--times", action="store_true", help="a row per protein and variant: pathways, edges and CPU seconds")
    parser.add_argument("--work", type=pathlib.Path, default=pathlib.Path("runs/folding"), help="where the runs are made")
    parser.add_argument("--roadmill", default="target/release/roadmill", help="the program")
    return parser.parse_args()


def run(command, codes):
    """Runs a command that ends with one of the exit codes; says what it said if it does not."""
    try:
        done = subprocess.run([str(word) for word in command], capture_output=True, text=True)
    except OSError as error:
        sys.exit(f"{command[0]}: {error.strerror}; --roadmill names the program")
    if done.returncode not in codes:
        sys.exit(f"{' '.join(map(str, command))}: exit code {done.returncode}\n{done.stderr}")
    return done


def rows(path):
    with open(path, encoding="utf-8") as file:
        return list(csv.DictReader(file))


def problem_of(args, data, entry, chain):
    """The problem of a protein's folding, as `fold` writes it, and how many contacts an unstructured conformation has at most."""
    out = args.work / entry
    file = out.with_suffix(".toml")
    if not file.exists():
        command = [args.roadmill, "fold", data / f"{entry}.pdb", "--out", out, "--max-sets", 1, "--threads", 1]
        run(command + (["--chain", chain] if chain else []), [0, 3])
    text = file.read_text(encoding="utf-8")
    return text, int(re.search(r"unstructured = (\d+)", text)[1])


def scrambled(args, entry, seed):
    """The file of a structure whose residues have one another's names, all but glycine and proline: as many count as hydrophobic, but
    others. No atom moves."""
    lines = (args.work / f"{entry}-structures/source.cif").read_text(encoding="utf-8").splitlines()
    rows = [line.split() for line in lines if line.startswith("ATOM ")]
    names = {row[8]: row[5] for row in rows}
    given = [number for number, name in names.items() if name not in ("GLY", "PRO")]
    shuffled = [names[number] for number in given]
    random.Random(seed).shuffle(shuffled)
    names.update(zip(given, shuffled))
    for row in rows:
        row[5] = row[16] = names[row[8]]
    rows = iter(rows)
    lines = [" ".join(next(rows)) if line.startswith("ATOM ") else line for line in lines]
    name = f"{entry}-structures/scrambled-{seed}.cif"
    (args.work / name).write_text("\n".join(lines) + "\n", encoding="utf-8")
    return name


def grown(args, text, entry, variant, seed):
    """The run of a variant and a seed: its folder, and the CPU seconds that it took."""
    out = args.work / f"{entry}-{variant}-{args.nodes}-{seed}"
    seconds = out.with_suffix(".seconds")
    if not seconds.exists():
        text = variant_of(variant)(text.split("[[evaluators]]")[0])
        text = re.sub(r"^seed = \d+$", f"seed = {seed}", text, flags=re.M)
        if variant == "scrambled":
            text = replaced(text, f"{entry}-structures/source.cif", scrambled(args, entry, seed))
        out.with_suffix(".toml").write_text(f"{text}\n[limits]\nnodes = {args.nodes}\n", encoding="utf-8")
        before = resource.getrusage(resource.RUSAGE_CHILDREN)
        run([args.roadmill, "build", out.with_suffix(".toml"), "--out", out, "--threads", 1, "--force"], [0])
        after = resource.getrusage(resource.RUSAGE_CHILDREN)
        taken = sum(getattr(after, key) - getattr(before, key) for key in ("ru_utime", "ru_stime"))
        seconds.write_text(f"{taken}\n", encoding="utf-8")
    return out, float(seconds.read_text(encoding="utf-8"))


def orders_of(args, out, unstructured):
    """Of a run the number of pathways, the most frequent order with its share, and the shares by pairs of parts."""
    tables = args.work / "tables"
    shutil.rmtree(tables, ignore_errors=True)
    run([args.roadmill, "orders", out, "--unstructured", unstructured, "--formed", args.formed, "--out", tables], [0, 3])
    if not (tables / "orders.csv").exists():
        return 0, ("none", float("nan")), {}
    orders = [row for row in rows(tables / "orders.csv") if row["of"] == "elements"]
    shares = {(row["first"], row["second"]): float(row["share"]) for row in rows(tables / "precedence.csv")}
    return sum(int(row["pathways"]) for row in orders), (orders[0]["order"], float(orders[0]["share"])), shares


def chances(successes, trials, share):
    """The probability of at least so many successes, and of at most so many, each with this probability."""
    from math import comb

    terms = [comb(trials, k) * share**k * (1 - share) ** (trials - k) for k in range(trials + 1)]
    return sum(terms[successes:]), sum(terms[: successes + 1])


def interval(successes, trials):
    """The 95 % interval of Clopper and Pearson for the probability of a success."""

    def bound(is_above):
        low, high = 0.0, 1.0
        for _ in range(60):
            middle = (low + high) / 2
            low, high = (low, middle) if is_above(middle) else (middle, high)
        return low

    lower = 0.0 if successes == 0 else bound(lambda share: chances(successes, trials, share)[0] > 0.025)
    upper = 1.0 if successes == trials else bound(lambda share: chances(successes, trials, share)[1] < 0.025)
    return lower, upper


def table(args, entry, pairs, made):
    """A row per seed."""
    print(f"\n| {entry}, seed | pathways | most frequent order | share |" + "".join(f" {a} < {b} | {b} < {a} |" for a, b in pairs))
    print("| --- | --- | --- | --- |" + " --- | --- |" * len(pairs))
    for seed, _, (count, (order, share), shares) in made:
        cells = [f"{shares.get(pair, float('nan')):.2f}" for a, b in pairs for pair in ((a, b), (b, a))]
        print(f"| {seed} | {count} | {order} | {share:.2f} |" + "".join(f" {cell} |" for cell in cells), flush=True)


def brief(entry, variant, pairs, made):
    """A row for each pair: every seed is one observation."""
    for a, b in pairs:
        known = [(shares[a, b], shares[b, a]) for _, _, (_, _, shares) in made if shares]
        first, second = sum(x > y for x, y in known), sum(y > x for x, y in known)
        low, high = interval(first, len(known)) if known else (0.0, 1.0)
        means = [sum(pair[at] for pair in known) / max(len(known), 1) for at in (0, 1)]
        print(f"| {entry} | {variant} | {a} < {b} | {first} of {len(known)} ({low:.2f} to {high:.2f}) | {second} | {means[0]:.2f} | {means[1]:.2f} |", flush=True)


def times(entry, variant, made):
    """A row: means over the seeds, with the least and the most."""
    cell = lambda values, digits: f"{sum(values) / len(values):.{digits}f} ({min(values):.{digits}f} to {max(values):.{digits}f})"
    pathways, seconds = [found[0] for _, _, found in made], [seconds for _, seconds, _ in made]
    print(f"| {entry} | {variant} | {cell(pathways, 0)} | {cell(seconds, 2)} |", flush=True)


def main():
    args = arguments()
    root = os.environ.get("ROADMILL_DATA")
    if not root:
        sys.exit("ROADMILL_DATA: not set; the folder with structures/ expected")
    data = pathlib.Path(root) / "structures"
    args.work.mkdir(parents=True, exist_ok=True)
    if args.brief:
        print("| protein | variant | pair | first before second, of seeds (95 %) | the reverse | mean share | of the reverse |\n|" + " --- |" * 7)
    if args.times:
        print("| protein | variant | pathways | CPU seconds |\n|" + " --- |" * 4)
    for name in args.proteins:
        entry, _, chain = name.partition(":")
        if not (data / f"{entry}.pdb").is_file():
            sys.exit(f"{data / entry}.pdb: not found; an entry of {data} expected")
        text, unstructured = problem_of(args, data, entry, chain)
        unstructured = unstructured if args.unstructured is None else args.unstructured
        for variant in args.variants.split(","):
            made = []
            for seed in args.seeds:
                out, seconds = grown(args, text, entry, variant, seed)
                made.append((seed, seconds, orders_of(args, out, unstructured)))
            pairs = PAIRS.get(entry, [])
            if args.brief:
                brief(entry, variant, pairs, made)
            elif args.times:
                times(entry, variant, made)
            else:
                table(args, entry, pairs, made)


if __name__ == "__main__":
    main()
