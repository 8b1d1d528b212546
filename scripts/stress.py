#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""Converts random closed surfaces and writes docs/results/stress.md.

    scripts/stress.py [--count 500] [--first-seed 0] [--jobs 2] [--binary FILE] [--limit 300]
                      [--fewest 300] [--most 30000] [--keep FOLDER] [--results FILE] [--minutes M]
    scripts/stress.py --make SEED FILE.off

Every mesh follows from its seed and the two sizes (see random_mesh.py). Each run must end within
the limit with exit code 0 in a valid solid of the genus of the mesh, exact at its joins and near
the mesh; joins that are not exact must be so for the same mesh at the origin, where coordinates are
not rounded so coarsely. A mesh that fails is kept with the command that repeats it. Exit code 0 when all are sound.
With --results each result is added to a file, and a seed that is in it is not run again, so that a
long campaign can be cut in parts (--minutes); the report is always about all results there are. The
file is of one binary with one choice of sizes and limit: another one is refused.
Needs numpy (Debian: python3-numpy).
"""

import argparse
import dataclasses
import hashlib
import json
import shlex
import sys
import tempfile
import time
from collections import Counter
from concurrent.futures import ProcessPoolExecutor, as_completed
from pathlib import Path

import random_mesh
import verdict


def crossing(binary, limit):
    """Asks the command whether faces of a mesh cross."""

    def ask(mesh):
        with tempfile.TemporaryDirectory(prefix="bot2nurbs_") as folder:
            path = Path(folder) / "mesh.off"
            random_mesh.write_off(path, mesh)
            run = verdict.check(binary, path, limit)
        if "input" not in run.report:
            raise RuntimeError(f"no report of the check: {run.code} {run.message}")
        return run.report["input"]["self_intersecting_pairs"] > 0

    return ask


def sound_at_origin(binary, mesh, limit):
    """Whether the mesh, moved so that its middle is the origin, has a sound result: then what is
    wrong with its joins where it was is how coarse coordinates are there."""
    middle = (mesh.vertices.min(axis=0) + mesh.vertices.max(axis=0)) / 2
    with tempfile.TemporaryDirectory(prefix="bot2nurbs_") as folder:
        path = Path(folder) / "mesh.off"
        random_mesh.write_off(path, dataclasses.replace(mesh, vertices=mesh.vertices - middle))
        return not verdict.faults(verdict.convert(binary, path, limit), [mesh.genus])


def trial(seed, binary, keep, fewest, most, limit):
    """One seed from the mesh to the verdict."""
    result = {"seed": seed, "faces": 0, "genus": 0, "recipe": "", "class": "", "why": ""}
    path = keep / f"seed_{seed}.off"
    try:
        mesh = random_mesh.make(seed, fewest, most, crossing(binary, limit))
    except RuntimeError as error:
        result.update({"class": "check failed", "why": str(error)})
        return result
    random_mesh.write_off(path, mesh)
    result.update(faces=len(mesh.triangles), genus=mesh.genus, recipe=", ".join(mesh.recipe))
    run = verdict.convert(binary, path, limit)
    found = verdict.faults(run, [mesh.genus])
    rounded = len(found) == 1 and "normals differ" in found[0] and sound_at_origin(binary, mesh, limit)
    result["seconds"] = run.seconds
    if run.code == 0 and (rounded or not found):
        (c,) = run.report["components"]
        result.update(
            patches=c["brep"]["faces"],
            valence=c["domain"]["max_valence"],
            rms=c["deviation"]["rms_relative"],
            max=c["deviation"]["max_relative"],
            angle=c["continuity"]["max_g1_angle_deg"],
            fallbacks=c.get("layout", {}).get("notes", []),
        )
    if run.hang:
        result["class"] = "hang"
    elif run.code < 0:
        result["class"] = "crash"
    elif run.code != 0:
        result["class"] = f"exit code {run.code}"
        found.append(run.message)
    elif rounded:
        result["class"] = "sound, joins rounded far from the origin"
    elif found:
        result["class"] = "unsound"
    elif "self_intersection" in run.warnings:
        result["class"] = "sound, crossing input (warned)"
    else:
        result["class"] = "sound"
    result["why"] = "; ".join(found).replace(str(keep) + "/", "")
    if result["class"].startswith("sound"):
        path.unlink()
    else:
        command = [run.command[0], str(path), str(keep / f"seed_{seed}.3dm"), *run.command[3:]]
        (keep / f"seed_{seed}.txt").write_text(shlex.join(command) + "\n" + result["why"] + "\n")
    return result


def report(results, arguments):
    """The results as Markdown."""
    classes = Counter(r["class"] for r in results)
    sound = [r for r in results if r["class"].startswith("sound")]
    bad = [r for r in results if not r["class"].startswith("sound")]
    seeds = sorted(r["seed"] for r in results)
    lines = [
        "# Random stress",
        "",
        "Written by `scripts/stress.py`: closed surfaces of genus 0 to 8 made from seeds (level sets, cubes;",
        "stretched, displaced, thinned out to slivers, with needles of 1:1000 and caps, turned, scaled by 1e-6",
        "to 1e6, far from the origin) through the whole command.",
        f"{len(seeds)} seeds of {seeds[0]} to {seeds[-1]}, {arguments.fewest} to {arguments.most} triangles before needles and caps, "
        f"at most {arguments.limit:.0f} s of one processor each.",
        "",
    ]
    lines += verdict.table(["verdict", "meshes"], classes.most_common())
    if sound:
        rows = []
        for name, key, form in (
            ("rms, of the diagonal", "rms", lambda x: f"{100 * x:.3g} %"),
            ("max, of the diagonal", "max", lambda x: f"{100 * x:.3g} %"),
            ("angle between normals at joins, degrees", "angle", lambda x: f"{x:.2g}"),
            ("valence", "valence", str),
            ("patches", "patches", str),
            ("seconds of one processor", "seconds", lambda x: f"{x:.1f}"),
            ("triangles", "faces", str),
        ):
            ranked = sorted(sound, key=lambda r: r[key])
            middle, worst = ranked[len(ranked) // 2], ranked[-1]
            rows.append([name, form(middle[key]), form(worst[key]), worst["seed"]])
        lines += ["", "Of the sound ones:", ""]
        lines += verdict.table(["number", "median", "largest", "seed of the largest"], rows)
        genera = Counter(r["genus"] for r in sound)
        lines += ["", "Genus: " + ", ".join(f"{g} ({n} meshes)" for g, n in sorted(genera.items())) + "."]
        notes = Counter(n for r in sound for n in r["fallbacks"])
        if notes:
            lines += ["", "What the layout noted:", ""]
            lines += verdict.table(["note", "times"], notes.most_common(20))
    lines += ["", "## Failures", ""]
    if bad:
        lines += verdict.table(
            ["seed", "verdict", "triangles", "genus", "made by", "why"],
            [[r["seed"], r["class"], r["faces"], r["genus"], r["recipe"], r["why"]] for r in bad],
        )
    else:
        lines.append("None.")
    return "\n".join(lines) + "\n"


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--count", type=int, default=500)
    parser.add_argument("--first-seed", type=int, default=0)
    parser.add_argument("--jobs", type=int, default=2)
    parser.add_argument("--binary", help="default: the newest build/*/bot2nurbs")
    parser.add_argument("--limit", type=float, default=300.0, help="seconds of processor time each")
    parser.add_argument("--fewest", type=int, default=300, help="triangles")
    parser.add_argument("--most", type=int, default=30000, help="triangles")
    parser.add_argument("--keep", type=Path, help="folder for meshes that fail (default: a new one)")
    parser.add_argument("--make", nargs=2, metavar=("SEED", "FILE"), help="only write a mesh")
    parser.add_argument("--results", type=Path, help="JSON lines, read first and added to")
    parser.add_argument("--minutes", type=float, help="no more seeds are begun soon after this time")
    parser.add_argument("--report", type=Path, default=verdict.ROOT / "docs/results/stress.md")
    arguments = parser.parse_args()
    binary = verdict.find_binary(arguments.binary)
    if arguments.make:
        ask = crossing(binary, arguments.limit)
        mesh = random_mesh.make(int(arguments.make[0]), arguments.fewest, arguments.most, ask)
        random_mesh.write_off(arguments.make[1], mesh)
        print(f"{len(mesh.triangles)} triangles, genus {mesh.genus}: {', '.join(mesh.recipe)}")
        return 0
    keep = arguments.keep or Path(tempfile.mkdtemp(prefix="bot2nurbs_stress_"))
    keep.mkdir(parents=True, exist_ok=True)
    start = time.monotonic()
    results = []
    campaign = {
        "binary": hashlib.sha256(Path(binary).read_bytes()).hexdigest(),
        "sizes": [arguments.fewest, arguments.most],
        "limit": arguments.limit,
    }
    if arguments.results and arguments.results.exists():
        # A line that was cut off is left out, its seed runs again.
        lines = arguments.results.read_text().split("\n")[:-1]
        if lines and json.loads(lines[0]) != campaign:
            sys.exit(f"stress.py: {arguments.results} is of another binary, other sizes or another limit")
        results = [json.loads(line) for line in lines[1:]]
        arguments.results.write_text("".join(line + "\n" for line in lines))
    if arguments.results and not (arguments.results.exists() and arguments.results.stat().st_size):
        arguments.results.write_text(json.dumps(campaign) + "\n")
    known = {r["seed"] for r in results}
    seeds = range(arguments.first_seed, arguments.first_seed + arguments.count)
    with ProcessPoolExecutor(arguments.jobs) as pool:
        tasks = [
            pool.submit(trial, s, binary, keep, arguments.fewest, arguments.most, arguments.limit)
            for s in seeds
            if s not in known
        ]
        for task in as_completed(tasks):
            if task.cancelled():
                continue
            r = task.result()
            results.append(r)
            if arguments.results:
                with arguments.results.open("a") as lines:
                    lines.write(json.dumps(r) + "\n")
            if arguments.minutes and time.monotonic() - start > 60 * arguments.minutes:
                for other in tasks:
                    other.cancel()
            numbers = f"rms {100 * r['rms']:.3f} %, max {100 * r['max']:.2f} %" if "rms" in r else ""
            print(
                f"{r['seed']:5} {r['class']:12} {r['faces']:6} faces, genus {r['genus']}, "
                f"{r.get('seconds', 0):6.1f} s, {numbers} [{r['recipe']}] {r['why']}",
                flush=True,
            )
    results.sort(key=lambda r: r["seed"])
    arguments.report.parent.mkdir(parents=True, exist_ok=True)
    arguments.report.write_text(report(results, arguments))
    failed = sum(not r["class"].startswith("sound") for r in results)
    print(f"{len(results)} meshes, {failed} failures, {time.monotonic() - start:.0f} s")
    if failed:
        print(f"those of this run are kept in {keep}")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
