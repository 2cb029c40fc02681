"""Problems, builds and paths for the studies of transitions: the program is started, watched, and its CPU time counted.

CPU seconds are those of the system (user and system time) of the process and of all that it waited for, as `wait4` gives
them. A build can be ended at a number of CPU seconds: it is watched through /proc and interrupted as by Ctrl-C, so
its last complete round stays.
"""

import csv
import json
import os
import shutil
import signal
import statistics
import subprocess
import sys
import time
import tomllib
from dataclasses import asdict, dataclass

from ledgers import Ledger, Round, Verdict

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
PAUSE = 0.2  # seconds between two looks at a build
TICK = os.sysconf("SC_CLK_TCK")

CALMODULIN = ("1CFD.pdb", "1CLL.pdb", ["--residues", "4-147"])
KINASE = ("4AKE.pdb", "1AKE.pdb", ["--chain", "A"])

# The default criteria of a transition: flow ratio, and fall of the barrier in model kJ/mol while the nodes doubled (5 kT).
RATIO, FALL = 5.0, 12.395

# The evaluators of builds that go on to a limit: the first two are never met.
JUDGED = [
    {"flow-ratio": {"ratio": 1e9}},
    {"lowest-barrier": {"energy": -1e9}},
    {"query": {}},
    {"barrier-trend": {"energy": FALL}},
]


def judged(round_):
    """What `JUDGED` says of a round: the flow ratio; the flow there and back, 1/kT; the lowest barrier as an energy, model
    kJ/mol; the cost of the cheapest path, kT; whether the default criteria are met."""
    ratio, barrier, query, fall = round_.verdicts
    return {
        "ratio": ratio.value,
        "flow": ratio.measures[0],
        "flow back": ratio.measures[2],
        "peak": barrier.value,
        "cost": query.path_cost,
        "is enough": ratio.value >= RATIO and fall.satisfied,
    }


@dataclass
class Run:
    """A build that has ended."""

    folder: str
    cpu: float
    rounds: list
    summary: dict

    @staticmethod
    def known(folder, cpu, rounds, summary):
        """A run out of what was noted of it."""
        for round_ in rounds:
            round_["verdicts"] = [Verdict(**verdict) for verdict in round_["verdicts"]]
        return Run(folder, cpu, [Round(**round_) for round_ in rounds], summary)

    @property
    def last(self):
        """The last round that was judged."""
        return self.rounds[-1]


