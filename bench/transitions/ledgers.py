"""Reads from a run's ledger how a build went, round by round. docs/ledger.md describes the bytes.

Only what the studies of transitions need is read: the ends of rounds and the judgements. Sets are passed over unread.
"""

import os
import struct
from dataclasses import dataclass, field

HEADING = 16  # `roadmill ledger` and the version of the format
FRAME = 48  # length, check of the length, and hash, before every payload
SET_KINDS, ROUND, JUDGEMENT = (1, 5), 2, 3


@dataclass
class Verdict:
    """What one evaluator said of a round."""

    satisfied: bool
    value: float
    measures: list  # the evaluator's further numbers, in its own order
    path_cost: float | None  # of its path from start to goal: the sum of its motions' costs


@dataclass
class Round:
    """What a roadmap had come to at the end of a round."""

    sets: int
    nodes: int
    edges: int
    components: int
    verdicts: list = field(default_factory=list)
    cpu: float | None = None  # CPU seconds of the build when the judgement was seen, where it was watched


class Bytes:
    """Numbers, one after the other, out of bytes."""

    def __init__(self, data):
        self.data, self.at = data, 0

    def take(self, layout):
        size = struct.calcsize("<" + layout)
        values = struct.unpack_from("<" + layout, self.data, self.at)
        self.at += size
        return values[0] if len(values) == 1 else values

    def floats(self):
        count = self.take("Q")
        values = struct.unpack_from(f"<{count}d", self.data, self.at)
        self.at += 8 * count
        return list(values)

    def verdict(self):
        satisfied, value, _threshold, _compared = self.take("?ddI")
        measures, path_cost = self.floats(), None
        if self.take("?"):  # an answer
            self.take("II?")
            if self.take("?"):  # a path
                self.take("I")
                self.floats()
                path_cost = self.take("d")
            self.take("Q")
        if self.take("?"):  # a cut
            for _ in range(self.take("Q")):
                self.take("IId")
        for _ in range(self.take("Q")):  # the parts of a combined criterion
            self.verdict()
        self.take("QQ")
        return Verdict(satisfied, value, measures, path_cost)


class Ledger:
    """A ledger that may still grow: `more` gives the rounds that were judged since it was asked last."""

    def __init__(self, folder):
        self.path = os.path.join(folder, "ledger")
        self.at, self.rounds = None, []

    def more(self):
        """The rounds that were judged since the last call, whole records only."""
        try:
            size = os.path.getsize(self.path)
        except FileNotFoundError:
            return []
        judged = []
        with open(self.path, "rb") as file:
            if self.at is None:
                heading = file.read(HEADING)
                if len(heading) < HEADING:
                    return []
                self.at = HEADING
                if heading[:15] != b"roadmill ledger" or heading[15] != 2:
                    raise SystemExit(f"{self.path}: no ledger of version 2")
            while self.at + FRAME + 4 <= size:
                file.seek(self.at)
                length = struct.unpack("<Q", file.read(FRAME)[:8])[0]
                if self.at + FRAME + length > size:
                    break
                kind = struct.unpack("<I", file.read(4))[0]
                if kind in (ROUND, JUDGEMENT):
                    payload = Bytes(file.read(length - 4))
                    payload.take("Q")
                    if kind == ROUND:
                        self.rounds.append(Round(*payload.take("QQQQ")))
                    elif not self.rounds[-1].verdicts:
                        last = self.rounds[-1]
                        last.verdicts = [payload.verdict() for _ in range(payload.take("Q"))]
                        judged.append(last)
                self.at += FRAME + length
        return judged


def sizes(folder):
    """Bytes of a ledger by what they are for: those of sets, and all others."""
    path = os.path.join(folder, "ledger")
    found = {"sets": 0, "rest": 16}
    with open(path, "rb") as file:
        at, size = 16, os.path.getsize(path)
        while at + FRAME + 4 <= size:
            file.seek(at)
            length = struct.unpack("<Q", file.read(FRAME)[:8])[0]
            kind = struct.unpack("<I", file.read(4))[0]
            found["sets" if kind in SET_KINDS else "rest"] += FRAME + length
            at += FRAME + length
    return found
