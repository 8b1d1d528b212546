#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Measures the time and memory of bot2nurbs on a ladder of models.

    bench/bench.py [--binary build/release/bot2nurbs] [--data ../shared/data/meshes]
                   [--quadriflow PATH] [--models bunny_3k,igea_134k] [--threads 1,2]
                   [--repeat N] [--tolerance 0.3] [--json bench.json]
                   [--table docs/results/bench.md]

Every run reads a mesh and writes a .3dm file. The JSON has, for each run, its stages as the report
gives them, and the processor time, wall time and peak memory the kernel counted; the table is made
of it. Of repeated runs the one with the least processor time counts: other work on the machine
only ever adds. --quadriflow names the command of QuadriFlow (github.com/hjwdzh/QuadriFlow), which
then makes 200 quads of the 70k-triangle bunny between the runs of ours; without it that target is
left out. With --tolerance every run refines to that many percent of the diagonal, which has targets
of its own. Exit code 1 when a run fails or writes other bytes on other threads; a missed target is
shown in the table and is no failure, as times depend on the machine and its load.
"""

import argparse
import array
import datetime
import hashlib
import json
import math
import os
import platform
import shutil
import subprocess
import sys
import tempfile
import time
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent

# The ladder: name -> (file below the data folder, times every triangle is cut in four).
LADDER = {
    "bunny_3k": ("smooth/bunny_3k.off", 0),
    "bunny_11k": ("smooth/bunny_11k.obj", 0),
    "bunny_35k_closed": ("smooth/bunny_35k_closed.off", 0),
    "igea_134k": ("smooth/igea_134k_tristrips.ply", 0),
    "igea_134k_split": ("smooth/igea_134k_tristrips.ply", 1),
}
COMPARED = "bunny_35k_closed"
LARGEST = "igea_134k_split"
QUADRIFLOW_QUADS = 200

# What the project promises.
MOST_QUADRIFLOW_TIMES = 2.0
MOST_COMPARED_MIB = 400.0
MOST_EXPONENT = 1.2
MOST_LARGEST_MIB = 3 * 1024.0
LEAST_SPEEDUP = 1.5
# With --tolerance 0.3.
MOST_TOLERANCE_SECONDS = 25.0
MOST_TOLERANCE_MIB = 4 * 1024.0
# Other work running on this share of a core and more makes wall times of two threads doubtful.
IDLE_LOAD = 0.3


# --- meshes ------------------------------------------------------------------------------------


def read_ply_strips(path):
    """Positions (flat) and triangles of a binary PLY file with one list of triangle strips."""
    data = path.read_bytes()
    end = data.index(b"end_header\n") + len(b"end_header\n")
    count = 0
    for line in data[:end].decode("ascii").splitlines():
        word = line.split()
        if word[:2] == ["element", "vertex"]:
            count = int(word[2])
    positions = array.array("f", data[end : end + 12 * count])
    strip = array.array("i", data[end + 12 * count :][4:])
    triangles = []
    start = 0
    for i, v in enumerate(strip):
        if v < 0:
            start = i + 1
        elif i - start >= 2:
            a, b = strip[i - 2], strip[i - 1]
            triangles.append((b, a, v) if (i - start) % 2 else (a, b, v))
    return positions, [t for t in triangles if len(set(t)) == 3]


def read_off(path):
    words = path.read_text().split()
    count, faces = int(words[1]), int(words[2])
    positions = array.array("d", map(float, words[4 : 4 + 3 * count]))
    at = 4 + 3 * count
    return positions, [tuple(map(int, words[at + 4 * f + 1 : at + 4 * f + 4])) for f in range(faces)]


def split_triangles(positions, triangles):
    """Every triangle in four at the midpoints of its sides."""
    positions = array.array("d", positions)
    middle = {}

    def midpoint(a, b):
        key = (a, b) if a < b else (b, a)
        if key not in middle:
            middle[key] = len(positions) // 3
            positions.extend((positions[3 * a + k] + positions[3 * b + k]) / 2 for k in range(3))
        return middle[key]

    cut = []
    for a, b, c in triangles:
        ab, bc, ca = midpoint(a, b), midpoint(b, c), midpoint(c, a)
        cut += [(a, ab, ca), (ab, b, bc), (ca, bc, c), (ab, bc, ca)]
    return positions, cut


def write_ply(path, positions, triangles):
    header = (
        "ply\nformat binary_little_endian 1.0\n"
        f"element vertex {len(positions) // 3}\n"
        "property double x\nproperty double y\nproperty double z\n"
        f"element face {len(triangles)}\nproperty list uchar int vertex_indices\nend_header\n"
    )
    with open(path, "wb") as file:
        file.write(header.encode("ascii"))
        file.write(positions.tobytes())
        rows = bytearray()
        for t in triangles:
            rows += b"\x03" + array.array("i", t).tobytes()
        file.write(rows)


def write_obj(path, positions, triangles):
    with open(path, "w") as file:
        for i in range(0, len(positions), 3):
            file.write("v %r %r %r\n" % tuple(positions[i : i + 3]))
        for t in triangles:
            file.write("f %d %d %d\n" % tuple(v + 1 for v in t))


def make_mesh(kind, source, target):
    """Runs in a process of its own: what a parent has used counts as its children's peak memory."""
    if kind == "split":
        write_ply(target, *split_triangles(*read_ply_strips(Path(source))))
    else:
        write_obj(target, *read_off(Path(source)))


