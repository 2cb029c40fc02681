"""Problems made of values are those of problem files."""

from __future__ import annotations

import pathlib
from dataclasses import replace

import numpy as np
import pytest

import roadmill
from roadmill import _core
from roadmill import Body, Box, Frame, Link, Mesh, Problem, Robot, Space, Strategy, method

CART = """
[space]
motion = "rigid-2d"
min = [0.0, 0.0]
max = [6.0, 4.0]
bounds = "body"

[robot]
bodies = [{ shape = { box = { size = [1.0, 0.4, 0.4] } } }]

[[obstacles]]
shape = { box = { size = [0.2, 2.5, 1.0] } }
position = [3.0, 1.25, 0.0]

[query]
start = [1.0, 1.0, 0.0]
goal = [5.0, 1.0, 1.57]
"""


def from_file(folder: pathlib.Path, text: str) -> str:
    """The digest of the problem in a file."""
    file = folder / "cart.toml"
    file.write_text(text)
    return _core.check_problem(file)[0]


def test_the_digest_is_that_of_the_file(cart: Problem, tmp_path: pathlib.Path) -> None:
    assert cart.digest() == from_file(tmp_path, CART)


def test_it_is_built(cart: Problem, tmp_path: pathlib.Path) -> None:
    by_processes = roadmill.build(cart, out=tmp_path / "processes", workers=1)
    by_threads = roadmill.build(cart, out=tmp_path / "threads", threads=1)
    assert by_processes.digest == by_threads.digest and by_processes.name == "cart"
    path = by_processes.path
    assert path is not None
    np.testing.assert_array_equal(path.configurations[[0, -1]], [cart.start, cart.goal])


def test_strategies_evaluators_and_limits(cart: Problem, tmp_path: pathlib.Path) -> None:
    problem = replace(
        cart,
        seed=2**63,
        sets_per_round=2,
        schedule=["near", "near", "trees"],
        strategies=[
            Strategy("near", method("gaussian", deviation=0.3), nodes=20, within=method("nearest", neighbors=5)),
            Strategy("trees", generator=method("rrt-connect", step=0.5), among=method("until-joined")),
        ],
        evaluators=[method("query", neighbors=20), {"any": [method("coverage", percent=90), method("connectivity")]}],
        max_nodes=400,
    )
    more = """
[img]
sets_per_round = 2
schedule = ["near", "near", "trees"]
[[strategies]]
label = "near"
nodes = 20
sampler = { gaussian = { deviation = 0.3 } }
within = { nearest = { neighbors = 5 } }
[[strategies]]
label = "trees"
generator = { rrt-connect = { step = 0.5 } }
among = { until-joined = {} }
[[evaluators]]
query = { neighbors = 20 }
[[evaluators]]
any = [{ coverage = { percent = 90 } }, { connectivity = {} }]
[limits]
nodes = 400
"""
    assert problem.digest() == from_file(tmp_path, f"seed = {2**63}\n{CART}{more}")
    assert "400" in problem.describe()


@pytest.mark.parametrize(
    ("change", "key", "told"),
    [
        ({"obstacles": [Body(Box([1.0, -1.0, 1.0]))]}, "obstacles[0].shape", "a positive length expected"),
        ({"space": Space("rigid-2d", [0.0], [6.0, 4.0])}, "space.min", "1 value"),
        ({"goal": [5.0, 1.0]}, "query.goal", "2 values found, 3 expected"),
        ({"start": [3.0, 1.0, 0.0]}, "query.start", "collides"),
        ({"max_nodes": 0}, "limits.nodes", "expected"),
        ({"evaluators": [method("coverage", percent=101)]}, "evaluators[0]", "101"),
        ({"strategies": [Strategy("a", method("grid", cells=0))]}, "strategies[0].sampler", "expected"),
    ],
)
def test_errors_name_the_key(
    cart: Problem, tmp_path: pathlib.Path, change: dict[str, object], key: str, told: str
) -> None:
    wrong = replace(cart, **change)  # type: ignore[arg-type]
    for attempt in (
        wrong.digest,
        lambda: roadmill.build(wrong, out=tmp_path / "p", workers=1),
        lambda: roadmill.build(wrong, out=tmp_path / "t", threads=1),
    ):
        with pytest.raises(roadmill.ProblemError, match=told) as raised:
            attempt()
        assert raised.value.key == key and str(raised.value).startswith(f"{key}: ")
    assert list(tmp_path.iterdir()) == []


def test_a_misspelt_method_is_said(cart: Problem) -> None:
    with pytest.raises(roadmill.ProblemError, match="unknown variant `gausian`"):
        replace(cart, strategies=[Strategy("a", method("gausian", deviation=1.0))]).digest()


