"""Builds: who does the work changes nothing, and nothing is lost when one is interrupted."""

from __future__ import annotations

import os
import pathlib
import re
import signal
import subprocess
import threading
from typing import Any

import pytest

import roadmill
from conftest import REPOSITORY


def readme_digest() -> str:
    found = re.search(r"^digest ([0-9a-f]{64})$", (REPOSITORY / "README.md").read_text(), re.MULTILINE)
    assert found is not None
    return found.group(1)


def test_the_digest_is_the_readmes(walls: roadmill.Roadmap) -> None:
    assert walls.digest == readme_digest()
    assert walls.status().digest == walls.digest
    assert walls.status().satisfied


def test_threads_give_the_same_roadmap(problems: pathlib.Path, tmp_path: pathlib.Path) -> None:
    roadmap = roadmill.build(problems / "walls.toml", out=tmp_path / "walls", threads=2)
    assert roadmap.digest == readme_digest()


@pytest.mark.parametrize("crew", [{"workers": 1}, {"threads": 1}])
def test_progress_is_told(endless: roadmill.Problem, tmp_path: pathlib.Path, crew: dict[str, Any]) -> None:
    told: list[roadmill.Progress] = []

    def progress(now: roadmill.Progress) -> None:
        told.append(now)
        if len(told) == 2:
            raise StopIteration("enough")

    with pytest.raises(StopIteration, match="enough"):
        roadmill.build(endless, out=tmp_path / "run", progress=progress, **crew)
    assert told[0].nodes <= told[1].nodes and told[1].workers_wanted == 1
    assert told[1].evaluators[0].name == "all"
    # What was complete is there.
    assert roadmill.Roadmap(tmp_path / "run").status().state == "interrupted"


@pytest.mark.parametrize("crew", [{"workers": 2}, {"threads": 2}])
def test_ctrl_c_keeps_the_last_complete_round(
    endless: roadmill.Problem, tmp_path: pathlib.Path, crew: dict[str, Any]
) -> None:
    def ctrl_c(now: roadmill.Progress) -> None:
        if now.rounds > 2:
            os.kill(os.getpid(), signal.SIGINT)

    with pytest.raises(KeyboardInterrupt) as raised:
        roadmill.build(endless, out=tmp_path / "run", progress=ctrl_c, **crew)
    interrupted = raised.value
    assert isinstance(interrupted, roadmill.Interrupted) and interrupted.code == 6
    assert interrupted.roadmap is not None
    rounds = interrupted.roadmap.status().rounds
    assert rounds > 2 and len(interrupted.roadmap.nodes) > 0
    # It goes on to what it would have come to without the interruption.
    limit = len(interrupted.roadmap) + 500
    resumed = interrupted.roadmap.resume(threads=1, max_nodes=limit)
    whole = roadmill.build(endless, out=tmp_path / "whole", threads=2, max_nodes=limit)
    assert resumed.digest == whole.digest and len(resumed) >= limit


def test_other_threads_go_on_while_threads_build(endless: roadmill.Problem, tmp_path: pathlib.Path) -> None:
    done = threading.Event()
    counted = 0

    def count() -> None:
        nonlocal counted
        while not done.is_set():
            counted += 1

    other = threading.Thread(target=count)
    before: list[int] = []
    other.start()
    try:
        roadmill.build(endless, out=tmp_path / "run", threads=1, max_nodes=3000, progress=lambda _: before.append(counted))
    finally:
        done.set()
        other.join()
    assert counted > 0
    assert len(roadmill.Roadmap(tmp_path / "run")) >= 3000


def test_a_limit_is_no_error(problems: pathlib.Path, tmp_path: pathlib.Path) -> None:
    crews: dict[str, dict[str, Any]] = {"processes": {"workers": 1}, "threads": {"threads": 1}}
    for name, crew in crews.items():
        roadmap = roadmill.build(problems / "sealed.toml", out=tmp_path / name, max_nodes=200, **crew)
        assert roadmap.path is None and not roadmap.status().satisfied
        assert roadmap.status().state == "node-limit"


@pytest.mark.parametrize("crew", [{"workers": 1}, {"threads": 1}])
def test_what_cannot_be_used_is_said(problems: pathlib.Path, tmp_path: pathlib.Path, crew: dict[str, Any]) -> None:
    with pytest.raises(roadmill.UsageError, match="cannot read the problem"):
        roadmill.build(tmp_path / "nothing.toml", **crew)
    roadmill.build(problems / "maze.toml", out=tmp_path / "maze", seed=3, **crew)
    with pytest.raises(roadmill.UsageError, match="maze"):
        roadmill.build(problems / "maze.toml", out=tmp_path / "maze", **crew)
    again = roadmill.build(problems / "maze.toml", out=tmp_path / "maze", force=True, **crew)
    assert again.seed == 1
    assert roadmill.build(problems / "maze.toml", out=tmp_path / "maze", or_resume=True, **crew).digest == again.digest


