"""Problems made of values: what a problem file says, said in Python.

Every key of docs/problems.md has the same name here, but those of `[limits]`, which are called as in `build`. What is said is written as a problem file, which the program reads, so
that the program alone decides what is right: its errors come back as `ProblemError`, with the key.
"""

from __future__ import annotations

import os
import pathlib
import tempfile
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any, Literal

import numpy as np
import numpy.typing as npt

from . import _core, _toml
from .errors import problem_failure
from .shapes import Body, Frame, MeshFiles, Table, Vector

__all__ = ["Landscape", "Link", "Problem", "Robot", "Space", "Strategy", "fixed", "method", "prismatic", "revolute", "spherical"]

Motion = Literal["translation-2d", "rigid-2d", "translation-3d", "rigid-3d", "fixed"]


def method(name: str, **settings: Any) -> dict[str, Any]:
    """A method with its settings: a sampler, connection, generator, neighbour finder, local planner or evaluator.

    `method("gaussian", deviation=0.5)` is what a problem file writes as `{ gaussian = { deviation = 0.5 } }`. Names and settings
    are those of docs/problems.md.
    """
    return {name: settings}


@dataclass(frozen=True)
class Space:
    """How the robot moves, and where."""

    motion: Motion
    min: Vector
    """Least x, y (planar) or x, y, z, in the world's frame; lengths."""
    max: Vector
    """Largest x, y or x, y, z."""
    bounds: Literal["body", "reference"] = "body"
    """What stays in the box: every point of the robot, or its reference point alone."""
    resolution: float | None = None
    """How finely motions are checked, a length; chosen by the program if there is none."""
    edges: Literal["swept", "sampled"] | None = None
    """Whether motions are proved over their whole length (the default) or checked at samples."""
    rotation_length: float | None = None
    """What a radian counts for in the metric, a length."""

    def table(self) -> Table:
        """The table `[space]`."""
        return dict(vars(self))


@dataclass(frozen=True)
class Link:
    """A link of a robot, and the joint by which it hangs on an earlier one."""

    name: str
    kind: Mapping[str, Any]
    """How it moves: `revolute(…)`, `prismatic(…)`, `spherical()` or `fixed()`."""
    bodies: Sequence[Body] = ()
    """In the link's frame."""
    parent: str | None = None
    """The name of the link that it hangs on; the link before it if there is none."""
    joint_name: str | None = None
    """Name of the joint's value in configurations; the link's if there is none."""
    before: Frame | None = None
    """The link's frame in its parent's is before · motion · after."""
    after: Frame | None = None

    def table(self, meshes: MeshFiles) -> Table:
        """An entry of `[[robot.links]]`."""
        frames = {name: frame and frame.table() for name, frame in (("before", self.before), ("after", self.after))}
        joint = {"parent": self.parent, "name": self.joint_name, "kind": self.kind, **frames}
        return {"name": self.name, "bodies": [body.table(meshes) for body in self.bodies] or None, "joint": joint}


def revolute(axis: Vector, *, degrees: Sequence[float] | None = None, radians: Sequence[float] | None = None) -> Table:
    """A joint that turns about an axis, between a least and a largest angle or, without them, on and on."""
    return {"revolute": {"axis": axis, "degrees": degrees, "radians": radians}}


def prismatic(axis: Vector, range: Sequence[float]) -> Table:
    """A joint that slides along an axis, between a least and a largest length."""
    return {"prismatic": {"axis": axis, "range": range}}


def spherical() -> Table:
    """A joint that turns freely; its value is a unit quaternion."""
    return {"spherical": {}}


def fixed() -> Table:
    """A joint that does not move."""
    return {"fixed": {}}


@dataclass(frozen=True)
class Robot:
    """What moves: bodies, links that hang on them, or a URDF."""

    bodies: Sequence[Body] = ()
    """In the robot's frame; of a linkage in that of its base."""
    links: Sequence[Link] = ()
    urdf: str | os.PathLike[str] | None = None
    """A file that takes the place of bodies and links."""
    base: Frame | None = None
    """Where a base with the motion `fixed` stands."""
    name: str | None = None
    may_touch: Sequence[tuple[str, str]] = ()
    """Pairs of links that may touch although they are no neighbours."""
    further: Mapping[str, Any] = field(default_factory=dict)
    """Further keys of `[robot]`, as they are."""

    def table(self, meshes: MeshFiles) -> Table:
        """The table `[robot]`."""
        return {
            "name": self.name,
            "urdf": None if self.urdf is None else str(pathlib.Path(self.urdf).absolute()),
            "base": self.base and self.base.table(),
            "bodies": [body.table(meshes) for body in self.bodies] or None,
            "links": [link.table(meshes) for link in self.links] or None,
            "may_touch": [list(pair) for pair in self.may_touch] or None,
            **self.further,
        }


