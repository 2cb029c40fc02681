"""What `roadmill._core`, which is written in Rust, has."""

import os
import pathlib
from collections.abc import Callable, Sequence
from typing import TypedDict

BITS_VERSION: int

_FoundPath = tuple[bytes, float]
_Validity = tuple[str, Callable[[bytes], bool]]
_Grown = tuple[pathlib.Path, str, str, int, BaseException | None]

class Failure(Exception):
    """Its arguments are an exit code and a message."""

class LoadedRun:
    def __init__(self, folder: str | os.PathLike[str], validity: _Validity | None) -> None: ...
    @property
    def validity(self) -> str | None: ...
    @property
    def digest(self) -> str: ...
    @property
    def problem_name(self) -> str: ...
    @property
    def seed(self) -> int: ...
    @property
    def dofs(self) -> list[tuple[str, str]]: ...
    @property
    def sizes(self) -> tuple[int, int, int]: ...
    @property
    def ends(self) -> tuple[list[float], list[float]] | None: ...
    @property
    def path(self) -> _FoundPath | None: ...
    def query(
        self, start: Sequence[float], goal: Sequence[float], tries: int | None
    ) -> tuple[_FoundPath | None, str | None, int]: ...
    def clearest(
        self, start: Sequence[float], goal: Sequence[float], widest: bool
    ) -> tuple[_FoundPath, float, float] | None: ...
    def clearances(self) -> tuple[bytes, bytes]: ...
    def write_npz(self, file: str | os.PathLike[str]) -> None: ...

class Course(TypedDict):
    """How a build goes."""

    threads: int
    max_nodes: int | None
    max_sets: int | None
    max_seconds: float | None
    max_memory: int | None
    progress: Callable[[str], object] | None
    validity: _Validity | None

def grow(
    problem: str | os.PathLike[str],
    out: str | os.PathLike[str] | None,
    seed: int | None,
    force: bool,
    or_resume: bool,
    course: Course,
) -> _Grown: ...
def go_on(
    run: str | os.PathLike[str], changed: str | os.PathLike[str] | None, course: Course
) -> _Grown: ...
def verify(
    run: str | os.PathLike[str],
    share: float | None,
    everything: bool,
    sets: Sequence[str],
    threads: int,
    validity: _Validity,
) -> tuple[int, int, int, str | None]: ...
def check_problem(file: str | os.PathLike[str]) -> tuple[str, str, list[str]]: ...
