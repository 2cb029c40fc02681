"""How far a build is, and what it came to."""

from __future__ import annotations

from dataclasses import dataclass, field, fields
from typing import Any, TypeVar

__all__ = ["Evaluation", "Progress", "Status"]


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
    return _made(Progress, {**event, "evaluators": [_evaluation(it) for it in event["evaluators"]]})


def status_of(event: dict[str, Any]) -> Status:
    """What an event `status` says."""
    return _made(Status, {**event, "evaluators": [_evaluation(it) for it in event["evaluators"]]})
