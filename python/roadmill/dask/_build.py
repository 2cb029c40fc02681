"""Growing roadmaps on the workers of a Dask cluster."""

from __future__ import annotations

import asyncio
import os
import pathlib
import tempfile
from collections.abc import Callable, Iterable, Sequence

from distributed import Client

from .._options import Crew, Limits, options, path_of, seed_of, whole
from .._program import Argument
from ..build import file_of, grown
from ..errors import failure
from ..problem import Problem
from ..roadmap import Roadmap
from ..status import Progress
from ._relays import Relays

# As of the program.
_AGENTS_MAX = 1024


def build(
    problem: str | os.PathLike[str] | Problem,
    client: Client,
    *,
    out: str | os.PathLike[str] | None = None,
    agents: int | None = None,
    workers: int | None = None,
    seed: int | None = None,
    max_nodes: int | None = None,
    max_sets: int | None = None,
    max_time: float | None = None,
    max_memory: int | None = None,
    imports: Iterable[str | os.PathLike[str]] = (),
    agent_wait: float | None = None,
    audit: float | None = None,
    dask_workers: Sequence[str] | None = None,
    program: str | None = None,
    direct: bool | None = None,
    insecure: bool = False,
    progress: Callable[[Progress], object] | None = None,
    force: bool = False,
    or_resume: bool = False,
) -> Roadmap:
    """Grows a roadmap on the workers of a Dask cluster until the problem's criteria are met or a limit is reached, and gives it.

    The coordinator runs on this machine and keeps the run folder here; on each Dask worker an agent does the work, in processes of its
    own. An agent that is lost, with its Dask worker or alone, is started again on a Dask worker that has none; what it had to do is done by
    others meanwhile. One that comes late, because its Dask worker does, is told what it missed. None of this changes the roadmap.

    Args:
        problem: A problem file (TOML, an OMPL.app `.cfg`, a Parasol `.env` or a URDF), or a `Problem`. Dask workers need no files.
        client: A client of the cluster. This function waits, so it is not to be called in the client's event loop; a thread may.
        out: The run folder to be made; `runs/NAME` or the first free of `runs/NAME-2`, … if there is none.
        agents: How many agents there are to be, at most one on each Dask worker; as many as there are Dask workers at the beginning if
            nothing is said. Agents for which there is no Dask worker wait for one to come.
        workers: How many worker processes each agent has; as many as its Dask worker has threads if nothing is said.
        seed: The base seed, instead of the problem's.
        max_nodes, max_sets: Stop at the end of the first round with so many nodes, or sets.
        max_time: Stop after so many seconds, but not before one round is finished.
        max_memory: Stop at the end of a round when the coordinator holds so many bytes.
        imports: Files of sets that `generate` has made.
        agent_wait: Give up when there was no agent for so many seconds; 600 if nothing is said.
        audit: Have so many per cent of all jobs done by two agents and compared; without it agents are trusted.
        dask_workers: Addresses of the Dask workers that may be used; all if nothing is said.
        program: The program on the Dask workers; that of the package there if nothing is said.
        direct: Whether Dask workers are called at their own addresses. If not, everything goes through the scheduler, which is slower;
            if nothing is said, it does where they cannot be reached.
        insecure: Use a cluster without TLS all the same.
        progress: Is called with a `Progress` about once a second; an exception that it raises ends the build.
        force: Replace the run that `out` names.
        or_resume: Go on with the run that `out` names, if there is one of this problem.

    Raises:
        ValueError, TypeError: A number cannot be what it is, or this is the client's event loop.
        Interrupted: Ctrl-C came; its `roadmap` is that of the last complete round.
        ProblemError: Something is wrong with a `Problem`; the message names the key.
        UsageError: The cluster has no TLS, and `insecure` is not said; or the problem or the run folder cannot be used.
        WorkersLost: There was no agent for too long.
        RoadmillError: The build could not begin or go on; see `roadmill.errors`.
    """
    with tempfile.TemporaryDirectory(prefix="roadmill-") as name:
        folder = pathlib.Path(name)
        file, raised = file_of(problem, folder)
        command: list[Argument] = ["build", file, *options(out=path_of(out), seed=seed_of(seed))]
        command += [*Crew(workers).options(), *Limits(max_nodes, max_sets, max_time, max_memory).options()]
        command += options(agent_wait=agent_wait, audit=audit)
        for sets in imports:
            command += ["--import", pathlib.Path(sets)]
        command += [flag for flag, given in (("--force", force), ("--or-resume", or_resume)) if given]
        relays = Relays(client, folder, chosen=dask_workers, program=program, direct=direct, insecure=insecure)
        return _grown_by_agents(command, relays, agents, raised, progress)


def resume(
    run: str | os.PathLike[str] | Roadmap,
    client: Client,
    *,
    changed: str | os.PathLike[str] | Problem | None = None,
    agents: int | None = None,
    workers: int | None = None,
    max_nodes: int | None = None,
    max_sets: int | None = None,
    max_time: float | None = None,
    max_memory: int | None = None,
    agent_wait: float | None = None,
    audit: float | None = None,
    dask_workers: Sequence[str] | None = None,
    program: str | None = None,
    direct: bool | None = None,
    insecure: bool = False,
    progress: Callable[[Progress], object] | None = None,
) -> Roadmap:
    """Goes on with a run on the workers of a Dask cluster, whoever did the work before.

    Args:
        run: The run folder, or its roadmap.
        client: A client of the cluster, as of `build`.
        changed: A problem whose criteria, query, limits and schedule hold from here on, as of `Roadmap.resume`.

    All else is as of `build`.

    Raises:
        ValueError, TypeError: A number cannot be what it is, or this is the client's event loop.
        Interrupted: Ctrl-C came; its `roadmap` is that of the last complete round.
        RoadmillError: The build cannot go on; see `roadmill.errors`.
    """
    place = run.run if isinstance(run, Roadmap) else pathlib.Path(run)
    with tempfile.TemporaryDirectory(prefix="roadmill-") as name:
        folder = pathlib.Path(name)
        file, raised = (None, failure) if changed is None else file_of(changed, folder)
        command: list[Argument] = ["resume", place, *options(**{"with": file})]
        command += [*Crew(workers).options(), *Limits(max_nodes, max_sets, max_time, max_memory).options()]
        command += options(agent_wait=agent_wait, audit=audit)
        relays = Relays(client, folder, chosen=dask_workers, program=program, direct=direct, insecure=insecure)
        return _grown_by_agents(command, relays, agents, raised, progress)


def _grown_by_agents(
    command: list[Argument],
    relays: Relays,
    agents: int | None,
    raised: Callable[[int, str], BaseException],
    progress: Callable[[Progress], object] | None,
) -> Roadmap:
    """Runs a command of the program that grows a roadmap, by agents on Dask workers."""
    refuse_loop(relays.client)
    agents = whole("agents", agents, largest=_AGENTS_MAX)
    with relays:
        count = agents or min(max(len(relays.workers), 1), _AGENTS_MAX)
        names = ",".join(f"dask-{number}" for number in range(count))
        return grown([*command, "--agents", names, "--agent-command", relays.command], raised, progress)


def refuse_loop(client: Client) -> None:
    """Raises if this is called in the client's event loop, which what is to be done needs meanwhile.

    Raises:
        ValueError: It is.
    """
    try:
        is_inside = asyncio.get_running_loop() is client.loop.asyncio_loop
    except RuntimeError:
        is_inside = False
    if is_inside:
        raise ValueError(
            "this function waits and would stop the client's event loop; `await asyncio.to_thread(roadmill.dask.build, …)` does not"
        )
