#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Compares the spline schemes on models: writes docs/results/schemes.md.

    scripts/schemes.py [MODELS ...] [--command BOT2NURBS] [--data FOLDER] [--tolerance 0.3]
                       [--output docs/results/schemes.md]

Each model is converted with the schemes peters and full, with the patches of default and to a
tolerance in percent of the diagonal, with --features off and on one thread. Models are names, found
as scripts/tolerance.py finds them. Exit code 1 when a run fails.
"""

import argparse
import json
import subprocess
import sys
import tempfile
from pathlib import Path

from tolerance import ROOT, find_model

DEFAULT = "bunny_11k spot kitten_9k fertility_12k hand_camille 3holes rocker_arm wolf".split()
SCHEMES = ("peters", "full")


def convert(command, model, scheme, tolerance, folder):
    """Cells of a row: patches, kB, CPU seconds, bound, rms, folded patches."""
    target, report = folder / "out.3dm", folder / "report.json"
    report.unlink(missing_ok=True)
    options = ["--tolerance", f"{tolerance:g}%"] if tolerance else []
    run = subprocess.run(
        [command, model, target, "--spline", scheme, "--features", "off", "--threads", "1",
         "--quiet", "--json", report, *options],
        capture_output=True, text=True, check=False,
    )  # fmt: skip
    if run.returncode not in (0, 7):
        return None, run.stderr.strip().splitlines()[-1]
    made = json.loads(report.read_text())
    percent = 100.0 / made["deviation"]["diagonal"]
    seconds = sum(stage["cpu_seconds"] for stage in made["stages"])
    return [
        str(made["brep"]["faces"]),
        f"{target.stat().st_size / 1000:.0f}",
        f"{seconds:.1f}",
        f"{percent * made['deviation']['upper_bound']:.3f}",
        f"{percent * made['deviation']['rms']:.4f}",
        str(made["fit"]["folded_patches"]),
    ], None


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("models", nargs="*", default=DEFAULT)
    parser.add_argument("--command", type=Path, default=ROOT / "build/release/bot2nurbs")
    parser.add_argument("--data", type=Path, default=ROOT / "../shared/data/meshes")
    parser.add_argument("--tolerance", type=float, default=0.3)
    parser.add_argument("--output", type=Path)
    args = parser.parse_args()
    if not args.data.is_dir():
        print(f"schemes.py: no models in {args.data}", file=sys.stderr)
        return 1
    heads = ["model", "scheme", "patches", "kB", "CPU s", "bound %", "rms %", "folded"]
    lines = [
        "# Spline schemes", "",
        "Written by `scripts/schemes.py`: the same models with the schemes `peters` and `full`, `--features off`, one thread. Bound and rms are",
        "percentages of the diagonal; bytes are those of the `.3dm` file.",
    ]
    failed = False
    with tempfile.TemporaryDirectory(prefix="bot2nurbs_") as name:
        for tolerance in (None, args.tolerance):
            lines += ["", f"## {'Patches of default' if tolerance is None else f'To {tolerance:g} %'}", "",
                      "| " + " | ".join(heads) + " |", "|---|---|" + "--:|" * (len(heads) - 2)]
            for model in args.models:
                for scheme in SCHEMES:
                    cells, error = convert(args.command, find_model(args.data, model), scheme,
                                           tolerance, Path(name))
                    failed = failed or error is not None
                    row = [model, scheme] + (cells or [error] + [""] * (len(heads) - 3))
                    lines.append("| " + " | ".join(row) + " |")
                    print(lines[-1], flush=True)
    if args.output:
        args.output.write_text("\n".join(lines) + "\n")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