# --- runs --------------------------------------------------------------------------------------


def measure(command, cwd):
    """Exit code, processor and wall seconds and peak MiB of a command; its output on failure."""
    load = os.getloadavg()[0]
    with tempfile.TemporaryFile() as output:
        start = time.monotonic()
        child = subprocess.Popen(command, cwd=cwd, stdout=output, stderr=subprocess.STDOUT)
        _, status, usage = os.wait4(child.pid, 0)
        wall = time.monotonic() - start
        child.returncode = os.waitstatus_to_exitcode(status)
        output.seek(0)
        text = output.read().decode("utf-8", "replace")
    return {
        "exit_code": child.returncode,
        "cpu_seconds": usage.ru_utime + usage.ru_stime,
        "user_seconds": usage.ru_utime,
        "wall_seconds": wall,
        "peak_rss_mib": usage.ru_maxrss / 1024.0,
        "load_before": load,
    }, text


def run_ours(binary, mesh, threads, folder, options=()):
    output, report = folder / "out.3dm", folder / "report.json"
    run, text = measure(
        [binary, mesh, output, "--threads", str(threads), "--json", report, "--quiet", *options],
        folder,
    )
    if run["exit_code"] not in (0, 7):
        print(text, file=sys.stderr)
        return run
    made = json.loads(report.read_text())
    run["stages"] = made["stages"]
    run["triangles"] = made["input"]["faces"]
    run["patches"] = made["domain"]["faces"]
    run["sha256"] = hashlib.sha256(output.read_bytes()).hexdigest()
    run["termination"] = made["fit"]["termination"]
    run["rms_percent"] = 100.0 * made["deviation"]["rms_relative"]
    return run


def least(runs):
    return min(runs, key=lambda r: r["cpu_seconds"])


def exponent(points):
    """The slope of log(seconds) over log(triangles) with the least squares."""
    x = [math.log(n) for n, _ in points]
    y = [math.log(s) for _, s in points]
    mx, my = sum(x) / len(x), sum(y) / len(y)
    return sum((a - mx) * (b - my) for a, b in zip(x, y)) / sum((a - mx) ** 2 for a in x)


def stage_seconds(run):
    """CPU seconds by stage, the stages of several components added up."""
    total = {}
    for stage in run["stages"]:
        name = stage["name"].split()[0]
        total[name] = total.get(name, 0.0) + stage["cpu_seconds"]
    return total


# --- verdicts and table ------------------------------------------------------------------------


