"""What `roadmill._core`, which is written in Rust, has."""

import os
import pathlib
from collections.abc import Callable, Sequence

BITS_VERSION: int

_FoundPath = tuple[bytes, float]

class Failure(Exception):
    """Its arguments are an exit code and a message."""

class LoadedRun:
    def __init__(self, folder: str | os.PathLike[str]) -> None: ...
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
    def write_npz(self, file: str | os.PathLike[str]) -> None: ...

def grow(
    problem: str | os.PathLike[str],
    out: str | os.PathLike[str] | None,
    threads: int,
    seed: int | None,
    max_nodes: int | None,
    max_sets: int | None,
    max_seconds: float | None,
    max_memory: int | None,
    force: bool,
    or_resume: bool,
    progress: Callable[[str], object] | None,
) -> tuple[pathlib.Path, str, str, int, BaseException | None]: ...
def check_problem(file: str | os.PathLike[str]) -> tuple[str, str, list[str]]: ...
