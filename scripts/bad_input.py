#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""Runs the command on every broken mesh of the shared data and writes docs/results/bad_input.md.

    scripts/bad_input.py [--binary FILE] [--data FOLDER] [--only TEXT] [--limit 60]

Each file must end within the limit, on the clock and with all processors, in a sound result (valid,
solid, exact joins) with every repair stated, or in exit code 3, 5 or 6 with a message and without any
file left behind. Exit code 0 when all do.
"""

import argparse
import os
import sys
from pathlib import Path

import verdict

# Defects of an input that a sound result may not pass over in silence: the code of the check and
# the codes of repairs or warnings of which one must be stated.
STATED = {
    "repeated_vertex": {"repeated_vertex"},
    "duplicate_face": {"duplicate_face"},
    "inconsistent_orientation": {"oriented"},
    "inward_component": {"turned_outward", "cavity"},
    "self_intersection": {"self_intersections", "self_intersection"},
    "unreferenced_vertex": {"unused_vertex"},
    "zero_area": {"repeated_vertex", "collapsed_edge", "flipped_cap", "zero_area_kept", "weld"},
}
THREADS = len(os.sched_getaffinity(0))


def judge(binary, path, limit):
    run = verdict.convert(binary, path, THREADS * limit, THREADS, clock=limit)
    found = verdict.faults(run)
    if not found and run.code == 0:
        seen = verdict.check(binary, path, limit)
        said = set(run.repairs) | set(run.warnings)
        for defect in seen.report.get("defects", []):
            wanted = STATED.get(defect["code"])
            if wanted and not wanted & said:
                found.append(f"{defect['code']} is not stated")
    return path, run, found


def describe(run):
    if run.code != 0:
        return run.message.replace(str(Path(run.command[1]).parent) + "/", "")
    said = run.repairs + [w for w in run.warnings if w not in run.repairs]
    rms = [c["deviation"]["rms_relative"] for c in run.report["components"]]
    text = ", ".join(said) or "nothing to repair"
    return f"{text}; {len(rms)} component(s), rms {100 * max(rms):.2g} %"


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--binary", help="default: the newest build/*/bot2nurbs")
    parser.add_argument("--data", default=verdict.ROOT.parent / "shared/data/meshes/broken", type=Path)
    parser.add_argument("--only", default="", help="files whose path contains this text; no report")
    parser.add_argument("--limit", type=float, default=60.0, help="seconds on the clock for each file")
    arguments = parser.parse_args()
    if not arguments.data.is_dir():
        print(f"skipped: {arguments.data} is absent")
        return 0
    binary = verdict.find_binary(arguments.binary)
    files = sorted(
        p
        for p in arguments.data.rglob("*")
        if p.is_file() and p.suffix != ".tsv" and arguments.only in str(p)
    )

    results = []
    for path in files:
        path, run, found = judge(binary, path, arguments.limit)
        results.append((path, run, found))
        state = "FAIL" if found else "ok"
        words = "; ".join(found) if found else describe(run)
        print(f"{state:4} {run.code:4} {run.clock:6.1f} s  {path.name}: {words}", flush=True)

    failures = [r for r in results if r[2]]
    if not arguments.only:
        classes = {}
        for _, run, found in results:
            kind = "failure" if found else verdict.REFUSALS.get(run.code, "sound")
            classes[kind] = classes.get(kind, 0) + 1
        lines = [
            "# Bad input",
            "",
            "Written by `scripts/bad_input.py`: every broken mesh of the test corpus through the whole",
            f"command. A verdict is due within {arguments.limit:.0f} s on {THREADS} processors: a sound result (valid, solid where closed, joins within",
            f"{verdict.MAX_ANGLE_DEG:g} degrees, no gap, rms below {100 * verdict.MAX_RMS:g} % of the diagonal) with the repairs stated, or exit code",
            "3, 5 or 6 with a message and no file left behind. Anything else is a failure. At n diagonals from the",
            f"origin the rounding of the coordinates alone turns normals by up to {verdict.FAR_ANGLE_DEG:g} n degrees (more where a body is thin), which is allowed.",
            "",
        ]
        order = ["sound", *verdict.REFUSALS.values(), "failure"]
        lines += verdict.table(["verdict", "files"], [[k, classes.get(k, 0)] for k in order])
        lines += ["", f"Longest: {max(r[1].clock for r in results):.1f} s.", ""]
        lines += verdict.table(
            ["file", "exit", "verdict", "what was said"],
            [
                [
                    path.relative_to(arguments.data),
                    run.code,
                    "**failure**" if found else verdict.REFUSALS.get(run.code, "sound"),
                    "; ".join(found) if found else describe(run),
                ]
                for path, run, found in results
            ],
        )
        target = verdict.ROOT / "docs/results/bad_input.md"
        target.parent.mkdir(parents=True, exist_ok=True)
        target.write_text("\n".join(lines) + "\n")
    print(f"{len(results)} files, {len(failures)} failures")
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main())
