"""Builds on a Dask cluster of four processes with TLS: whoever does the work, and whoever dies, changes nothing."""

from __future__ import annotations

import asyncio
import contextlib
import dataclasses
import json
import os
import pathlib
import signal
import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from typing import Any

import pytest

import roadmill
from test_build import readme_digest

if os.environ.get("ROADMILL_REQUIRE_DASK"):
    import cryptography  # noqa: F401
    import distributed
else:
    distributed = pytest.importorskip("distributed", reason="the package `distributed` is not installed: Dask is not tested")
    pytest.importorskip("cryptography", reason="the package `cryptography` is not installed: Dask is not tested")

import roadmill.dask

# What waits for something that must come gives up after so many seconds.
PATIENCE = 120.0


@pytest.fixture(scope="module")
def cluster() -> Iterator[Any]:
    """Four Dask workers, each a process of one thread, with a certificate that was made for them."""
    with distributed.LocalCluster(
        n_workers=4, threads_per_worker=1, processes=True, security=True, dashboard_address=None
    ) as cluster:
        yield cluster


@pytest.fixture
def client(cluster: Any) -> Iterator[Any]:
    with distributed.Client(cluster) as client:
        client.wait_for_workers(4, timeout=PATIENCE)
        assert client.scheduler.address.startswith("tls://")
        yield client


def children() -> list[tuple[int, bytes]]:
    """The numbers and command lines of the processes that this process has started."""
    found = []
    for thread in pathlib.Path("/proc/self/task").iterdir():
        for child in (thread / "children").read_text().split():
            with contextlib.suppress(FileNotFoundError):
                found.append((int(child), pathlib.Path(f"/proc/{child}/cmdline").read_bytes()))
    return found


def agents_on(client: Any) -> int:
    """How many agents run on the Dask workers, whichever build they belong to."""
    processes = client.run(children).values()
    return sum(b"\0agent\0" in command for each in processes for _, command in each)


def wait_until(condition: Callable[[], bool], what: str) -> None:
    begin = time.monotonic()
    while not condition():
        assert time.monotonic() - begin < PATIENCE, what
        time.sleep(0.1)


class Enough(Exception):
    """Ends a build from its progress."""


class Script:
    """Does one thing after another to a build, each when what comes before has had its effect, then ends the build."""

    def __init__(self, *steps: tuple[Callable[[roadmill.Progress], bool], Callable[[], object]]) -> None:
        self.steps = list(steps)
        self.begin = time.monotonic()
        self.last: roadmill.Progress | None = None

    def __call__(self, now: roadmill.Progress) -> None:
        self.last = now
        assert time.monotonic() - self.begin < PATIENCE, f"{len(self.steps)} steps are left, {now}"
        if self.steps[0][0](now):
            self.steps.pop(0)[1]()


def enough() -> None:
    raise Enough


def ready(now: roadmill.Progress) -> int:
    return sum(machine.state == "ready" for machine in now.machines)


def check_against_threads(problem: roadmill.Problem, run: pathlib.Path, folder: pathlib.Path) -> None:
    """What was built until it was ended is what threads build up to the same size."""
    roadmap = roadmill.Roadmap(run)
    assert roadmap.status().rounds > 2
    # Every round has nodes, so that the first with so many nodes is the last of the other.
    same = roadmill.build(problem, out=folder / "threads", threads=2, max_nodes=len(roadmap))
    assert same.digest == roadmap.digest


@pytest.mark.parametrize("direct", [None, True, False])
def test_four_agents_give_the_readmes_digest(
    client: Any, problems: pathlib.Path, tmp_path: pathlib.Path, direct: bool | None
) -> None:
    roadmap = roadmill.dask.build(problems / "walls.toml", client, out=tmp_path / "walls", direct=direct)
    assert roadmap.digest == readme_digest()
    assert roadmap.status().satisfied
    machines = json.loads((roadmap.run / "summary.json").read_text())["machines"]
    assert [machine["name"] for machine in machines] == [f"dask-{number}" for number in range(4)]
    # Nothing is left on the Dask workers.
    wait_until(lambda: agents_on(client) == 0, "an agent is left")


