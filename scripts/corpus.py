#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Converts models with default options, has the results judged, and writes a table.

    scripts/corpus.py [MODELS ...] [--folders NAME ...] [--output FILE.md]

MODELS are names (bunny_11k) or paths; without any, ten closed models, or with --folders every model
of these folders of ../shared/data/meshes (or of --data). Each becomes a .3dm and a .step file in
build/corpus. The judges of tests/judges, openNURBS on Node and Open CASCADE, read them back. Needs
the release build with tests.

Exit code 0 when every model passes: converted, valid by our own checks and by both judges, solid
where the input is closed, the Euler characteristic of the input, no gap, normals equal to 1e-8
degrees across joins, rms error within --rms percent of the diagonal; or refused because the input
is at fault (exit code 5), with the reason.
"""

import argparse
import json
import os
import subprocess
import sys
import time
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
DEFAULT = (
    "sphere_589 bunny_11k spot hand_camille torus_2k kitten_9k double_torus 3holes femur_g2 "
    "fertility_4k"
).split()
FOLDERS = ("smooth", "genus", "mechanical", "open", "multi")
EXTENSIONS = {".stl", ".obj", ".ply", ".off"}

# Codes of errors that an input can be at fault for.
INPUT_FAULTS = {"empty_input", "bad_geometry", "not_manifold", "not_orientable", "self_intersecting"}
MAX_GAP = 0.0  # Shared coefficients are the same numbers.
MAX_ANGLE = 1e-8  # Degrees: rounding of exact joins.
VOLUME_SHARE = 0.005  # Of the mesh's volume.
TOLERANCE_SHARE = 1e-6  # Of the diagonal: Open CASCADE's largest tolerance.


def find_models(data, names, folders):
    found = {}
    for folder in folders or FOLDERS:
        for path in sorted((data / folder).glob("*")):
            if path.suffix.lower() in EXTENSIONS:
                found.setdefault(path.stem, path)
    if folders and not names:
        return list(found.values())
    models = []
    for name in names or DEFAULT:
        path = found.get(name, Path(name))
        if not path.is_file():
            sys.exit(f"corpus.py: no model {name} in {data}")
        models.append(path)
    return models


def run_measured(arguments, log):
    """Exit code, seconds and peak memory in MiB of a child process."""
    start = time.monotonic()
    with open(log, "w") as errors:
        process = subprocess.Popen(arguments, stdout=errors, stderr=errors)
        _, status, usage = os.wait4(process.pid, 0)
    process.returncode = os.waitstatus_to_exitcode(status)
    return process.returncode, time.monotonic() - start, usage.ru_maxrss / 1024


def run_json(arguments):
    """Exit code and the JSON on standard output; None where there is none."""
    run = subprocess.run(arguments, capture_output=True, text=True)
    try:
        return run.returncode, json.loads(run.stdout)
    except json.JSONDecodeError:
        return run.returncode, None


def judge_3dm(path, closed):
    """What openNURBS says: 'valid' or 'valid solid', or what is wrong; and the sum of the Euler
    characteristics. `closed` says for each B-Rep what it must be."""
    code, verdict = run_json(["node", ROOT / "tests/judges/judge_3dm.mjs", path])
    if code != 0 or not verdict or not verdict["readable"]:
        return "not readable", None
    euler, wrong = 0, set()
    if len(verdict["objects"]) != len(closed):
        return f"holds {len(verdict['objects'])} objects", None
    for brep, solid in zip(verdict["objects"], closed):
        if "faces" not in brep:
            return f"holds a {brep['type']}", None
        euler += brep["vertices"] - brep["edges"] + brep["faces"]
        wrong |= {key for key in ("isValid", "isManifold") if not brep[key]}
        wrong |= {key for key in ("nonmanifoldEdges", "inconsistentEdges") if brep[key]}
        if brep["isSolid"] != solid or (brep["boundaryEdges"] == 0) != solid:
            wrong.add("open" if solid else "closed")
    if wrong:
        return "wrong: " + ", ".join(sorted(wrong)), euler
    return ("valid solid" if all(closed) else "valid"), euler


def judge_occ(judge, path, closed, volume):
    """What Open CASCADE says: 'valid' or 'valid solid', or what is wrong."""
    command = [judge, path, "--solids", str(sum(closed)), "--tolerance-share", str(TOLERANCE_SHARE)]
    if all(closed):
        command += ["--closed", "--volume", repr(volume), "--volume-share", str(VOLUME_SHARE)]
    code, verdict = run_json(command)
    if not verdict or not verdict.get("readable"):
        return "not readable"
    if code != 0:
        return "wrong: " + ", ".join(verdict["failed"])
    return "valid solid" if all(closed) else "valid"


def convert(model, options, judge, work):
    """One row of the table, and what failed."""
    row = {"name": model.stem}
    outputs = [work / (model.stem + extension) for extension in (".3dm", ".step")]
    report_path = work / (model.stem + ".json")
    for path in (*outputs, report_path):
        path.unlink(missing_ok=True)
    code, seconds, memory = run_measured(
        [options.binary, model, *outputs, "--json", report_path], work / (model.stem + ".log")
    )
    row.update(exit=code, seconds=seconds, memory=memory)
    if code != 0:
        lines = (work / (model.stem + ".log")).read_text().splitlines()
        row["verdict"] = next((x for x in reversed(lines) if x.startswith("error")), "no message")
        report = json.loads(report_path.read_text()) if report_path.is_file() else {}
        row["refused"] = report.get("error", {}).get("code") in INPUT_FAULTS
        return row, ([] if row["refused"] else [f"exit code {code}"])

    report = json.loads(report_path.read_text())
    domain, deviation, brep = report["domain"], report["deviation"], report["brep"]
    components = report["components"]
    closed = [c["boundary_loops"] == 0 for c in components]
    euler = sum(2 - 2 * c["genus"] - c["boundary_loops"] for c in components)
    volume = sum(c["volume"] for c in report["input"]["components"])
    opennurbs, result_euler = judge_3dm(outputs[0], closed)
    open_cascade = judge_occ(judge, outputs[1], closed, volume)
    stretch = max(
        c["layout_quality"]["stretch"]["most"] / c["layout_quality"]["stretch"]["median"]
        for c in components
    )
    stage = {s["name"].split(" ")[0]: 0.0 for s in report["stages"]}
    for s in report["stages"]:
        stage[s["name"].split(" ")[0]] += s["cpu_seconds"]
    row.update(
        triangles=report["input"]["faces"], components=len(components), open=closed.count(False),
        genus=sum(c["genus"] for c in components), patches=domain["faces"],
        vertices=domain["vertices"], extraordinary=domain["extraordinary"],
        valences=", ".join(f"{v}: {n}" for v, n in domain["valences"].items() if v != "4"),
        stretch=stretch, features=report["features"],
        max=100 * deviation["max_relative"], rms=100 * deviation["rms_relative"],
        bound=100 * deviation["upper_bound_relative"], bound_share=stage["bound"] / stage["fit"],
        angle=report["continuity"]["max_g1_angle_deg"], gap=report["continuity"]["max_gap"],
        opennurbs=opennurbs, open_cascade=open_cascade,
    )
    failed = []
    for what, good in (
        ("valid", brep["valid"]), ("solid", brep["solid"] == all(closed)),
        ("gap", row["gap"] <= MAX_GAP), ("angle", row["angle"] <= MAX_ANGLE),
        ("Euler characteristic", result_euler == euler), ("rms", row["rms"] <= options.rms),
        ("openNURBS", opennurbs.startswith("valid")),
        ("Open CASCADE", open_cascade.startswith("valid")),
    ):
        if not good:
            failed.append(what)
    return row, failed


def machine():
    try:
        lines = Path("/proc/cpuinfo").read_text().splitlines()
        name = next(x.split(":")[1].strip() for x in lines if x.startswith("model name"))
    except (OSError, StopIteration):
        name = "unknown processor"
    return f"{os.cpu_count()} threads of {name}"


COLUMNS = (  # Heading, alignment, text of a row.
    ("model", "---", lambda r: r["name"]),
    ("triangles", "---:", lambda r: r["triangles"]),
    ("genus", "---:", lambda r: r["genus"]),
    ("patches", "---:", lambda r: r["patches"]),
    ("extraordinary (valence: number)", "---",
     lambda r: f"{r['extraordinary']} of {r['vertices']} ({r['valences']})"),
    ("stretch", "---:", lambda r: f"{r['stretch']:.1f}"),
    ("max %", "---:", lambda r: f"{r['max']:.3f}"),
    ("bound %", "---:", lambda r: f"{r['bound']:.3f}"),
    ("rms %", "---:", lambda r: f"{r['rms']:.4f}"),
    ("bound / fit", "---:", lambda r: f"{r['bound_share']:.2f}"),
    ("join angle °", "---:", lambda r: f"{r['angle']:.1e}"),
    ("seconds", "---:", lambda r: f"{r['seconds']:.1f}"),
    ("peak MiB", "---:", lambda r: f"{r['memory']:.0f}"),
    ("openNURBS", "---", lambda r: r["opennurbs"]),
    ("Open CASCADE", "---", lambda r: r["open_cascade"]),
)
FEATURE_COLUMNS = (
    ("components (open)", "---:", lambda r: f"{r['components']} ({r['open']})"),
    ("sharp edges found", "---:", lambda r: r["features"]["detected_edges"]),
    ("kept", "---:", lambda r: r["features"]["kept_edges"]),
    ("smoothed", "---:", lambda r: r["features"]["smoothed_edges"]),
    ("creases", "---:", lambda r: r["features"]["creases"]),
)


def table(rows, title, columns, version, command):
    good = sum(not row["failed"] for row in rows)
    refused = sum(row.get("refused", False) for row in rows)
    lines = [
        f"# {title}",
        "",
        f"Written by `{command}`; {version}, on {machine()}. {good} of {len(rows)} models pass"
        + (f", {refused} of them by being refused for a fault of the input" if refused else "") + ":",
        "converted to `.3dm` and `.step` in one run, valid (solid where closed), topology kept, no gap, joins within 1e-8 degrees, judged by",
        "openNURBS (`rhino3dm`, reading the `.3dm`) and Open CASCADE (reading the `.step`: BRepCheck valid, closed, outward, volume within",
        f"{100 * VOLUME_SHARE:g} % of the mesh's, tolerance at most 1e-6 of the diagonal). Errors are percentages of the diagonal of the bounding",
        "box, both ways: *max* is attained, *bound* proven, *bound / fit* the CPU time of proving it beside that of the fit. *stretch* is the",
        "largest stretch of a chart beside the median. Seconds and memory are those of the whole run, writing included.",
        "",
        "| " + " | ".join(c[0] for c in columns) + " |",
        "|" + "|".join(c[1] for c in columns) + "|",
    ]
    for r in rows:
        if r["exit"] == 0:
            lines.append("| " + " | ".join(str(c[2](r)) for c in columns) + " |")
    for r in rows:
        if r["exit"] != 0:
            lines += ["", f"* {r['name']}: exit code {r['exit']} after {r['seconds']:.1f} s: {r['verdict']}"]
    failed = [r for r in rows if r["failed"] and r["exit"] == 0]
    if failed:
        lines += ["", "Not passed: " + "; ".join(f"{r['name']} ({', '.join(r['failed'])})" for r in failed) + "."]
    return "\n".join(lines) + "\n"


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("models", nargs="*")
    parser.add_argument("--folders", nargs="+", choices=FOLDERS, help="every model of these")
    parser.add_argument("--data", type=Path, default=ROOT.parent / "shared/data/meshes")
    parser.add_argument("--build", type=Path, default=ROOT / "build/release")
    parser.add_argument("--work", type=Path, default=ROOT / "build/corpus")
    parser.add_argument("--rms", type=float, default=0.5, help="limit in percent (default: 0.5)")
    parser.add_argument("--output", type=Path, help="where to write the table")
    parser.add_argument("--title", default="Closed models, default options")
    parser.add_argument("--with-features", action="store_true", help="columns about sharp edges")
    options = parser.parse_args()

    options.binary = options.build / "bot2nurbs"
    judge = options.build / "tests/judges/judge_occ"
    for program in (options.binary, judge):
        if not program.is_file():
            sys.exit(f"corpus.py: {program} is missing: build the release preset first")
    options.work.mkdir(parents=True, exist_ok=True)
    version = subprocess.run([options.binary, "--version"], capture_output=True, text=True).stdout.strip()
    rows = []
    for model in find_models(options.data, options.models, options.folders):
        row, failed = convert(model, options, judge, options.work)
        row["failed"] = failed
        rows.append(row)
        state = "FAILED: " + ", ".join(failed) if failed else "ok"
        numbers = (
            f"{row['patches']:5} patches  rms {row['rms']:.4f} %  max {row['max']:.3f} %  "
            f"{row['opennurbs']}/{row['open_cascade']}" if row["exit"] == 0 else row["verdict"]
        )
        print(f"{row['name']:24} {row['seconds']:7.1f} s  {numbers}  {state}", flush=True)
    if options.output:
        options.output.parent.mkdir(parents=True, exist_ok=True)
        command = " ".join(
            ["scripts/corpus.py", *options.models]
            + (["--folders", *options.folders] if options.folders else [])
            + (["--with-features"] if options.with_features else [])
        )
        columns = list(COLUMNS)
        if options.with_features:
            columns[5:5] = FEATURE_COLUMNS
        options.output.write_text(table(rows, options.title, columns, version, command))
    return 1 if any(row["failed"] for row in rows) else 0


if __name__ == "__main__":
    sys.exit(main())
