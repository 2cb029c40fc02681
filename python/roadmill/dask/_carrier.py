"""The process that the coordinator starts for an agent on a Dask worker. It is run by its file's name and imports nothing of roadmill,
so that it starts in a few milliseconds.

    python _carrier.py SOCKET NAME

It hands its standard input and output, which are pipes to the coordinator, to the process that listens at SOCKET, and with them NAME, the
name of the agent's place. What that process then sends is written to standard error. This process ends when the connection does,
and the connection when this process does: so each side sees that the other is gone.

Where nobody listens at SOCKET, the process that had the Dask client has been killed. No agent can be started any more, so this process tells
the coordinator, which has started it, to end. What is complete is in the run folder by then.
"""

from __future__ import annotations

import os
import signal
import socket
import sys


def main() -> int:
    """Hands the streams on and waits for the end; the exit code."""
    path, name = sys.argv[1:]
    with socket.socket(socket.AF_UNIX, socket.SOCK_STREAM) as connection:
        try:
            connection.connect(path)
            socket.send_fds(connection, [name.encode()], [0, 1])
        except OSError as error:
            print(f"the process with the Dask client is gone: {error}", file=sys.stderr)
            os.kill(os.getppid(), signal.SIGTERM)
            return 1
        # The coordinator sees the end of a pipe when nobody has the pipe open any more.
        os.close(0)
        os.close(1)
        try:
            while said := connection.recv(1 << 12):
                os.write(2, said)
        except OSError:
            pass
    return 0


if __name__ == "__main__":
    sys.exit(main())