@dataclass(frozen=True)
class Landscape:
    """A point that moves in a rectangle of the plane, in an energy (docs/landscape.md)."""

    min: Vector
    max: Vector
    energy: Mapping[str, Any]
    """`method("muller-brown")`, or `{"terms": […]}`."""
    highest: float | None = None
    """Configurations and motions above this energy are invalid."""
    tolerance: float | None = None

    def table(self) -> Table:
        """The table `[landscape]`."""
        return dict(vars(self))


@dataclass(frozen=True)
class Strategy:
    """How the node sets of one label are made and joined to the roadmap."""

    label: str
    sampler: Mapping[str, Any] | None = None
    nodes: int | None = None
    """Nodes per set."""
    within: Mapping[str, Any] | None = None
    among: Mapping[str, Any] | None = None
    generator: Mapping[str, Any] | None = None
    """Instead of sampler and within."""

    def table(self) -> Table:
        """An entry of `[[strategies]]`."""
        return dict(vars(self))


@dataclass(frozen=True)
class Problem:
    """A problem: what is to be planned, how the roadmap is built, and when it is finished.

    What is left out has the defaults of docs/problems.md. A problem of rigid bodies and linkages has `space`, `robot` and
    `obstacles`; one of an energy over the plane has `landscape` instead.
    """

    name: str
    space: Space | None = None
    robot: Robot | None = None
    obstacles: Sequence[Body] = ()
    """In the world's frame."""
    landscape: Landscape | None = None
    start: Sequence[float] | npt.NDArray[np.float64] | None = None
    """The configuration where a path is to begin: one value per degree of freedom."""
    goal: Sequence[float] | npt.NDArray[np.float64] | None = None
    seed: int | None = None
    sets_per_round: int | None = None
    schedule: Sequence[str] | Mapping[str, Any] | None = None
    """Labels of strategies, over and over, or `{"adaptive": {"rounds": 10}}`."""
    strategies: Sequence[Strategy] = ()
    evaluators: Sequence[Mapping[str, Any]] | None = None
    """Methods: the criteria that a finished roadmap meets. Without them, of a problem with start and goal, that a path is found."""
    max_nodes: int | None = None
    max_sets: int | None = None
    max_time: float | None = None
    """Seconds."""
    further: Mapping[str, Any] = field(default_factory=dict)
    """Further tables of a problem file, as they are: `{"protein": {…}}`, `{"deformable": {}}`."""

    def to_toml(self, meshes: str | os.PathLike[str] = ".") -> str:
        """The problem as a problem file. Meshes that are arrays are written into the folder `meshes`."""
        files = MeshFiles(pathlib.Path(meshes).absolute())
        query = None
        if self.start is not None or self.goal is not None:
            query = {"start": self.start, "goal": self.goal}
        img = {"sets_per_round": self.sets_per_round, "schedule": self.schedule}
        limits = {"nodes": self.max_nodes, "sets": self.max_sets, "seconds": self.max_time}
        return _toml.document(
            {
                "name": self.name,
                "seed": self.seed,
                "space": self.space and self.space.table(),
                "robot": self.robot and self.robot.table(files),
                "obstacles": [body.table(files) for body in self.obstacles] or None,
                "landscape": self.landscape and self.landscape.table(),
                "query": query,
                "img": _said(img),
                "strategies": [strategy.table() for strategy in self.strategies] or None,
                "evaluators": None if self.evaluators is None else list(self.evaluators),
                "limits": _said(limits),
                **self.further,
            }
        )

    def write(self, file: str | os.PathLike[str]) -> pathlib.Path:
        """Writes the problem as a problem file, and meshes that are arrays beside it; gives the file's path."""
        place = pathlib.Path(file)
        place.write_text(self.to_toml(place.parent), encoding="utf-8")
        return place

    def describe(self) -> str:
        """What would be built, in words: what a configuration is, the scene, strategies, criteria and limits.

        Raises:
            ProblemError: Something is wrong with the problem; the message names the key.
        """
        return self._checked()[1]

    def digest(self) -> str:
        """The digest of all that determines the roadmap, 64 hexadecimal digits; name, criteria and limits do not count.

        Raises:
            ProblemError: Something is wrong with the problem; the message names the key.
        """
        return self._checked()[0]

    def _checked(self) -> tuple[str, str, list[str]]:
        with tempfile.TemporaryDirectory(prefix="roadmill-") as folder:
            file = self.write(pathlib.Path(folder) / "problem.toml")
            try:
                return _core.check_problem(file)
            except _core.Failure as failed:
                code, message = failed.args
                raise problem_failure(code, message, str(file)) from None


def _said(table: Table) -> Table | None:
    """The table, or None if it says nothing."""
    return table if any(it is not None for it in table.values()) else None
