"""Making sets as ordinary Dask tasks."""

from __future__ import annotations

import os
import pathlib
import subprocess
import tempfile
import urllib.parse
from collections.abc import Callable, Mapping

from distributed import Client, as_completed

from .._options import options, seed_of, whole
from .._program import call, find_program, said
from ..build import file_of
from ..errors import RoadmillError, failure
from ..problem import Problem
from ._build import refuse_loop
from ._security import refuse_insecure

# Files by their names in a folder.
Bundle = dict[str, bytes]
_PROBLEM = "problem.toml"


def generate(
    problem: str | os.PathLike[str] | Problem,
    client: Client,
    sets: Mapping[str, int | range],
    folder: str | os.PathLike[str],
    *,
    seed: int | None = None,
    per_task: int = 16,
    threads: int = 1,
    retries: int = 3,
    program: str | None = None,
    insecure: bool = False,
    progress: Callable[[int, int], object] | None = None,
) -> list[pathlib.Path]:
    """Makes sets on the workers of a Dask cluster, for a build to import, and gives the files that they are in.

        files = roadmill.dask.generate("walls.toml", client, {"uniform": 256}, "parts")
        roadmap = roadmill.dask.build("walls.toml", client, imports=files)

    Each task makes a few sets; one that fails, or whose Dask worker dies, is done again. A task's file is written when the task is
    done, under a name that says which sets it has; tasks whose files are there already are not done. A build with imported sets gives
    the same roadmap, byte for byte.

    Args:
        problem: A problem file, or a `Problem`. Dask workers need no files: they get the problem with its meshes.
        client: A client of the cluster. This function waits, so it is not to be called in the client's event loop.
        sets: For labels of strategies how many of their sets, from the first on, or which, as a `range` without steps.
            Strategies that grow their sets from the roadmap cannot be among them.
        folder: Where the files are written; it is made if it is not there.
        seed: The base seed, instead of the problem's. The build needs the same.
        per_task: How many sets a task makes, at most: enough for some seconds of work.
        threads: In how many threads a task makes its sets. Dask gives a worker as many tasks at a time as that has threads.
        retries: How often a task is done again that fails.
        program: The program on the Dask workers; that of the package there if nothing is said.
        insecure: Use a cluster without TLS all the same.
        progress: Is called with how many sets are made and how many are to be, whenever a task is done.

    Raises:
        ValueError, TypeError: A number cannot be what it is, or this is the client's event loop.
        UsageError: The cluster has no TLS, and `insecure` is not said; or the problem has no such sets.
        RoadmillError: The sets cannot be made; see `roadmill.errors`. What was made before is in the folder.
    """
    refuse_loop(client)
    whole("per_task", per_task)
    whole("threads", threads)
    seed = seed_of(seed)
    refuse_insecure([client.scheduler.address, *client.nthreads()], insecure)
    place = pathlib.Path(folder)
    place.mkdir(parents=True, exist_ok=True)
    parts = {place / _name(label, part): (label, part) for label, part in _parts(sets, per_task)}
    missing = {file: part for file, part in parts.items() if not file.exists()}
    total = sum(len(part) for _, part in parts.values())
    made = total - sum(len(part) for _, part in missing.values())
    # A task of its own, so that Dask makes it again where it is lost.
    bundle = client.submit(_same, _bundle(problem), pure=False)
    futures = {
        client.submit(
            make, bundle, label, part.start, part.stop, seed, threads, program, pure=False, retries=retries
        ): file
        for file, (label, part) in missing.items()
    }
    try:
        for future in as_completed(list(futures)):
            file = futures[future]
            _write(file, future.result())
            # The Dask workers need not keep the sets.
            future.release()
            made += len(parts[file][1])
            if progress is not None:
                progress(made, total)
    finally:
        client.cancel([future for future in futures if not future.done()])
    return list(parts)


def _parts(sets: Mapping[str, int | range], per_task: int) -> list[tuple[str, range]]:
    """The sets of each task: a label and ordinals."""
    parts = []
    for label, asked in sets.items():
        ordinals = asked if isinstance(asked, range) else range(asked)
        if ordinals.step != 1 or ordinals.start < 0 or not ordinals:
            raise ValueError(f"sets[{label!r}]: {asked} found; a positive number, or a range of ordinals in steps of 1, expected")
        parts += [(label, ordinals[at : at + per_task]) for at in range(0, len(ordinals), per_task)]
    return parts


def _name(label: str, part: range) -> str:
    """The name of a file of sets, whatever characters the label has."""
    return f"{urllib.parse.quote(label, safe='')}-{part.start}-{part.stop}.sets"


def _bundle(problem: str | os.PathLike[str] | Problem) -> Bundle:
    """The problem as a file, with all files that belong to it."""
    with tempfile.TemporaryDirectory(prefix="roadmill-") as name:
        folder = pathlib.Path(name)
        file, raised = file_of(problem, folder)
        whole = folder / "whole"
        whole.mkdir()
        try:
            call("import", file, "--out", whole / _PROBLEM)
        except RoadmillError as error:
            raise raised(error.code, str(error)) from None
        return {str(it.relative_to(whole)): it.read_bytes() for it in whole.rglob("*") if it.is_file()}


def _same(bundle: Bundle) -> Bundle:
    return bundle


def make(
    bundle: Bundle, label: str, first: int, end: int, seed: int | None, threads: int, program: str | None
) -> bytes:
    """The Dask task: makes sets and gives the content of their file.

    Raises:
        RoadmillError: The program cannot make them.
        OSError: It cannot be started.
    """
    with tempfile.TemporaryDirectory(prefix="roadmill-") as name:
        folder = pathlib.Path(name)
        for path, content in bundle.items():
            (folder / path).parent.mkdir(parents=True, exist_ok=True)
            (folder / path).write_bytes(content)
        made = folder / "made.sets"
        asked = options(sets=f"{label}:{first}..{end}", out=made, seed=seed, threads=threads)
        command = [program or find_program(), "generate", str(folder / _PROBLEM), *map(str, asked)]
        done = subprocess.run(command, capture_output=True, text=True, stdin=subprocess.DEVNULL)
        if done.returncode != 0:
            # The names of files here mean nothing to others.
            raise failure(done.returncode, said(done.stderr).replace(f"{folder}/", ""))
        return made.read_bytes()


def _write(file: pathlib.Path, content: bytes) -> None:
    """Writes a file so that it is there only when it is whole."""
    part = file.with_name(f"{file.name}.part")
    part.write_bytes(content)
    os.replace(part, file)
