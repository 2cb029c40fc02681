#!/usr/bin/env python3
"""Robots of links beside FCL and OMPL: whether reasons name the right pairs, and how soon real arms are solved.

    python3 bench/robots.py reasons ROADMILL PEER [--robots FOLDER] [--count N] [--seed S] PROBLEM …
    python3 bench/robots.py solve ROADMILL PEER [--robots FOLDER] [--seeds N] [--seconds S] [--settings FILE] PROBLEM …

ROADMILL is the program, PEER is `bench/peers/robots.cpp`, built as its first lines say. FOLDER takes the place of `ROBOTS` in
problem files, such as those of `bench/robots`: the folder `robots` of PyPI's example-robot-data. Needs numpy.

`reasons` draws configurations uniformly from the space of each problem until FCL has found N (default 20) in which bodies
touch that must not. Of each it asks `roadmill check --at … --json` which pairs of bodies are in the way and compares them
with FCL's. A body inside of a closed mesh touches nothing by FCL, which knows surfaces alone: such pairs are found here, by
the corners of the one that lie inside the other. Last, every body is moved out of every obstacle by the depth and direction
that the reason names, and FCL is asked whether that pair still meets, unless the base stands still. The table: drawn
configurations, invalid ones, pairs that both sides name, pairs that only one side names, and pairs that are free after the way
out.

`solve` lets both sides plan the problem's query with N seeds (default 10), at most S seconds each (default 60): roadmill in one
thread with the settings of the problem and, with `--settings`, once more with the text of FILE after it, and OMPL's RRT-Connect
with FCL on the same meshes at the same resolution. A path of OMPL's counts if its motions are also free at steps 20 times finer,
as roadmill's are proved free at all times. `planning` are the CPU seconds of roadmill's build, with what it prepares, and of
OMPL's planner alone; `all` those of the whole processes, with reading the files.

Where links stand and which pairs of links count is computed anew, from the tables that `roadmill import` writes.
"""

import json
import resource
import subprocess
import sys
import tempfile
import tomllib
from pathlib import Path

import numpy as np

# The pose that moves nothing: x y z qw qx qy qz.
IDENTITY = [0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0]