def test_a_dask_worker_killed_and_agents_that_come_late(
    client: Any, cluster: Any, endless: roadmill.Problem, tmp_path: pathlib.Path
) -> None:
    def kill_one() -> None:
        busy = [worker for worker, tasks in client.processing().items() if tasks]
        os.kill(client.run(os.getpid, workers=busy[:1])[busy[0]], signal.SIGKILL)

    script = Script(
        # The fifth agent has no Dask worker yet.
        (lambda now: ready(now) == 4 and now.rounds > 2, lambda: cluster.scale(5)),
        (lambda now: ready(now) == 5, kill_one),
        (lambda now: ready(now) == 5 and sum(machine.restarts for machine in now.machines) > 0, enough),
    )
    # More sets at a time than agents.
    wide = dataclasses.replace(endless, sets_per_round=8)
    try:
        with pytest.raises(Enough):
            roadmill.dask.build(wide, client, out=tmp_path / "run", agents=5, progress=script)
    finally:
        cluster.scale(4)
    assert script.last is not None and {machine.cores for machine in script.last.machines} == {1}
    check_against_threads(wide, tmp_path / "run", tmp_path)


def test_ctrl_c_keeps_the_last_complete_round(client: Any, endless: roadmill.Problem, tmp_path: pathlib.Path) -> None:
    script = Script((lambda now: ready(now) == 2 and now.rounds > 2, lambda: os.kill(os.getpid(), signal.SIGINT)))
    with pytest.raises(roadmill.Interrupted) as raised:
        roadmill.dask.build(
            endless, client, out=tmp_path / "run", agents=2, workers=2, audit=50, progress=script
        )
    assert raised.value.roadmap is not None
    assert script.last is not None and [machine.cores for machine in script.last.machines] == [2, 2]
    check_against_threads(endless, tmp_path / "run", tmp_path)
    wait_until(lambda: agents_on(client) == 0, "an agent is left")
    # It goes on.
    limit = len(raised.value.roadmap) + 200
    more = roadmill.dask.resume(raised.value.roadmap, client, max_nodes=limit)
    assert len(more) >= limit
    assert more.digest == roadmill.build(endless, out=tmp_path / "whole", threads=1, max_nodes=limit).digest


def test_a_build_goes_on_after_its_coordinator_was_killed(
    client: Any, endless: roadmill.Problem, tmp_path: pathlib.Path
) -> None:
    def kill_coordinator() -> None:
        (coordinator,) = (pid for pid, command in children() if b"\0--agents\0" in command)
        os.kill(coordinator, signal.SIGKILL)

    script = Script((lambda now: now.rounds > 2, kill_coordinator))
    with pytest.raises(roadmill.RoadmillError):
        roadmill.dask.build(endless, client, out=tmp_path / "run", progress=script)
    wait_until(lambda: agents_on(client) == 0, "an agent is left")
    killed = roadmill.Roadmap(tmp_path / "run")
    assert killed.status().state == "killed"
    limit = len(killed) + 200
    roadmap = roadmill.dask.resume(tmp_path / "run", client, max_nodes=limit)
    assert roadmap.digest == roadmill.build(endless, out=tmp_path / "threads", threads=2, max_nodes=limit).digest


def test_the_coordinator_ends_when_the_client_is_gone(tmp_path: pathlib.Path) -> None:
    from roadmill.dask import _carrier

    # A coordinator that starts a carrier, and would then go on for ever.
    carrier = [sys.executable, "-I", "-S", _carrier.__file__, str(tmp_path / "agents"), "dask-0"]
    script = f"import subprocess, signal; subprocess.run({carrier!r}); signal.pause()"
    ended = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, timeout=PATIENCE)
    assert ended.returncode == -signal.SIGTERM
    assert "the process with the Dask client is gone" in ended.stderr


