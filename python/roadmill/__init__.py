"""roadmill grows probabilistic roadmaps, the same bit for bit however many processes or threads do the work.

    import roadmill

    roadmap = roadmill.build("problems/walls.toml", out="runs/walls")
    print(roadmap.nodes.shape, roadmap.digest)
    path = roadmap.query([1, 2, 2, 1, 0, 0, 0], [7, 2, 2, 1, 0, 0, 0], shorten=True)

`build` grows a roadmap, `Roadmap` is what it leaves in a run folder, and `Problem` says what to plan without a file.
"""

from __future__ import annotations

from importlib.metadata import PackageNotFoundError, version

from . import errors
from ._core import BITS_VERSION
from .build import build
from .errors import (
    BrokenRun,
    Interrupted,
    NoSuccess,
    NotTheSame,
    ProblemError,
    RoadmillError,
    SystemFailure,
    UsageError,
    WorkersLost,
)
from .paths import Answer, Path
from .problem import (
    Landscape,
    Link,
    Problem,
    Robot,
    Space,
    Strategy,
    fixed,
    method,
    prismatic,
    revolute,
    spherical,
)
from .roadmap import Roadmap
from .shapes import Body, Box, Capsule, Cylinder, Frame, Mesh, Point, Sphere
from .status import Evaluation, Machine, Progress, Status
from .validity import ValidityFunction

try:
    __version__ = version("roadmill")
except PackageNotFoundError:
    __version__ = "unknown"

__all__ = [
    "BITS_VERSION",
    "Answer",
    "Body",
    "Box",
    "BrokenRun",
    "Capsule",
    "Cylinder",
    "Evaluation",
    "Frame",
    "Interrupted",
    "Landscape",
    "Link",
    "Machine",
    "Mesh",
    "NoSuccess",
    "NotTheSame",
    "Path",
    "Point",
    "Problem",
    "ProblemError",
    "Progress",
    "Roadmap",
    "RoadmillError",
    "Robot",
    "Space",
    "Sphere",
    "Status",
    "Strategy",
    "SystemFailure",
    "UsageError",
    "ValidityFunction",
    "WorkersLost",
    "build",
    "errors",
    "fixed",
    "method",
    "prismatic",
    "revolute",
    "spherical",
]
