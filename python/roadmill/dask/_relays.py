"""In the process that has the Dask client: between the coordinator's carriers and the agents on Dask workers."""

from __future__ import annotations

import asyncio
import os
import pathlib
import secrets
import shlex
import socket
import sys
from collections import Counter
from collections.abc import Awaitable, Callable, Coroutine, Sequence
from typing import Any, TypeVar

from distributed import Client
from distributed.core import ConnectionPool

from . import _carrier
from ._security import is_secure, refuse_insecure
from ._worker import Agents, serve

# So many bytes are read at once of what the coordinator sends.
_PIECE_BYTES = 1 << 20
# Between two looks at whether a Dask worker is free, or an agent has been started, in seconds. The second is doubled up to the first.
_LOOK, _SOON = 1.0, 0.02
# A Dask worker that cannot be connected to in so many seconds is called through the scheduler.
_CONNECT = 5.0
# So long the end of an agent or of a build may take that Dask does not answer, in seconds.
_LEAVE = 5.0
# The longest path that a Unix socket can have.
_SOCKET_PATH_BYTES_MAX = 107

_T = TypeVar("_T")


class Lost(Exception):
    """An agent is lost; why, for people."""


class Relays:
    """Carries the streams of a build's agents: starts each on a Dask worker that has none, and on another when that worker is lost.

    The coordinator starts a carrier for each agent and again for each that it lost, after a pause. A carrier brings two pipes;
    an agent is started as a Dask task, and bytes go between the two. Whatever goes wrong on the way closes the pipes, and the
    coordinator does the rest: it alone knows what an agent had to do.

    All but the constructor and the context manager runs in the client's event loop.
    """

    def __init__(
        self,
        client: Client,
        folder: pathlib.Path,
        *,
        chosen: Sequence[str] | None,
        program: str | None,
        direct: bool | None,
        insecure: bool,
    ) -> None:
        self.client = client
        """The client of the Dask cluster."""
        self._loop: asyncio.AbstractEventLoop = client.loop.asyncio_loop
        self._path = folder / "agents"
        if len(os.fsencode(self._path)) > _SOCKET_PATH_BYTES_MAX:
            raise OSError(f"{self._path}: too long for the path of a socket; TMPDIR names the folder that it is in")
        self._chosen = None if chosen is None else frozenset(chosen)
        self._program, self._direct, self._insecure = program, direct, insecure
        self._plugin = f"roadmill-agents-{secrets.token_hex(16)}"
        self._busy: set[str] = set()
        self._losses: Counter[str] = Counter()
        self._tasks: set[asyncio.Task[None]] = set()
        self._listener: socket.socket | None = None
        self._pool: Any = None
        self._is_known = False
        self.workers: dict[str, int] = {}
        """The Dask workers that there were at the beginning, and how many threads each has."""

    @property
    def command(self) -> str:
        """The command that the coordinator starts for an agent; `{}` stands for its name."""
        words = [sys.executable, "-I", "-S", _carrier.__file__, str(self._path)]
        return " ".join([*map(shlex.quote, words), "{}"])

    def __enter__(self) -> Relays:
        try:
            self._run(self._start())
        except BaseException:
            self._run(self._stop())
            raise
        return self

    def __exit__(self, *_: object) -> None:
        self._run(self._stop())

    def _run(self, work: Coroutine[Any, Any, _T]) -> _T:
        """Runs in the client's event loop, and waits."""
        return asyncio.run_coroutine_threadsafe(work, self._loop).result()

    async def _start(self) -> None:
        self.workers = await self._running()
        refuse_insecure([self.client.scheduler.address, *self.workers], self._insecure)
        self._pool = ConnectionPool(limit=1 << 16, connection_args=self.client.connection_args, timeout=_CONNECT)
        await self._pool.start()
        await self.client.register_plugin(Agents(self._plugin))
        self._is_known = True
        self._listener = socket.socket(socket.AF_UNIX, socket.SOCK_STREAM)
        self._listener.bind(str(self._path))
        self._listener.listen(128)
        self._listener.setblocking(False)
        self._begin(self._listen(self._listener))

    async def _stop(self) -> None:
        if self._listener is not None:
            self._listener.close()
        for task in self._tasks:
            task.cancel()
        await asyncio.gather(*self._tasks, return_exceptions=True)
        if self._is_known:
            await _in_time(self.client.unregister_worker_plugin(self._plugin))
        if self._pool is not None:
            await _in_time(self._pool.close())

    def _begin(self, work: Coroutine[Any, Any, None]) -> None:
        task = asyncio.ensure_future(work)
        self._tasks.add(task)
        task.add_done_callback(self._tasks.discard)

    async def _running(self) -> dict[str, int]:
        """The Dask workers that may be used, and how many threads each has."""
        threads: dict[str, int] = await self.client.scheduler.ncores_running(workers=None)
        return {worker: n for worker, n in threads.items() if self._chosen is None or worker in self._chosen}

    async def _listen(self, listener: socket.socket) -> None:
        while True:
            connection, _ = await self._loop.sock_accept(listener)
            self._begin(self._carry(connection))

    async def _carry(self, connection: socket.socket) -> None:
        """Carries the streams of one agent until either side ends."""
        with connection:
            # A carrier sends this first of all, or has ended.
            connection.settimeout(_LEAVE)
            try:
                name, files, _, _ = await asyncio.to_thread(socket.recv_fds, connection, 1 << 12, 2)
            except OSError:
                return
            connection.setblocking(False)
            if len(files) != 2:
                for file in files:
                    os.close(file)
                return
            agent = f"{name.decode()}-{secrets.token_hex(16)}"
            async with _Pipes(self._loop, *files) as pipes:
                relay = asyncio.ensure_future(self._relay(agent, pipes, connection))
                # A carrier says nothing more: this is the end of it.
                end = asyncio.ensure_future(self._loop.sock_recv(connection, 1))
                try:
                    await asyncio.wait([relay, end], return_when=asyncio.FIRST_COMPLETED)
                finally:
                    end.cancel()
                    relay.cancel()
                    (outcome,) = await asyncio.gather(relay, return_exceptions=True)
                    if isinstance(outcome, Exception):
                        said = str(outcome) if isinstance(outcome, Lost) else f"{type(outcome).__name__}: {outcome}"
                        await _in_time(self._loop.sock_sendall(connection, f"{said}\n".encode()))

    async def _relay(self, agent: str, pipes: _Pipes, connection: socket.socket) -> None:
        """Starts an agent on a Dask worker that has none, as soon as there is one, and carries its streams until it ends.

        Raises:
            Lost: The agent or its Dask worker is gone, or the agent cannot be started.
        """
        worker, threads = await self._free()
        is_lost = True
        try:
            task = self.client.submit(
                serve, self._plugin, agent, self._program, threads,
                key=f"roadmill-agent-{agent}", workers=[worker], pure=False, retries=0,
            )  # fmt: skip
            call: Call | None = None
            try:
                call = await self._reached(worker, agent)
                await _started(task, call)
                await _carried(call, pipes, lambda said: self._loop.sock_sendall(connection, said))
                is_lost = False
            except asyncio.CancelledError:
                # The carrier has ended: the coordinator needs the agent no more, or cannot hear it.
                is_lost = False
                raise
            except OSError as error:
                raise Lost(f"the Dask worker {worker} is lost: {error}") from error
            finally:
                if call is not None:
                    await _in_time(call("leave"))
                task.release()
        finally:
            self._busy.discard(worker)
            self._losses[worker] += is_lost

    async def _free(self) -> tuple[str, int]:
        """A Dask worker without an agent, and how many threads it has. Those that lost the fewest agents come first: one that is lost
        may be listed for a while, and one that hangs for minutes."""
        while True:
            running = await self._running()
            free = [worker for worker in running if worker not in self._busy]
            free = [worker for worker in free if self._insecure or is_secure(worker)]
            if free:
                worker = min(free, key=lambda worker: self._losses[worker])
                self._busy.add(worker)
                return worker, running[worker]
            await asyncio.sleep(_LOOK)

    async def _reached(self, worker: str, agent: str) -> Call:
        """How to call an agent: at its Dask worker, or through the scheduler where that cannot be reached."""

        async def directly(do: str, **values: Any) -> dict[str, Any]:
            answer: dict[str, Any] = await getattr(self._pool(worker), self._plugin)(agent=agent, do=do, **values)
            return answer

        async def through_scheduler(do: str, **values: Any) -> dict[str, Any]:
            message = {"op": self._plugin, "agent": agent, "do": do, **values}
            answer: dict[str, Any] = await self.client.scheduler.proxy(worker=worker, msg=message)
            return answer

        if self._direct is False:
            return through_scheduler
        try:
            await directly("is-here")
        except OSError:
            if self._direct:
                raise
            return through_scheduler
        return directly


