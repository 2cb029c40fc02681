#!/usr/bin/env python3
"""Studies of proteins' transitions: each subcommand builds what it needs and prints its tables as Markdown.

    ROADMILL_DATA=/path/to/data python3 bench/transitions/studies.py STUDY [--binary target/release/roadmill] [--out FOLDER]

docs/transition-studies.md says what came of them. Every build is one process and one thread where nothing else is said, and
CPU seconds are the system's (user and system), not wall time. `ranking` needs numpy, the others nothing but Python 3.11 or later.
"""

import argparse
import os
import sys

import calmodulin
import controls
import img
import ledger_size
import restart
import throughput
from runs import ROOT, Lab

STUDIES = {
    "calmodulin": calmodulin,
    "img": img,
    "controls": controls,
    "ranking": None,  # imported when it is asked for, since it needs numpy
    "throughput": throughput,
    "bytes": ledger_size,
    "restart": restart,
}


def main():
    if "ranking" in sys.argv[1:2]:
        import ranking

        STUDIES["ranking"] = ranking
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    commands = parser.add_subparsers(dest="study", required=True)
    for name, study in STUDIES.items():
        about = study.__doc__ if study else "How stable the ranking of dissimilar paths is over seeds; needs numpy."
        command = commands.add_parser(
            name, help=about.split("\n")[0], description=about, formatter_class=argparse.RawDescriptionHelpFormatter
        )
        command.add_argument("--binary", default=os.path.join(ROOT, "target/release/roadmill"), help="the program")
        command.add_argument("--out", default="runs/studies", help="a folder for problems and runs (runs/studies)")
        command.add_argument("--seeds", type=int, nargs="+", default=[1, 2, 3, 4, 5], help="base seeds (1 to 5)")
        if study:
            study.options(command)
    asked = parser.parse_args()
    data = os.environ.get("ROADMILL_DATA")
    if not data:
        sys.exit("ROADMILL_DATA: not set; the folder with `structures` expected")
    STUDIES[asked.study].run(
        Lab(os.path.abspath(asked.binary), os.path.abspath(data), os.path.abspath(asked.out)), asked
    )


main()