def judge(result):
    """The targets that can be judged from these runs: (what, measured, target, met or None)."""
    runs = {(r["model"], r["threads"]): r for r in result["models"]}
    verdicts = []

    def add(what, measured, target, met):
        verdicts.append({"what": what, "measured": measured, "target": target, "met": met})

    compared = runs.get((COMPARED, 1))
    if result["tolerance"]:
        if compared:
            add(
                f"CPU of {COMPARED} to {result['tolerance']:g} %, one thread",
                f"{compared['cpu_seconds']:.1f} s, {compared['termination']}",
                f"at most {MOST_TOLERANCE_SECONDS:g} s",
                compared["cpu_seconds"] <= MOST_TOLERANCE_SECONDS
                and compared["termination"] == "tolerance_met",
            )
        if (LARGEST, 1) in runs:
            peak = runs[LARGEST, 1]["peak_rss_mib"]
            add(
                f"peak memory of {runs[LARGEST, 1]['triangles']} triangles",
                f"{peak:.0f} MiB",
                f"at most {MOST_TOLERANCE_MIB:g} MiB",
                peak <= MOST_TOLERANCE_MIB,
            )
        return verdicts
    if compared and result["quadriflow"]:
        ratio = compared["cpu_seconds"] / result["quadriflow"]["cpu_seconds"]
        add(
            f"CPU of {COMPARED} to .3dm on one thread over QuadriFlow making "
            f"{QUADRIFLOW_QUADS} quads",
            f"{ratio:.2f} ({compared['cpu_seconds']:.2f} s / "
            f"{result['quadriflow']['cpu_seconds']:.2f} s)",
            f"at most {MOST_QUADRIFLOW_TIMES:g}, aim 1",
            ratio <= MOST_QUADRIFLOW_TIMES,
        )
    if compared:
        add(
            f"peak memory of {COMPARED}",
            f"{compared['peak_rss_mib']:.0f} MiB",
            f"at most {MOST_COMPARED_MIB:g} MiB",
            compared["peak_rss_mib"] <= MOST_COMPARED_MIB,
        )
    growth = result["growth"]
    if "total" in growth:
        add(
            f"exponent of CPU over triangles, {growth['from']} to {growth['to']}",
            f"{growth['total']:.2f}",
            f"at most {MOST_EXPONENT:g}",
            growth["total"] <= MOST_EXPONENT,
        )
    largest = [runs[LARGEST, t] for t in (1, 2) if (LARGEST, t) in runs]
    if largest:
        peak = max(r["peak_rss_mib"] for r in largest)
        add(
            f"peak memory of {largest[0]['triangles']} triangles",
            f"{peak:.0f} MiB",
            f"at most {MOST_LARGEST_MIB:g} MiB",
            peak <= MOST_LARGEST_MIB,
        )
    for name in (COMPARED, LARGEST):
        one, two = runs.get((name, 1)), runs.get((name, 2))
        if one and two:
            speedup = one["wall_seconds"] / two["wall_seconds"]
            busy = max(one["load_before"], two["load_before"]) > IDLE_LOAD + 2
            add(
                f"wall time of {name}, one thread over two",
                f"{speedup:.2f}" + (" (on a busy machine)" if busy else ""),
                f"at least {LEAST_SPEEDUP:g}",
                speedup >= LEAST_SPEEDUP,
            )
    return verdicts