class Lab:
    """Where a study works: the program, the structures, and a folder for its runs."""

    def __init__(self, binary, data, folder):
        self.binary, self.structures, self.folder = binary, os.path.join(data, "structures"), folder
        os.makedirs(folder, exist_ok=True)
        for what in (binary, self.structures):
            if not os.path.exists(what):
                sys.exit(f"{what}: not found; see --help")

    def path(self, name):
        return os.path.join(self.folder, name)

    def command(self, *arguments, codes=(0,)):
        """Runs the program; what it printed, and its CPU seconds."""
        process = subprocess.Popen([self.binary, *arguments], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        out, err = process.stdout.read(), process.stderr.read()
        _, status, usage = os.wait4(process.pid, 0)
        process.returncode = os.waitstatus_to_exitcode(status)
        if process.returncode not in codes:
            sys.exit(f"{' '.join(arguments)}: exit code {process.returncode}\n{err}")
        return out, usage.ru_utime + usage.ru_stime

    def transition(self, name, ends):
        """The problem between two structures as `transition` makes it, as nested tables; written once."""
        file = self.path(f"{name}.toml")
        if not os.path.exists(file):
            first, second, more = ends
            first, second = (os.path.join(self.structures, end) for end in (first, second))
            self.command("protein", "problem", first, second, *more, "--out", file)
        with open(file, "rb") as opened:
            return tomllib.load(opened)

    def chignolin(self):
        """The problem that ships, its structure named by a path that holds from everywhere."""
        folder = os.path.join(ROOT, "problems")
        with open(os.path.join(folder, "chignolin.toml"), "rb") as opened:
            tables = tomllib.load(opened)
        source = tables["protein"]["source"]
        source["file"] = os.path.join(folder, source["file"])
        return tables

    def build(self, name, tables, seed, *arguments, cpu_limit=None, workers=None, before=()):
        """Builds anew; the run. `cpu_limit` ends it at so many CPU seconds, which needs a single process; `before` are words that
        the command begins with, such as a profiler's. A build that was made before by the same command is not made again.
        """
        file, folder = self.path(f"{name}.toml"), self.path(name)
        text = toml({**tables, "name": name})
        who = ["--workers", str(workers)] if workers else ["--threads", "1"]
        whole = [*before, self.binary, "build", file, "--out", folder, "--seed", str(seed), *who, "--json", *arguments]
        asked = {"command": whole, "problem": text, "cpu_limit": cpu_limit}
        noted = self.path(f"{name}.json")
        if os.path.exists(noted):
            with open(noted) as opened:
                known = json.load(opened)
            if known.pop("asked") == asked:
                return Run.known(**known)
        with open(file, "w") as opened:
            opened.write(text)
        if os.path.exists(os.path.join(folder, "ledger")):
            shutil.rmtree(folder)
        run = self.watched(name, whole, folder, cpu_limit)
        with open(noted, "w") as opened:
            json.dump({"asked": asked, **asdict(run)}, opened)
        cpu, summary = run.cpu, run.summary
        note(f"{name} seed {seed}: {summary['nodes']} nodes, {cpu:.1f} CPU s, {summary['stop']}")
        return run

    def watched(self, name, command, folder, cpu_limit):
        """Runs a build and notes every judgement as it is written."""
        output, errors = (open(self.path(f"{name}.{kind}"), "w+") for kind in ("out", "err"))
        process = subprocess.Popen(command, stdout=output, stderr=errors)
        ledger, rounds, is_asked_to_end = Ledger(folder), [], False
        while True:
            pid, _, usage = os.wait4(process.pid, os.WNOHANG)
            now = usage.ru_utime + usage.ru_stime if pid else cpu_of(process.pid)
            for judged_round in ledger.more():
                judged_round.cpu = now
                rounds.append(judged_round)
            if pid:
                break
            if cpu_limit and now >= cpu_limit and not is_asked_to_end:
                process.send_signal(signal.SIGINT)
                is_asked_to_end = True
            time.sleep(PAUSE)
        process.returncode = 0  # waited for above
        output.seek(0), errors.seek(0)
        lines = [json.loads(line) for line in output if line.startswith("{")]
        complaint = errors.read()
        output.close(), errors.close()
        summary = next((line for line in lines if line["event"] == "summary"), None)
        # Whatever limit ended it has a summary; only a build without one has failed.
        if summary is None:
            sys.exit(f"{name}: {complaint}")
        return Run(folder, now, rounds, summary)

    def go_on(self, run, tables, nodes):
        """Goes on with a build by other evaluators (`JUDGED`) to so many nodes; the flow ratio there."""
        ledger = Ledger(run.folder)

        def there():
            ledger.more()
            return [r for r in ledger.rounds if r.nodes >= nodes and len(r.verdicts) == len(JUDGED)]

        if not there():
            name = os.path.basename(run.folder)
            file = self.path(f"{name}-on.toml")
            with open(file, "w") as opened:
                opened.write(toml({**tables, "name": name, "seed": run.summary["seed"]}))
            limit = ["--threads", "1", "--max-nodes", str(nodes), "--json"]
            self.command("resume", run.folder, "--with", file, *limit, codes=(0, 3))
        return judged(there()[0])["ratio"]

    def paths(self, run, name, *arguments):
        """Several paths of a run: the folder they are written to, the rows of its table, and the CPU seconds."""
        folder, noted = self.path(name), self.path(f"{name}.json")
        asked = [run.summary["digest"], *arguments]
        if os.path.exists(noted):
            with open(noted) as opened:
                known = json.load(opened)
            if known["asked"] == asked:
                return folder, known["rows"], known["cpu"]
        shutil.rmtree(folder, ignore_errors=True)
        _, cpu = self.command("paths", run.folder, "--out", folder, *arguments, codes=(0, 3))
        note(f"paths of {name}: {cpu:.1f} CPU s")
        table = os.path.join(folder, "paths.csv")
        rows = read_csv(table) if os.path.exists(table) else []
        with open(noted, "w") as opened:
            json.dump({"asked": asked, "rows": rows, "cpu": cpu}, opened)
        return folder, rows, cpu


def cpu_of(pid):
    """CPU seconds of a process that runs, in the system's ticks."""
    with open(f"/proc/{pid}/stat") as file:
        fields = file.read().rsplit(")", 1)[1].split()
    return sum(map(int, fields[11:15])) / TICK


def read_csv(path):
    with open(path) as file:
        return list(csv.DictReader(file))


def column(row, start):
    """The value of the column whose name begins so, as a number."""
    return float(next(value for name, value in row.items() if name.startswith(start)))


def toml(tables):
    """Tables as a TOML file, a top-level key a line."""
    return "".join(f"{key} = {toml_value(value)}\n" for key, value in tables.items())


def toml_value(value):
    if isinstance(value, dict):
        return "{ " + ", ".join(f"{key} = {toml_value(inner)}" for key, inner in value.items()) + " }"
    if isinstance(value, list):
        return "[" + ", ".join(map(toml_value, value)) + "]"
    return json.dumps(value, ensure_ascii=False)


def note(text):
    print(text, file=sys.stderr, flush=True)


def table(head, rows):
    """Prints a table as Markdown."""
    print("| " + " | ".join(head) + " |")
    print("| " + " | ".join("---" for _ in head) + " |")
    for row in rows:
        print("| " + " | ".join(map(str, row)) + " |")
    sys.stdout.flush()


def spread(values, digits=0):
    """The median, and the least and the largest value in brackets."""
    values = [value for value in values if value is not None]
    if not values:
        return "none"
    shown = lambda value: f"{value:.{digits}f}"
    low, high = min(values), max(values)
    if shown(low) == shown(high):
        return shown(low)
    return f"{shown(statistics.median(values))} ({shown(low)}–{shown(high)})"
