"""Bodies: shapes, and where they stand."""

from __future__ import annotations

import os
import pathlib
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Literal

import numpy as np
import numpy.typing as npt

__all__ = ["Body", "Box", "Capsule", "Cylinder", "Frame", "Mesh", "Point", "Sphere"]

Vector = Sequence[float] | npt.NDArray[np.float64]
Table = dict[str, Any]


class MeshFiles:
    """Where meshes that are arrays are written as files, one after the other."""

    def __init__(self, folder: pathlib.Path) -> None:
        self._folder = folder
        self._count = 0

    def write(self, vertices: npt.NDArray[np.float64], triangles: npt.NDArray[np.int64]) -> str:
        """Writes a mesh as a Wavefront OBJ, whose numbers are read back to the same bits; its path."""
        file = self._folder / f"mesh-{self._count}.obj"
        self._count += 1
        with open(file, "w", encoding="ascii") as out:
            out.writelines(f"v {x!r} {y!r} {z!r}\n" for x, y, z in vertices.tolist())
            out.writelines(f"f {a} {b} {c}\n" for a, b, c in (triangles + 1).tolist())
        return str(file)


@dataclass(frozen=True)
class Point:
    """The origin alone; of robots only."""

    def table(self, meshes: MeshFiles) -> Table:
        """The shape as a problem file has it."""
        return {"point": {}}


@dataclass(frozen=True)
class Box:
    """Edge lengths along x, y, z; centred."""

    size: Vector

    def table(self, meshes: MeshFiles) -> Table:
        """The shape as a problem file has it."""
        return {"box": {"size": self.size}}


@dataclass(frozen=True)
class Sphere:
    """A ball; centred."""

    radius: float

    def table(self, meshes: MeshFiles) -> Table:
        """The shape as a problem file has it."""
        return {"sphere": {"radius": self.radius}}


@dataclass(frozen=True)
class Cylinder:
    """A cylinder about the z axis; centred."""

    radius: float
    height: float

    def table(self, meshes: MeshFiles) -> Table:
        """The shape as a problem file has it."""
        return {"cylinder": {"radius": self.radius, "height": self.height}}


@dataclass(frozen=True)
class Capsule:
    """A cylinder about the z axis with half a ball on either end: height + 2 radius long; centred."""

    radius: float
    height: float

    def table(self, meshes: MeshFiles) -> Table:
        """The shape as a problem file has it."""
        return {"capsule": {"radius": self.radius, "height": self.height}}


@dataclass(frozen=True, eq=False)
class Mesh:
    """Triangles: of a file (`.obj`, `.stl`, `.ply`, `.dae`, `.g`), or of arrays."""

    file: str | os.PathLike[str] | None = None
    vertices: npt.ArrayLike | None = None
    """n × 3, lengths; not beside a file."""
    triangles: npt.ArrayLike | None = None
    """m × 3, numbers of vertices from 0 on."""
    scale: float | None = None
    """What coordinates are multiplied with."""
    weld: float | None = None
    """Vertices of an open mesh are joined that are at most this far apart, as a share of its size."""

    def table(self, meshes: MeshFiles) -> Table:
        """The shape as a problem file has it."""
        if (self.file is None) == (self.vertices is None) or (self.vertices is None) != (self.triangles is None):
            raise ValueError("a file, or vertices and triangles, expected")
        if self.file is not None:
            file = str(pathlib.Path(self.file).absolute())
        else:
            file = meshes.write(*self._arrays())
        return {"mesh": {"file": file, "scale": self.scale, "weld": self.weld}}

    def _arrays(self) -> tuple[npt.NDArray[np.float64], npt.NDArray[np.int64]]:
        vertices = np.asarray(self.vertices, dtype=np.float64)
        triangles = np.asarray(self.triangles)
        for name, array in (("vertices", vertices), ("triangles", triangles)):
            if array.ndim != 2 or array.shape[1] != 3:
                raise ValueError(f"{name}: an array of shape {array.shape} found; one of shape (n, 3) expected")
        if not np.issubdtype(triangles.dtype, np.integer):
            raise ValueError(f"triangles: {triangles.dtype} found; whole numbers expected")
        if triangles.size and (triangles.min() < 0 or triangles.max() >= len(vertices)):
            raise ValueError(f"triangles: numbers of vertices from 0 to {len(vertices) - 1} expected")
        return vertices, triangles.astype(np.int64)


Shape = Point | Box | Sphere | Cylinder | Capsule | Mesh


@dataclass(frozen=True)
class Frame:
    """Where something stands: p ↦ rotation · p + position."""

    position: Vector | None = None
    orientation: Vector | None = None
    """A quaternion w x y z."""
    turn: tuple[Vector, float] | None = None
    """The same as an axis and an angle in degrees, right-handed; not beside orientation."""

    def table(self) -> Table:
        """The keys of a frame."""
        turn = None if self.turn is None else {"axis": self.turn[0], "degrees": self.turn[1]}
        return {"position": self.position, "orientation": self.orientation, "turn": turn}


@dataclass(frozen=True)
class Body:
    """A shape somewhere: of a robot in the frame of its link, of an obstacle in the world's."""

    shape: Shape
    position: Vector | None = None
    """Where its origin stands, a length each."""
    orientation: Vector | None = None
    """A quaternion w x y z."""
    turn: tuple[Vector, float] | None = None
    """The same as an axis and an angle in degrees, right-handed; not beside orientation."""
    solid: bool | Literal["auto"] | None = None
    """Whether the inside of a mesh is material; of closed ones if nothing is said."""
    further: Mapping[str, Any] | None = None
    """Further keys of a body, as they are."""

    def table(self, meshes: MeshFiles) -> Table:
        """The body as a problem file has it."""
        frame = Frame(self.position, self.orientation, self.turn).table()
        return {"shape": self.shape.table(meshes), **frame, "solid": self.solid, **(self.further or {})}
