"""What can go wrong: an exception for every exit code of the program, with the message that the program prints.

| exit code | exception | what happened |
| --- | --- | --- |
| 1 | `SystemFailure` | the system failed: disk full, no process or thread can be started |
| 2 | `UsageError`, `ProblemError` | an argument, the problem or the run folder cannot be used, or is in use |
| 3 | `NoSuccess` | nothing was found where something was asked for |
| 4 | `BrokenRun` | a damaged or impossible run folder |
| 5 | `WorkersLost` | worker processes died faster than they could be replaced |
| 6 | `Interrupted` | a signal, as Ctrl-C, ended a build; the last complete round is saved |
| 7 | `NotTheSame` | what was recomputed by `Roadmap.verify` differs from what is recorded |

A number that cannot be, as 0 workers, is a `ValueError` before anything is begun. `build` does not raise `NoSuccess` for a build that ends at a limit: there is a roadmap then, whose `status()` says why it ended.
"""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from .roadmap import Roadmap

__all__ = [
    "BrokenRun",
    "Interrupted",
    "NoSuccess",
    "NotTheSame",
    "ProblemError",
    "RoadmillError",
    "SystemFailure",
    "UsageError",
    "WorkersLost",
]


class RoadmillError(Exception):
    """A failure; `code` is the program's exit code for it."""

    code = 1


class SystemFailure(RoadmillError):
    """The system failed: a disk is full, output is lost, a process or thread cannot be started."""

    code = 1


class UsageError(RoadmillError):
    """An argument, the problem or the run folder cannot be used, or the run is in use."""

    code = 2


class ProblemError(UsageError):
    """A problem that cannot be used. `key` is what is wrong in it, as `obstacles[2].shape`; None where it is no key."""

    def __init__(self, message: str, key: str | None = None) -> None:
        super().__init__(message)
        self.key = key


class NoSuccess(RoadmillError):
    """A roadmap was searched, or a limit reached, without success."""

    code = 3


class BrokenRun(RoadmillError):
    """A run folder is damaged or says what cannot be, or a job gave two different outcomes."""

    code = 4


class WorkersLost(RoadmillError):
    """The worker processes died faster than they could be replaced, or one job killed them."""

    code = 5


class NotTheSame(RoadmillError):
    """What was recomputed is not what is recorded."""

    code = 7


class Interrupted(KeyboardInterrupt):
    """A signal ended a build. `roadmap` is that of the last complete round; None where there is no run folder yet.

    It is a `KeyboardInterrupt`, as Ctrl-C raises it elsewhere, and so not caught by `except Exception`.
    """

    code = 6

    def __init__(self, message: str, roadmap: Roadmap | None = None) -> None:
        super().__init__(message)
        self.roadmap = roadmap


_KINDS: dict[int, type[RoadmillError]] = {
    kind.code: kind
    for kind in (SystemFailure, UsageError, NoSuccess, BrokenRun, WorkersLost, NotTheSame)
}

# A key of a problem file at the beginning of a message: `obstacles[2].shape: …`.
_KEY = re.compile(r"((?:[a-z_]+(?:\[\d+\])*)(?:\.[a-z_]+(?:\[\d+\])*)*): ")


def failure(code: int, message: str) -> RoadmillError | Interrupted:
    """The exception for an exit code."""
    if code == Interrupted.code:
        return Interrupted(message)
    return _KINDS.get(code, RoadmillError)(message)


def problem_failure(code: int, message: str, file: str) -> RoadmillError | Interrupted:
    """The exception for what is wrong with a problem that was written into `file`, a name that its user never gave."""
    if code != UsageError.code:
        return failure(code, message)
    told = re.sub(re.escape(file) + r"(:\d+)?: ", "", message, count=1)
    key = _KEY.match(told)
    return ProblemError(told, key.group(1) if key else None)