Call = Callable[..., Awaitable[dict[str, Any]]]


async def _started(task: Any, call: Call) -> None:
    """Waits until the task of an agent has begun: the Dask worker may have other tasks to do first."""
    pause = _SOON
    while not (await call("is-here"))["here"]:
        if task.done():
            error = await task.exception()
            raise Lost(f"the agent cannot be started: {error or 'its task has ended'}")
        await asyncio.sleep(pause)
        pause = min(2 * pause, _LOOK)


async def _carried(call: Call, pipes: _Pipes, complain: Callable[[bytes], Awaitable[None]]) -> None:
    """Carries an agent's streams until it has ended. Neither direction waits for the other."""

    async def down() -> None:
        while True:
            answer = await call("pull")
            if answer.get("gone"):
                raise Lost("the Dask worker has ended the agent")
            if said := answer.get("errors"):
                await complain(said)
            if output := answer.get("output"):
                pipes.writer.write(output)
                await pipes.writer.drain()
            if "ended" in answer:
                return

    async def up() -> None:
        while True:
            data = await pipes.reader.read(_PIECE_BYTES)
            await call("push", data=data)
            if not data:
                return

    downward, upward = asyncio.ensure_future(down()), asyncio.ensure_future(up())
    try:
        await asyncio.wait([downward, upward], return_when=asyncio.FIRST_COMPLETED)
        if not downward.done():
            # Either the coordinator has said all that it had to, or the way to the agent is broken, which is raised here.
            await upward
        await downward
    finally:
        downward.cancel()
        upward.cancel()
        await asyncio.gather(downward, upward, return_exceptions=True)


