#!/usr/bin/env python3
"""Writes scenes of many rooms as problem files, for benches of merging (docs/performance.md, "Ways of merging").

    bench/rooms.py FOLDER

`house-…`: a grid of rooms 10 by 10, between which doors, drawn at random, make a tree, with or without some more; the
query goes from the first room to the last. `corridor-…`: one corridor that runs to and fro between thin walls, so that
most of what is near lies behind a wall. Lengths are in metres.
"""

import pathlib
import random
import sys

ROOM = 10.0
WALL = 0.5


def box(x, y, width, depth, height, z):
    return (
        f"[[obstacles]]\nshape = {{ box = {{ size = [{width!r}, {depth!r}, {height!r}] }} }}\n"
        f"position = [{x!r}, {y!r}, {z!r}]\n"
    )


def doors_of(columns, rows, more, drawn):
    """Pairs of rooms with a door between them: a random tree, and a share of the other pairs."""
    doors, seen, way = set(), {(0, 0)}, [(0, 0)]
    while way:
        column, row = way[-1]
        beside = [(column + 1, row), (column - 1, row), (column, row + 1), (column, row - 1)]
        fresh = [
            room for room in beside if 0 <= room[0] < columns and 0 <= room[1] < rows and room not in seen
        ]
        if not fresh:
            way.pop()
            continue
        room = drawn.choice(fresh)
        seen.add(room)
        way.append(room)
        doors.add(frozenset([(column, row), room]))
    return lambda a, b: frozenset([a, b]) in doors or drawn.random() < more


def house(columns, rows, seed, door, more, robot, in_space):
    """A house on one floor, in the plane or in 3D with rooms 4 high."""
    drawn = random.Random(seed)
    has_door = doors_of(columns, rows, more, drawn)
    height, z = (4.0, 2.0) if in_space else (1.0, 0.0)
    width, depth = columns * ROOM, rows * ROOM
    walls = []
    for column in range(columns):
        for row in range(rows):
            for along_y, other in [(True, (column + 1, row)), (False, (column, row + 1))]:
                if other[0] == columns or other[1] == rows:
                    continue
                across = (column + 1 if along_y else row + 1) * ROOM
                begin = (row if along_y else column) * ROOM
                pieces = [(begin - WALL / 2, begin + ROOM + WALL / 2)]
                if has_door((column, row), other):
                    at = drawn.uniform(begin + 1, begin + ROOM - 1 - door)
                    pieces = [(begin - WALL / 2, at), (at + door, begin + ROOM + WALL / 2)]
                for low, high in pieces:
                    middle, length = (low + high) / 2, high - low
                    if along_y:
                        walls.append(box(across, middle, WALL, length, height, z))
                    else:
                        walls.append(box(middle, across, length, WALL, height, z))
    motion, ends = ("rigid-2d", ", 0.0") if not in_space else ("rigid-3d", ", 2.0, 1.0, 0.0, 0.0, 0.0")
    top = ", 4.0" if in_space else ""
    bottom = ", 0.0" if in_space else ""
    return (
        f'[space]\nmotion = "{motion}"\nmin = [0.0, 0.0{bottom}]\nmax = [{width!r}, {depth!r}{top}]\n'
        f'bounds = "body"\n\n[robot]\nbodies = [{{ shape = {{ box = {{ size = {robot} }} }} }}]\n\n'
        + "".join(walls)
        + f"\n[query]\nstart = [5.0, 5.0{ends}]\ngoal = [{width - 5!r}, {depth - 5!r}{ends}]\n"
    )


def corridor(bends, length, width, gap, radius):
    """A disc in a corridor with so many stretches, between walls 0.05 thick that leave a gap at one end."""
    walls = [
        box(at * width, (length + (-gap if at % 2 else gap)) / 2, 0.05, length - gap, 2.0, 0.0)
        for at in range(1, bends)
    ]
    end = 1.0 if bends % 2 == 0 else length - 1
    return (
        f'[space]\nmotion = "translation-2d"\nmin = [0.0, 0.0]\nmax = [{bends * width!r}, {length!r}]\n'
        f'bounds = "reference"\n\n[robot]\nbodies = [{{ shape = {{ sphere = {{ radius = {radius} }} }} }}]\n\n'
        + "".join(walls)
        + f"\n[query]\nstart = [{width / 2!r}, 1.0]\ngoal = [{(bends - 0.5) * width!r}, {end!r}]\n"
    )


