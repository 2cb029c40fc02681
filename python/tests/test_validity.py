"""Validity by a function of one's own."""

from __future__ import annotations

import os
import pathlib
import signal
import threading
import time
from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np
import numpy.typing as npt
import pytest

import roadmill
from conftest import REPOSITORY
from roadmill import Problem, Roadmap, ValidityFunction

Configuration = npt.NDArray[np.float64]


def low(q: Configuration) -> bool:
    """Below a line above the wall's end, which leaves a way."""
    return bool(q[1] < 3.4)


@pytest.fixture
def sampled(cart: Problem) -> Problem:
    """The cart, of whose motions nothing is to be proved."""
    assert cart.space is not None
    return replace(cart, space=replace(cart.space, edges="sampled"), max_nodes=3000)


@pytest.fixture
def built(sampled: Problem, tmp_path: pathlib.Path) -> Roadmap:
    return roadmill.build(sampled, out=tmp_path / "built", threads=2, validity=ValidityFunction("low 1", low))


def test_all_that_is_there_is_allowed(built: Roadmap) -> None:
    path = built.path
    assert path is not None
    assert (built.nodes[:, 1] < 3.4).all() and (path.configurations[:, 1] < 3.4).all()
    # Straight in y, so that the steps between two ends are below the line where the ends are.
    assert len(built.edges) > 0
    short = built.query(shorten=True)
    assert short is not None and (short.configurations[:, 1] < 3.4).all()


def test_who_does_the_work_changes_nothing(built: Roadmap, sampled: Problem, tmp_path: pathlib.Path) -> None:
    again = roadmill.build(sampled, out=tmp_path / "again", threads=1, validity=ValidityFunction("low 1", low))
    assert again.digest == built.digest
    without = roadmill.build(sampled, out=tmp_path / "without", threads=1)
    assert without.digest != built.digest


def test_a_configuration_is_an_array_in_order(sampled: Problem, tmp_path: pathlib.Path) -> None:
    seen: list[Configuration] = []

    def note(q: Configuration) -> bool:
        seen.append(q)
        return True

    roadmap = roadmill.build(sampled, out=tmp_path / "run", threads=1, validity=ValidityFunction("all", note))
    assert roadmap.dof_names == ["x", "y", "theta"]
    asked = np.stack(seen)
    assert asked.dtype == np.float64 and asked.shape[1] == 3
    assert (asked[:, :2] > 0).all() and (asked[:, 0] < 6).all() and (asked[:, 1] < 4).all()
    assert not seen[0].flags.writeable
    np.testing.assert_array_equal(seen[0], sampled.start)
    # What joins `all` finds, the problem alone finds too: the same roadmap under another digest of the problem.
    without = roadmill.build(sampled, out=tmp_path / "without", threads=1)
    np.testing.assert_array_equal(without.nodes, roadmap.nodes)
    np.testing.assert_array_equal(without.edges, roadmap.edges)


def test_the_function_is_needed_again(built: Roadmap) -> None:
    alone = Roadmap(built.run)
    assert len(alone.nodes) == len(built) and alone.path is not None
    asks: list[Callable[[Roadmap], object]] = [
        lambda roadmap: roadmap.query(),
        lambda roadmap: roadmap.verify(threads=1),
        lambda roadmap: roadmap.verify(workers=1),
        lambda roadmap: roadmap.resume(threads=1, max_nodes=4000),
        lambda roadmap: roadmap.resume(workers=1, max_nodes=4000),
        lambda roadmap: roadmap.paths(2),
    ]
    for ask in asks:
        with pytest.raises(roadmill.UsageError, match="judged by the validity function `low 1` too"):
            ask(alone)
    other = Roadmap(built.run, validity=ValidityFunction("low 2", low))
    for ask in (asks[0], asks[1], asks[3]):
        with pytest.raises(roadmill.UsageError, match="validity function `low 2` found, `low 1` expected"):
            ask(other)
    for ask in (asks[2], asks[4]):
        with pytest.raises(ValueError, match="threads expected"):
            ask(built)
    with pytest.raises(roadmill.UsageError, match="validity function `low 1` found, none expected"):
        len(Roadmap(roadmill_without(built), validity=ValidityFunction("low 1", low)))


