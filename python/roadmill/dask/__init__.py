"""Builds on the workers of a Dask cluster: `pip install roadmill[dask]`.

    import distributed
    import roadmill.dask

    client = distributed.Client(cluster)
    roadmap = roadmill.dask.build("problems/walls.toml", client, out="runs/walls")

`build` and `resume` have an agent of roadmill's on each Dask worker, and the coordinator on this machine. `generate` makes sets beforehand, as
ordinary Dask tasks. Dask places the work, moves the bytes and proves who is who; roadmill opens no port. Either way the roadmap is
that of `roadmill.build`, bit for bit.

Every Dask worker needs this package, of the same version: it brings the program that works there.
"""

from __future__ import annotations

try:
    import distributed as _distributed  # noqa: F401
except ImportError as missing:
    raise ImportError(
        f"roadmill.dask needs the package `distributed` ({missing}); `pip install roadmill[dask]` brings it"
    ) from missing

from ._build import build, resume
from ._generate import generate

__all__ = ["build", "generate", "resume"]
