#!/usr/bin/env python3
"""Which of many URDFs load, and if not, why: a table.

    pip download --no-deps example-robot-data && unzip -q example_robot_data-*.whl -d robots
    python3 bench/urdf.py target/release/roadmill robots > table.md

Every `.urdf` below the folder is given to `roadmill check`. The table has one row for each: degrees of freedom, links, pairs
of links that are tested, triangles, and how long it took; of those that do not load what the program says.
"""

import re
import resource
import subprocess
import sys
from pathlib import Path


def checked(program, urdf):
    """What `check` says of a file, whether it could be used, and the processor time that this took in seconds."""
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    done = subprocess.run([program, "check", str(urdf)], capture_output=True, text=True, check=False)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    seconds = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
    return done.stdout if done.returncode == 0 else done.stderr, done.returncode, seconds


def number(pattern, text):
    """The first number that a pattern finds, or 0."""
    found = re.search(pattern, text)
    return int(found.group(1)) if found else 0


def row(program, folder, urdf):
    """The row of one file, and whether it loaded."""
    said, code, seconds = checked(program, urdf)
    name = urdf.relative_to(folder)
    short = "/".join(part for part in name.parts if part not in ("urdf", "robots"))[-60:]
    if code != 0:
        last = said.strip().splitlines()[-1] if said.strip() else f"exit code {code}"
        reason = last.replace(str(urdf.parent) + "/", "").replace(str(folder) + "/", "").replace("|", "\\|")
        return f"| `{short}` | – | – | – | – | {seconds:.1f} | {reason} |", False
    configuration = re.search(r"configuration\s+(.*)", said)
    values = len(configuration.group(1).split()) if configuration else 0
    links, pairs = number(r"(\d+) links, ", said), number(r"links, (\d+) pairs", said)
    triangles = sum(int(count) for count in re.findall(r"\((\d+) triangles\)", said))
    followers = len(re.findall(r"has no value: it follows", said))
    note = {0: "", 1: "1 joint follows another"}.get(followers, f"{followers} joints follow others")
    return f"| `{short}` | {values} | {links} | {pairs} | {triangles} | {seconds:.1f} | {note} |", True


def main():
    """Writes the table."""
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    program, folder = sys.argv[1], Path(sys.argv[2])
    files = sorted(folder.rglob("*.urdf"))
    rows = [row(program, folder, urdf) for urdf in files]
    loaded = sum(1 for _, loads in rows if loads)
    print(f"{loaded} of {len(files)} load.\n")
    print("| robot | values | links | pairs tested | triangles | CPU s | |")
    print("|-------|-------:|------:|-------------:|----------:|------:|-|")
    print("\n".join(text for text, _ in rows))


if __name__ == "__main__":
    main()