# What is carried, its depth, width and height along x, y and z: boxes with their places.
SOFA = [([1.8, 0.8, 0.4], [0.0, 0.0, 0.0]), ([1.8, 0.2, 0.4], [0.0, -0.3, 0.4])]
PIANO = [
    ([1.5, 0.5, 0.6], [0.0, 0.0, 0.2]),
    ([1.5, 0.3, 0.15], [0.0, 0.4, 0.0]),
    ([0.1, 0.1, 0.6], [-0.65, 0.5, -0.35]),
    ([0.1, 0.1, 0.6], [0.65, 0.5, -0.35]),
]
STOREY = 2.5
LINTEL = 2.1


def apartment(columns, rows, seed, door, robot):
    """Rooms 4 by 4 with a door between some, a cupboard, a table and a bed in each that is neither the first nor the last."""
    drawn = random.Random(seed)
    side, wall = 4.0, 0.15
    has_door = doors_of(columns, rows, 0.2, drawn)
    boxes = []
    for column in range(columns):
        for row in range(rows):
            for along_y, other in [(True, (column + 1, row)), (False, (column, row + 1))]:
                if other[0] == columns or other[1] == rows:
                    continue
                across = (column + 1 if along_y else row + 1) * side
                begin = (row if along_y else column) * side
                pieces = [(begin, begin + side, STOREY, STOREY / 2)]
                if has_door((column, row), other):
                    at = begin + drawn.uniform(0.5, side - 0.5 - door)
                    pieces = [
                        (begin, at, STOREY, STOREY / 2),
                        (at, at + door, STOREY - LINTEL, (STOREY + LINTEL) / 2),
                        (at + door, begin + side, STOREY, STOREY / 2),
                    ]
                for low, high, height, z in pieces:
                    middle, length = (low + high) / 2, high - low
                    if along_y:
                        boxes.append(box(across, middle, wall, length, height, z))
                    else:
                        boxes.append(box(middle, across, length, wall, height, z))
            if (column, row) not in [(0, 0), (columns - 1, rows - 1)]:
                x, y = column * side, row * side
                boxes.append(box(x + 0.4, y + 0.6, 0.6, 0.9, 2.0, 1.0))
                boxes.append(box(x + 2.2, y + 2.1, 0.8, 0.8, 0.75, 0.375))
                boxes.append(box(x + 3.2, y + 3.4, 1.3, 0.9, 0.5, 0.25))
    bodies = ",\n    ".join(f"{{ shape = {{ box = {{ size = {size} }} }}, position = {at} }}" for size, at in robot)
    width, depth = columns * side, rows * side
    # Outer walls, floor and ceiling are obstacles, so that the scene is the same for a program that bounds the origin only.
    for x in [0.0, width]:
        boxes.append(box(x, depth / 2, wall, depth, STOREY, STOREY / 2))
    for y in [0.0, depth]:
        boxes.append(box(width / 2, y, width, wall, STOREY, STOREY / 2))
    for z in [-0.05, STOREY + 0.05]:
        boxes.append(box(width / 2, depth / 2, width, depth, 0.1, z))
    turned = "0.7, 1.0, 0.0, 0.0, 0.0"
    return (
        f'[space]\nmotion = "rigid-3d"\nmin = [0.0, 0.0, 0.0]\nmax = [{width!r}, {depth!r}, {STOREY}]\n'
        f'bounds = "body"\n\n[robot]\nbodies = [\n    {bodies},\n]\n\n'
        + "".join(boxes)
        + f"\n[query]\nstart = [2.0, 2.0, {turned}]\ngoal = [{width - 2!r}, {depth - 2!r}, {turned}]\n"
    )


SCENES = {
    "house-36": house(6, 6, 1, 2.5, 0.0, [1.5, 0.6, 0.5], False),
    "house-144": house(12, 12, 2, 3.0, 0.1, [1.0, 0.6, 0.5], False),
    "house-36-3d": house(6, 6, 3, 2.5, 0.05, [1.5, 0.6, 0.4], True),
    "corridor-20": corridor(20, 20.0, 1.0, 1.5, 0.2),
    "corridor-40": corridor(40, 20.0, 0.6, 0.8, 0.1),
    "apartment-sofa": apartment(3, 2, 4, 0.95, SOFA),
    "apartment-piano": apartment(4, 3, 5, 1.05, PIANO),
}

if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    folder = pathlib.Path(sys.argv[1])
    folder.mkdir(parents=True, exist_ok=True)
    for name, text in SCENES.items():
        (folder / f"{name}.toml").write_text(text)
