"""On a Dask worker: an agent, and the calls that carry its standard streams.

An agent is a Dask task, so that Dask knows that the worker is busy. The bytes go by calls to a handler of the worker's, because a task
has no way to talk while it runs. Dask carries these calls: along the worker's own port, with the cluster's TLS.
"""

from __future__ import annotations

import asyncio
import time
from typing import Any

from distributed import WorkerPlugin, get_worker

from .._program import find_program

# The most bytes that one answer carries, of either stream.
_ANSWER_BYTES = 1 << 20
# So long a call waits for something to tell, in seconds.
_WAIT = 10.0
# An agent that nobody has called for so long is given up, in seconds: the client is gone.
_SILENCE_MAX = 60.0
# The same of an agent that has ended, whose last words are still to be fetched; longer than a call may wait.
_SILENCE_MAX_ENDED = 15.0
# Between two looks at that, in seconds.
_LOOK = 5.0
# So long an agent may take to end when its standard input ends, and then again when it is told to, in seconds.
_LEAVE = 3.0

Answer = dict[str, Any]


class Relay:
    """A process and its standard streams, of which calls bring and fetch what there is."""

    def __init__(self, process: asyncio.subprocess.Process) -> None:
        self._process = process
        # When a call came last. When it was answered says nothing of whether the client is there.
        self._called = time.monotonic()
        self._over = asyncio.Event()
        streams = {"output": process.stdout, "errors": process.stderr}
        self._streams = {name: stream for name, stream in streams.items() if stream is not None}
        # What is being read of each stream that has not ended.
        self._reads = {name: self._read(name) for name in self._streams}

    @classmethod
    async def start(cls, command: list[str]) -> Relay:
        """Starts the process, with a session of its own: Ctrl-C at the worker's terminal is for the worker.

        Raises:
            OSError: It cannot be started.
        """
        pipe = asyncio.subprocess.PIPE
        process = await asyncio.create_subprocess_exec(
            *command, stdin=pipe, stdout=pipe, stderr=pipe, limit=_ANSWER_BYTES, start_new_session=True
        )
        return cls(process)

    def _read(self, name: str) -> asyncio.Task[bytes]:
        return asyncio.ensure_future(self._streams[name].read(_ANSWER_BYTES))

    async def push(self, data: bytes) -> Answer:
        """Writes to the process's standard input, and ends that if there is nothing to write. Comes back when there is room for more."""
        self._called = time.monotonic()
        stdin = self._process.stdin
        if stdin is not None:
            try:
                if data:
                    stdin.write(data)
                    await stdin.drain()
                else:
                    stdin.close()
            except OSError:
                # The process has ended, which is told by `pull`.
                pass
        return {}

    async def pull(self) -> Answer:
        """What the process has written (`output`, `errors`), as soon as there is something or after a while. `ended` is its exit
        code once it has ended and all it wrote on standard output is fetched. Only one call at a time may be made."""
        self._called = time.monotonic()
        if "output" in self._reads:
            await asyncio.wait(self._reads.values(), timeout=_WAIT, return_when=asyncio.FIRST_COMPLETED)
        else:
            await self._process.wait()
            # Processes that it has started may keep its standard error open.
            await asyncio.wait(self._reads.values() or [asyncio.ensure_future(asyncio.sleep(0))], timeout=1.0)
        answer: Answer = {}
        for name, read in list(self._reads.items()):
            if read.done():
                answer[name] = read.result()
                del self._reads[name]
                if answer[name]:
                    self._reads[name] = self._read(name)
        if "output" not in self._reads and self._process.returncode is not None:
            answer["ended"] = self._process.returncode
        return answer

    def leave(self) -> None:
        """Lets `wait` come back."""
        self._over.set()

    async def wait(self) -> None:
        """Waits until `leave` is called, or for so long nothing was."""
        while not self._over.is_set():
            longest = _SILENCE_MAX if self._process.returncode is None else _SILENCE_MAX_ENDED
            if time.monotonic() - self._called >= longest:
                return
            try:
                await asyncio.wait_for(self._over.wait(), timeout=_LOOK)
            except asyncio.TimeoutError:
                pass

    async def end(self) -> None:
        """Ends the process: by the end of its standard input, else by a signal, else by one that none survives."""
        process = self._process
        if process.stdin is not None:
            process.stdin.close()
        for end in (process.terminate, process.kill):
            try:
                await asyncio.wait_for(process.wait(), timeout=_LEAVE)
                break
            except asyncio.TimeoutError:
                end()
        await process.wait()
        for read in self._reads.values():
            read.cancel()


class Agents(WorkerPlugin):  # type: ignore[misc]
    """The agents of one build on a Dask worker. Its name is also that of the handler, and nobody can guess it."""

    def __init__(self, name: str) -> None:
        self.name = name
        self._relays: dict[str, Relay] = {}

    def setup(self, worker: Any) -> None:
        """Dask calls this on every worker that there is or comes."""
        self._relays = {}
        worker.handlers[self.name] = self.answer

    async def teardown(self, worker: Any) -> None:
        """Dask calls this when the worker or the build ends."""
        worker.handlers.pop(self.name, None)
        for relay in self._relays.values():
            relay.leave()

    async def serve(self, agent: str, program: str | None, workers: int) -> None:
        """Starts an agent with so many worker processes and waits until it is to end.

        Raises:
            RoadmillError: There is no program.
            OSError: It cannot be started.
        """
        relay = await Relay.start([program or find_program(), "agent", "--workers", str(workers)])
        self._relays[agent] = relay
        try:
            await relay.wait()
        finally:
            self._relays.pop(agent, None)
            await relay.end()

    async def answer(self, agent: str, do: str, data: bytes = b"") -> Answer:
        """Answers a call: `is-here` whether the agent has been started, `push` and `pull` carry its streams, `leave` ends it."""
        relay = self._relays.get(agent)
        if do == "is-here":
            return {"here": relay is not None}
        if relay is None:
            return {"gone": True}
        if do == "push":
            return await relay.push(data)
        if do == "pull":
            return await relay.pull()
        relay.leave()
        return {}


async def serve(plugin: str, agent: str, program: str | None, workers: int) -> None:
    """The Dask task that an agent is."""
    agents: Agents = get_worker().plugins[plugin]
    await agents.serve(agent, program, workers)
