#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Converts closed models with default options, has the results judged, and writes a table.

    scripts/corpus.py [MODELS ...] [--all] [--output FILE.md]

MODELS are names (bunny_11k) or paths; without any the ten models of docs/results/closed.md, with
--all every model of the folders smooth and genus. Models come from ../shared/data/meshes, or the
folder of --data. Each becomes a .3dm and a .step file in build/corpus. The judges of tests/judges,
openNURBS on Node and Open CASCADE, read them back. Needs the release build with tests.

Exit code 0 when every model passes: converted, valid and solid by our own checks and by both
judges, the genus of the input, no gap, normals equal to 1e-8 degrees, rms error within --rms
percent of the diagonal.
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
FOLDERS = ("smooth", "genus")
EXTENSIONS = {".stl", ".obj", ".ply", ".off"}

MAX_GAP = 0.0  # Shared coefficients are the same numbers.
MAX_ANGLE = 1e-8  # Degrees: rounding of exact joins.
VOLUME_SHARE = 0.005  # Of the mesh's volume.
TOLERANCE_SHARE = 1e-6  # Of the diagonal: Open CASCADE's largest tolerance.


def find_models(data, names, everything):
    found = {}
    for folder in FOLDERS:
        for path in sorted((data / folder).glob("*")):
            if path.suffix.lower() in EXTENSIONS:
                found[path.stem] = path
    if everything:
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


def judge_3dm(path):
    """What openNURBS says: 'valid solid', or what is wrong; and the sum of the genera."""
    code, verdict = run_json(["node", ROOT / "tests/judges/judge_3dm.mjs", path])
    if code != 0 or not verdict or not verdict["readable"]:
        return "not readable", None
    genus, wrong = 0, []
    for brep in verdict["objects"]:
        if "faces" not in brep:
            return f"holds a {brep['type']}", None
        genus += 1 - (brep["vertices"] - brep["edges"] + brep["faces"]) // 2
        wrong += [key for key in ("isValid", "isSolid", "isManifold") if not brep[key]]
        wrong += [
            key for key in ("boundaryEdges", "nonmanifoldEdges", "inconsistentEdges") if brep[key]
        ]
    return ("wrong: " + ", ".join(sorted(set(wrong))) if wrong else "valid solid"), genus


def judge_occ(judge, path, solids, volume):
    """What Open CASCADE says: 'valid solid', or what is wrong."""
    code, verdict = run_json(
        [judge, path, "--solids", str(solids), "--closed", "--volume", repr(volume),
         "--volume-share", str(VOLUME_SHARE), "--tolerance-share", str(TOLERANCE_SHARE)]
    )
    if not verdict or not verdict.get("readable"):
        return "not readable"
    return "valid solid" if code == 0 else "wrong: " + ", ".join(verdict["failed"])