def table(result):
    """docs/results/bench.md."""
    machine = result["machine"]
    lines = [
        "# Time and memory",
        "",
        f"Made by `bench/bench.py` with bot2nurbs {result['version']} ({result['commit']}) on "
        f"{result['date']}: {machine['processor']}, {machine['cores']} cores, least of "
        f"{result['repeat']} run{'s' if result['repeat'] > 1 else ''}. Every run reads a mesh and "
        + ("writes a `.3dm` file with the default options. " if not result["tolerance"] else
           f"writes a `.3dm` file with `--tolerance {result['tolerance']:g}%`. ")
        + "CPU is processor time of all threads; "
        "wall time is what a clock shows and depends on what else the machine does.",
        "",
        "## Targets",
        "",
        "| what | measured | target | met |",
        "|---|---|---|---|",
    ]
    for v in result["verdicts"]:
        lines.append(
            f"| {v['what']} | {v['measured']} | {v['target']} | {'yes' if v['met'] else '**no**'} |"
        )
    if not result["quadriflow"] and not result["tolerance"]:
        lines += ["", "Not compared with QuadriFlow: no `--quadriflow`."]
    lines += [
        "",
        "## Runs",
        "",
        "| model | triangles | patches | threads | CPU s | wall s | peak MiB |",
        "|---|--:|--:|--:|--:|--:|--:|",
    ]
    for r in result["models"]:
        lines.append(
            f"| {r['model']} | {r['triangles']} | {r['patches']} | {r['threads']} | "
            f"{r['cpu_seconds']:.2f} | {r['wall_seconds']:.2f} | {r['peak_rss_mib']:.0f} |"
        )
    if result["quadriflow"]:
        q = result["quadriflow"]
        lines.append(
            f"| {COMPARED}, QuadriFlow, {QUADRIFLOW_QUADS} quads |  |  | 1 | "
            f"{q['cpu_seconds']:.2f} | {q['wall_seconds']:.2f} | {q['peak_rss_mib']:.0f} |"
        )
    single = [r for r in result["models"] if r["threads"] == 1]
    names = list(dict.fromkeys(name for r in single for name in stage_seconds(r)))
    if single:
        lines += [
            "",
            "## CPU seconds by stage, one thread",
            "",
            "| model | " + " | ".join(names) + " |",
            "|---|" + "--:|" * len(names),
        ]
        for r in single:
            seconds = stage_seconds(r)
            lines.append(
                f"| {r['model']} | "
                + " | ".join(f"{seconds.get(n, 0.0):.2f}" for n in names)
                + " |"
            )
        if "stages" in result["growth"]:
            lines.append(
                "| exponent | "
                + " | ".join(
                    "" if result["growth"]["stages"].get(n) is None
                    else f"{result['growth']['stages'][n]:.2f}"
                    for n in names
                )
                + " |"
            )
        lines += ["", "The exponent is the slope of log(time) over log(triangles), least squares;",
                  "stages that stay under 20 ms have none."]
    lines.append("")
    return "\n".join(lines)


def growth_of(models):
    single = [r for r in models if r["threads"] == 1]
    if len(single) < 2:
        return {}
    growth = {
        "from": single[0]["model"],
        "to": single[-1]["model"],
        "total": exponent([(r["triangles"], r["cpu_seconds"]) for r in single]),
        "stages": {},
    }
    for name in dict.fromkeys(n for r in single for n in stage_seconds(r)):
        points = [(r["triangles"], stage_seconds(r).get(name, 0.0)) for r in single]
        points = [(n, s) for n, s in points if s >= 0.02]
        growth["stages"][name] = exponent(points) if len(points) >= 3 else None
    return growth


def processor():
    try:
        for line in Path("/proc/cpuinfo").read_text().splitlines():
            if line.startswith("model name"):
                return line.split(":", 1)[1].strip()
    except OSError:
        pass
    return platform.machine()


def git_commit():
    made = subprocess.run(
        ["git", "-C", ROOT, "rev-parse", "--short", "HEAD"], capture_output=True, text=True
    )
    return made.stdout.strip() or "unknown"


def parse_arguments():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--binary", type=Path, default=ROOT / "build/release/bot2nurbs")
    parser.add_argument("--data", type=Path, default=ROOT / "../shared/data/meshes")
    parser.add_argument("--quadriflow", type=Path, help="QuadriFlow's command, to compare with")
    parser.add_argument("--models", default=",".join(LADDER))
    parser.add_argument("--threads", default="1,2")
    parser.add_argument("--repeat", type=int, default=1)
    parser.add_argument("--tolerance", type=float, help="refine, to this percentage of the diagonal")
    parser.add_argument("--json", type=Path, help="write the measurements here")
    parser.add_argument("--table", type=Path, help="write the table here")
    parser.add_argument("--make-mesh", nargs=3, help=argparse.SUPPRESS)
    arguments = parser.parse_args()
    unknown = set(arguments.models.split(",")) - set(LADDER)
    if unknown:
        parser.error(f"no such models: {', '.join(sorted(unknown))}; known: {', '.join(LADDER)}")
    return arguments


