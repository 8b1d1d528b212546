#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""Converts clouds of points and tabulates what comes out.

    scripts/clouds.py FOLDER OUTPUT.md [--command BOT2NURBS] [--only TEXT] [--timeout SECONDS]

FOLDER holds clouds, and in `synthetic/` clouds sampled from meshes in `../meshes`: their surfaces
are measured against the true mesh too (needs VTK: scripts/install_dependencies.sh --render). Every
cloud is one command without options.
"""

import argparse
import json
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import numpy as np

ROOT = Path(__file__).resolve().parent.parent
SUFFIXES = {".ply", ".xyz", ".pts", ".txt", ".pcd", ".obj", ".pwn", ".las", ".off"}
# The true mesh of a synthetic cloud by the start of its name, its genus, and whether it is closed.
TRUE_MESHES = {
    "bunny_3k": ("smooth/bunny_3k.off", 0, True),
    "fertility_4k": ("genus/fertility_4k.off", 4, True),
    "fandisk": ("mechanical/fandisk.obj", 0, True),
    "cowhead": ("open/cowhead.obj", 0, False),
}
TYPES = {"double": "f8", "float": "f4", "int": "i4", "uchar": "u1"}


def read_vertices(path):
    """Positions of the vertices of a tessellation (binary PLY)."""
    data = path.read_bytes()
    end = data.find(b"end_header\n") + len(b"end_header\n")
    fields, counts = [], []
    for line in data[:end].decode().splitlines():
        word = line.split()
        if word and word[0] == "element":
            counts.append(int(word[2]))
        elif word and word[0] == "property" and len(counts) == 1:
            fields.append((word[2], "<" + TYPES[word[1]]))
    vertices = np.frombuffer(data, np.dtype(fields), counts[0], end)
    return np.stack([vertices["x"], vertices["y"], vertices["z"]], axis=1).astype(float)


def read_mesh(path):
    """Vertices and faces of an OFF or OBJ file."""
    words = [line.split() for line in path.read_text().splitlines()]
    words = [w for w in words if w and not w[0].startswith("#")]
    if path.suffix == ".obj":
        vertices = [[float(x) for x in w[1:4]] for w in words if w[0] == "v"]
        faces = [[int(x.split("/")[0]) - 1 for x in w[1:]] for w in words if w[0] == "f"]
        return np.array(vertices), faces
    count = [int(x) for x in (words[1] if len(words[0]) == 1 else words[0][1:])[:2]]
    body = words[2 if len(words[0]) == 1 else 1 :]
    vertices = [[float(x) for x in w[:3]] for w in body[: count[0]]]
    faces = [[int(x) for x in w[1 : 1 + int(w[0])]] for w in body[count[0] : sum(count)]]
    return np.array(vertices), faces


class TrueMesh:
    """Distances from a mesh."""

    def __init__(self, path):
        import vtk

        vertices, faces = read_mesh(path)
        self.diagonal = float(np.linalg.norm(vertices.max(0) - vertices.min(0)))
        points = vtk.vtkPoints()
        for p in vertices:
            points.InsertNextPoint(p)
        cells = vtk.vtkCellArray()
        for face in faces:
            cells.InsertNextCell(len(face), face)
        self.mesh = vtk.vtkPolyData()
        self.mesh.SetPoints(points)
        self.mesh.SetPolys(cells)
        self.locator = vtk.vtkCellLocator()
        self.locator.SetDataSet(self.mesh)
        self.locator.BuildLocator()
        self.vtk = vtk

    def distances(self, positions):
        found, cell = [0.0, 0.0, 0.0], self.vtk.vtkGenericCell()
        number, part, square = self.vtk.mutable(0), self.vtk.mutable(0), self.vtk.mutable(0.0)
        result = np.empty(len(positions))
        for i, p in enumerate(positions):
            self.locator.FindClosestPoint(p, found, cell, number, part, square)
            result[i] = float(square) ** 0.5
        return result


def true_mesh_of(cloud, cache):
    for start, (path, genus, closed) in TRUE_MESHES.items():
        if cloud.name.startswith(start):
            if start not in cache:
                cache[start] = TrueMesh(cloud.parent.parent.parent / "meshes" / path)
            return cache[start], genus, closed
    return None, None, None


def run(command, cloud, timeout, folder):
    """Exit code, seconds, last line of errors and the report of one conversion."""
    report, surface = folder / "report.json", folder / "surface.ply"
    for path in (report, surface):
        path.unlink(missing_ok=True)
    start = time.monotonic()
    try:
        done = subprocess.run(
            [command, cloud, folder / "out.step", "--json", report, "--tessellation", surface, "--quiet"],
            capture_output=True, text=True, timeout=timeout, check=False,
        )
        code, words = done.returncode, done.stderr.strip().splitlines()
    except subprocess.TimeoutExpired:
        code, words = None, []
    seconds = time.monotonic() - start
    result = json.loads(report.read_text()) if report.exists() else {}
    return code, seconds, words[-1] if words else "", result, surface


def row_of(cloud, code, seconds, words, report, surface, cache):
    cells = {"cloud": cloud.name, "exit": "timeout" if code is None else str(code)}
    cells["seconds"] = f"{seconds:.0f}"
    made = report.get("cloud", {})
    if code != 0:
        message = report.get("error", {}).get("message", words)
        cells["reason"] = message.replace("|", "/")
        return cells
    diagonal = report["deviation"]["diagonal"]
    distance = made["deviation"]
    cells["points"] = str(made["points"])
    cells["normals"] = made["normals"]["source"]
    cells["noise"] = f"{100 * made['noise'] / diagonal:.2f}"
    cells["topology"] = made["topology"]
    genus = sum(c["genus"] for c in report["input"]["components"])
    loops = sum(c["boundary_loops"] for c in report["input"]["components"])
    cells["components"] = str(len(report["input"]["components"]))
    cells["genus"], cells["loops"] = str(genus), str(loops)
    cells["patches"] = str(report["brep"]["faces"])
    cells["solid"] = "yes" if report["brep"]["solid"] else ("open" if report["brep"]["valid"] else "INVALID")
    cells["rms"] = f"{100 * distance['rms'] / diagonal:.3f}"
    cells["p95"] = f"{100 * distance['percentile_95'] / diagonal:.3f}"
    cells["max"] = f"{100 * distance['max'] / diagonal:.2f}"
    true_mesh, true_genus, _ = true_mesh_of(cloud, cache)
    if true_mesh is not None:
        away = true_mesh.distances(read_vertices(surface))
        cells["true genus"] = str(true_genus)
        cells["true rms"] = f"{100 * float(np.sqrt(np.mean(away**2))) / true_mesh.diagonal:.3f}"
        cells["true max"] = f"{100 * float(away.max()) / true_mesh.diagonal:.2f}"
    return cells


def table(columns, rows):
    lines = ["| " + " | ".join(columns) + " |", "|" + "---|" * len(columns)]
    lines += ["| " + " | ".join(row.get(c, "") for c in columns) + " |" for row in rows]
    return "\n".join(lines) + "\n"


def page(rows, synthetic):
    good = [r for r in rows if r["exit"] == "0"]
    common = ["cloud", "exit", "seconds", "points", "normals", "noise", "topology", "components", "genus", "loops",
              "patches", "solid", "rms", "p95", "max"]
    text = [
        "# Results on clouds of points\n",
        "Made by `scripts/clouds.py`; one command each, `bot2nurbs CLOUD out.step`, without options. Distances in",
        "percent of the diagonal: of the points from the surface (rms, 95 %, max), and of the surface from the",
        "mesh that a synthetic cloud was sampled from (true rms, true max; it includes parts that a partial",
        "cloud does not show, where the surface is a guess). `solid`: a valid solid (yes) or a valid open",
        "surface (open). Seconds of wall-clock time on a loaded machine of two cores.\n",
        f"{len(good)} of {len(rows)} clouds give a valid B-Rep.\n",
        "## Sampled from known meshes\n",
        table(common + ["true genus", "true rms", "true max"], [r for r in good if r["cloud"] in synthetic]),
        "## Others\n",
        table(common, [r for r in good if r["cloud"] not in synthetic]),
    ]
    bad = [r for r in rows if r["exit"] != "0"]
    if bad:
        text += ["## Without a result\n", table(["cloud", "exit", "seconds", "reason"], bad)]
    return "\n".join(text)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", type=Path)
    parser.add_argument("output", type=Path)
    parser.add_argument("--command", default=str(ROOT / "build/release/bot2nurbs"))
    parser.add_argument("--only", default="", help="clouds whose name has this")
    parser.add_argument("--timeout", type=float, default=300.0)
    arguments = parser.parse_args()
    synthetic = sorted(p for p in (arguments.folder / "synthetic").iterdir() if p.suffix in SUFFIXES)
    others = sorted(p for p in arguments.folder.iterdir() if p.suffix in SUFFIXES)
    rows, cache = [], {}
    with tempfile.TemporaryDirectory() as folder:
        for cloud in synthetic + others:
            if arguments.only not in cloud.name:
                continue
            found = run(arguments.command, cloud, arguments.timeout, Path(folder))
            rows.append(row_of(cloud, *found, cache))
            print(rows[-1], file=sys.stderr, flush=True)
            # Written as it grows: a run over all takes a while.
            arguments.output.write_text(page(rows, {p.name for p in synthetic}))


if __name__ == "__main__":
    main()