def convert(model, binary, judge, work, rms_limit):
    """One row of the table, and what failed."""
    row = {"name": model.stem}
    _, checked = run_json([binary, "--check", model, "--quiet", "--json", "-"])
    outputs = [work / (model.stem + extension) for extension in (".3dm", ".step")]
    report_path = work / (model.stem + ".json")
    for path in (*outputs, report_path):
        path.unlink(missing_ok=True)
    code, seconds, memory = run_measured(
        [binary, model, *outputs, "--json", report_path], work / (model.stem + ".log")
    )
    row.update(exit=code, seconds=seconds, memory=memory)
    if code != 0 or not checked:
        lines = (work / (model.stem + ".log")).read_text().splitlines()
        row["verdict"] = next((x for x in reversed(lines) if x.startswith("error")), "no message")
        return row, [f"exit code {code}"]

    report = json.loads(report_path.read_text())
    domain, deviation, brep = report["domain"], report["deviation"], report["brep"]
    components = report["input"]["components"]
    genus = sum(c["genus"] for c in components)
    # A mesh that is inside out is turned, so the result's volume is positive.
    volume = sum(abs(c["volume"]) for c in checked["components"])
    opennurbs, result_genus = judge_3dm(outputs[0])
    open_cascade = judge_occ(judge, outputs[1], len(components), volume)
    row.update(
        triangles=report["input"]["faces"], genus=genus, patches=domain["faces"],
        extraordinary=domain["extraordinary"],
        valences=", ".join(f"{v}: {n}" for v, n in domain["valences"].items() if v != "4"),
        max=100 * deviation["max_relative"], rms=100 * deviation["rms_relative"],
        angle=report["continuity"]["max_g1_angle_deg"], gap=report["continuity"]["max_gap"],
        opennurbs=opennurbs, open_cascade=open_cascade,
    )
    failed = []
    for what, good in (
        ("valid", brep["valid"]), ("solid", brep["solid"]),
        ("gap", row["gap"] <= MAX_GAP), ("angle", row["angle"] <= MAX_ANGLE),
        ("genus", result_genus == genus), ("rms", row["rms"] <= rms_limit),
        ("openNURBS", opennurbs == "valid solid"), ("Open CASCADE", open_cascade == "valid solid"),
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


def table(rows, version, command):
    good = sum(not row["failed"] for row in rows)
    lines = [
        "# Closed models, default options",
        "",
        f"Written by `{command}`; {version}, on {machine()}. {good} of {len(rows)} models pass:",
        "converted to `.3dm` and `.step` in one run, valid and solid, genus kept, no gap, joins within 1e-8 degrees, judged by",
        "openNURBS (`rhino3dm`, reading the `.3dm`) and Open CASCADE (reading the `.step`: BRepCheck valid, closed, outward, volume within",
        f"{100 * VOLUME_SHARE:g} % of the mesh's, tolerance at most 1e-6 of the diagonal). Errors are percentages of the diagonal of the bounding",
        "box, sampled from both sides. Seconds and memory are those of the whole run, writing included.",
        "",
        "| model | triangles | genus | patches | extraordinary vertices (valence: number) | max % | rms % | join angle ° | seconds | peak MiB | openNURBS | Open CASCADE |",
        "|---|---:|---:|---:|---|---:|---:|---:|---:|---:|---|---|",
    ]
    for r in rows:
        if r["exit"] != 0:
            lines.append(
                f"| {r['name']} | | | | exit {r['exit']}: {r['verdict']} | | | | {r['seconds']:.1f} "
                f"| {r['memory']:.0f} | | |"
            )
            continue
        lines.append(
            f"| {r['name']} | {r['triangles']} | {r['genus']} | {r['patches']} "
            f"| {r['extraordinary']} ({r['valences']}) | {r['max']:.3f} | {r['rms']:.4f} "
            f"| {r['angle']:.1e} | {r['seconds']:.1f} | {r['memory']:.0f} | {r['opennurbs']} "
            f"| {r['open_cascade']} |"
        )
    return "\n".join(lines) + "\n"


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("models", nargs="*")
    parser.add_argument("--all", action="store_true", help="every model of smooth and genus")
    parser.add_argument("--data", type=Path, default=ROOT.parent / "shared/data/meshes")
    parser.add_argument("--build", type=Path, default=ROOT / "build/release")
    parser.add_argument("--work", type=Path, default=ROOT / "build/corpus")
    parser.add_argument("--rms", type=float, default=0.5, help="limit in percent (default: 0.5)")
    parser.add_argument("--output", type=Path, help="where to write the table")
    options = parser.parse_args()

    binary = options.build / "bot2nurbs"
    judge = options.build / "tests/judges/judge_occ"
    for program in (binary, judge):
        if not program.is_file():
            sys.exit(f"corpus.py: {program} is missing: build the release preset first")
    options.work.mkdir(parents=True, exist_ok=True)
    version = subprocess.run([binary, "--version"], capture_output=True, text=True).stdout.strip()
    rows = []
    for model in find_models(options.data, options.models, options.all):
        row, failed = convert(model, binary, judge, options.work, options.rms)
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
        command = "scripts/corpus.py" + (" --all" if options.all else "")
        options.output.write_text(table(rows, version, command))
    return 1 if any(row["failed"] for row in rows) else 0


if __name__ == "__main__":
    sys.exit(main())
