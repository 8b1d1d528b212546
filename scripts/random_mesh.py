# SPDX-License-Identifier: MIT
"""Closed triangle meshes from a seed, made to be hard: part of the campaigns of this folder.

make(seed) gives a connected, closed, oriented, two-manifold mesh: the level set of a random function
(marching tetrahedra: embedded whatever the function is) or the boundary of random cubes; of genus
0 to 8; relaxed, stretched, displaced by noise, thinned out by random edge collapses, with needles
(edges of 1:1000) and caps; turned, scaled by 1e-6 to 1e6 and moved. Displacement and collapses may
make faces cross: `crossing(vertices, triangles)` is asked, and steps that lead to crossings are
taken back or made weaker; what remains is stated by the command as a warning.
"""

from dataclasses import dataclass, field
from itertools import permutations
from math import sqrt

import numpy as np

MAX_GENUS = 8
SHORT = 1e-3  # Shortest part of an edge at a needle, and height of a cap, over the edge.


@dataclass
class Mesh:
    vertices: np.ndarray
    triangles: np.ndarray
    recipe: list = field(default_factory=list)

    @property
    def genus(self):
        return 1 - (len(self.vertices) - len(self.triangles) // 2) // 2


# --- surfaces -------------------------------------------------------------------------------------


def smooth_min(a, b, width):
    h = np.clip(0.5 + 0.5 * (b - a) / width, 0.0, 1.0)
    return b + (a - b) * h - width * h * (1.0 - h)


def torus(p, centre, normal, large, small):
    d = p - centre
    height = d @ normal
    flat = np.sqrt(np.maximum((d * d).sum(-1) - height**2, 0.0))
    return np.hypot(flat - large, height) - small


def direction(rng):
    d = rng.normal(size=3)
    return d / np.linalg.norm(d)


def tori(rng, genus):
    """A chain of tori, each turned at random about the way to the next."""
    parts, at = [], np.zeros(3)
    way = direction(rng)
    for _ in range(max(genus, 1)):
        normal = np.cross(way, direction(rng))
        normal /= np.linalg.norm(normal)
        large = rng.uniform(0.7, 1.3)
        at = at + way * large
        parts.append((at.copy(), normal, large, rng.uniform(0.25, 0.4) * large))
        at = at + way * large
        way = way + 0.4 * rng.normal(size=3)
        way /= np.linalg.norm(way)

    def f(p):
        value = None
        for part in parts:
            d = torus(p, *part)
            value = d if value is None else smooth_min(value, d, 0.15)
        return value

    centres = np.array([c for c, *_ in parts])
    reach = np.array([r + s for _, _, r, s in parts])[:, None] + 0.3
    return f, (centres - reach).min(0), (centres + reach).max(0)


def plate(rng, genus):
    """A rounded plate with holes."""
    columns = int(np.ceil(np.sqrt(max(genus, 1))))
    rows = -(-max(genus, 1) // columns)
    half = np.array([columns, rows, rng.uniform(0.15, 0.6)]) * [0.6, 0.6, 1.0]
    radius = min(0.12, 0.9 * half[2])
    holes = [
        (
            (i % columns - (columns - 1) / 2) * 1.15 + rng.uniform(-0.08, 0.08),
            (i // columns - (rows - 1) / 2) * 1.15 + rng.uniform(-0.08, 0.08),
            rng.uniform(0.15, 0.38),
        )
        for i in range(genus)
    ]

    def f(p):
        q = np.abs(p) - (half - radius)
        value = np.linalg.norm(np.maximum(q, 0.0), axis=-1) + np.minimum(q.max(-1), 0.0) - radius
        for x, y, r in holes:
            value = -smooth_min(-value, np.hypot(p[..., 0] - x, p[..., 1] - y) - r, 0.05)
        return value

    return f, -half - 0.2, half + 0.2


def blobs(rng, genus):
    """Random balls in a chain, with handles on some of them."""
    at, parts = np.zeros(3), []
    for _ in range(rng.integers(1, 7)):
        parts.append((at.copy(), rng.uniform(0.4, 1.0)))
        at = at + direction(rng) * rng.uniform(0.4, 1.2)
    handles = []
    for _ in range(genus):
        centre, radius = parts[rng.integers(len(parts))]
        out = direction(rng)
        normal = np.cross(out, direction(rng))
        normal /= np.linalg.norm(normal)
        large = rng.uniform(0.25, 0.5)
        handles.append((centre + out * radius, normal, large, rng.uniform(0.2, 0.4) * large))

    def f(p):
        value = None
        for c, r in parts:
            d = np.linalg.norm(p - c, axis=-1) - r
            value = d if value is None else smooth_min(value, d, 0.25)
        for h in handles:
            value = smooth_min(value, torus(p, *h), 0.05)
        return value

    centres = np.array([c for c, _ in parts])
    reach = np.array([r for _, r in parts])[:, None] + 0.9
    return f, (centres - reach).min(0), (centres + reach).max(0)


def waves(rng, _):
    """A ball whose wall random waves bore through."""
    frequency = [rng.normal(size=3) * rng.uniform(1.5, 4.0) for _ in range(6)]
    phase = rng.uniform(0, 2 * np.pi, size=6)
    strength = rng.uniform(0.1, 0.5)

    def f(p):
        ripple = sum(np.cos(p @ k + a) for k, a in zip(frequency, phase)) / 6**0.5
        return np.linalg.norm(p, axis=-1) - 1.0 + strength * ripple

    return f, np.full(3, -2.4), np.full(3, 2.4)


def marching_tetrahedra(f, low, high, cell, nearest):
    """The level set, each crossing kept `nearest` of its edge away from the corners."""
    count = np.maximum(np.ceil((high - low) / cell).astype(int) + 1, 4)
    axes = [np.linspace(low[k], high[k], count[k]) for k in range(3)]
    grid = np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1)
    value = f(grid)
    for k in range(3):  # The surface ends inside the grid.
        edge = [slice(None)] * 3
        for side in (0, -1):
            edge[k] = side
            value[tuple(edge)] = np.maximum(value[tuple(edge)], 0.1 * cell)
    value = np.where(value == 0.0, 1e-12, value).ravel()
    grid = grid.reshape(-1, 3)
    stride = np.array([count[1] * count[2], count[2], 1])
    base = (np.indices(count - 1).reshape(3, -1).T * stride).sum(1)
    tets = []
    for order in permutations(range(3)):
        steps = np.cumsum([0, *(stride[k] for k in order)])
        even = order in ((0, 1, 2), (1, 2, 0), (2, 0, 1))
        tets.append(base[:, None] + (steps if even else steps[[0, 2, 1, 3]]))
    tets = np.concatenate(tets)
    inside = value[tets] < 0.0
    some = inside.any(1) & ~inside.all(1)
    tets, inside = tets[some], inside[some]
    even = [(0, 1, 2, 3), (1, 0, 3, 2), (2, 0, 1, 3), (3, 0, 2, 1)]
    pairs = [(0, 1, 2, 3), (0, 2, 3, 1), (0, 3, 1, 2), (1, 2, 0, 3), (1, 3, 2, 0), (2, 3, 0, 1)]
    corners = []  # Each: three grid edges.
    number = inside.sum(1)
    for i, j, k, l in even:
        for t, turn in (
            (tets[(number == 1) & inside[:, i]], False),
            (tets[(number == 3) & ~inside[:, i]], True),
        ):
            ring = (j, l, k) if turn else (j, k, l)
            corners.append(np.stack([t[:, [i, r]] for r in ring], axis=1))
    for i, j, k, l in pairs:
        t = tets[(number == 2) & inside[:, i] & inside[:, j]]
        quad = [t[:, [i, k]], t[:, [i, l]], t[:, [j, l]], t[:, [j, k]]]
        corners.append(np.stack([quad[0], quad[1], quad[2]], axis=1))
        corners.append(np.stack([quad[0], quad[2], quad[3]], axis=1))
    edges = np.sort(np.concatenate(corners).reshape(-1, 2), axis=1)
    unique, triangles = np.unique(edges, axis=0, return_inverse=True)
    v0, v1 = value[unique[:, 0]], value[unique[:, 1]]
    t = np.clip(v0 / (v0 - v1), nearest, 1.0 - nearest)[:, None]
    vertices = (1.0 - t) * grid[unique[:, 0]] + t * grid[unique[:, 1]]
    return largest_component(vertices, triangles.reshape(-1, 3))


def polycube(rng, genus):
    """Cubes grown at random side by side, each only where the surface stays manifold."""
    size = int(rng.integers(3, 5 + genus // 3))
    full = np.zeros((size + 2,) * 3, bool)
    full[tuple(rng.integers(1, size + 1, size=3))] = True
    for _ in range(int(rng.uniform(0.5, 6.0) * size**3)):
        cells = np.argwhere(full)
        at = cells[rng.integers(len(cells))]
        axis = rng.integers(3)
        at[axis] = np.clip(at[axis] + rng.choice((-1, 1)), 1, size)
        if full[tuple(at)]:
            continue
        full[tuple(at)] = True
        near = full[tuple(slice(x - 1, x + 2) for x in at)]
        octants = [
            near[i : i + 2, j : j + 2, k : k + 2].ravel() for i in (0, 1) for j in (0, 1) for k in (0, 1)
        ]
        full[tuple(at)] = DISK[(np.array(octants) << np.arange(8)).sum(-1)].all()
    return full


def disk_corners():
    """Of the 256 ways to fill eight cubes about a corner: those whose surface is one disk or none."""
    result = np.zeros(256, bool)
    for code in range(256):
        cells = [(i, j, k) for i in (0, 1) for j in (0, 1) for k in (0, 1)]
        full = {c: bool(code >> n & 1) for n, c in enumerate(cells)}

        def pieces(state):
            left = {c for c in cells if full[c] == state}
            count = 0
            while left:
                count += 1
                stack = [left.pop()]
                while stack:
                    c = stack.pop()
                    for axis in range(3):
                        other = tuple(1 - x if a == axis else x for a, x in enumerate(c))
                        if other in left:
                            left.remove(other)
                            stack.append(other)
            return count

        result[code] = code in (0, 255) or (pieces(True) == 1 and pieces(False) == 1)
    return result


DISK = disk_corners()


def cubes_surface(full, faces):
    """The boundary of cubes, each side cut in squares so that about `faces` triangles come out."""
    sides = sum(int(np.abs(np.diff(full.astype(int), axis=a)).sum()) for a in range(3))
    cut = max(1, round(np.sqrt(faces / (2 * sides))))
    fine = full
    for axis in range(3):
        fine = np.repeat(fine, cut, axis=axis)
    quads = []
    for axis in range(3):
        change = np.diff(fine.astype(int), axis=axis)
        at = np.argwhere(change != 0)
        outward = change[tuple(at.T)] < 0
        b, c = (axis + 1) % 3, (axis + 2) % 3
        at[:, axis] += 1
        ring = []
        for db, dc in ((0, 0), (1, 0), (1, 1), (0, 1)):
            corner = at.copy()
            corner[:, b] += db
            corner[:, c] += dc
            ring.append(corner)
        ring = np.stack(ring, axis=1)
        quads.append(np.where(outward[:, None, None], ring, ring[:, ::-1]))
    quads = np.concatenate(quads)
    unique, index = np.unique(quads.reshape(-1, 3), axis=0, return_inverse=True)
    index = index.reshape(-1, 4)
    triangles = np.concatenate([index[:, [0, 1, 2]], index[:, [0, 2, 3]]])
    return largest_component(unique / cut, triangles)


# --- topology -------------------------------------------------------------------------------------


def largest_component(vertices, triangles):
    if len(triangles) == 0:
        return Mesh(vertices[:0], triangles)
    label = np.arange(len(vertices))
    while True:
        low = label[triangles].min(1)
        new = label.copy()
        for k in range(3):
            np.minimum.at(new, triangles[:, k], low)
        new = new[new]
        if (new == label).all():
            break
        label = new
    face_label = label[triangles[:, 0]]
    names, sizes = np.unique(face_label, return_counts=True)
    triangles = triangles[face_label == names[sizes.argmax()]]
    used, triangles = np.unique(triangles, return_inverse=True)
    return Mesh(vertices[used], triangles.reshape(-1, 3))


def fault(mesh):
    """Why the mesh is not closed, oriented, two-manifold and connected; empty when it is."""
    t = mesh.triangles
    n = len(mesh.vertices)
    halfedges = np.concatenate([t[:, [0, 1]], t[:, [1, 2]], t[:, [2, 0]]]).astype(np.int64)
    forward = np.sort(halfedges[:, 0] * n + halfedges[:, 1])
    backward = np.sort(halfedges[:, 1] * n + halfedges[:, 0])
    if (np.diff(forward) == 0).any():
        return "an edge is used twice in one direction"
    if (forward != backward).any():
        return "not closed"
    following = [dict() for _ in range(n)]
    for a, b, c in t.tolist():
        following[a][b] = c
        following[b][c] = a
        following[c][a] = b
    for ring in following:
        if not ring:
            return "a vertex without faces"
        start = next(iter(ring))
        length, at = 1, ring[start]
        while at != start:
            length, at = length + 1, ring[at]
        if length != len(ring):
            return "a vertex with several fans"
    if len(largest_component(mesh.vertices, t).triangles) != len(t):
        return "not connected"
    return ""


# --- changes --------------------------------------------------------------------------------------


def vertex_normals(mesh):
    p = mesh.vertices[mesh.triangles]
    normal = np.cross(p[:, 1] - p[:, 0], p[:, 2] - p[:, 0])
    total = np.zeros_like(mesh.vertices)
    for k in range(3):
        np.add.at(total, mesh.triangles[:, k], normal)
    return total / np.maximum(np.linalg.norm(total, axis=1, keepdims=True), 1e-300)


def edges_of(mesh):
    t = mesh.triangles
    ends = np.sort(np.concatenate([t[:, [0, 1]], t[:, [1, 2]], t[:, [2, 0]]]), axis=1)
    return np.unique(ends, axis=0)


def relaxed(mesh, rounds):
    ends = edges_of(mesh)
    degree = np.bincount(ends.ravel(), minlength=len(mesh.vertices))[:, None]
    p = mesh.vertices
    for _ in range(rounds):
        mean = np.zeros_like(p)
        np.add.at(mean, ends[:, 0], p[ends[:, 1]])
        np.add.at(mean, ends[:, 1], p[ends[:, 0]])
        p = p + 0.5 * (mean / degree - p)
    return Mesh(p, mesh.triangles, mesh.recipe)


def nearest_edge(mesh):
    """Per vertex: the length of its shortest edge."""
    ends = edges_of(mesh)
    length = np.linalg.norm(mesh.vertices[ends[:, 0]] - mesh.vertices[ends[:, 1]], axis=1)
    shortest = np.full(len(mesh.vertices), np.inf)
    for k in range(2):
        np.minimum.at(shortest, ends[:, k], length)
    return shortest[:, None]


def displaced(mesh, rng, strength, along):
    """Moved at random, by a part of the shortest edge at each vertex."""
    if along:
        move = vertex_normals(mesh) * rng.normal(size=(len(mesh.vertices), 1))
    else:
        move = rng.normal(size=mesh.vertices.shape) / np.sqrt(3)
    return Mesh(mesh.vertices + strength * nearest_edge(mesh) * move, mesh.triangles, mesh.recipe)


def minus(a, b):
    return (a[0] - b[0], a[1] - b[1], a[2] - b[2])


def dot(a, b):
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def cross(a, b):
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def collapsed(mesh, rng, faces, turn_limit):
    """Random edge collapses down to `faces` triangles.

    The surface stays manifold (link condition); no face may turn its normal by more than an angle
    of cosine `turn_limit`. Triangles of any shape are welcome.
    """
    p = [tuple(v) for v in mesh.vertices.tolist()]  # numpy is slow for single triangles
    tri = [list(t) for t in mesh.triangles.tolist()]
    around = [set() for _ in p]
    for f, t in enumerate(tri):
        for v in t:
            around[v].add(f)
    alive = len(tri)
    names = np.arange(len(p))
    tries = 0
    while alive > faces and tries < 8 * len(p):
        tries += 1
        a = int(names[rng.integers(len(names))])
        if not around[a]:
            continue
        ring_a = {v for f in around[a] for v in tri[f]} - {a}
        ordered = sorted(ring_a)
        b = ordered[rng.integers(len(ordered))]
        ring_b = {v for f in around[b] for v in tri[f]} - {b}
        if len(ring_a & ring_b) != 2 or len(ring_a | ring_b) < 6:
            continue
        gone = around[a] & around[b]
        if len(gone) != 2:
            continue
        s = float(rng.choice((0.0, 1.0, rng.uniform())))
        target = tuple((1.0 - s) * x + s * y for x, y in zip(p[a], p[b]))
        fine = True
        for f in (around[a] | around[b]) - gone:
            old = [p[v] for v in tri[f]]
            new = [target if v in (a, b) else p[v] for v in tri[f]]
            n0 = cross(minus(old[1], old[0]), minus(old[2], old[0]))
            n1 = cross(minus(new[1], new[0]), minus(new[2], new[0]))
            size = sqrt(dot(n0, n0) * dot(n1, n1))
            longest = max(dot(d, d) for d in (minus(new[0], new[1]), minus(new[1], new[2])))
            if dot(n0, n1) <= turn_limit * size or dot(n1, n1) <= (1e-4 * longest) ** 2:
                fine = False
                break
        if not fine:
            continue
        p[a] = target
        for f in gone:
            for v in tri[f]:
                around[v].discard(f)
            tri[f] = None
        for f in around[b]:
            tri[f] = [a if v == b else v for v in tri[f]]
            around[a].add(f)
        around[b] = set()
        alive -= 2
    triangles = np.array([t for t in tri if t])
    used, triangles = np.unique(triangles, return_inverse=True)
    return Mesh(np.array(p)[used], triangles.reshape(-1, 3), mesh.recipe)


def with_needles(mesh, rng, count):
    """Edges cut at a thousandth of their length: the surface as a set does not change."""
    p = list(mesh.vertices)
    tri = [tuple(t) for t in mesh.triangles.tolist()]
    face_of = {}
    for f, t in enumerate(tri):
        for k in range(3):
            face_of[t[k], t[(k + 1) % 3]] = f
    touched = set()
    for _ in range(count):
        f = int(rng.integers(len(mesh.triangles)))
        k = int(rng.integers(3))
        a, b, c = tri[f][k], tri[f][(k + 1) % 3], tri[f][(k + 2) % 3]
        g = face_of.get((b, a))
        if g is None or f in touched or g in touched:
            continue
        d = next(v for v in tri[g] if v not in (a, b))
        touched |= {f, g}
        m = len(p)
        p.append((1.0 - SHORT) * p[a] + SHORT * p[b])
        tri[f], tri[g] = (a, m, c), (m, a, d)
        tri += [(m, b, c), (b, m, d)]
    return Mesh(np.array(p), np.array(tri), mesh.recipe)


def with_caps(mesh, rng, count):
    """Faces cut at points just off one of their edges: triangles of 180 degrees."""
    p = list(mesh.vertices)
    tri = [tuple(t) for t in mesh.triangles.tolist()]
    for f in sorted(set(rng.integers(len(tri), size=count).tolist())):
        k = int(rng.integers(3))
        a, b, c = tri[f][k], tri[f][(k + 1) % 3], tri[f][(k + 2) % 3]
        s = rng.uniform(0.2, 0.8)
        m = len(p)
        p.append((1.0 - SHORT) * ((1.0 - s) * p[a] + s * p[b]) + SHORT * p[c])
        tri[f] = (a, b, m)
        tri += [(b, c, m), (c, a, m)]
    return Mesh(np.array(p), np.array(tri), mesh.recipe)


def rotation(rng):
    q, r = np.linalg.qr(rng.normal(size=(3, 3)))
    q = q * np.sign(np.diag(r))
    return q if np.linalg.det(q) > 0 else -q


# --- the whole ------------------------------------------------------------------------------------

SURFACES = (tori, plate, blobs, waves, polycube)


def base(rng, faces):
    """A surface of about `faces` triangles, with genus at most MAX_GENUS."""
    while True:
        kind = SURFACES[rng.integers(len(SURFACES))]
        genus = int(rng.integers(MAX_GENUS + 1))
        if kind is polycube:
            mesh = cubes_surface(polycube(rng, genus), faces)
        else:
            f, low, high = kind(rng, genus)
            nearest = (0.3, 0.05, 1e-3)[rng.integers(3)]
            cell = float(np.prod(high - low)) ** (1 / 3) / 12
            for _ in range(4):  # The number of triangles goes with the square of the cells.
                mesh = marching_tetrahedra(f, low, high, cell, nearest)
                ratio = len(mesh.triangles) / faces
                if 0.8 < ratio < 1.25:
                    break
                cell *= np.clip(np.sqrt(ratio), 0.3, 2.0)
        if len(mesh.triangles) and mesh.genus <= MAX_GENUS and not fault(mesh):
            mesh.recipe.append(kind.__name__)
            return mesh


def make(seed, fewest, most, crossing):
    """The mesh of a seed. `crossing(mesh)` says whether faces of a mesh cross."""
    rng = np.random.default_rng(seed)
    faces = int(np.exp(rng.uniform(np.log(fewest), np.log(most))))
    thin = rng.uniform() < 0.4
    mesh = base(rng, int(faces * rng.uniform(1.5, 5.0)) if thin else faces)

    def attempt(name, change, strengths):
        """Takes the strongest change that makes no faces cross; none when all do."""
        nonlocal mesh
        state = rng.bit_generator.state
        for strength in strengths:
            rng.bit_generator.state = state
            changed = change(strength)
            if not fault(changed) and not crossing(changed):
                changed.recipe = [*mesh.recipe, f"{name} {strength:g}"]
                mesh = changed
                return
        mesh.recipe.append(f"no {name}")

    if rng.uniform() < 0.5:
        attempt("relaxed", lambda n: relaxed(mesh, int(n)), (10, 3, 1))
    if rng.uniform() < 0.3:
        stretch = np.exp(rng.uniform(np.log(0.05), 0.0, size=3))
        mesh = Mesh(mesh.vertices * stretch, mesh.triangles, [*mesh.recipe, "stretched"])
    if thin:
        attempt("collapsed", lambda c: collapsed(mesh, rng, faces, c), (0.0, 0.5, 0.9))
    if rng.uniform() < 0.5:
        along = rng.uniform() < 0.5
        attempt("noise", lambda s: displaced(mesh, rng, s, along), (0.3, 0.1, 0.03))
    if rng.uniform() < 0.4:
        count = int(len(mesh.triangles) * rng.uniform(0.01, 0.2)) + 1
        attempt("needles", lambda n: with_needles(mesh, rng, int(n)), (count,))
    if rng.uniform() < 0.3:
        count = int(len(mesh.triangles) * rng.uniform(0.01, 0.2)) + 1
        attempt("caps", lambda n: with_caps(mesh, rng, int(n)), (count,))

    scale = 10.0 ** rng.uniform(-6, 6) if rng.uniform() < 0.5 else 1.0
    p = mesh.vertices @ rotation(rng).T
    diagonal = np.linalg.norm(p.max(0) - p.min(0))
    offset = diagonal * 10.0 ** rng.uniform(-1, 3) * direction(rng) if rng.uniform() < 0.3 else 0.0
    p = scale * (p - 0.5 * (p.max(0) + p.min(0)) + offset)
    mesh = Mesh(p, mesh.triangles, mesh.recipe)
    if rng.uniform() < 0.5:
        mesh = shuffled(mesh, rng)
    if scale != 1.0:
        mesh.recipe.append(f"scale {scale:.0e}")
    if np.any(offset):
        mesh.recipe.append(f"{np.linalg.norm(offset) / diagonal:.0f} diagonals off")
    return mesh


def shuffled(mesh, rng):
    """The same mesh with vertices, faces and first corners in another order."""
    order = rng.permutation(len(mesh.vertices))
    number = np.empty(len(order), int)
    number[order] = np.arange(len(order))
    triangles = number[mesh.triangles][rng.permutation(len(mesh.triangles))]
    turn = rng.integers(3, size=len(triangles))
    triangles = np.stack(
        [triangles[np.arange(len(triangles)), (turn + k) % 3] for k in range(3)], axis=1
    )
    return Mesh(mesh.vertices[order], triangles, mesh.recipe)


def write_off(path, mesh):
    with open(path, "w", encoding="ascii") as out:
        out.write(f"OFF\n{len(mesh.vertices)} {len(mesh.triangles)} 0\n")
        for x, y, z in mesh.vertices.tolist():
            out.write(f"{x!r} {y!r} {z!r}\n")
        for a, b, c in mesh.triangles.tolist():
            out.write(f"3 {a} {b} {c}\n")
