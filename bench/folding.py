#!/usr/bin/env python3
"""In which order the parts of proteins form, over several seeds: `roadmill fold` and `roadmill orders`, as a table.

    ROADMILL_DATA=../shared/data python3 bench/folding.py 1PGA 1BDD 1MI0:A --nodes 10000 --unstructured 4

A row per protein and seed: the number of pathways, the most frequent order of the helices and strands, and for every pair that is asked
for the shares of pathways on which the first forms before the second, and the second before the first. Runs that are there are not
made again.
"""

import argparse
import csv
import os
import pathlib
import shutil
import subprocess
import sys

# Of protein G and its variants the two hairpins, of protein A the helices that Table 5.2 of S. Nath 2013 orders.
PAIRS = {
    "1PGA": [("β1–β2", "β3–β4")],
    "1MI0": [("β1–β2", "β3–β4")],
    "1BDD": [("α2", "α1"), ("α3", "α1")],
}


def arguments():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("proteins", nargs="+", metavar="ENTRY[:CHAIN]", help="names of files in structures/, with a chain or without")
    parser.add_argument("--seeds", type=int, default=5, help="so many seeds, from 1 on")
    parser.add_argument("--nodes", type=int, default=10000, help="nodes of each roadmap at most")
    parser.add_argument("--unstructured", type=int, default=0, help="native contacts at which a pathway may begin")
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


def folded(args, data, entry, chain, seed):
    """The run of a protein and a seed: its folder."""
    out = args.work / f"{entry}-{args.nodes}-{seed}"
    # A limit of nodes may end it before its criterion does: exit code 3.
    command = [args.roadmill, "fold", data / f"{entry}.pdb", "--out", out, "--seed", seed, "--max-nodes", args.nodes]
    command += ["--threads", 1, "--or-resume"] + (["--chain", chain] if chain else [])
    if not out.with_suffix(".html").exists():
        run(command, [0, 3])
    return out


def main():
    args = arguments()
    root = os.environ.get("ROADMILL_DATA")
    if not root:
        sys.exit("ROADMILL_DATA: not set; the folder with structures/ expected")
    data = pathlib.Path(root) / "structures"
    args.work.mkdir(parents=True, exist_ok=True)
    for name in args.proteins:
        entry, _, chain = name.partition(":")
        if not (data / f"{entry}.pdb").is_file():
            sys.exit(f"{data / entry}.pdb: not found; an entry of {data} expected")
        pairs = PAIRS.get(entry, [])
        print(f"\n| {entry}, seed | pathways | most frequent order | share |" + "".join(f" {a} < {b} | {b} < {a} |" for a, b in pairs))
        print("| --- | --- | --- | --- |" + " --- | --- |" * len(pairs))
        for seed in range(1, args.seeds + 1):
            out = folded(args, data, entry, chain, seed)
            tables = args.work / "tables"
            shutil.rmtree(tables, ignore_errors=True)
            run([args.roadmill, "orders", out, "--unstructured", args.unstructured, "--out", tables], [0, 3])
            orders = [row for row in rows(tables / "orders.csv") if row["of"] == "elements"]
            count = sum(int(row["pathways"]) for row in orders)
            best = orders[0] if orders else {"order": "none", "share": "nan"}
            share = {(row["first"], row["second"]): float(row["share"]) for row in rows(tables / "precedence.csv")}
            cells = [f"{share.get(pair, float('nan')):.2f}" for a, b in pairs for pair in ((a, b), (b, a))]
            print(f"| {seed} | {count} | {best['order']} | {float(best['share']):.2f} |" + "".join(f" {cell} |" for cell in cells), flush=True)


if __name__ == "__main__":
    main()