def main():
    arguments = parse_arguments()
    if arguments.make_mesh:
        make_mesh(*arguments.make_mesh)
        return 0
    binary = arguments.binary.resolve()
    if not os.access(binary, os.X_OK):
        print(f"bench: no command at {arguments.binary}; build it or name it with --binary")
        return 1
    version = subprocess.run([binary, "--version"], capture_output=True, text=True).stdout.split()
    options = ["--tolerance", f"{arguments.tolerance:g}%"] if arguments.tolerance else []
    quadriflow = arguments.quadriflow.resolve() if arguments.quadriflow else None
    if quadriflow and not os.access(quadriflow, os.X_OK):
        print(f"bench: no QuadriFlow at {arguments.quadriflow}: not compared")
        quadriflow = None
    result = {
        "schema": "bot2nurbs.bench/1",
        "version": version[-1] if version else "unknown",
        "commit": git_commit(),
        "date": datetime.date.today().isoformat(),
        "repeat": arguments.repeat,
        "machine": {"processor": processor(), "cores": os.cpu_count()},
        "tolerance": arguments.tolerance,
        "models": [],
        "quadriflow": None,
    }
    failures = 0
    with tempfile.TemporaryDirectory(prefix="bot2nurbs-bench-") as name:
        folder = Path(name)

        def made(kind, source, target):
            subprocess.run([sys.executable, __file__, "--make-mesh", kind, source, target],
                           check=True)
            return target

        for model in arguments.models.split(","):
            file, splits = LADDER[model]
            mesh = (arguments.data / file).resolve()
            if not mesh.exists():
                print(f"bench: {model} is left out: no {file} in the data folder")
                continue
            if splits:
                mesh = made("split", mesh, folder / "split.ply")
            compare = quadriflow and model == COMPARED
            theirs = []
            hashes = set()
            runs = {int(t): [] for t in arguments.threads.split(",")}
            if compare:
                obj = made("obj", mesh, folder / "compared.obj")
            for _ in range(arguments.repeat):
                for threads, of_threads in runs.items():
                    run = run_ours(binary, mesh, threads, folder, options)
                    run.update(model=model, threads=threads)
                    if run["exit_code"] not in ((0, 7) if options else (0,)):
                        print(f"bench: {model} failed with exit code {run['exit_code']}")
                        failures += 1
                        continue
                    hashes.add(run["sha256"])
                    of_threads.append(run)
                    print(
                        f"{model:18} {run['triangles']:8} triangles  {threads} thread(s)  "
                        f"{run['cpu_seconds']:7.2f} s CPU  {run['wall_seconds']:7.2f} s wall  "
                        f"{run['peak_rss_mib']:6.0f} MiB",
                        flush=True,
                    )
                if compare:
                    run, text = measure(
                        [quadriflow, "-i", obj, "-o", folder / "quads.obj", "-f",
                         str(QUADRIFLOW_QUADS)], folder)
                    if run["exit_code"] == 0 and (folder / "quads.obj").exists():
                        theirs.append(run)
                        print(f"QuadriFlow on {model}: {run['cpu_seconds']:.2f} s CPU, "
                              f"{run['peak_rss_mib']:.0f} MiB", flush=True)
                    else:
                        print(f"bench: QuadriFlow failed: {text[-300:]}")
            if len(hashes) > 1:
                print(f"bench: {model} is not the same file on every run")
                failures += 1
            result["models"] += [least(r) for r in runs.values() if r]
            if theirs:
                result["quadriflow"] = least(theirs)
    result["growth"] = growth_of(result["models"])
    result["verdicts"] = judge(result)
    for v in result["verdicts"]:
        print(f"{'met ' if v['met'] else 'MISS'}  {v['what']}: {v['measured']} ({v['target']})")
    if not quadriflow and not options:
        print("not compared with QuadriFlow: name its command with --quadriflow")
    if arguments.json:
        arguments.json.write_text(json.dumps(result, indent=1) + "\n")
    if arguments.table:
        arguments.table.parent.mkdir(parents=True, exist_ok=True)
        arguments.table.write_text(table(result))
    return 1 if failures or not result["models"] else 0


if __name__ == "__main__":
    sys.exit(main())
