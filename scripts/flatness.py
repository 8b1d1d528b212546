#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""Measures what makes a part a part: creases kept, crease error, and how flat plane faces stay.

    scripts/flatness.py [MODEL ...] [--binary FILE] [--data DIR] [--output FILE]

A plane face is a connected set of triangles of the source in one plane, with at least a hundredth
of its area. Every vertex of the tessellation whose nearest triangle belongs to one, away from the
rim of that face, is measured against its plane. Needs what scripts/install_dependencies.sh --render
installs (VTK).
"""

import argparse
import json
import subprocess
import sys
import tempfile
from collections import defaultdict
from pathlib import Path

import numpy as np
import vtk

import render

ROOT = Path(__file__).resolve().parent.parent
MODELS = [
    "fandisk", "cube-meshed", "anchor_dense", "joint_4k", "bearing_plate", "hoppe_mechpart",
    "cylinder_plate", "beveled_shoulder", "plate1_rem", "wedge",
]  # fmt: skip
SAME_PLANE_DEG = 0.01  # Between neighbours of one plane face.
LEAST_AREA = 1e-2  # Of the surface: smaller ones are facets of curved faces.
SHARP_DEG = 35.0  # As --features auto.
RIM = 1e-3  # Of the diagonal: nearer to the rim the crease decides, not the face.


def read_mesh(path):
    """Vertices and triangles of an OBJ, OFF, PLY or STL file, vertices at one place joined."""
    reader = {
        ".obj": vtk.vtkOBJReader, ".ply": vtk.vtkPLYReader, ".stl": vtk.vtkSTLReader,
    }.get(path.suffix.lower())  # fmt: skip
    if reader is None:
        return read_off(path)
    reader = reader()
    reader.SetFileName(str(path))
    triangles = vtk.vtkTriangleFilter()
    triangles.SetInputConnection(reader.GetOutputPort())
    clean = vtk.vtkCleanPolyData()
    clean.SetInputConnection(triangles.GetOutputPort())
    clean.Update()
    return clean.GetOutput()


def read_off(path):
    """The same for OFF, which VTK does not read."""
    words = path.read_text().split()
    vertices, faces = int(words[1]), int(words[2])
    data = vtk.vtkPolyData()
    points = vtk.vtkPoints()
    points.SetDataTypeToDouble()
    at = 4
    for _ in range(vertices):
        points.InsertNextPoint(*map(float, words[at : at + 3]))
        at += 3
    cells = vtk.vtkCellArray()
    for _ in range(faces):
        corners = [int(w) for w in words[at + 1 : at + 1 + int(words[at])]]
        at += 1 + len(corners)
        for k in range(1, len(corners) - 1):
            cells.InsertNextCell(3, [corners[0], corners[k], corners[k + 1]])
    data.SetPoints(points)
    data.SetPolys(cells)
    return data


def plane_faces(points, triangles):
    """Number of the plane face of every triangle, -1 for none, and of each its rim edges."""
    normal = np.cross(
        points[triangles[:, 1]] - points[triangles[:, 0]],
        points[triangles[:, 2]] - points[triangles[:, 0]],
    )
    area = 0.5 * np.linalg.norm(normal, axis=1)
    normal /= np.maximum(2 * area, 1e-300)[:, None]
    sides = defaultdict(list)
    for t, corners in enumerate(triangles):
        for k in range(3):
            sides[frozenset((corners[k], corners[(k + 1) % 3]))].append(t)
    parent = np.arange(len(triangles))

    def root(t):
        while parent[t] != t:
            parent[t] = parent[parent[t]]
            t = parent[t]
        return t

    least = np.cos(np.radians(SAME_PLANE_DEG))
    for pair in sides.values():
        if len(pair) == 2 and normal[pair[0]] @ normal[pair[1]] >= least:
            parent[root(pair[0])] = root(pair[1])
    face = np.array([root(t) for t in range(len(triangles))])
    total = np.bincount(face, area, len(triangles))
    face[total[face] < LEAST_AREA * area.sum()] = -1
    rim, smooth = [], set()
    for edge, pair in sides.items():
        if len(pair) == 2 and face[pair[0]] == face[pair[1]]:
            continue
        rim.append(tuple(edge))
        if len(pair) == 2 and normal[pair[0]] @ normal[pair[1]] > np.cos(np.radians(SHARP_DEG)):
            smooth |= {face[t] for t in pair}
    return face, normal, rim, smooth


def flatness(model, tessellation):
    """Of plane faces with a sharp rim, and of those that go over into others smoothly: how many, and
    the largest distance from their planes over the diagonal."""
    mesh = read_mesh(model)
    points = np.array([mesh.GetPoint(i) for i in range(mesh.GetNumberOfPoints())])
    ids = vtk.vtkIdList()
    triangles = []
    for c in range(mesh.GetNumberOfCells()):
        mesh.GetCellPoints(c, ids)
        triangles.append([ids.GetId(k) for k in range(3)])
    triangles = np.array(triangles)
    face, normal, rim, smooth = plane_faces(points, triangles)
    diagonal = np.linalg.norm(np.ptp(points, axis=0))
    locator = vtk.vtkStaticCellLocator()
    locator.SetDataSet(mesh)
    locator.BuildLocator()
    rim_lines = vtk.vtkPolyData()
    rim_lines.SetPoints(mesh.GetPoints())
    lines = vtk.vtkCellArray()
    for a, b in rim:
        lines.InsertNextCell(2, [a, b])
    rim_lines.SetLines(lines)
    rim_locator = vtk.vtkStaticCellLocator()
    rim_locator.SetDataSet(rim_lines)
    rim_locator.BuildLocator()
    cell, sub, distance = vtk.reference(0), vtk.reference(0), vtk.reference(0.0)
    nearest = [0.0, 0.0, 0.0]
    worst = [0.0, 0.0]
    for v in render.read_tessellation(tessellation)[0]:
        p = np.array([v["x"], v["y"], v["z"]])
        locator.FindClosestPoint(p, nearest, cell, sub, distance)
        t = int(cell)
        if face[t] < 0:
            continue
        rim_locator.FindClosestPoint(p, nearest, cell, sub, distance)
        if float(distance) < (RIM * diagonal) ** 2:
            continue
        kind = face[t] in smooth
        worst[kind] = max(worst[kind], abs(normal[t] @ (p - points[triangles[t, 0]])) / diagonal)
    found = set(face[face >= 0])
    return [(len(found - smooth), worst[0]), (len(found & smooth), worst[1])]


def row(model, binary, work):
    """The cells of one model's row."""
    report, ply = work / "report.json", work / "model.ply"
    command = [binary, model, work / "model.3dm", "--tessellation", ply, "--json", report, "--quiet"]
    if subprocess.run(command, stderr=subprocess.DEVNULL).returncode != 0:
        return [model.stem, "", "", "", "", "", "not converted", ""]
    data = json.loads(report.read_text())
    (c,) = data["components"]
    found = data["features"]
    percent = 100 / c["deviation"]["diagonal"]
    creases = c.get("creases")
    error = "-"
    if creases:
        sides = (creases["source_to_surface"]["max"], creases["surface_to_source"]["max"])
        error = f"{percent * max(sides):.3f}"
    planes = [f"{count}: {worst:.1e}" if count else "-" for count, worst in flatness(model, ply)]
    return [
        model.stem, c["brep"]["faces"], f"{found['detected_edges']}", f"{found['kept_edges']}",
        f"{found['creases']} ({creases['edges'] if creases else 0})", error, *planes,
    ]  # fmt: skip


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("models", nargs="*", default=MODELS)
    parser.add_argument("--binary", type=Path, default=ROOT / "build/release/bot2nurbs")
    parser.add_argument("--data", type=Path, default=ROOT.parent / "shared/data/meshes/mechanical")
    parser.add_argument("--output", type=Path)
    options = parser.parse_args()
    if not options.data.is_dir():
        sys.exit(f"{options.data}: no such folder; name one with --data")
    lines = [
        "# Parts: creases and plane faces", "",
        "Written by `scripts/flatness.py`, default options. *Sharp edges* of the source turn by 35 degrees or more; *kept* are those of",
        "creases (weaker ones that carry a crease on count too); *creases* are their paths, in brackets the edges of the B-Rep they became.",
        "*Crease error* is the largest distance between both, either way, in percent of the diagonal; *flat* how many plane",
        "faces the source has with a sharp rim all round, and the largest distance of the surface from their planes as a share of the",
        "diagonal; *flat, smooth rim* the same for those that go over into a curved face somewhere.", "",
        "| model | patches | sharp edges | kept | creases (edges) | crease error % | flat | flat, smooth rim |",
        "|---|---:|---:|---:|---:|---:|---|---|",
    ]  # fmt: skip
    with tempfile.TemporaryDirectory() as folder:
        for name in options.models:
            (model,) = options.data.glob(name + ".*")
            lines.append("| " + " | ".join(map(str, row(model, options.binary, Path(folder)))) + " |")
            print(lines[-1], flush=True)
    if options.output:
        options.output.write_text("\n".join(lines) + "\n")


if __name__ == "__main__":
    main()
