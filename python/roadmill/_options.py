"""What builds are given beside the problem: checked here, so that a value that cannot be is an error of its caller."""

from __future__ import annotations

import math
import operator
import os
import pathlib
from dataclasses import dataclass

from ._program import Argument

# As of the program.
_WORKERS_MAX = 4096
_SEED_MAX = 2**64 - 1


def whole(name: str, value: int | None, least: int = 1, largest: int | None = None) -> int | None:
    """A whole number within its bounds, or None.

    Raises:
        TypeError: It is no whole number.
        ValueError: It is out of bounds.
    """
    if value is None:
        return None
    if isinstance(value, bool):
        raise TypeError(f"{name}: {value} found; a whole number expected")
    try:
        number = operator.index(value)
    except TypeError:
        raise TypeError(f"{name}: {value!r} found; a whole number expected") from None
    if number < least or (largest is not None and number > largest):
        expected = f"at least {least}" if largest is None else f"{least} to {largest}"
        raise ValueError(f"{name}: {number} found; {expected} expected")
    return number


def seed_of(value: int | None) -> int | None:
    """A base seed, or None."""
    return whole("seed", value, 0, _SEED_MAX)


@dataclass(frozen=True)
class Crew:
    """Who does the work: worker processes, threads of this process, or, if neither is given, as many processes as there are
    cores."""

    workers: int | None = None
    threads: int | None = None

    def __post_init__(self) -> None:
        whole("workers", self.workers, largest=_WORKERS_MAX)
        whole("threads", self.threads, largest=_WORKERS_MAX)
        if self.workers is not None and self.threads is not None:
            raise ValueError("workers or threads expected, not both")

    def options(self) -> list[Argument]:
        """Options of the command line."""
        return options(workers=self.workers, threads=self.threads)

    def threads_for_function(self) -> int:
        """How many threads call a validity function.

        Raises:
            ValueError: Worker processes are asked for, or nothing is.
        """
        if self.threads is None:
            raise ValueError("threads expected: a validity function is called in threads of this process only")
        return self.threads


@dataclass(frozen=True)
class Limits:
    """Bounds on a build, beside the problem's own."""

    max_nodes: int | None = None
    max_sets: int | None = None
    max_time: float | None = None
    """Seconds."""
    max_memory: int | None = None
    """Bytes of all processes together."""

    def __post_init__(self) -> None:
        for name in ("max_nodes", "max_sets", "max_memory"):
            whole(name, getattr(self, name), largest=2**64 - 1)
        if self.max_time is not None and not (0 < self.max_time < math.inf):
            raise ValueError(f"max_time: {self.max_time} found; a positive number of seconds expected")

    def options(self) -> list[Argument]:
        """Options of the command line."""
        return options(
            max_nodes=self.max_nodes, max_sets=self.max_sets, max_time=self.max_time, max_memory=self.max_memory
        )


def options(**values: str | int | float | os.PathLike[str] | None) -> list[Argument]:
    """Options of the command line for those of the values that are given. A value may begin with `-`."""
    return [
        f"--{name.replace('_', '-')}={os.fspath(value) if isinstance(value, os.PathLike) else value}"
        for name, value in values.items()
        if value is not None
    ]


def path_of(place: str | os.PathLike[str] | None) -> pathlib.Path | None:
    """A path, or None."""
    return None if place is None else pathlib.Path(place)
