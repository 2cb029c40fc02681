"""Paths that a roadmap gives."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
import numpy.typing as npt

__all__ = ["Answer", "Path"]


@dataclass(frozen=True, eq=False)
class Path:
    """A path: configurations, each joined with the next by a straight motion in the configuration space.

    Every motion was checked 20 times finer than the problem's resolution.
    """

    configurations: npt.NDArray[np.float64]
    """n × dofs, from start to goal; lengths in the problem's unit, angles in radians, rotations as unit quaternions w x y z."""
    length: float
    """What its motions cost together: their lengths in the space's metric, or of a model with energies the sum of climbs."""
    measures: dict[str, float | None] = field(default_factory=dict)
    """Of a path of `Roadmap.paths` what is measured of it, by the columns of `paths.csv` (docs/formats.md); None where the
    model has no such number. Of a path of `Roadmap.clearest` its least and its mean clearance."""
    passes: str | None = None
    """Of a path of `Roadmap.paths(distinct=True)` the class of paths that it belongs to."""

    def __len__(self) -> int:
        return len(self.configurations)


@dataclass(frozen=True, eq=False)
class Answer:
    """What a query came to."""

    path: Path | None
    """The path; None where there is none."""
    reason: str | None
    """Why there is no path; None where there is one."""
    dropped_edges: int
    """Edges that failed the finer check of the path and were left out."""


def of_bytes(found: tuple[bytes, float], dofs: int) -> Path:
    """A path as `roadmill._core` gives it."""
    configurations = np.frombuffer(found[0], dtype="<f8").reshape(-1, dofs)
    return Path(configurations, found[1])
