"""Whether a protein's roadmap has the same bits whoever works, and after its processes were killed.

The same problem is built with 1, 2 and 4 workers, and once more with 2 while a worker and then the coordinator are killed
(SIGKILL), twice; each time it is resumed. All digests have to be the same, and `verify --all` has to find nothing.
"""

import json
import os
import signal
import shutil
import subprocess
import time

from img import problem_of
from ledgers import Ledger
from runs import note, table, toml


def children(pid):
    with open(f"/proc/{pid}/task/{pid}/children") as file:
        return [int(word) for word in file.read().split()]


def killed(lab, name, file, seed, nodes):
    """Builds, killing a worker at once and the coordinator some rounds later, twice; the digest, and at which rounds."""
    folder, kills = lab.path(name), []
    whole = [
        "build",
        file,
        "--out",
        folder,
        "--seed",
        str(seed),
        "--workers",
        "2",
        "--max-nodes",
        str(nodes),
        "--json",
        "--or-resume",
    ]
    for turn in range(3):
        process = subprocess.Popen([lab.binary, *whole], stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True)
        ledger, before = Ledger(folder), None
        worker = None
        while turn < 2 and process.poll() is None:
            ledger.more()
            before = len(ledger.rounds) if before is None else before
            if worker is None and children(process.pid):
                worker = children(process.pid)[0]
                os.kill(worker, signal.SIGKILL)
                note(f"worker {worker} killed at round {len(ledger.rounds)}")
            if worker and len(ledger.rounds) >= before + 2:
                kills.append(len(ledger.rounds))
                os.kill(process.pid, signal.SIGKILL)
                note(f"coordinator killed at round {kills[-1]}")
                break
            time.sleep(0.01)
        out = process.communicate()[0]
    last = json.loads(out.strip().splitlines()[-1])
    return last, kills


def run(lab, asked):
    # Rounds of four sets, so that there are enough of them to be killed between.
    tables = problem_of(lab, "calmodulin")
    tables = {**tables, "evaluators": [], "img": {**tables["img"], "sets_per_round": 4}}
    rows, seed = [], asked.seeds[0]
    for workers in (1, 2, 4):
        built = lab.build(f"restart-{workers}", tables, seed, "--max-nodes", str(asked.nodes), workers=workers)
        rows.append((f"{workers} workers", built.summary["nodes"], built.summary["digest"]))
    name = "restart-killed"
    file = lab.path(f"{name}.toml")
    shutil.rmtree(lab.path(name), ignore_errors=True)
    with open(file, "w") as opened:
        opened.write(toml({**tables, "name": name}))
    last, kills = killed(lab, name, file, seed, asked.nodes)
    rows.append(
        (
            f"2 workers, one killed twice; coordinator killed after rounds {' and '.join(map(str, kills))}",
            last["nodes"],
            last["digest"],
        )
    )
    table(["build", "nodes", "digest"], rows)
    same = len({row[2] for row in rows}) == 1
    out, cpu = lab.command("verify", lab.path(name), "--all", "--threads", "1")
    print(
        f"\nall the same: {'yes' if same else 'NO'}; `verify --all` of the killed one ({cpu:.1f} CPU s): {out.strip()}"
    )
    if not same or len(kills) != 2:
        raise SystemExit(1)


def options(parser):
    parser.add_argument("--nodes", type=int, default=1200, help="nodes of a build (1200)")
