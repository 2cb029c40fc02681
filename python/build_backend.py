"""Builds the wheel: the program `roadmill`, the module `roadmill._core` and the Python files.

maturin packs a module or a program, not both, but it packs a folder of data files too, whose `scripts` pip puts where
programs are. So this backend (PEP 517) has cargo build the program into that folder and leaves the rest to maturin.

The environment variable ROADMILL_PROFILE names the profile of cargo that both are built with; `release` if there is none.
ROADMILL_COMPATIBILITY is maturin's `--compatibility`: `pypi` makes a wheel for every system whose C library is new enough, and says
in its name how new; without it the wheel is for systems like this one.
"""

from __future__ import annotations

import json
import os
import shutil
import subprocess
from pathlib import Path
from typing import Any

import maturin
from maturin import *  # noqa: F403  (the hooks that nothing is added to)

HERE = Path(__file__).resolve().parent
PROFILE = os.environ.get("ROADMILL_PROFILE", "release")
COMPATIBILITY = os.environ.get("ROADMILL_COMPATIBILITY", "off")
SCRIPTS = HERE / "data" / "scripts"
# maturin expects the folder in every hook.
SCRIPTS.mkdir(parents=True, exist_ok=True)


def build_wheel(
    wheel_directory: str,
    config_settings: dict[str, Any] | None = None,
    metadata_directory: str | None = None,
) -> str:
    """The hook of PEP 517: builds the wheel into a folder and gives its name."""
    place_program()
    settings = dict(config_settings or {})
    # The most that the format of wheels can be compressed: 3 % less than by default.
    arguments = f"--profile {PROFILE} --compatibility {COMPATIBILITY} --compression-level 9"
    settings.setdefault("build-args", arguments)
    name: str = maturin.build_wheel(wheel_directory, settings, metadata_directory)
    return name


def place_program() -> None:
    """Builds the program and puts it, without its symbols, where maturin looks for data files."""
    cargo = ["cargo", "build", "--profile", PROFILE, "--bin", "roadmill"]
    # With the features that the whole workspace asks for, so that the module, which is built next, shares what is compiled.
    cargo.append("--workspace")
    told = subprocess.run(
        [*cargo, "--message-format", "json-render-diagnostics"],
        cwd=HERE,
        stdout=subprocess.PIPE,
        text=True,
        check=True,
    ).stdout
    messages = [json.loads(line) for line in told.splitlines() if line.startswith("{")]
    program = next(
        message["executable"]
        for message in messages
        if message.get("executable") and message["target"]["name"] == "roadmill"
    )
    place = SCRIPTS / "roadmill"
    shutil.copy(program, place)
    strip = shutil.which("strip")
    if strip is not None:
        subprocess.run([strip, str(place)], check=True)