class _Pipes:
    """The carrier's standard input and output, as streams."""

    reader: asyncio.StreamReader
    writer: asyncio.StreamWriter

    def __init__(self, loop: asyncio.AbstractEventLoop, incoming: int, outgoing: int) -> None:
        self._loop, self._incoming, self._outgoing = loop, incoming, outgoing

    async def __aenter__(self) -> _Pipes:
        self.reader = asyncio.StreamReader(limit=_PIECE_BYTES)
        self._reading, _ = await self._loop.connect_read_pipe(
            lambda: asyncio.StreamReaderProtocol(self.reader), os.fdopen(self._incoming, "rb", buffering=0)
        )
        writing, protocol = await self._loop.connect_write_pipe(
            lambda: asyncio.StreamReaderProtocol(asyncio.StreamReader()), os.fdopen(self._outgoing, "wb", buffering=0)
        )
        self.writer = asyncio.StreamWriter(writing, protocol, None, self._loop)
        return self

    async def __aexit__(self, *_: object) -> None:
        self._reading.close()
        # What is still to be written is written, as long as the coordinator is there.
        self.writer.close()


async def _in_time(work: Awaitable[object]) -> None:
    """Waits for what is done for tidiness, as long as it does not take too long; if it fails there is nothing left to do about it."""
    try:
        await asyncio.wait_for(work, timeout=_LEAVE)
    except (OSError, asyncio.TimeoutError, ValueError, KeyError):
        pass
