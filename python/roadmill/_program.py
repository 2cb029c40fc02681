"""The program `roadmill`: where it is, and how it is run."""

from __future__ import annotations

import importlib.metadata
import os
import pathlib
import shutil
import subprocess
from functools import cache

from .errors import SystemFailure, failure

Argument = str | int | float | os.PathLike[str]


@cache
def find_program() -> str:
    """The path of the program: that of the environment variable ROADMILL_PROGRAM, or the one that was installed with this
    package, or the first on the PATH."""
    named = os.environ.get("ROADMILL_PROGRAM")
    if named:
        return named
    try:
        installed = importlib.metadata.files("roadmill") or []
    except importlib.metadata.PackageNotFoundError:
        installed = []
    for file in installed:
        if file.name == "roadmill" and file.parent.name == "bin":
            place = pathlib.Path(os.fspath(file.locate())).resolve()
            if place.is_file():
                return str(place)
    found = shutil.which("roadmill")
    if found is None:
        raise SystemFailure("the program `roadmill` is not installed; `pip install roadmill` brings it")
    return found


def command(*arguments: Argument) -> list[str]:
    """The program with these arguments. A path is never taken for an option, whatever its name begins with."""

    def text(argument: Argument) -> str:
        if not isinstance(argument, os.PathLike):
            return str(argument)
        path = os.fspath(argument)
        return f"./{path}" if path.startswith("-") else path

    return [find_program(), *map(text, arguments)]


def call(*arguments: Argument) -> str:
    """Runs the program and gives what it printed on standard output.

    Raises the exception for its exit code, with what it printed on standard error, if that is not 0.
    """
    done = subprocess.run(command(*arguments), capture_output=True, text=True, stdin=subprocess.DEVNULL)
    if done.returncode != 0:
        raise failure(done.returncode, said(done.stderr))
    return done.stdout


def said(errors: str) -> str:
    """The message of a failure in what the program printed on standard error: what follows its name there for the last time,
    or, where the command line is wrong, the line that says so."""
    for mark in ("roadmill: ", "error: "):
        at = ("\n" + errors).rfind("\n" + mark)
        if at >= 0:
            message = errors[at + len(mark) :].strip()
            return message if mark == "roadmill: " else message.splitlines()[0]
    return errors.strip() or "it ended without a message"