def roadmill_without(built: Roadmap) -> pathlib.Path:
    """A run without a function."""
    room = Problem("room", space=roadmill.Space("translation-2d", [0, 0], [1, 1]), robot=roadmill.Robot([roadmill.Body(roadmill.Sphere(0.1))]))
    return roadmill.build(room, out=built.run.with_name("room"), threads=1, max_sets=1).run


def test_it_is_verified_and_goes_on(built: Roadmap, sampled: Problem, tmp_path: pathlib.Path) -> None:
    own = ValidityFunction("low 1", low)
    assert "all as recorded" in built.verify(everything=True, threads=2)
    limit = len(built) + 500
    never = replace(sampled, evaluators=[{"all": [roadmill.method("query"), {"not": roadmill.method("query")}]}], max_nodes=limit)
    longer = Roadmap(built.run, validity=own).resume(changed=never, threads=2)
    assert len(longer) >= limit and longer.validity is own and (longer.nodes[:, 1] < 3.4).all()
    assert f"digest {longer.digest}" in longer.verify(threads=1)
    again = roadmill.build(never, out=tmp_path / "again", threads=1, validity=own)
    assert again.digest == longer.digest
    assert roadmill.build(never, out=tmp_path / "again", threads=1, or_resume=True, validity=own).digest == again.digest


def test_another_function_under_the_same_identity_is_found_out(built: Roadmap) -> None:
    higher = Roadmap(built.run, validity=ValidityFunction("low 1", lambda q: bool(q[1] < 3.9)))
    with pytest.raises(roadmill.NotTheSame):
        higher.verify(everything=True, threads=1)


@pytest.mark.parametrize("threads", [1, 3])
def test_an_exception_ends_the_build_as_itself(sampled: Problem, tmp_path: pathlib.Path, threads: int) -> None:
    asked = 0

    def failing(q: Configuration) -> bool:
        nonlocal asked
        asked += 1
        if asked > 2000:
            raise LookupError("not in the table")
        return low(q)

    with pytest.raises(LookupError, match="not in the table") as raised:
        roadmill.build(sampled, out=tmp_path / "run", threads=threads, validity=ValidityFunction("low 1", failing))
    # It says where it was raised.
    assert raised.traceback[-1].name == "failing"
    # What was complete before is sound, and goes on.
    run = Roadmap(tmp_path / "run", validity=ValidityFunction("low 1", low))
    whole = roadmill.build(sampled, out=tmp_path / "whole", threads=1, validity=ValidityFunction("low 1", low))
    assert run.resume(threads=1).digest == whole.digest


def test_a_function_tells_no_distances(built: Roadmap) -> None:
    for ask in (built.clearest, lambda: built.node_clearances):
        with pytest.raises(roadmill.UsageError, match="a problem without a validity function expected"):
            ask()


def test_an_exception_of_a_query_leaves_the_roadmap_usable(built: Roadmap) -> None:
    fails = False

    def sometimes(q: Configuration) -> bool:
        if fails:
            raise KeyboardInterrupt
        return low(q)

    roadmap = Roadmap(built.run, validity=ValidityFunction("low 1", sometimes))
    expected = roadmap.query()
    fails = True
    for ask in (lambda: roadmap.query(), lambda: roadmap.verify(threads=1, everything=True)):
        with pytest.raises(KeyboardInterrupt):
            ask()
    fails = False
    again = roadmap.query()
    assert expected is not None and again is not None
    np.testing.assert_array_equal(again.configurations, expected.configurations)


def test_answers_that_differ_are_an_error(sampled: Problem, tmp_path: pathlib.Path) -> None:
    turns = iter(range(10**9))
    fickle = ValidityFunction("fickle", lambda q: abs(q[0] - 3.0) > 1.5 or next(turns) % 2 == 0)
    with pytest.raises(RuntimeError, match=r"the validity function `fickle` said (true|false) of \[.*when it was asked again"):
        roadmill.build(sampled, out=tmp_path / "run", threads=1, validity=fickle)


