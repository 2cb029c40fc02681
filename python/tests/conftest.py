"""What tests share."""

from __future__ import annotations

import pathlib

import pytest

import roadmill

REPOSITORY = pathlib.Path(__file__).resolve().parents[2]


@pytest.fixture(scope="session")
def problems() -> pathlib.Path:
    """The folder of the problems that ship with roadmill."""
    return REPOSITORY / "problems"


@pytest.fixture(scope="session")
def walls(problems: pathlib.Path, tmp_path_factory: pytest.TempPathFactory) -> roadmill.Roadmap:
    """The roadmap of the README's first command."""
    return roadmill.build(problems / "walls.toml", out=tmp_path_factory.mktemp("runs") / "walls", workers=2)


@pytest.fixture
def cart() -> roadmill.Problem:
    """A cart in a room with one wall: the problem at the top of docs/problems.md."""
    return roadmill.Problem(
        "cart",
        space=roadmill.Space("rigid-2d", [0.0, 0.0], [6.0, 4.0], bounds="body"),
        robot=roadmill.Robot([roadmill.Body(roadmill.Box([1.0, 0.4, 0.4]))]),
        obstacles=[roadmill.Body(roadmill.Box([0.2, 2.5, 1.0]), position=[3.0, 1.25, 0.0])],
        start=[1.0, 1.0, 0.0],
        goal=[5.0, 1.0, 1.57],
    )


@pytest.fixture
def endless(cart: roadmill.Problem) -> roadmill.Problem:
    """The same with a criterion that is never met."""
    from dataclasses import replace

    never = {"all": [roadmill.method("query"), {"not": roadmill.method("query")}]}
    return replace(cart, evaluators=[never], sets_per_round=1)