def test_sets_are_generated_and_imported(client: Any, problems: pathlib.Path, tmp_path: pathlib.Path) -> None:
    told: list[tuple[int, int]] = []
    killed: list[int] = []

    def progress(made: int, total: int) -> None:
        told.append((made, total))
        if not killed:
            # Tasks that it has, and what is on it, are another Dask worker's to do again.
            killed.extend(client.run(os.getpid).values())
            os.kill(killed[0], signal.SIGKILL)

    sets = {"uniform": range(2, 60)}
    files = roadmill.dask.generate(
        problems / "walls.toml", client, sets, tmp_path / "parts", per_task=8, progress=progress
    )
    assert [file.name for file in files[:2]] == ["uniform-2-10.sets", "uniform-10-18.sets"] and len(files) == 8
    assert told[-1] == (58, 58) and len(told) == 8 and killed
    # All are there.
    contents = [file.read_bytes() for file in files]
    files[3].unlink()
    again = roadmill.dask.generate(problems / "walls.toml", client, sets, tmp_path / "parts", per_task=8)
    assert again == files and [file.read_bytes() for file in files] == contents
    assert sorted(tmp_path.joinpath("parts").iterdir()) == sorted(files)
    roadmap = roadmill.dask.build(problems / "walls.toml", client, out=tmp_path / "walls", imports=files)
    assert roadmap.digest == readme_digest()


def test_what_cannot_be_generated_is_said(client: Any, cart: roadmill.Problem, tmp_path: pathlib.Path) -> None:
    with pytest.raises(roadmill.UsageError, match="nothing"):
        roadmill.dask.generate(cart, client, {"nothing": 4}, tmp_path, retries=0)
    with pytest.raises(ValueError, match="uniform"):
        roadmill.dask.generate(cart, client, {"uniform": range(0, 8, 2)}, tmp_path)
    with pytest.raises(roadmill.ProblemError) as raised:
        roadmill.dask.generate(roadmill.Problem("none", further={"spce": {}}), client, {"uniform": 1}, tmp_path)
    assert raised.value.key is None or "spce" in raised.value.key


def test_an_agent_that_cannot_be_started_is_told(
    client: Any, problems: pathlib.Path, tmp_path: pathlib.Path
) -> None:
    with pytest.raises(roadmill.WorkersLost, match="no-such-program"):
        roadmill.dask.build(
            problems / "walls.toml", client, out=tmp_path / "walls", program="/no-such-program", agent_wait=3.0
        )


def test_without_tls_only_if_it_is_asked_for(problems: pathlib.Path, tmp_path: pathlib.Path) -> None:
    with (
        distributed.LocalCluster(
            n_workers=1, threads_per_worker=2, processes=False, protocol="tcp://", dashboard_address=":0"
        ) as cluster,
        distributed.Client(cluster) as client,
    ):
        assert client.scheduler.address.startswith("tcp://")
        with pytest.raises(roadmill.UsageError, match=r"tcp://.*TLS expected"):
            roadmill.dask.build(problems / "walls.toml", client, out=tmp_path / "walls")
        with pytest.raises(roadmill.UsageError, match=r"tcp://.*TLS expected"):
            roadmill.dask.generate(problems / "walls.toml", client, {"uniform": 1}, tmp_path)
        roadmap = roadmill.dask.build(problems / "walls.toml", client, out=tmp_path / "walls", insecure=True)
        assert roadmap.digest == readme_digest()


def test_the_clients_event_loop_is_not_stopped(cluster: Any, problems: pathlib.Path, tmp_path: pathlib.Path) -> None:
    async def main() -> str:
        async with distributed.Client(
            cluster.scheduler_address, security=cluster.security, asynchronous=True
        ) as client:
            with pytest.raises(ValueError, match="to_thread"):
                roadmill.dask.build(problems / "walls.toml", client)
            built = await asyncio.to_thread(
                roadmill.dask.build, problems / "walls.toml", client, out=tmp_path / "walls"
            )
            return built.digest

    assert asyncio.run(main()) == readme_digest()


def test_numbers_that_cannot_be(client: Any, cart: roadmill.Problem) -> None:
    with pytest.raises(ValueError, match="agents: 0 found"):
        roadmill.dask.build(cart, client, agents=0)
    with pytest.raises(ValueError, match="per_task: 0 found"):
        roadmill.dask.generate(cart, client, {"uniform": 1}, "parts", per_task=0)
