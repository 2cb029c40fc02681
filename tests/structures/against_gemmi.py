"""Holds what is read of structure files against gemmi.

Usage: against_gemmi.py FILE ..., while what `roadmill protein info --json` prints for each file comes on stdin, a line
each. The files have the same models, and each of these as many atoms, alternatives included, and residues.
"""

import json
import sys

import gemmi

files = sys.argv[1:]
lines = sys.stdin.read().splitlines()
assert len(lines) == len(files), f"{len(lines)} lines for {len(files)} files"
for file, line in zip(files, lines):
    ours = [(m["number"], m["atoms"], m["residues"]) for m in json.loads(line)["models"]]
    structure = gemmi.read_structure(file)
    theirs = [
        (model.num, model.count_atom_sites(), sum(len(chain) for chain in model))
        for model in structure
    ]
    assert ours == theirs, f"{file}: {ours} and by gemmi {theirs}"
print(f"{len(files)} files agree")
