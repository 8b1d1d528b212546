#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""Makes the models of examples/: closed smooth surfaces of implicit functions, and parts with edges.

    scripts/make_examples.py [FOLDER]

Needs numpy (Debian: python3-numpy). Deterministic. Each model is the zero set of a function that
is negative inside, meshed as a surface net on a grid (one vertex a cell that the surface crosses,
one quad a grid edge), then relaxed along the surface and put back onto it by Newton's method.
Every such mesh is checked before it is written: closed, two-manifold, outward, of the genus it
names. The parts are an arch, swept along an axis from a grid between two curves, and the same
without its front, which is open.
"""

import struct
import sys
from pathlib import Path

import numpy as np

ROUNDS = 30  # Of relaxation; the triangles hardly change after twenty.


# --- implicit functions ---------------------------------------------------------------------------


def smooth_union(a, b, width):
    """Polynomial smooth minimum: differs from min(a, b) where they are closer than width."""
    h = np.clip(0.5 + 0.5 * (b - a) / width, 0.0, 1.0)
    return b + (a - b) * h - width * h * (1.0 - h)


def smooth_difference(a, b, width):
    return -smooth_union(-a, b, width)


def box(p, centre, half, radius):
    q = np.abs(p - centre) - (np.asarray(half) - radius)
    outside = np.linalg.norm(np.maximum(q, 0.0), axis=-1)
    return outside + np.minimum(q.max(axis=-1), 0.0) - radius


def cylinder(p, centre, axis, radius):
    axis = np.asarray(axis, float)
    d = p - centre
    d = d - (d @ axis)[..., None] * axis
    return np.linalg.norm(d, axis=-1) - radius


def ball(p, centre, radius):
    return np.linalg.norm(p - np.asarray(centre), axis=-1) - radius


def capsule(p, a, b, radius_a, radius_b):
    a, b = np.asarray(a, float), np.asarray(b, float)
    t = np.clip(((p - a) @ (b - a)) / ((b - a) @ (b - a)), 0.0, 1.0)
    return np.linalg.norm(p - a - t[..., None] * (b - a), axis=-1) - (
        radius_a + t * (radius_b - radius_a)
    )


def bracket(p):
    """An angle bracket in millimetres: a foot with two holes, an upright with one."""
    foot = box(p, (0, 0, 8), (40, 26, 8), 7)
    upright = box(p, (-30, 0, 32), (9, 26, 32), 8)
    rib = capsule(p, (-26, 0, 34), (6, 0, 10), 7, 6)
    body = smooth_union(smooth_union(foot, upright, 16), rib, 14)
    for hole in (
        cylinder(p, (20, -11, 0), (0, 0, 1), 5.5),
        cylinder(p, (20, 11, 0), (0, 0, 1), 5.5),
        cylinder(p, (0, 0, 47), (1, 0, 0), 8),
    ):
        body = smooth_difference(body, hole, 9)
    return body


def knot(p):
    """A tube about a trefoil knot."""
    t = np.linspace(0, 2 * np.pi, 150, endpoint=False)
    curve = np.stack(
        [
            np.sin(t) + 2 * np.sin(2 * t),
            np.cos(t) - 2 * np.cos(2 * t),
            -1.3 * np.sin(3 * t),
        ],
        axis=-1,
    )
    a, b = curve, np.roll(curve, -1, axis=0)
    best = np.full(p.shape[:-1], np.inf)
    for s, e in zip(a, b):
        best = np.minimum(best, capsule(p, s, e, 0.0, 0.0))
    return best - 0.46


def torso(p):
    """A blobby torso with a head, two arms and two legs cut short."""
    d = ball(p, (0, 0, 0), 1.0)
    d = smooth_union(d, ball(p, (0, 0.1, 1.15), 0.9), 0.6)
    d = smooth_union(d, ball(p, (0, 0.15, 2.65), 0.62), 0.9)
    for side in (-1, 1):
        d = smooth_union(d, capsule(p, (0.8 * side, 0, 1.6), (2.0 * side, 0.4, 1.1), 0.46, 0.42), 0.75)
        d = smooth_union(d, capsule(p, (0.55 * side, 0, -0.6), (1.15 * side, 0.1, -1.8), 0.5, 0.5), 0.75)
    return d


def sphere(p):
    return ball(p, (0, 0, 0), 1.0)


# --- surface net ----------------------------------------------------------------------------------


def gradient(f, p, step):
    offset = step * np.eye(3)
    return np.stack([(f(p + e) - f(p - e)) / (2 * step) for e in offset], axis=-1)


def surface_net(f, low, high, cell):
    low, high = np.asarray(low, float), np.asarray(high, float)
    count = np.ceil((high - low) / cell).astype(int) + 1
    axes = [low[k] + cell * np.arange(count[k]) for k in range(3)]
    grid = np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1)
    value = f(grid)
    inside = value < 0.0

    # A vertex in each cell with corners on both sides: the mean of its edges' crossings.
    cells = count - 1
    total = np.zeros((*cells, 3))
    crossings = np.zeros(cells, int)
    for axis in range(3):
        first = [slice(None)] * 3
        second = [slice(None)] * 3
        first[axis], second[axis] = slice(0, -1), slice(1, None)
        v0, v1 = value[tuple(first)], value[tuple(second)]
        p0, p1 = grid[tuple(first)], grid[tuple(second)]
        cut = (v0 < 0.0) != (v1 < 0.0)
        t = np.where(cut, v0 / np.where(cut, v0 - v1, 1.0), 0.0)[..., None]
        point = np.where(cut[..., None], p0 + t * (p1 - p0), 0.0)
        others = [k for k in range(3) if k != axis]
        for i in (0, 1):
            for j in (0, 1):
                part = [slice(None)] * 3
                part[others[0]] = slice(i, i + cells[others[0]])
                part[others[1]] = slice(j, j + cells[others[1]])
                total += point[tuple(part)]
                crossings += cut[tuple(part)]
    used = crossings > 0
    number = np.full(cells, -1)
    number[used] = np.arange(used.sum())
    vertices = total[used] / crossings[used][:, None]

    # A quad about each grid edge whose ends lie on different sides, turned outward.
    quads = []
    for axis in range(3):
        b, c = (axis + 1) % 3, (axis + 2) % 3
        ends = np.argwhere(np.diff(inside.astype(int), axis=axis) != 0)
        for e in ends:
            if not (0 < e[b] < count[b] - 1 and 0 < e[c] < count[c] - 1):
                sys.exit("the surface leaves the grid")
            ring = []
            for db, dc in ((-1, -1), (0, -1), (0, 0), (-1, 0)):
                corner = e.copy()
                corner[b] += db
                corner[c] += dc
                ring.append(number[tuple(corner)])
            quads.append(ring if inside[tuple(e)] else ring[::-1])
    return vertices, np.array(quads)


def mesh_of(f, low, high, cell):
    vertices, quads = surface_net(f, low, high, cell)
    step = 1e-4 * cell

    def project(p):
        for _ in range(4):
            g = gradient(f, p, step)
            move = (f(p) / np.maximum((g * g).sum(-1), 1e-12))[:, None] * g
            length = np.linalg.norm(move, axis=-1, keepdims=True)
            p = p - move * np.minimum(1.0, 0.5 * cell / np.maximum(length, 1e-300))
        return p

    ends = np.unique(np.sort(np.concatenate([quads[:, [k, (k + 1) % 4]] for k in range(4)]), axis=1), axis=0)
    degree = np.bincount(ends.ravel(), minlength=len(vertices))[:, None]
    for _ in range(ROUNDS):
        mean = np.zeros_like(vertices)
        np.add.at(mean, ends[:, 0], vertices[ends[:, 1]])
        np.add.at(mean, ends[:, 1], vertices[ends[:, 0]])
        vertices = project(vertices + 0.5 * (mean / degree - vertices))

    # Each quad is cut along its shorter diagonal.
    a, b, c, d = (vertices[quads[:, k]] for k in range(4))
    along = np.linalg.norm(a - c, axis=1) <= np.linalg.norm(b - d, axis=1)
    q = np.where(along[:, None], quads, np.roll(quads, -1, axis=1))
    return vertices, np.concatenate([q[:, [0, 1, 2]], q[:, [0, 2, 3]]])


# --- parts with edges -----------------------------------------------------------------------------


def arch(front=True, around=48, across=6, along=10):
    """A block of 60 x 30 x 40 with a vault of radius 15 and two rounded shoulders."""
    t = np.linspace(np.pi, 0.0, around + 1)
    inner = np.stack([15 * np.cos(t), 15 * np.sin(t)], axis=-1)
    shoulder = np.linspace(0.0, 0.5 * np.pi, around // 6 + 1)[1:]
    left = np.stack([np.full(around // 6, -30.0), np.linspace(0, 28, around // 6, endpoint=False)], -1)
    round_left = np.stack([-18 - 12 * np.cos(shoulder), 28 + 12 * np.sin(shoulder)], axis=-1)
    start = np.array([[-30.0, 28.0]])
    half = np.concatenate([left, start, round_left])
    count = around // 2 + 1 - len(half)
    top = np.stack([np.linspace(-18, 0, count + 1)[1:], np.full(count, 40.0)], axis=-1)
    half = np.concatenate([half, top])
    outer = np.concatenate([half, half[-2::-1] * (-1, 1)])
    number, vertices, triangles = {}, [], []

    def at(i, r, y):
        if (i, r, y) not in number:
            number[i, r, y] = len(vertices)
            p = inner[i] + r / across * (outer[i] - inner[i])
            vertices.append((p[0], 30.0 * y / along, p[1]))
        return number[i, r, y]

    def quad(a, b, c, d):
        triangles.extend([(a, b, c), (a, c, d)])

    for i in range(around):
        for r in range(across):
            if front:
                quad(at(i, r, 0), at(i + 1, r, 0), at(i + 1, r + 1, 0), at(i, r + 1, 0))
            quad(at(i, r, along), at(i, r + 1, along), at(i + 1, r + 1, along), at(i + 1, r, along))
        for y in range(along):
            quad(at(i, 0, y), at(i, 0, y + 1), at(i + 1, 0, y + 1), at(i + 1, 0, y))
            quad(at(i, across, y), at(i + 1, across, y), at(i + 1, across, y + 1), at(i, across, y + 1))
    for i in (0, around):
        for r in range(across):
            for y in range(along):
                foot = [at(i, r, y), at(i, r + 1, y), at(i, r + 1, y + 1), at(i, r, y + 1)]
                quad(*(foot if i == 0 else foot[::-1]))
    vertices, triangles = np.array(vertices), np.array(triangles)
    a, b, c = (vertices[triangles[:, k]] for k in range(3))
    if np.einsum("ij,ij->", a, np.cross(b, c)) < 0.0:
        triangles = triangles[:, ::-1]
    return vertices, triangles


# --- checks ---------------------------------------------------------------------------------------


def check(name, vertices, triangles, genus):
    """Stops the script unless the mesh is closed, manifold, connected, outward, of that genus."""
    halfedges = np.concatenate([triangles[:, [k, (k + 1) % 3]] for k in range(3)])
    directed = {}
    for a, b in halfedges:
        if (a, b) in directed:
            sys.exit(f"{name}: the edge {a} {b} is used twice in one direction")
        directed[a, b] = True
    if any((b, a) not in directed for a, b in directed):
        sys.exit(f"{name}: not closed")
    following = [dict() for _ in range(len(vertices))]
    for t in triangles:
        for k in range(3):
            following[t[k]][t[(k + 1) % 3]] = t[(k + 2) % 3]
    for v, ring in enumerate(following):
        start = next(iter(ring))
        length, at = 1, ring[start]
        while at != start:
            length, at = length + 1, ring[at]
        if length != len(ring):
            sys.exit(f"{name}: the faces at vertex {v} are no single fan")
    seen, stack = {0}, [0]
    while stack:
        for w in following[stack.pop()]:
            if w not in seen:
                seen.add(w)
                stack.append(w)
    if len(seen) != len(vertices):
        sys.exit(f"{name}: not connected")
    euler = len(vertices) - len(directed) // 2 + len(triangles)
    if euler != 2 - 2 * genus:
        sys.exit(f"{name}: Euler number {euler} where genus {genus} was meant")
    a, b, c = (vertices[triangles[:, k]] for k in range(3))
    volume = np.einsum("ij,ij->", a, np.cross(b, c)) / 6.0
    if volume <= 0.0:
        sys.exit(f"{name}: inside out")
    normal = np.cross(b - a, c - a)
    # The models are meant to be smooth: no edge turns by more than the command would call sharp.
    unit = normal / np.linalg.norm(normal, axis=1)[:, None]
    face_of = {tuple(e): i % len(triangles) for i, e in enumerate(halfedges)}
    turn = min(unit[f] @ unit[face_of[b, a]] for (a, b), f in face_of.items())
    if turn < np.cos(np.radians(40)):
        sys.exit(f"{name}: an edge turns by {np.degrees(np.arccos(turn)):.0f} degrees")
    sides = ((b - a) ** 2).sum(1) + ((c - b) ** 2).sum(1) + ((a - c) ** 2).sum(1)
    quality = 2 * np.sqrt(3) * np.linalg.norm(normal, axis=1) / sides
    print(
        f"{name}: {len(vertices)} vertices, {len(triangles)} triangles, genus {genus}, "
        f"volume {volume:.6g}, worst triangle {quality.min():.2f}"
    )


# --- files ----------------------------------------------------------------------------------------


def write_ply(path, vertices, triangles):
    header = (
        "ply\nformat binary_little_endian 1.0\ncomment made by scripts/make_examples.py\n"
        f"element vertex {len(vertices)}\nproperty float x\nproperty float y\nproperty float z\n"
        f"element face {len(triangles)}\nproperty list uchar int vertex_indices\nend_header\n"
    )
    with open(path, "wb") as file:
        file.write(header.encode())
        file.write(vertices.astype("<f4").tobytes())
        for t in triangles:
            file.write(struct.pack("<Biii", 3, *t))


def write_off(path, vertices, triangles):
    with open(path, "w") as file:
        file.write(f"OFF\n# made by scripts/make_examples.py\n{len(vertices)} {len(triangles)} 0\n")
        file.writelines("%.5f %.5f %.5f\n" % tuple(v) for v in vertices)
        file.writelines("3 %d %d %d\n" % tuple(t) for t in triangles)


def write_obj(path, vertices, triangles):
    with open(path, "w") as file:
        file.write("# made by scripts/make_examples.py\n")
        file.writelines("v %.6f %.6f %.6f\n" % tuple(v) for v in vertices)
        file.writelines("f %d %d %d\n" % tuple(t + 1) for t in triangles)


MODELS = [
    # file, function, box, cell, genus, writer
    ("bracket.ply", bracket, ((-46, -32, -6), (46, 32, 70)), 2.3, 3, write_ply),
    ("knot.ply", knot, ((-3.8, -3.8, -2.1), (3.8, 3.8, 2.1)), 0.17, 1, write_ply),
    ("torso.off", torso, ((-2.7, -1.3, -2.7), (2.7, 1.3, 3.6)), 0.14, 0, write_off),
    ("sphere.obj", sphere, ((-1.3, -1.3, -1.3), (1.3, 1.3, 1.3)), 0.24, 0, write_obj),
]


def main():
    root = Path(__file__).resolve().parent.parent
    folder = Path(sys.argv[1]) if len(sys.argv) > 1 else root / "examples"
    folder.mkdir(parents=True, exist_ok=True)
    for name, f, (low, high), cell, genus, write in MODELS:
        vertices, triangles = mesh_of(f, low, high, cell)
        check(name, vertices, triangles, genus)
        write(folder / name, vertices, triangles)
    write_obj(folder / "arch.obj", *arch())
    write_obj(folder / "hood.obj", *arch(front=False))


if __name__ == "__main__":
    main()