def turned(quaternion):
    """The matrix of a quaternion w x y z."""
    w, x, y, z = np.array(quaternion, float) / np.linalg.norm(quaternion)
    return np.array([
        [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
        [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
        [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
    ])


def frame(table):
    """A pose x y z qw qx qy qz of a table with `position` and `orientation`."""
    return list(table.get("position", IDENTITY[:3])) + list(table.get("orientation", IDENTITY[3:]))


class Mesh:
    """Triangles of an OBJ file as roadmill writes it."""

    def __init__(self, path):
        self.points, self.faces = [], []
        for line in path.read_text().splitlines():
            words = line.split()
            if words[:1] == ["v"]:
                self.points.append([float(word) for word in words[1:4]])
            if words[:1] == ["f"]:
                self.faces.append([int(word.split("/")[0]) - 1 for word in words[1:4]])
        self.points, self.faces = np.array(self.points), np.array(self.faces)

    def holds(self, point):
        """Whether a point is inside, by how often a ray of an odd direction leaves the surface."""
        ray = np.array([0.542, 0.613, 0.575])
        a, b, c = (self.points[self.faces[:, i]] for i in range(3))
        u, v = b - a, c - a
        across = np.cross(ray, v)
        scale = np.einsum("ij,ij->i", u, across)
        with np.errstate(divide="ignore", invalid="ignore"):
            s = np.einsum("ij,ij->i", point - a, across) / scale
            up = np.cross(point - a, u)
            t = np.einsum("ij,j->i", up, ray) / scale
            ahead = np.einsum("ij,ij->i", v, up) / scale
        return int(np.sum((s >= 0) & (t >= 0) & (s + t <= 1) & (ahead > 0))) % 2 == 1


class Body:
    """A shape at a pose."""

    def __init__(self, table, folder):
        (self.kind, shape), = table["shape"].items()
        self.pose, self.mesh, self.solid = frame(table), None, table.get("solid", True)
        if self.kind == "mesh":
            self.mesh = Mesh(folder / shape["file"])
            size = np.abs(self.mesh.points).max(axis=0)
            self.corners = self.mesh.points
        else:
            half = {"box": lambda: np.array(shape["size"]) / 2,
                    "sphere": lambda: np.full(3, shape["radius"]),
                    "cylinder": lambda: np.array([shape["radius"], shape["radius"], shape["height"] / 2]),
                    "capsule": lambda: np.array([shape["radius"], shape["radius"], shape["height"] / 2 + shape["radius"]]),
                    }[self.kind]
            size = half()
            self.corners = np.zeros((1, 3))
        self.numbers = {"box": lambda: shape["size"], "sphere": lambda: [shape["radius"]],
                        "cylinder": lambda: [shape["radius"], shape["height"]],
                        "capsule": lambda: [shape["radius"], shape["height"]], "mesh": lambda: []}[self.kind]()
        self.reach = float(np.linalg.norm(self.pose[:3]) + np.linalg.norm(size))

    def text(self):
        """The body for the peer."""
        words = [self.kind] + [repr(float(value)) for value in self.numbers]
        if self.mesh is not None:
            words += [str(len(self.mesh.points)), str(len(self.mesh.faces))]
            words += [repr(float(value)) for value in self.mesh.points.ravel()]
            words += [str(index) for index in self.mesh.faces.ravel()]
        return " ".join(words + [repr(float(value)) for value in self.pose])


class Link:
    """A link and its joint."""

    def __init__(self, table, folder):
        self.name = table["name"]
        self.bodies = [Body(body, folder) for body in table.get("bodies", [])]
        joint = table.get("joint")
        self.joint, self.parent, self.value, self.multiplier, self.offset = joint, -1, -1, 1.0, 0.0
        self.kind, self.axis = "base", [0.0, 0.0, 1.0]
        if joint is not None:
            (self.kind, settings), = joint["kind"].items()
            self.axis = list(np.array(settings.get("axis", self.axis), float))
            self.settings = settings


class Scene:
    """A problem of bodies, read from the tables that roadmill writes."""

    def __init__(self, program, problem, folder):
        flat = folder / "flat.toml"
        subprocess.run([program, "import", str(problem), "--out", str(flat)], check=True, capture_output=True)
        tables = tomllib.loads(flat.read_text())
        self.file, self.query = flat, tables.get("query")
        space, robot = tables["space"], tables["robot"]
        self.motion, self.resolution = space["motion"], space["resolution"]
        self.base = frame(robot.get("base", {}))
        self.links = [Link({"name": robot["name"], "bodies": robot.get("bodies", [])}, folder)]
        self.links += [Link(link, folder) for link in robot.get("links", [])]
        self.obstacles = [Body(body, folder) for body in tables.get("obstacles", [])]
        names = {link.name: index for index, link in enumerate(self.links)}
        self.may_touch = {frozenset(names[name] for name in pair) for pair in robot.get("may_touch", [])}
        self.draws = self.drawn_base(space)
        for link in self.links[1:]:
            link.parent = names[link.joint["parent"]]
            if link.kind in ("revolute", "prismatic", "spherical") and "mimic" not in link.joint:
                link.value = sum(size for size, _ in self.draws)
                self.draws.append(self.drawn(link))
        for link in self.links[1:]:
            mimic = link.joint.get("mimic")
            if mimic:
                link.value = self.links[names[mimic["link"]]].value
                link.multiplier, link.offset = mimic["multiplier"], mimic["offset"]
        self.pairs = self.self_pairs()

    def drawn_base(self, space):
        """How many values the base has and how they are drawn."""
        low, high = np.array(space["min"]), np.array(space["max"])
        place = (len(low), lambda draw: list(draw.uniform(low, high)))
        return {"fixed": [], "translation-2d": [place], "translation-3d": [place],
                "rigid-2d": [place, (1, lambda draw: [draw.uniform(-np.pi, np.pi)])],
                "rigid-3d": [place, (4, rotation)]}[self.motion]

    @staticmethod
    def drawn(link):
        """How many values a joint has and how they are drawn."""
        if link.kind == "spherical":
            return 4, rotation
        low, high = link.settings.get("radians", link.settings.get("range", [-np.pi, np.pi]))
        return 1, lambda draw: [draw.uniform(low, high)]

    def draw(self, draw):
        """A configuration, uniformly."""
        return [value for _, how in self.draws for value in how(draw)]

    def self_pairs(self):
        """Pairs of links that must not touch, by the rule of docs/problems.md."""
        part, held, above, empty = [], [], [], []
        for index, link in enumerate(self.links):
            moves = link.kind in ("revolute", "prismatic", "spherical")
            held.append(index if link.parent < 0 or moves else held[link.parent])
            if link.kind == "fixed":
                part.append(part[link.parent])
            else:
                part.append(len(above))
                above.append(None if link.parent < 0 else part[link.parent])
                empty.append(True)
            empty[part[-1]] &= not link.bodies

        def moved_by(child, mover):
            parent = above[child]
            return parent is not None and (parent == mover or (empty[parent] and above[parent] == mover))

        pairs = []
        for high in range(len(self.links)):
            for low in range(high):
                solid = self.links[low].bodies and self.links[high].bodies
                one, other = part[low], part[high]
                exempt = held[low] == held[high] or moved_by(one, other) or moved_by(other, one)
                if solid and not exempt and frozenset((low, high)) not in self.may_touch:
                    pairs.append((low, high))
        return pairs

    def lever(self, link):
        """A bound on the way of any point per unit of a link's joint."""
        if link.kind == "prismatic":
            return 1.0
        index = self.links.index(link)
        farthest, reaches = 0.0, {index: 0.0}
        for other, carried in enumerate(self.links):
            if other != index:
                if carried.parent not in reaches:
                    continue
                before, after = frame(carried.joint["before"]), frame(carried.joint["after"])
                slide = max(map(abs, carried.settings.get("range", [0.0]))) if carried.kind == "prismatic" else 0.0
                way = np.linalg.norm(before[:3]) + np.linalg.norm(after[:3]) + slide
                reaches[other] = reaches[carried.parent] + way
            else:
                reaches[other] = np.linalg.norm(frame(carried.joint["after"])[:3])
            for body in carried.bodies:
                farthest = max(farthest, reaches[other] + body.reach)
        return float(farthest)

    def text(self):
        """The scene for the peer."""
        words = [f"{self.resolution!r} {self.motion}", numbers(self.base), str(len(self.links))]
        for link in self.links:
            words.append(f"{link.parent} {link.kind} {numbers(link.axis)} {link.value} {link.multiplier!r} {link.offset!r}")
            joint = link.joint or {}
            words += [numbers(frame(joint.get(key, {}))) for key in ("before", "after")]
            words.append(str(len(link.bodies)))
            words += [body.text() for body in link.bodies]
        words += [str(len(self.obstacles))] + [body.text() for body in self.obstacles]
        words += [str(len(self.pairs))] + [f"{low} {high}" for low, high in self.pairs]
        moving = [link for link in self.links if link.kind in ("revolute", "prismatic") and "mimic" not in link.joint]
        words.append(str(len(moving)))
        for link in moving:
            low, high = link.settings.get("radians", link.settings.get("range", [-np.pi, np.pi]))
            words.append(f"{low!r} {high!r} {self.lever(link)!r}")
        return "\n".join(words) + "\n"

    def poses(self, q):
        """The rotation matrices and origins of all links at a configuration."""
        found = []
        for link in self.links:
            if link.parent < 0:
                found.append(self.base_at(q))
                continue
            turn, shift = np.eye(3), np.zeros(3)
            axis = np.array(link.axis)
            if link.value >= 0 and link.kind != "spherical":
                value = link.multiplier * q[link.value] + link.offset
                if link.kind == "revolute":
                    half = value / 2
                    turn = turned([np.cos(half), *(np.sin(half) * axis)])
                else:
                    shift = value * axis
            if link.kind == "spherical":
                turn = turned(q[link.value:link.value + 4])
            pose = found[link.parent]
            before, after = frame(link.joint["before"]), frame(link.joint["after"])
            for step in ((turned(before[3:]), np.array(before[:3])), (turn, shift), (turned(after[3:]), np.array(after[:3]))):
                pose = (pose[0] @ step[0], pose[0] @ step[1] + pose[1])
            found.append(pose)
        return found

    def base_at(self, q):
        """The rotation matrix and the origin of the base."""
        if self.motion == "fixed":
            return turned(self.base[3:]), np.array(self.base[:3])
        flat = self.motion.endswith("2d")
        place = np.array([q[0], q[1], 0.0 if flat else q[2]])
        if self.motion == "rigid-2d":
            return turned([np.cos(q[2] / 2), 0, 0, np.sin(q[2] / 2)]), place
        return (turned(q[3:7]) if self.motion == "rigid-3d" else np.eye(3)), place

    def enclosed(self, q):
        """Pairs of bodies of which a closed mesh holds a corner of the other."""
        stands = self.poses(q)
        still = (np.eye(3), np.zeros(3))
        named = [(f"{i}.{k}", body, stands[i]) for i, link in enumerate(self.links) for k, body in enumerate(link.bodies)]
        fixed = [(str(index), body, still) for index, body in enumerate(self.obstacles)]
        own = {(low, high) for low, high in self.pairs}
        found = set()
        for name, body, pose in named:
            link = int(name.split(".")[0])
            others = fixed + [other for other in named if (link, int(other[0].split(".")[0])) in own]
            for other_name, other, other_pose in others:
                if holds(body, pose, other, other_pose) or holds(other, other_pose, body, pose):
                    found.add(f"{name}:{other_name}")
        return found


def holds(outer, pose, inner, inner_pose):
    """Whether a closed mesh holds the first corner of another body."""
    if outer.mesh is None or not outer.solid:
        return False
    local = turned(inner.pose[3:]) @ inner.corners[0] + inner.pose[:3]
    world = inner_pose[0] @ local + inner_pose[1]
    seen = pose[0].T @ (world - pose[1])
    return outer.mesh.holds(turned(outer.pose[3:]).T @ (seen - outer.pose[:3]))


def rotation(draw):
    """A rotation, uniformly, as a unit quaternion."""
    quaternion = draw.normal(size=4)
    return list(quaternion / np.linalg.norm(quaternion))


def numbers(values):
    """Numbers in a line."""
    return " ".join(repr(float(value)) for value in values)


def touching(peer, scene, folder, configurations):
    """The pairs that FCL finds at each configuration."""
    (folder / "scene").write_text(scene.text())
    (folder / "configurations").write_text("".join(numbers(q) + "\n" for q in configurations))
    done = subprocess.run([peer, "touching", str(folder / "scene"), str(folder / "configurations")],
                          check=True, capture_output=True, text=True)
    return [set(line.split()) for line in done.stdout.splitlines()]


def told(program, scene, q):
    """What roadmill says of a configuration: its pairs, each with depth and direction."""
    at = " ".join(repr(float(value)) for value in q)
    done = subprocess.run([program, "check", str(scene.file), "--json", f"--at={at}"], capture_output=True, text=True, check=False)
    names = {link.name: index for index, link in enumerate(scene.links)}
    found = {}
    for reason in json.loads(done.stdout)["reasons"]:
        if reason["reason"] != "collision":
            continue
        ends = []
        for end in (reason["body"], reason["other"]):
            if "obstacle" in end:
                ends.append(str(end["obstacle"]))
            else:
                ends.append(f"{names.get(end['link'], 0)}.{end['body']}")
        if "." in ends[1] and int(ends[0].split(".")[0]) > int(ends[1].split(".")[0]):
            ends.reverse()
        found[":".join(ends)] = (reason["depth"], np.array(reason["direction"]))
    return found


def reasons(program, peer, problem, count, seed):
    """The row of a problem."""
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        scene = Scene(program, problem, folder)
        draw, invalid, drawn = np.random.default_rng(seed), [], 0
        while len(invalid) < count and drawn < 100_000:
            batch = [scene.draw(draw) for _ in range(count)]
            drawn += count
            found = touching(peer, scene, folder, batch)
            invalid += [(q, pairs) for q, pairs in zip(batch, found) if pairs]
        invalid = invalid[:count]
        theirs = ours = both = 0
        ways = []
        for q, pairs in invalid:
            said = told(program, scene, q)
            enclosed = scene.enclosed(q)
            pairs = pairs | enclosed
            theirs, ours, both = theirs + len(pairs - set(said)), ours + len(set(said) - pairs), both + len(pairs & set(said))
            if pairs != set(said):
                print(f"{problem}: at {numbers(q)}: FCL {sorted(pairs)}, roadmill {sorted(said)}", file=sys.stderr)
            for pair, (depth, direction) in said.items():
                if "." in pair.split(":")[1] or scene.motion == "fixed":
                    continue
                moved = list(q)
                axes = 2 if scene.motion.endswith("2d") else 3
                for axis in range(axes):
                    moved[axis] += depth * (1 + 1e-6) * direction[axis]
                ways.append((pair, moved))
        after = touching(peer, scene, folder, [moved for _, moved in ways])
        freed = sum(pair not in pairs for (pair, _), pairs in zip(ways, after))
        links = len(scene.links)
        free = f"{freed} of {len(ways)}" if ways else "–"
        print(f"| `{Path(problem).stem}` | {scene.motion} | {links} | {drawn} | {len(invalid)} | {both} | {theirs} | {ours} | {free} |",
              flush=True)


def spent(command):
    """What a command writes, its exit code, and the CPU seconds that it took."""
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return done, after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime


def middle(values):
    """Median, least and largest."""
    return f"{np.median(values):.2f} ({min(values):.2f}–{max(values):.2f})"


def built(program, problem, seed, seconds, folder):
    """Whether roadmill solves a problem, the CPU seconds of its build, and those of the process."""
    run = folder / "run"
    command = [program, "build", str(problem), "--seed", str(seed), "--threads", "1", "--max-time", f"{seconds}s",
               "--out", str(run), "--force"]
    done, took = spent(command)
    return done.returncode == 0, json.loads((run / "summary.json").read_text())["cpu_seconds"], took


def planned(peer, folder, seed, seconds):
    """The same of OMPL's planner."""
    files = [str(folder / name) for name in ("scene", "query", "path")]
    done, took = spent([peer, "solve", files[0], files[1], str(seed), str(seconds), files[2]])
    planning, _, passes = done.stdout.split()
    return passes == "1", float(planning), took


def solve(program, peer, problem, options):
    """The rows of a problem."""
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        scene = Scene(program, problem, folder)
        (folder / "scene").write_text(scene.text())
        ends = "".join(numbers(scene.query[key]) + "\n" for key in ("start", "goal"))
        (folder / "query").write_text(ends)
        seconds, settings = options["--seconds"], options["--settings"]
        ways = {"roadmill": lambda seed: built(program, problem, seed, seconds, folder)}
        if settings:
            other = folder / Path(problem).name
            other.write_text(Path(problem).read_text() + Path(settings).read_text())
            ways[f"roadmill, `{Path(settings).stem}`"] = lambda seed: built(program, other, seed, seconds, folder)
        ways["OMPL RRT-Connect, FCL"] = lambda seed: planned(peer, folder, seed, seconds)
        found = {who: [] for who in ways}
        for seed in range(1, options["--seeds"] + 1):
            for who, way in ways.items():
                found[who].append(way(seed))
        for who, builds in found.items():
            solved, planning, whole = zip(*builds)
            count = f"{sum(solved)} of {len(solved)}"
            print(f"| `{Path(problem).stem}` | {who} | {count} | {middle(planning)} | {middle(whole)} |", flush=True)


def placed(problem, robots, folder):
    """A problem file with the robots' folder in it."""
    text = Path(problem).read_text(errors="replace")
    if "ROBOTS" not in text:
        return problem
    copy = folder / Path(problem).name
    copy.write_text(text.replace("ROBOTS", str(Path(robots).resolve())))
    return copy


def main():
    """Reads the command line."""
    words = sys.argv[1:]
    if len(words) < 4 or words[0] not in ("reasons", "solve"):
        sys.exit(__doc__)
    options = {"--count": 20, "--seed": 1, "--seeds": 10, "--seconds": 60, "--settings": None}
    given, robots, rest = [], "robots", iter(words[3:])
    for word in rest:
        if word in options:
            options[word] = next(rest) if word == "--settings" else int(next(rest))
        elif word == "--robots":
            robots = next(rest)
        else:
            given.append(word)
    with tempfile.TemporaryDirectory() as name:
        compare(words, [placed(problem, robots, Path(name)) for problem in given], options)


def compare(words, problems, options):
    """Writes the table."""
    if words[0] == "reasons":
        print("| problem | base | links | drawn | invalid | pairs of both | FCL's alone | roadmill's alone | free after the way out |")
        print("|---------|------|------:|------:|--------:|--------------:|------------:|-----------------:|-----------------------:|")
        for problem in problems:
            reasons(words[1], words[2], problem, options["--count"], options["--seed"])
    else:
        print("| problem | program | solved | planning, CPU s: median (least–most) | all, CPU s |")
        print("|---------|---------|-------:|-------------------------------------:|-----------:|")
        for problem in problems:
            solve(words[1], words[2], problem, options)


if __name__ == "__main__":
    main()