def test_meshes_from_arrays_are_those_of_files(cart: Problem, tmp_path: pathlib.Path) -> None:
    corners = np.array([[x, y, z] for x in (-0.1, 0.1) for y in (-1.25, 1.25) for z in (-0.5, 0.5)]) / 3.0
    faces = [[0, 1, 3], [0, 3, 2], [4, 6, 7], [4, 7, 5], [0, 4, 5], [0, 5, 1], [2, 3, 7], [2, 7, 6], [0, 2, 6], [0, 6, 4], [1, 5, 7], [1, 7, 3]]
    lines = [f"v {x!r} {y!r} {z!r}" for x, y, z in corners.tolist()] + [f"f {a + 1} {b + 1} {c + 1}" for a, b, c in faces]
    (tmp_path / "wall.obj").write_text("\n".join(lines))
    where = [3.0, 1.25, 0.0]
    by_array = replace(cart, obstacles=[Body(Mesh(vertices=corners, triangles=faces, scale=3.0), position=where)])
    by_file = replace(cart, obstacles=[Body(Mesh(tmp_path / "wall.obj", scale=3.0), position=where)])
    assert by_array.digest() == by_file.digest()
    assert roadmill.build(by_array, out=tmp_path / "run", workers=1).path is not None
    for wrong in (Mesh(), Mesh("a.stl", vertices=corners, triangles=faces), Mesh(vertices=corners)):
        with pytest.raises(ValueError, match="a file, or vertices and triangles"):
            replace(cart, obstacles=[Body(wrong)]).digest()
    with pytest.raises(ValueError, match="from 0 to 7"):
        replace(cart, obstacles=[Body(Mesh(vertices=corners, triangles=[[0, 1, 8]]))]).digest()


def test_linkages(tmp_path: pathlib.Path) -> None:
    arm = Robot(
        [Body(Box([0.4, 0.4, 0.4]))],
        links=[
            Link("arm", roadmill.revolute([0, 1, 0], degrees=[-90, 90]), [Body(roadmill.Capsule(0.1, 1.0), [0, 0, 0.6])], before=Frame([0, 0, 0.2])),
            Link("tool", roadmill.prismatic([0, 0, 1], [0.0, 0.5]), [Body(roadmill.Sphere(0.1))], parent="arm", before=Frame([0, 0, 1.2])),
        ],
        base=Frame([0, 0, 1]),
        may_touch=[("base", "tool")],
    )
    problem = Problem("arm", space=Space("fixed", [-3, -3, 0], [3, 3, 4]), robot=arm, start=[-1.5, 0.0], goal=[1.5, 0.5])
    assert "arm" in problem.describe()
    roadmap = roadmill.build(problem, out=tmp_path / "arm", threads=1)
    assert roadmap.dof_names == ["arm", "tool"] and roadmap.path is not None


def test_a_urdf(problems: pathlib.Path) -> None:
    space = Space("fixed", [-1, -2, 0], [5, 2, 3])
    gantry = Problem("gantry", space=space, robot=Robot(urdf=problems / "gantry.urdf"))
    assert "slide" in gantry.describe()


def test_a_landscape() -> None:
    landscape = roadmill.Landscape([-1.5, -0.5], [1.2, 2.0], method("muller-brown"), highest=20.0)
    assert "x y" in Problem("energy", landscape=landscape).describe()


def test_texts_and_numbers_are_read_back(cart: Problem, tmp_path: pathlib.Path) -> None:
    tomllib = pytest.importorskip("tomllib")  # Python 3.11
    text = replace(cart, further={"a b": {"x\n\x7f\"\\é": [1e300, -0.0, 5, True, np.float64(0.1), np.int64(7)]}}).to_toml()
    assert tomllib.loads(text)["a b"] == {"x\n\x7f\"\\é": [1e300, -0.0, 5, True, 0.1, 7]}
    with pytest.raises(TypeError, match="a number, text, path, sequence or mapping expected"):
        replace(cart, further={"x": object()}).to_toml()


@pytest.mark.parametrize("name", ["../../escaped", "a/b", ""])
def test_a_name_is_no_path(cart: Problem, tmp_path: pathlib.Path, name: str) -> None:
    before = set(tmp_path.parent.iterdir())
    try:
        roadmap = roadmill.build(replace(cart, name=name), out=tmp_path / "run", threads=1)
    except roadmill.ProblemError as error:
        assert error.key == "name"
    else:
        assert roadmap.name == name
    assert set(tmp_path.parent.iterdir()) == before