@pytest.mark.parametrize("answer", [None, 1, np.array([True])])
def test_an_answer_is_a_bool(sampled: Problem, tmp_path: pathlib.Path, answer: Any) -> None:
    with pytest.raises(TypeError, match="a bool expected"):
        roadmill.build(sampled, out=tmp_path / "run", threads=1, validity=ValidityFunction("odd", lambda q: answer))
    numpys = ValidityFunction("numpy's", lambda q: np.all(q[:2] > -1.0))  # type: ignore[arg-type, return-value]
    assert roadmill.build(sampled, out=tmp_path / "run", threads=1, validity=numpys).path is not None


def test_ctrl_c_ends_a_build_whose_function_is_slow(sampled: Problem, tmp_path: pathlib.Path) -> None:
    main = threading.main_thread().ident
    assert main is not None
    began = threading.Event()

    def slow(q: Configuration) -> bool:
        began.set()
        time.sleep(0.001)
        return low(q)

    def ctrl_c() -> None:
        began.wait()
        signal.pthread_kill(main, signal.SIGINT)

    # The ends of the query are judged by the main thread, where Ctrl-C would be raised in the function itself.
    free = replace(sampled, start=None, goal=None, evaluators=[], max_nodes=None)
    pressing = threading.Thread(target=ctrl_c)
    pressing.start()
    try:
        with pytest.raises(KeyboardInterrupt) as raised:
            roadmill.build(free, out=tmp_path / "run", threads=2, validity=ValidityFunction("low 1", slow))
    finally:
        began.set()
        pressing.join()
    assert isinstance(raised.value, roadmill.Interrupted)
    assert Roadmap(tmp_path / "run").status().state == "interrupted"


def test_several_threads_ask_one_roadmap(built: Roadmap) -> None:
    expected = built.query()
    assert expected is not None
    found: list[Configuration] = []

    def ask() -> None:
        for _ in range(5):
            path = built.query()
            assert path is not None
            found.append(path.configurations)

    threads = [threading.Thread(target=ask) for _ in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert len(found) == 20
    for configurations in found:
        np.testing.assert_array_equal(configurations, expected.configurations)


def test_what_no_function_can_judge_is_refused(cart: Problem, sampled: Problem, tmp_path: pathlib.Path) -> None:
    own = ValidityFunction("low 1", low)
    with pytest.raises(roadmill.ProblemError, match='edges = "sampled" expected') as raised:
        roadmill.build(cart, out=tmp_path / "run", threads=1, validity=own)
    assert raised.value.key == "space.edges"
    for crew in ({}, {"workers": 1}):
        with pytest.raises(ValueError, match="threads expected"):
            roadmill.build(sampled, out=tmp_path / "run", validity=own, **crew)  # type: ignore[arg-type]
    for identity in ("", "two\nlines", "x" * 201):
        with pytest.raises(roadmill.UsageError, match="1 to 200 bytes"):
            roadmill.build(sampled, out=tmp_path / "run", threads=1, validity=ValidityFunction(identity, low))
    with pytest.raises(roadmill.ProblemError, match="the validity function `left` forbids it") as raised:
        roadmill.build(sampled, out=tmp_path / "run", threads=1, validity=ValidityFunction("left", lambda q: bool(q[0] < 3)))
    assert raised.value.key == "query.goal"
    assert os.listdir(tmp_path) == []


def test_an_invalid_end_names_the_function(built: Roadmap) -> None:
    with pytest.raises(roadmill.UsageError, match="goal: .*the validity function `low 1` forbids it"):
        built.query([1.0, 1.0, 0.0], [1.0, 3.5, 0.0])


def test_the_example_of_the_documentation_runs(tmp_path: pathlib.Path, monkeypatch: pytest.MonkeyPatch) -> None:
    text = (REPOSITORY / "docs" / "python.md").read_text(encoding="utf-8")
    example = text.split("## Validity by a function of one's own")[1].split("```python\n")[1].split("```")[0]
    monkeypatch.chdir(tmp_path)
    names: dict[str, Any] = {"__name__": "example"}
    exec(compile(example, "docs/python.md", "exec"), names)
    nodes = names["roadmap"].nodes
    assert (np.abs(nodes[nodes[:, 0] >= 3.0, 2]) <= np.pi / 2).all() and (nodes[:, 0] >= 3.0).any()
