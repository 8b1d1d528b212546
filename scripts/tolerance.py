#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Converts models to tolerances, has the results checked, and writes a table.

    scripts/tolerance.py [MODELS ...] [--tolerances 1 0.3 0.1] [--output FILE.md]

MODELS are names (bunny_11k); without any those of docs/results/tolerance.md. Models come from
../shared/data/meshes, or the folder of --data. Each becomes a .3dm file in build/tolerance, with
--features off. Needs the release build. Tolerances are percentages of the diagonal.

Exit code 0 when every result is valid, closed and G1, and every tolerance is met.
"""

import argparse
import json
import subprocess
import sys
import time
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
DEFAULT = (
    "bunny_11k spot kitten_9k fertility_12k hand_camille 3holes rocker_arm armadillo_15k wolf "
    "knot1 bone_femur femur_g2 igea_134k_tristrips"
).split()
FOLDERS = ("smooth", "genus", "mechanical")
MAX_ANGLE = 1e-8  # Degrees: rounding of exact joins.
CONTROL_POINTS = 144  # Of a patch as .3dm has it.


def find_model(data, name):
    for folder in FOLDERS:
        for path in sorted((data / folder).glob(name + ".*")):
            return path
    sys.exit(f"tolerance.py: no model {name} in {data}")


def convert(command, model, tolerance, seconds):
    """The report of a conversion, its time, or the reason why there is none."""
    folder = ROOT / "build/tolerance"
    folder.mkdir(parents=True, exist_ok=True)
    target = folder / f"{model.stem}_{tolerance:g}"
    start = time.monotonic()
    try:
        run = subprocess.run(
            [
                command, model, f"{target}.3dm", "--features", "off", "--quiet",
                "--tolerance", f"{tolerance:g}%", "--json", f"{target}.json",
            ],
            capture_output=True, text=True, timeout=seconds,
        )  # fmt: skip
    except subprocess.TimeoutExpired:
        return None, f"no result within {seconds} s"
    if run.returncode not in (0, 7):
        return None, run.stderr.strip().splitlines()[-1]
    report = json.loads(Path(f"{target}.json").read_text())
    report["wall"] = time.monotonic() - start
    return report, None


def row(model, tolerance, report, failure):
    if failure:
        return f"| {model.stem} | {tolerance:g} | {failure} |" + " |" * 11, False
    percent = 100.0 / report["deviation"]["diagonal"]
    result = report["components"][0]["tolerance"]
    angle = report["continuity"]["max_g1_angle_deg"]
    good = report["brep"]["valid"] and angle <= MAX_ANGLE and report["continuity"]["max_gap"] == 0
    memory = max(stage["peak_rss_mib"] for stage in report["stages"])
    cells = [
        model.stem,
        f"{tolerance:g}",
        result["termination"],
        report["brep"]["faces"],
        CONTROL_POINTS * report["brep"]["faces"],
        len(result["rounds"]),
        f"{percent * result['upper_bound']:.3f}",
        f"{percent * report['deviation']['rms']:.4f}",
        report["domain"]["max_valence"],
        report["fit"]["folded_patches"],
        f"{angle:.1e}",
        "solid" if report["brep"]["solid"] else "valid" if report["brep"]["valid"] else "not valid",
        f"{report['wall']:.1f}",
        f"{memory:.0f}",
    ]
    return "| " + " | ".join(map(str, cells)) + " |", good and result["tolerance_met"]


def table(rows, met):
    return f"""# Refinement to a tolerance

Written by `scripts/tolerance.py`; `--features off`, the spline scheme of default. {met} of {len(rows)} runs end within their
tolerance, valid, without gaps and with joins within {MAX_ANGLE:g} degrees. Tolerance, bound and rms are percentages of the diagonal of the
bounding box; the bound is proven, both ways, of the surface as written (`docs/algorithms/deviation.md`). Control points are those of the
`.3dm` file; *folded* patches face away from the mesh somewhere. Seconds are of two cores that others use too: only their order of magnitude means something.

![Patches against the proven distance](../images/tolerance.png)

Drawn by `scripts/plot_tolerance.py`.

| model | tolerance % | termination | patches | control points | rounds | bound % | rms % | largest valence | folded | join angle ° | B-Rep | seconds | peak MiB |
|---|---:|---|---:|---:|---:|---:|---:|---:|---:|---:|---|---:|---:|
""" + "\n".join(rows) + "\n"


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("models", nargs="*")
    parser.add_argument("--tolerances", nargs="+", type=float, default=[1.0, 0.3, 0.1])
    parser.add_argument("--data", type=Path, default=ROOT / "../shared/data/meshes")
    parser.add_argument("--command", type=Path, default=ROOT / "build/release/bot2nurbs")
    parser.add_argument("--seconds", type=float, default=600.0, help="for one conversion, at most")
    parser.add_argument("--output", type=Path)
    options = parser.parse_args()

    rows, met = [], 0
    for name in options.models or DEFAULT:
        model = find_model(options.data, name)
        for tolerance in options.tolerances:
            line, good = row(
                model, tolerance, *convert(options.command, model, tolerance, options.seconds)
            )
            print(line, flush=True)
            rows.append(line)
            met += good
            if options.output:
                options.output.write_text(table(rows, met))
    return 0 if met == len(rows) else 1


if __name__ == "__main__":
    sys.exit(main())
