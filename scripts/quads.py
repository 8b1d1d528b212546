#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Converts models over quad meshes of other tools, has the results judged, and writes a table.

    scripts/quads.py [--quadriflow PROGRAM] [--output FILE.md]

Layouts: of ellipse the quads it is published with; of spot the quads its triangles come in, also
coarsened by one step of subdivision; of bunny and rocker arm what QuadriFlow makes of them, if its
PROGRAM is given (https://github.com/hjwdzh/QuadriFlow). Each model is converted over these quads and
over an automatic layout of as many patches; and the quads alone are converted as subdivision cages.
Models come from ../shared/data/meshes, or the folder of --data; files go to build/quads. Needs the
release build with tests, for the judges.

Exit code 0 when every result over quads is valid and solid by our own checks and by openNURBS and
Open CASCADE, with normals equal to 1e-8 degrees.
"""

import argparse
import json
import subprocess
import sys
from pathlib import Path

from corpus import MAX_ANGLE, ROOT, judge_3dm, judge_occ, run_measured


def read_mesh(path):
    """Vertices and faces of an OBJ or OFF file."""
    lines = path.read_text().splitlines()
    if path.suffix == ".obj":
        vertices = [x.split()[1:4] for x in lines if x.startswith("v ")]
        faces = [[int(c.split("/")[0]) - 1 for c in x.split()[1:]]
                 for x in lines if x.startswith("f ")]
        return vertices, faces
    words = " ".join(x.split("#")[0] for x in lines).split()
    count, at = int(words[1]), 4
    vertices = [words[at + 3 * i : at + 3 * i + 3] for i in range(count)]
    at += 3 * count
    faces = []
    while at < len(words):
        size = int(words[at])
        faces.append([int(i) for i in words[at + 1 : at + 1 + size]])
        at += 1 + size
    return vertices, faces


def write_obj(path, vertices, faces):
    lines = ["v " + " ".join(v) for v in vertices]
    lines += ["f " + " ".join(str(i + 1) for i in f) for f in faces]
    path.write_text("\n".join(lines) + "\n")
    return path


def paired(triangles):
    """The quads of triangles 2 k and 2 k + 1, which share an edge."""
    quads = []
    for first, second in zip(triangles[::2], triangles[1::2]):
        opposite = next(v for v in second if v not in first)
        k = next(k for k in range(3) if first[k] not in second)
        quads.append([first[k], first[(k + 1) % 3], opposite, first[(k + 2) % 3]])
    return quads


def coarsened(quads):
    """The quads of which one step of Catmull and Clark's subdivision makes these."""
    at = {}
    for q in quads:
        for k, v in enumerate(q):
            at.setdefault(v, []).append(q[k:] + q[:k])
    # Old vertices, and those of old faces, lie opposite each other in every quad.
    kind = {next(v for v, around in sorted(at.items()) if len(around) != 4): "vertex"}
    pending = list(kind)
    while pending:
        v = pending.pop()
        other = "face" if kind[v] == "vertex" else "vertex"
        for _, _, opposite, _ in at[v]:
            if opposite not in kind:
                kind[opposite] = other
                pending.append(opposite)
            elif kind[opposite] != other:
                sys.exit("quads.py: these quads are not refined ones")
    result = []
    for v in sorted(x for x in kind if kind[x] == "face"):
        step = {left: (opposite, right) for _, left, opposite, right in at[v]}
        edge, quad = min(step), []
        for _ in range(4):
            opposite, edge = step[edge]
            quad.append(opposite)
        result.append(quad)
    return result


def compact(vertices, faces):
    """Without unused vertices."""
    used = sorted({v for f in faces for v in f})
    number = {v: i for i, v in enumerate(used)}
    return [vertices[v] for v in used], [[number[v] for v in f] for f in faces]


def quadriflow(program, model, faces, work):
    """A file of about so many quads; None where there is no program."""
    if not program:
        return None
    source = write_obj(work / f"{model.stem}_triangles.obj", *read_mesh(model))
    result = work / f"{model.stem}_{faces}.obj"
    subprocess.run([program, "-i", source, "-o", result, "-f", str(faces)],
                   check=True, capture_output=True)
    return result


def layouts(data, work, program):
    """Name, mesh, quads and where they come from."""
    smooth = data / "smooth"
    found = [("ellipse", smooth / "ellipse.obj", smooth / "ellipse_quads.obj", "published with it")]
    spot = smooth / "spot.obj"
    vertices, triangles = read_mesh(spot)
    quads = paired(triangles)
    coarse = write_obj(work / "spot_coarse.obj", *compact(vertices, coarsened(quads)))
    found.append(("spot", spot, coarse, "its own quads, coarsened once"))
    for model in (smooth / "bunny_35k_closed.off", data / "mechanical/rocker_arm.obj"):
        made = quadriflow(program, model, 400, work)
        if made:
            found.append((model.stem, model, made, "QuadriFlow, `-f 400`"))
    return found


def convert(arguments, stem, work, binary, judge):
    """A row of numbers, and what failed."""
    outputs = [work / (stem + extension) for extension in (".3dm", ".step")]
    report_path = work / (stem + ".json")
    for path in (*outputs, report_path):
        path.unlink(missing_ok=True)
    log = work / (stem + ".log")
    code, _, _ = run_measured([binary, *arguments, *outputs, "--json", report_path], log)
    if code != 0:
        lines = [x for x in log.read_text().splitlines() if x.startswith("error")]
        return {"error": lines[-1] if lines else f"exit code {code}"}, ["exit"]
    report = json.loads(report_path.read_text())
    closed = [c["boundary_loops"] == 0 for c in report["components"]]
    opennurbs, _ = judge_3dm(outputs[0], closed)
    volume = abs(report["brep"]["volume"])
    occ = judge_occ(judge, outputs[1], closed, volume)
    row = {
        "patches": report["domain"]["faces"],
        "extraordinary": report["domain"]["extraordinary"],
        "rms": 100 * report["deviation"]["rms_relative"],
        "max": 100 * report["deviation"]["max_relative"],
        "angle": report["continuity"]["max_g1_angle_deg"],
        "stretch": report["components"][0]["layout_quality"]["stretch"]["median"],
        "valid": f"{opennurbs} / {occ}",
    }
    good = {
        "valid": report["brep"]["valid"], "solid": report["brep"]["solid"],
        "angle": row["angle"] <= MAX_ANGLE, "openNURBS": opennurbs == "valid solid",
        "Open CASCADE": occ == "valid solid",
    }
    return row, [what for what, passed in good.items() if not passed]


def line(name, layout, row):
    if "error" in row:
        return f"| {name} | {layout} | | | {row['error']} | | | | |"
    return (
        f"| {name} | {layout} | {row['patches']} | {row['extraordinary']} | {row['rms']:.4f} "
        f"| {row['max']:.3f} | {row['angle']:.1e} | {row['stretch']:.2f} | "
        f"{row['valid']} |"
    )


def table(rows, cages, version):
    head = [
        "| model | layout | patches | extraordinary vertices | rms % | max % | join angle ° "
        "| median stretch | openNURBS / Open CASCADE |",
        "|---|---|---:|---:|---:|---:|---:|---:|---|",
    ]
    return "\n".join([
        "# Layouts of quad meshes, and cages",
        "",
        f"Written by `scripts/quads.py` with {version}. Errors are percentages of the diagonal,",
        "sampled both ways. Stretch is the L2 stretch of a patch's chart, 1 for a similarity.",
        "",
        "## `--layout quads=FILE` beside the automatic layout of as many patches",
        "", *head, *rows,
        "",
        "## `--cage`: the same quads as subdivision cages",
        "",
        "Errors are those from the limit surface of Catmull and Clark's subdivision.",
        "", *head, *cages, "",
    ])


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--data", type=Path, default=ROOT.parent / "shared/data/meshes")
    parser.add_argument("--build", type=Path, default=ROOT / "build/release")
    parser.add_argument("--work", type=Path, default=ROOT / "build/quads")
    parser.add_argument("--quadriflow", help="the program")
    parser.add_argument("--output", type=Path, help="where to write the table")
    options = parser.parse_args()
    binary = options.build / "bot2nurbs"
    judge = options.build / "tests/judges/judge_occ"
    for program in (binary, judge):
        if not program.is_file():
            sys.exit(f"quads.py: {program} is missing: build the release preset first")
    options.work.mkdir(parents=True, exist_ok=True)
    version = subprocess.run([binary, "--version"], capture_output=True, text=True).stdout.strip()
    rows, cages, all_good = [], [], True
    for name, mesh, quads, origin in layouts(options.data, options.work, options.quadriflow):
        count = len(read_mesh(quads)[1])
        runs = (
            (rows, f"quads: {origin}", [mesh, "--layout", f"quads={quads}"], "_quads", True),
            (rows, f"automatic, `--patches {count}`", [mesh, "--patches", str(count)], "_eck", False),
            (cages, f"cage: {origin}", ["--cage", quads], "_cage", True),
        )
        for lines, layout, arguments, ending, counts in runs:
            row, failed = convert(arguments, name + ending, options.work, binary, judge)
            lines.append(line(name, layout, row))
            all_good = all_good and not (counts and failed)
            print(lines[-1], "FAILED: " + ", ".join(failed) if failed else "", flush=True)
    if options.output:
        options.output.write_text(table(rows, cages, version))
    return 0 if all_good else 1


if __name__ == "__main__":
    sys.exit(main())
