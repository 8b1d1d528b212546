#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""Draws a result: its layout, its distance to the source, and zebra stripes.

    scripts/render.py MODEL PREFIX [-- OPTION ...]

MODEL is a file that `bot2nurbs --tessellation` wrote, or a mesh, which is converted first (what
follows `--` goes to the command). Writes PREFIX-layout.png, PREFIX-error.png and PREFIX-zebra.png,
each from two opposite sides. Needs what scripts/install_dependencies.sh --render installs:
VTK, and a virtual X server where there is no screen.

Layout: patches in soft colours, borders black, vertices of valence 3 blue, 5 red, 6 and more
yellow. Error: blue inside the source, red outside. Zebra: stripes of light reflected by the
surface; they are continuous where the tangent plane is, smooth where the curvature is.
"""

import argparse
import colorsys
import os
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np
import vtk
from vtk.util.numpy_support import numpy_to_vtk, numpy_to_vtkIdTypeArray

ROOT = Path(__file__).resolve().parent.parent
SIZE = (1600, 900)  # Pixels of a picture: two views side by side.
STRIPES = 8  # Pairs of dark and light over half a turn.
TYPES = {"double": "f8", "float": "f4", "int": "i4", "uchar": "u1"}


def read_tessellation(path):
    """The vertices and triangles of a tessellation; None for any other file."""
    data = path.read_bytes()
    if not data.startswith(b"ply"):
        return None
    end = data.find(b"end_header\n") + len(b"end_header\n")
    order, fields, counts = "<", [], []
    for line in data[:end].decode(errors="replace").splitlines():
        word = line.split()
        if word[:2] == ["format", "binary_big_endian"]:
            order = ">"
        elif word and word[0] == "element":
            counts.append(int(word[2]))
        elif word and word[0] == "property" and len(counts) == 1:
            fields.append((word[2], word[1]))
    names = [name for name, _ in fields]
    if "patch" not in names or "distance" not in names:
        return None
    vertex = np.dtype([(name, order + TYPES[kind]) for name, kind in fields])
    face = np.dtype([("count", "u1"), ("v", order + "i4", 3)])
    vertices = np.frombuffer(data, vertex, counts[0], end)
    faces = np.frombuffer(data, face, counts[1], end + counts[0] * vertex.itemsize)
    return vertices, faces["v"]


def tessellate(mesh, arguments):
    binary = ROOT / "build/release/bot2nurbs"
    if not binary.is_file():
        sys.exit(f"render.py: {binary} is missing: build the release preset first")
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "result.ply"
        run = subprocess.run([binary, mesh, "--tessellation", path, *arguments])
        if run.returncode != 0:
            sys.exit(run.returncode)
        return read_tessellation(path)


def poly_data(points, triangles=None):
    data = vtk.vtkPolyData()
    array = vtk.vtkPoints()
    array.SetData(numpy_to_vtk(np.ascontiguousarray(points), deep=True))
    data.SetPoints(array)
    if triangles is not None:
        cells = vtk.vtkCellArray()
        ids = np.insert(triangles.astype(np.int64), 0, 3, axis=1).ravel()
        cells.SetCells(len(triangles), numpy_to_vtkIdTypeArray(ids, deep=True))
        data.SetPolys(cells)
    return data


def surface_actor(vertices, triangles, scalars, table, low, high):
    points = np.stack([vertices[k] for k in "xyz"], axis=-1).astype(float)
    data = poly_data(points, triangles)
    normals = np.stack([vertices[k] for k in ("nx", "ny", "nz")], axis=-1).astype(np.float32)
    data.GetPointData().SetNormals(numpy_to_vtk(normals, deep=True))
    data.GetPointData().SetScalars(numpy_to_vtk(np.ascontiguousarray(scalars, np.float32), deep=True))
    mapper = vtk.vtkPolyDataMapper()
    mapper.SetInputData(data)
    mapper.SetLookupTable(table)
    mapper.SetScalarRange(low, high)
    mapper.InterpolateScalarsBeforeMappingOn()
    actor = vtk.vtkActor()
    actor.SetMapper(mapper)
    actor.GetProperty().SetInterpolationToPhong()
    actor.GetProperty().SetSpecular(0.15)
    return actor


def border_actor(vertices, points, width):
    """The four sides of every patch as polylines."""
    patches = int(vertices["patch"].max()) + 1
    side = int(round((len(vertices) / patches) ** 0.5))
    grid = np.arange(len(vertices)).reshape(patches, side, side)
    lines = vtk.vtkCellArray()
    for line in (grid[:, :, 0], grid[:, :, -1], grid[:, 0, :], grid[:, -1, :]):
        for ids in line:
            lines.InsertNextCell(side)
            for i in ids:
                lines.InsertCellPoint(int(i))
    data = poly_data(points)
    data.SetLines(lines)
    mapper = vtk.vtkPolyDataMapper()
    mapper.SetInputData(data)
    mapper.SetResolveCoincidentTopologyToPolygonOffset()
    actor = vtk.vtkActor()
    actor.SetMapper(mapper)
    actor.GetProperty().SetColor(0.05, 0.05, 0.05)
    actor.GetProperty().SetLineWidth(width)
    actor.GetProperty().LightingOff()
    return actor


def valence_actors(vertices, points, radius):
    actors = []
    for low, high, colour in ((3, 3, (0.1, 0.3, 0.95)), (5, 5, (0.9, 0.1, 0.1)), (6, 99, (1.0, 0.8, 0.0))):
        chosen = (vertices["valence"] >= low) & (vertices["valence"] <= high)
        if not chosen.any():
            continue
        sphere = vtk.vtkSphereSource()
        sphere.SetRadius(radius)
        sphere.SetThetaResolution(16)
        sphere.SetPhiResolution(16)
        mapper = vtk.vtkGlyph3DMapper()
        mapper.SetInputData(poly_data(np.unique(points[chosen], axis=0)))
        mapper.SetSourceConnection(sphere.GetOutputPort())
        mapper.ScalarVisibilityOff()
        actor = vtk.vtkActor()
        actor.SetMapper(mapper)
        actor.GetProperty().SetColor(*colour)
        actors.append(actor)
    return actors


def patch_table(patches):
    table = vtk.vtkLookupTable()
    table.SetNumberOfTableValues(patches)
    for i in range(patches):
        # Steps of the golden ratio: neighbouring numbers get unlike colours.
        h = (0.13 + 0.618034 * i) % 1.0
        table.SetTableValue(i, *colorsys.hsv_to_rgb(h, 0.25, 0.95), 1.0)
    return table


def diverging_table():
    table = vtk.vtkLookupTable()
    table.SetNumberOfTableValues(256)
    for i in range(256):
        t = i / 127.5 - 1.0
        fade = 1.0 - abs(t)
        table.SetTableValue(i, *((1.0, fade, fade) if t > 0 else (fade, fade, 1.0)), 1.0)
    return table


def stripe_table():
    table = vtk.vtkLookupTable()
    table.SetNumberOfTableValues(2048)
    for i in range(2048):
        light = 0.95 if int(2 * STRIPES * i / 2048) % 2 else 0.08
        table.SetTableValue(i, light, light, light, 1.0)
    return table


def draw(path, make_actors, points, title, bar=None):
    """Two opposite views of what make_actors(direction of view) gives."""
    window = vtk.vtkRenderWindow()
    window.SetOffScreenRendering(1)
    window.SetSize(*SIZE)
    window.SetMultiSamples(8)
    centre = 0.5 * (points.min(axis=0) + points.max(axis=0))
    diagonal = np.linalg.norm(points.max(axis=0) - points.min(axis=0))
    # Looked at along the shortest side of the box, from a little to the side, with the longest of
    # the others upright.
    order = np.argsort(points.max(axis=0) - points.min(axis=0))
    forward, side, up = np.eye(3)[order]
    for half, sign in enumerate((1.0, -1.0)):
        direction = sign * (forward + 0.35 * side) + 0.3 * up
        direction /= np.linalg.norm(direction)
        renderer = vtk.vtkRenderer()
        renderer.SetViewport(0.5 * half, 0.0, 0.5 * half + 0.5, 1.0)
        renderer.SetBackground(1, 1, 1)
        for actor in make_actors(direction):
            renderer.AddActor(actor)
        camera = renderer.GetActiveCamera()
        camera.SetFocalPoint(*centre)
        camera.SetPosition(*(centre + 3.0 * diagonal * direction))
        camera.SetViewUp(*up)
        camera.SetViewAngle(20)
        renderer.ResetCamera()
        camera.Zoom(1.15)
        renderer.ResetCameraClippingRange()
        if half == 0:
            text = vtk.vtkTextActor()
            text.SetInput(title)
            text.GetTextProperty().SetColor(0, 0, 0)
            text.GetTextProperty().SetFontSize(20)
            text.SetPosition(12, 12)
            renderer.AddActor2D(text)
        elif bar is not None:
            renderer.AddActor2D(bar)
        window.AddRenderer(renderer)
    window.Render()
    grab = vtk.vtkWindowToImageFilter()
    grab.SetInput(window)
    grab.ReadFrontBufferOff()
    writer = vtk.vtkPNGWriter()
    writer.SetFileName(str(path))
    writer.SetInputConnection(grab.GetOutputPort())
    writer.Write()
    print(path)


def scale_bar(table, limit):
    mapper_table = vtk.vtkScalarBarActor()
    mapper_table.SetLookupTable(table)
    mapper_table.SetTitle("% of diagonal")
    mapper_table.SetNumberOfLabels(5)
    mapper_table.SetLabelFormat("%-#.2g")
    for text in (mapper_table.GetTitleTextProperty(), mapper_table.GetLabelTextProperty()):
        text.SetColor(0, 0, 0)
        text.ShadowOff()
        text.ItalicOff()
    mapper_table.SetPosition(0.86, 0.25)
    mapper_table.SetWidth(0.12)
    mapper_table.SetHeight(0.5)
    table.SetRange(-limit, limit)
    return mapper_table


def main():
    if not os.environ.get("DISPLAY"):
        # Debian's VTK draws through X, also off-screen.
        os.execvp("xvfb-run", ["xvfb-run", "-a", "-s", "-screen 0 1920x1200x24", *sys.argv])
    arguments = sys.argv[1:]
    passed_on = []
    if "--" in arguments:
        cut = arguments.index("--")
        arguments, passed_on = arguments[:cut], arguments[cut + 1 :]
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("model", type=Path)
    parser.add_argument("prefix")
    options = parser.parse_args(arguments)
    if not options.model.is_file():
        sys.exit(f"render.py: there is no file {options.model}")

    vertices, triangles = read_tessellation(options.model) or tessellate(options.model, passed_on)
    points = np.stack([vertices[k] for k in "xyz"], axis=-1).astype(float)
    normals = np.stack([vertices[k] for k in ("nx", "ny", "nz")], axis=-1).astype(float)
    diagonal = np.linalg.norm(points.max(axis=0) - points.min(axis=0))
    patches = int(vertices["patch"].max()) + 1
    name = options.model.stem

    def layout(_):
        table = patch_table(patches)
        return [
            surface_actor(vertices, triangles, vertices["patch"], table, 0, patches - 1),
            border_actor(vertices, points, 1.6),
            *valence_actors(vertices, points, 0.006 * diagonal),
        ]

    distance = 100.0 * vertices["distance"] / diagonal
    # The worst thousandth saturates, so that one spot does not hide the rest.
    limit = max(float(np.quantile(np.abs(distance), 0.999)), 1e-9)
    table = diverging_table()

    def error(_):
        return [
            surface_actor(vertices, triangles, distance, table, -limit, limit),
            border_actor(vertices, points, 0.6),
        ]

    def zebra(direction):
        # Where the mirrored ray goes, as an angle to a fixed axis across the view.
        reflected = 2.0 * (normals @ direction)[:, None] * normals - direction
        across = np.cross(direction, (0.31, 0.43, 0.85))
        across /= np.linalg.norm(across)
        angle = np.arccos(np.clip(reflected @ across, -1.0, 1.0))
        return [surface_actor(vertices, triangles, angle, stripe_table(), 0.0, np.pi)]

    valences = vertices["valence"]
    irregular = len(np.unique(points[(valences > 0) & (valences != 4)], axis=0))
    draw(f"{options.prefix}-layout.png", layout, points,
         f"{name}: {patches} patches, {irregular} extraordinary vertices")
    draw(f"{options.prefix}-error.png", error, points,
         f"{name}: distance to the source, largest {np.abs(distance).max():.3g} %", scale_bar(table, limit))
    draw(f"{options.prefix}-zebra.png", zebra, points, f"{name}: zebra stripes")


if __name__ == "__main__":
    main()
