"""Roadmaps: what a build has left in its run folder."""

from __future__ import annotations

import base64
import csv
import html
import json
import os
import pathlib
import tempfile
from collections.abc import Callable, Sequence
from dataclasses import replace
from functools import cached_property
from typing import TYPE_CHECKING, Any, Literal

import numpy as np
import numpy.typing as npt

from . import _core
from ._arrays import Arrays, mapped
from ._options import Crew, Limits, options, whole
from ._program import call
from .errors import NoSuccess, RoadmillError, failure
from .paths import Answer, Path, of_bytes
from .status import Progress, Status, status_of

if TYPE_CHECKING:
    import networkx

    from .problem import Problem
    from .validity import ValidityFunction

__all__ = ["Roadmap"]

# Larger roadmaps have pictures of many megabytes, which no notebook should keep.
_PICTURE_EDGES_MAX = 20_000
# Tries of shortcuts, as of the program.
_SHORTEN_TRIES = 200

Floats = npt.NDArray[np.float64]


class Roadmap:
    """The roadmap of a run folder, as of the last complete round when it is first looked at.

    Nothing is read before it is needed. Then the ledger is read once and checked, and kept for queries; the arrays are
    read-only views of a file in memory. A `Roadmap` does not follow a build that goes on: make a new one for that.

    A run whose configurations a function judged (`build(…, validity=…)`) needs that function, with the same identity, for `query`,
    `ask`, `resume` and `verify`; `paths` of such a run cannot be had, since the program, which looks for them, has no function.
    """

    def __init__(self, run: str | os.PathLike[str], *, validity: ValidityFunction | None = None) -> None:
        self.run = pathlib.Path(run)
        """The run folder."""
        self.validity = validity
        """The function that judges configurations beside the model."""

    @cached_property
    def _loaded(self) -> _core.LoadedRun:
        try:
            return _core.LoadedRun(self.run, None if self.validity is None else self.validity.for_core())
        except _core.Failure as failed:
            raise failure(*failed.args) from None

    @cached_property
    def _arrays(self) -> Arrays:
        # The file is removed at once: the system keeps what is mapped for as long as the arrays live.
        with tempfile.TemporaryDirectory(prefix="roadmill-") as folder:
            file = pathlib.Path(folder) / "roadmap.npz"
            try:
                self._loaded.write_npz(file)
            except _core.Failure as failed:
                raise failure(*failed.args) from None
            return mapped(file)

    @property
    def nodes(self) -> Floats:
        """The nodes' configurations, n × dofs: lengths in the problem's unit, angles in radians, rotations as unit
        quaternions w x y z. `dof_names` and `dof_units` name the columns."""
        return self._arrays["nodes"]

    @property
    def edges(self) -> npt.NDArray[np.uint32]:
        """The edges, m × 2: numbers of nodes, the lower first."""
        return self._arrays["edges"]

    @property
    def weights(self) -> Floats:
        """What each edge costs from its lower node to its higher, m: of most models its length in the space's metric."""
        return self._arrays["weights"]

    @property
    def weights_back(self) -> Floats:
        """What each edge costs from its higher node to its lower, m; the same as `weights` but in models with energies."""
        return self._arrays.get("weights_back", self._arrays["weights"])

    @property
    def peaks(self) -> Floats | None:
        """The highest energy on each edge, m; None in models without energies."""
        return self._arrays.get("peaks")

    @property
    def components(self) -> npt.NDArray[np.uint32]:
        """The connected component of each node, n: the smallest number of a node in it."""
        return self._arrays["components"]

    @property
    def planners(self) -> npt.NDArray[np.uint8]:
        """The local planner of each edge, m: tags, which docs/formats.md lists; 0 is a straight motion."""
        return self._arrays["planners"]

    @property
    def values(self) -> dict[str, Floats]:
        """Numbers that the model gives every node, by name, n each: of models with energies `energy`."""
        names = self._arrays.get("value_names")
        if names is None:
            return {}
        return {str(name): self._arrays["values"][:, index] for index, name in enumerate(names)}

    @property
    def dof_names(self) -> list[str]:
        """Names of the degrees of freedom, the columns of `nodes`."""
        return [name for name, _ in self._loaded.dofs]

    @property
    def dof_units(self) -> list[str]:
        """Their units: `length`, `rad`, or `1` of quaternions."""
        return [unit for _, unit in self._loaded.dofs]

    @property
    def digest(self) -> str:
        """The roadmap's digest, 64 hexadecimal digits: the same for the same problem and seed, whoever did the work."""
        return self._loaded.digest

    @property
    def name(self) -> str:
        """The problem's name."""
        return self._loaded.problem_name

    @property
    def seed(self) -> int:
        """The base seed."""
        return self._loaded.seed

    @property
    def path(self) -> Path | None:
        """The path that answers the problem's own query; None where it was not solved, or there is none."""
        found = self._loaded.path
        return None if found is None else of_bytes(found, len(self._loaded.dofs))

    def __len__(self) -> int:
        """Number of nodes."""
        return self._loaded.sizes[0]

    def __repr__(self) -> str:
        nodes, edges, components = self._loaded.sizes
        return f"<Roadmap {self.name}: {nodes} nodes, {edges} edges, {components} components, in {self.run}>"

    def query(
        self,
        start: Sequence[float] | Floats | None = None,
        goal: Sequence[float] | Floats | None = None,
        *,
        shorten: bool | int = False,
    ) -> Path | None:
        """The shortest path between two configurations through the roadmap; None where there is none (`ask` says why).

        It is the path of `roadmill query`, to the bit. The first query prepares what later ones need too.

        Args:
            start, goal: Configurations, one value per degree of freedom; the problem's own if they are not given.
            shorten: Whether the path is made shorter, by 200 shortcuts or the number that is given.

        Raises:
            UsageError: A configuration is not valid, or the run's validity function is missing.
        """
        return self.ask(start, goal, shorten=shorten).path

    def ask(
        self,
        start: Sequence[float] | Floats | None = None,
        goal: Sequence[float] | Floats | None = None,
        *,
        shorten: bool | int = False,
    ) -> Answer:
        """As `query`; says also why there is no path."""
        start, goal = self._ends(start, goal)
        tries = (_SHORTEN_TRIES if shorten else None) if isinstance(shorten, bool) else whole("shorten", shorten, 0, 2**32 - 1)
        try:
            found, reason, dropped = self._loaded.query(start, goal, tries)
        except _core.Failure as failed:
            raise failure(*failed.args) from None
        path = None if found is None else of_bytes(found, len(self._loaded.dofs))
        return Answer(path, reason, dropped)

    def clearest(
        self,
        start: Sequence[float] | Floats | None = None,
        goal: Sequence[float] | Floats | None = None,
        *,
        by: Literal["widest", "weighted"] = "widest",
    ) -> Path | None:
        """The path between two configurations that keeps away from obstacles best; None where there is none.

        It is the path of `roadmill query --clearest`, to the bit. Its `measures` hold `least_clearance` and `mean_clearance`, certain
        to within the problem's resolution. The first call finds the clearances of all edges.

        Args:
            start, goal: Configurations, one value per degree of freedom; the problem's own if they are not given.
            by: `widest` for the highest least clearance, and of several such paths the shortest; `weighted` for the least sum of
                the edges' lengths, each divided by its mean clearance.

        Raises:
            UsageError: A configuration is not valid, or the problem has no clearances: it is about no bodies, without obstacles, or
                has a validity function, which tells no distances.
        """
        if by not in ("widest", "weighted"):
            raise ValueError(f"by: {by!r} found, 'widest' or 'weighted' expected")
        start, goal = self._ends(start, goal)
        try:
            found = self._loaded.clearest(start, goal, by == "widest")
        except _core.Failure as failed:
            raise failure(*failed.args) from None
        if found is None:
            return None
        path, least, mean = found
        measures: dict[str, float | None] = {"least_clearance": least, "mean_clearance": mean}
        return replace(of_bytes(path, len(self._loaded.dofs)), measures=measures)

    @property
    def node_clearances(self) -> Floats:
        """How far the nearest obstacle is from the robot at each node, n, in the problem's unit of length. It is found when it or
        `edge_clearances` is first asked for; a `UsageError` of a problem that is about no bodies, has no obstacles, or has a validity function."""
        return self._clearances[0]

    @property
    def edge_clearances(self) -> Floats:
        """How far the nearest obstacle is along each edge, m × 2: the least distance and the mean one, certain to within the problem's
        resolution."""
        return self._clearances[1]

    @cached_property
    def _clearances(self) -> tuple[Floats, Floats]:
        try:
            of_nodes, of_edges = self._loaded.clearances()
        except _core.Failure as failed:
            raise failure(*failed.args) from None
        return np.frombuffer(of_nodes, dtype="<f8"), np.frombuffer(of_edges, dtype="<f8").reshape(-1, 2)

    def _ends(
        self, start: Sequence[float] | Floats | None, goal: Sequence[float] | Floats | None
    ) -> tuple[list[float], list[float]]:
        own = self._loaded.ends
        if start is None or goal is None:
            if own is None:
                raise ValueError("start and goal expected: the problem has no query of its own")
            start = own[0] if start is None else start
            goal = own[1] if goal is None else goal
        return [float(value) for value in start], [float(value) for value in goal]

    def paths(
        self,
        count: int = 5,
        *,
        start: Sequence[float] | None = None,
        goal: Sequence[float] | None = None,
        dissimilar: bool | float = False,
        distinct: bool = False,
    ) -> list[Path]:
        """Several paths between two configurations, the best first; none if there is none. See `roadmill paths --help`.

        Args:
            count: How many are looked for.
            start, goal: Configurations; the problem's own if they are not given.
            dissimilar: Only paths that far apart from each other, or as far as the program chooses.
            distinct: The shortest of each class of paths that pass the obstacles alike.
        """
        told = {
            name: None if q is None else " ".join(repr(float(value)) for value in q)
            for name, q in (("start", start), ("goal", goal))
        }
        arguments = options(count=whole("count", count), **told)
        if dissimilar:
            arguments += ["--dissimilar"] if dissimilar is True else options(dissimilar=dissimilar)
        if distinct:
            arguments.append("--distinct")
        with tempfile.TemporaryDirectory(prefix="roadmill-") as folder:
            out = pathlib.Path(folder) / "paths"
            try:
                call("paths", self.run, *arguments, *options(out=out))
            except NoSuccess:
                return []
            with open(out / "paths.csv", newline="", encoding="utf-8") as table:
                rows = list(csv.DictReader(table))
            return [_ranked(out / f"path-{row['path']}.csv", row) for row in rows]

    def status(self) -> Status:
        """How far the build is, or why it ended, from the run's files as they are now."""
        return status_of(json.loads(call("status", self.run, "--json")))

    def verify(
        self,
        *,
        share: float | None = None,
        everything: bool = False,
        sets: Sequence[str] = (),
        workers: int | None = None,
        threads: int | None = None,
    ) -> str:
        """Recomputes sets, joins and judgements from the seeds and compares them with what is recorded; a hundredth of them
        unless it is said which. Gives the program's report.

        Args:
            share: The share that is recomputed, more than 0, at most 1.
            everything: Recompute everything.
            sets: Recompute these sets, as `uniform:17`.
            workers, threads: Who does the work, as of `build`.

        Raises:
            NotTheSame: Something differs.
        """
        crew = Crew(workers, threads)
        if share is not None and not 0 < share <= 1:
            raise ValueError(f"share: {share} found; more than 0, at most 1 expected")
        if (share is not None) + everything + bool(sets) > 1:
            raise ValueError("share, everything or sets expected, not several of them")
        if self.validity is not None:
            return self._verified_here(share, everything, sets, crew.threads_for_function())
        arguments = options(sample=None if share is None else f"{100 * share!r}%")
        if everything:
            arguments.append("--all")
        for name in sets:
            arguments += options(set=name)
        return call("verify", self.run, *arguments, *crew.options())

    def _verified_here(self, share: float | None, everything: bool, sets: Sequence[str], threads: int) -> str:
        """The report of `verify`, by this process, which has the validity function."""
        assert self.validity is not None
        try:
            found = _core.verify(self.run, share, everything, list(sets), threads, self.validity.for_core())
        except _core.Failure as failed:
            raise failure(*failed.args) from None
        recomputed, recorded, judgements, digest = found
        report = f"{recomputed} of {recorded} sets and {judgements} judgements recomputed: all as recorded\n"
        return report if digest is None else f"{report}digest {digest}\n"

    def resume(
        self,
        *,
        changed: str | os.PathLike[str] | Problem | None = None,
        workers: int | None = None,
        threads: int | None = None,
        max_nodes: int | None = None,
        max_sets: int | None = None,
        max_time: float | None = None,
        max_memory: int | None = None,
        progress: Callable[[Progress], object] | None = None,
    ) -> Roadmap:
        """Goes on with the build, on any number of workers, and gives the roadmap that it comes to.

        Args:
            changed: A problem whose query, criteria, limits and strategies are taken from here on.
            workers, threads, max_nodes, max_sets, max_time, max_memory, progress: As of `build`.

        Raises:
            Interrupted: Ctrl-C came; its `roadmap` is that of the last complete round.
        """
        from .build import resumed

        limits = Limits(max_nodes, max_sets, max_time, max_memory)
        return resumed(self.run, changed, Crew(workers, threads), limits, progress, self.validity)

    def export(self, file: str | os.PathLike[str], format: str | None = None) -> pathlib.Path:
        """Writes the roadmap for other programs and gives the file's path. The format is that of the file's extension
        (`graphml`, `csv`, `npz`, `map`, `svg`, `vtk`, `pdb`, `dcd`,
        `xtc`, `clearance`) if none is named; docs/formats.md describes them."""
        place = pathlib.Path(file)
        call("export", self.run, *options(format=format or place.suffix.removeprefix("."), out=place))
        return place

    def to_networkx(self) -> networkx.Graph[int]:
        """The roadmap as a graph of networkx. Nodes are numbers, with `configuration` (a tuple) and `component`, edges have
        `weight` and `planner`. In a model with energies it is a `DiGraph` with both directions, whose edges have `peak` too."""
        import networkx

        peaks = self.peaks
        graph: Any = networkx.Graph() if peaks is None else networkx.DiGraph()
        graph.graph.update(problem=self.name, seed=self.seed, digest=self.digest)
        configurations = map(tuple, self.nodes.tolist())
        components = self.components.tolist()
        graph.add_nodes_from(
            (node, {"configuration": q, "component": component})
            for node, (q, component) in enumerate(zip(configurations, components))
        )
        low, high = self.edges.T.tolist() if len(self.edges) else ([], [])
        planners = self.planners.tolist()
        if peaks is None:
            attributes = ({"weight": w, "planner": p} for w, p in zip(self.weights.tolist(), planners))
            graph.add_edges_from(zip(low, high, attributes))
        else:
            for ends, weights in (((low, high), self.weights), ((high, low), self.weights_back)):
                several = zip(weights.tolist(), planners, peaks.tolist())
                attributes = ({"weight": w, "planner": p, "peak": e} for w, p, e in several)
                graph.add_edges_from(zip(*ends, attributes))
        return graph

    def picture(self) -> str:
        """A picture of the scene, the roadmap and the path of the problem's query, as SVG.

        Raises:
            UsageError: The model cannot be drawn.
        """
        with tempfile.TemporaryDirectory(prefix="roadmill-") as folder:
            file = self.export(pathlib.Path(folder) / "roadmap.svg")
            return file.read_text(encoding="utf-8")

    def _repr_html_(self) -> str:
        """What a notebook shows: the picture, if the roadmap is not too large for one, and its numbers."""
        nodes, edges, components = self._loaded.sizes
        numbers = [("nodes", nodes), ("edges", edges), ("components", components), ("digest", self.digest[:16] + "…")]
        row = "".join(f"<td><b>{name}</b> {value}</td>" for name, value in numbers)
        title = f"<b>{html.escape(self.name)}</b> (seed {self.seed})"
        shown = ""
        if edges <= _PICTURE_EDGES_MAX:
            try:
                # As an image, so that two pictures on one page do not share names.
                data = base64.b64encode(self.picture().encode()).decode()
                alt = html.escape(f"The roadmap of {self.name}", quote=True)
                shown = f'<img alt="{alt}" style="max-width:100%;max-height:480px" src="data:image/svg+xml;base64,{data}"/>'
            except RoadmillError as error:
                shown = f"<i>{html.escape(str(error))}</i>"
        return f"<div>{title}<table><tr>{row}</tr></table>{shown}</div>"


def _ranked(file: pathlib.Path, row: dict[str, str]) -> Path:
    """A path that `roadmill paths` has written, with its line of the table."""
    configurations = np.loadtxt(file, delimiter=",", skiprows=1, ndmin=2)
    configurations.flags.writeable = False
    # Columns are called `cost [length]`: the unit is no part of the name.
    columns = {name.split(" [")[0]: text for name, text in row.items()}
    passes = columns.pop("class", None)
    measures = {name: float(text) if text else None for name, text in columns.items()}
    cost = measures["cost"]
    assert cost is not None
    return Path(configurations, cost, measures, passes)
