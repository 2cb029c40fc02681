"""How far a build is, and what it came to."""

from __future__ import annotations

from dataclasses import dataclass, field, fields
from typing import Any, TypeVar

__all__ = ["Evaluation", "Machine", "Progress", "Status"]


@dataclass(frozen=True)
class Evaluation:
    """What an evaluator said last."""

    name: str
    value: float
    """The value; infinite where there is none yet."""
    threshold: float
    """What the value is compared with."""
    bound: str
    """Whether the threshold is the least (`at-least`) or the largest (`at-most`) value that satisfies."""
    satisfied: bool
    measures: dict[str, float] = field(default_factory=dict)
    """Further numbers by name."""
    path_length: float | None = None
    """Of a solved query: the length of its path."""
    dropped_edges: int | None = None
    """Of a query: edges left out because they failed the finer check."""


@dataclass(frozen=True)
class Machine:
    """What one of several machines does for a build. Each has an agent, with worker processes of its own."""

    name: str
    """Its name in this build."""
    host: str
    """What it calls itself; empty before its agent has said so."""
    state: str
    """`ready`, `starting`, `waiting` (its agent is to be started again) or `refused`."""
    reason: str
    """Why it is not ready, where there is a reason."""
    cores: int
    """How many jobs it does at once."""
    held: int
    """Jobs that it holds."""
    done: int
    """Jobs that it has done."""
    busy_seconds: float
    """Seconds that its jobs took, added up over its cores."""
    waiting_seconds: float
    """Core-seconds that it was ready and did nothing."""
    bytes_received: int
    """Bytes that it sent."""
    bytes_sent: int
    """Bytes that it was sent."""
    restarts: int
    """How often its agent was started after it had been lost."""
    worker_deaths: int
    """Deaths of its worker processes."""
    round_trip_seconds: float | None
    """How long a sign of life takes there and back; None before the first."""


@dataclass(frozen=True)
class Progress:
    """How far a build is while it runs."""

    seconds: float
    """Wall-clock seconds since it began."""
    sets_generated: int
    sets_joined: int
    rounds: int
    nodes: int
    edges: int
    components: int
    nodes_per_second: float
    evaluators: list[Evaluation]
    workers_alive: int
    workers_wanted: int
    machines: list[Machine] = field(default_factory=list)
    """Of a build on several machines."""


@dataclass(frozen=True)
class Status:
    """How far a run is, from its files alone."""

    run: str
    problem: str
    seed: int
    rounds: int
    sets: int
    nodes: int
    edges: int
    components: int
    evaluators: list[Evaluation]
    state: str
    """`running`, `held` (on another host), `killed`, `failed`, or why it stopped in a word: `satisfied`, `node-limit`, …"""
    reason: str
    """The same for people."""
    digest: str | None
    """Digest of the roadmap; None before the first round."""

    @property
    def satisfied(self) -> bool:
        """Whether the build ended because all criteria were met."""
        return self.state == "satisfied"


_T = TypeVar("_T")


def _made(kind: type[_T], values: dict[str, Any]) -> _T:
    """An instance of a data class from those of the values that it has fields for."""
    names = {each.name for each in fields(kind)}  # type: ignore[arg-type]
    return kind(**{name: value for name, value in values.items() if name in names})


def _evaluation(values: dict[str, Any]) -> Evaluation:
    # JSON has no infinity.
    numbers = {key: float("inf") if values[key] is None else values[key] for key in ("value", "threshold")}
    return _made(Evaluation, {**values, **numbers})


def progress_of(event: dict[str, Any]) -> Progress:
    """What an event `progress` says."""
    machines = [_made(Machine, it) for it in event.get("machines", [])]
    return _made(Progress, {**event, "evaluators": [_evaluation(it) for it in event["evaluators"]], "machines": machines})


def status_of(event: dict[str, Any]) -> Status:
    """What an event `status` says."""
    return _made(Status, {**event, "evaluators": [_evaluation(it) for it in event["evaluators"]]})
