"""Growing roadmaps."""

from __future__ import annotations

import json
import os
import pathlib
import signal
import subprocess
import tempfile
from collections.abc import Callable, Iterable
from typing import TYPE_CHECKING

from . import _core
from ._options import Crew, Limits, options, path_of, seed_of
from ._program import Argument, command, said
from .errors import Interrupted, failure, problem_failure
from .problem import Problem
from .roadmap import Roadmap
from .status import Progress, progress_of
from .validity import ValidityFunction

if TYPE_CHECKING:
    from ._core import Course

__all__ = ["build"]

# Exit codes after which there is a roadmap: the criteria are met, or a limit came first.
_WITH_ROADMAP = (0, 3)
# Its name says nothing: that of the problem stands in the file, and may be anything but the name of a file.
_PROBLEM_FILE = "problem.toml"


def build(
    problem: str | os.PathLike[str] | Problem,
    *,
    out: str | os.PathLike[str] | None = None,
    workers: int | None = None,
    threads: int | None = None,
    seed: int | None = None,
    max_nodes: int | None = None,
    max_sets: int | None = None,
    max_time: float | None = None,
    max_memory: int | None = None,
    progress: Callable[[Progress], object] | None = None,
    force: bool = False,
    or_resume: bool = False,
    validity: ValidityFunction | None = None,
) -> Roadmap:
    """Grows a roadmap until the problem's criteria are met or a limit is reached, and gives it.

    Who does the work changes how long that takes and nothing else: by default as many worker processes as there are cores,
    `workers` processes, or `threads` threads of this process, which other Python threads run beside.

    Args:
        problem: A problem file (TOML, an OMPL.app `.cfg`, a Parasol `.env` or a URDF), or a `Problem`.
        out: The run folder to be made; `runs/NAME` or the first free of `runs/NAME-2`, … if there is none.
        seed: The base seed, instead of the problem's.
        max_nodes, max_sets: Stop at the end of the first round with so many nodes, or sets.
        max_time: Stop after so many seconds, but not before one round is finished.
        max_memory: Stop at the end of a round when all processes together hold so many bytes.
        progress: Is called with a `Progress` about once a second; an exception that it raises ends the build.
        force: Replace the run that `out` names.
        or_resume: Go on with the run that `out` names, if there is one of this problem.
        validity: A function of one's own that judges configurations beside the problem's model, in `threads`.

    Raises:
        ValueError, TypeError: A number cannot be what it is.
        Interrupted: Ctrl-C came; its `roadmap` is that of the last complete round.
        ProblemError: Something is wrong with a `Problem`; the message names the key.
        RoadmillError: The build could not begin or go on; see `roadmill.errors`.
    """
    crew, seed = Crew(workers, threads), seed_of(seed)
    limits = Limits(max_nodes, max_sets, max_time, max_memory)
    in_threads = crew.threads if validity is None else crew.threads_for_function()
    with tempfile.TemporaryDirectory(prefix="roadmill-") as folder:
        file, raised = file_of(problem, pathlib.Path(folder))
        if in_threads is not None:
            course = _course(in_threads, limits, progress, validity)
            return _in_threads(lambda: _core.grow(file, path_of(out), seed, force, or_resume, course), raised, validity)
        arguments: list[Argument] = ["build", file]
        arguments += [*options(out=path_of(out), seed=seed), *crew.options(), *limits.options()]
        arguments += [flag for flag, given in (("--force", force), ("--or-resume", or_resume)) if given]
        return grown(arguments, raised, progress)


def resumed(
    run: pathlib.Path,
    changed: str | os.PathLike[str] | Problem | None,
    crew: Crew,
    limits: Limits,
    progress: Callable[[Progress], object] | None,
    validity: ValidityFunction | None,
) -> Roadmap:
    """Goes on with a run: see `Roadmap.resume`."""
    with tempfile.TemporaryDirectory(prefix="roadmill-") as folder:
        file, raised = (None, failure) if changed is None else file_of(changed, pathlib.Path(folder))
        if validity is not None:
            course = _course(crew.threads_for_function(), limits, progress, validity)
            return _in_threads(lambda: _core.go_on(run, file, course), raised, validity)
        arguments: list[Argument] = ["resume", run, *options(**{"with": file}), *crew.options(), *limits.options()]
        return grown(arguments, raised, progress)