def test_workers_or_threads(problems: pathlib.Path) -> None:
    with pytest.raises(ValueError, match="not both"):
        roadmill.build(problems / "maze.toml", workers=1, threads=1)


@pytest.mark.parametrize(
    ("wrong", "kind", "told"),
    [
        ({"workers": 0}, ValueError, "workers: 0 found; 1 to 4096 expected"),
        ({"threads": 0}, ValueError, "threads: 0 found; 1 to 4096 expected"),
        ({"threads": 5000}, ValueError, "threads: 5000 found; 1 to 4096 expected"),
        ({"seed": -1}, ValueError, "seed: -1 found; 0 to 18446744073709551615 expected"),
        ({"seed": -1, "threads": 1}, ValueError, "seed: -1 found"),
        ({"seed": 2**64, "threads": 1}, ValueError, "seed: 18446744073709551616 found"),
        ({"seed": 1.5}, TypeError, "seed: 1.5 found; a whole number expected"),
        ({"max_nodes": 0}, ValueError, "max_nodes: 0 found; 1 to"),
        ({"max_nodes": True}, TypeError, "max_nodes: True found; a whole number expected"),
        ({"max_sets": -3, "threads": 1}, ValueError, "max_sets: -3 found; 1 to"),
        ({"max_memory": 0, "threads": 1}, ValueError, "max_memory: 0 found; 1 to"),
        ({"max_time": 0.0}, ValueError, "max_time: 0.0 found; a positive number of seconds expected"),
        ({"max_time": float("nan"), "threads": 1}, ValueError, "max_time: nan found"),
    ],
)
def test_numbers_that_cannot_be_are_errors_of_the_caller(
    problems: pathlib.Path, tmp_path: pathlib.Path, wrong: dict[str, Any], kind: type[Exception], told: str
) -> None:
    with pytest.raises(kind, match=f"^{re.escape(told)}"):
        roadmill.build(problems / "maze.toml", out=tmp_path / "run", **wrong)
    if "seed" not in wrong:
        with pytest.raises(kind, match=f"^{re.escape(told)}"):
            roadmill.Roadmap(tmp_path / "run").resume(**wrong)
    assert not (tmp_path / "run").exists()


@pytest.mark.parametrize("crew", [{"workers": 1}, {"threads": 1}])
def test_a_name_that_begins_with_a_hyphen_is_no_option(
    problems: pathlib.Path, tmp_path: pathlib.Path, monkeypatch: pytest.MonkeyPatch, crew: dict[str, Any]
) -> None:
    monkeypatch.chdir(tmp_path)
    pathlib.Path("-maze.toml").write_text((problems / "maze.toml").read_text())
    roadmap = roadmill.build("-maze.toml", out="--run", **crew)
    assert roadmap.status().satisfied and pathlib.Path("--run/ledger").is_file()
    assert roadmap.export("-map.csv", format="csv").exists()
    assert "all as recorded" in roadmap.verify(threads=1)
    assert roadmap.resume(**crew).digest == roadmap.digest


def test_a_number_below_zero_is_no_option(tmp_path: pathlib.Path) -> None:
    ball = roadmill.Robot([roadmill.Body(roadmill.Sphere(0.1))])
    room = roadmill.Problem("room", space=roadmill.Space("translation-2d", [-1, -1], [1, 1]), robot=ball)
    roadmap = roadmill.build(room, out=tmp_path / "room", threads=1, max_sets=2)
    assert len(roadmap.paths(1, start=[-0.5, -0.5], goal=[0.5, 0.5])) == 1


def test_every_exit_code_has_its_exception() -> None:
    kinds = {code: roadmill.errors.failure(code, "why") for code in range(1, 8)}
    assert {code: kind.code for code, kind in kinds.items()} == {code: code for code in range(1, 8)}
    assert len({type(kind) for kind in kinds.values()}) == 7
    assert all(str(kind) == "why" for kind in kinds.values())


def test_the_program_is_there() -> None:
    from roadmill._program import find_program

    told = subprocess.run([find_program(), "--version"], capture_output=True, text=True, check=True)
    assert told.stdout.startswith("roadmill ")