def file_of(
    problem: str | os.PathLike[str] | Problem, folder: pathlib.Path
) -> tuple[pathlib.Path, Callable[[int, str], BaseException]]:
    """The file of a problem, written into the folder if it has none, and the exception for an exit code and a message."""
    if not isinstance(problem, Problem):
        return pathlib.Path(problem), failure
    file = problem.write(folder / _PROBLEM_FILE)
    return file, lambda code, message: problem_failure(code, message, str(file))


def _course(
    threads: int,
    limits: Limits,
    progress: Callable[[Progress], object] | None,
    validity: ValidityFunction | None,
) -> Course:
    """What `roadmill._core` is told of a build."""
    return {
        "threads": threads,
        "max_nodes": limits.max_nodes,
        "max_sets": limits.max_sets,
        "max_seconds": limits.max_time,
        "max_memory": limits.max_memory,
        "progress": None if progress is None else (lambda text: progress(progress_of(json.loads(text)))),
        "validity": None if validity is None else validity.for_core(),
    }


def _in_threads(
    grow: Callable[[], tuple[pathlib.Path, str, str, int, BaseException | None]],
    raised: Callable[[int, str], BaseException],
    validity: ValidityFunction | None,
) -> Roadmap:
    """Builds in threads of this process."""
    try:
        run, _, reason, code, error = grow()
    except _core.Failure as failed:
        raise raised(*failed.args) from None
    roadmap = Roadmap(run, validity=validity)
    if isinstance(error, KeyboardInterrupt):
        raise Interrupted(reason, roadmap) from None
    if error is not None:
        raise error
    if code not in _WITH_ROADMAP:
        raise raised(code, reason)
    return roadmap


def grown(
    arguments: Iterable[Argument],
    raised: Callable[[int, str], BaseException],
    progress: Callable[[Progress], object] | None,
) -> Roadmap:
    """Runs a command of the program that grows a roadmap, and tells how far it is. The program gets a session of its own, so
    that Ctrl-C at a terminal reaches this process alone, which passes it on once."""
    with tempfile.TemporaryFile("w+", encoding="utf-8", errors="replace") as errors:
        child = subprocess.Popen(
            command(*arguments, "--json"),
            stdin=subprocess.DEVNULL,
            stdout=subprocess.PIPE,
            stderr=errors,
            text=True,
            start_new_session=True,
        )
        interrupted = False
        try:
            run = _listened(child, progress)
        except KeyboardInterrupt:
            interrupted = True
            run = _ended_by_signal(child)
        except BaseException:
            # `progress` raised: the build ends as by a signal, with the last complete round saved.
            _ended_by_signal(child)
            raise
        code = child.wait()
        errors.seek(0)
        message = said(errors.read())
    if interrupted or code == Interrupted.code:
        raise Interrupted(message, None if run is None else Roadmap(run))
    if code not in _WITH_ROADMAP or run is None:
        raise raised(code, message)
    return Roadmap(run)


def _listened(
    child: subprocess.Popen[str], progress: Callable[[Progress], object] | None
) -> str | None:
    """Tells of all events until the program ends; the run folder that its summary names."""
    run: str | None = None
    assert child.stdout is not None
    for line in child.stdout:
        event = json.loads(line)
        if event["event"] == "summary":
            run = event["run"]
        elif progress is not None:
            progress(progress_of(event))
    return run


def _ended_by_signal(child: subprocess.Popen[str]) -> str | None:
    """Passes Ctrl-C on and waits until the program has saved the last complete round; the run folder that its summary names.
    A second Ctrl-C while it does that ends it at once."""
    child.send_signal(signal.SIGINT)
    run: str | None = None
    assert child.stdout is not None
    try:
        for line in child.stdout:
            # The line that was being read when Ctrl-C came may lack its beginning.
            if line.startswith("{"):
                event = json.loads(line)
                run = event["run"] if event["event"] == "summary" else run
        child.wait()
    except BaseException:
        child.kill()
        child.wait()
        raise
    return run
