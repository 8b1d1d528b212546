#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""Measures the time and memory of bot2nurbs on clouds of points without normals.

    bench/cloud_bench.py [--binary build/release/bot2nurbs] [--points 10000,100000,1000000]
                         [--table docs/results/cloud_bench.md]

The points are scattered evenly over a wavy torus. Every run is one command without options but for
one thread, from a PLY file to a .3dm file. Beside it, in the same run, stands the bare screened
Poisson reconstruction of Open3D (Debian: python3-open3d) at the depth that ours chose, on one
thread, from points whose normals it is given; without Open3D that column is left out. Needs numpy.
Exit code 1 when a run fails; a missed target is shown in the table and is no failure, as times
depend on the machine and its load.
"""

import argparse
import json
import os
import sys
import tempfile
import time
from pathlib import Path

import numpy as np

import bench

ROOT = Path(__file__).resolve().parent.parent
RING, TUBE, WAVE = 3.0, 1.0, 0.12
# What the project promises of a cloud of so many points.
JUDGED = 1_000_000
MOST_MIB = 6 * 1024.0
MOST_POISSON_TIMES = 3.0
STAGES = ("read", "normals", "reconstruct", "layout", "samples", "fit", "bound")


def torus(u, v):
    tube = TUBE + WAVE * np.cos(5 * u) * np.cos(3 * v)
    ring = RING + tube * np.cos(v)
    return np.stack([ring * np.cos(u), ring * np.sin(u), tube * np.sin(v)], axis=-1)


def scattered(count):
    """Points spread evenly by area, and their outward normals."""
    generator, step = np.random.default_rng(1), 1e-5
    points, normals = [], []
    most = 1.5 * (RING + TUBE + WAVE) * TUBE  # above the largest area of a unit of (u, v)
    while sum(map(len, points)) < count:
        u, v = generator.uniform(0.0, 2.0 * np.pi, (2, 2 * count))
        along = (torus(u + step, v) - torus(u - step, v)) / (2 * step)
        around = (torus(u, v + step) - torus(u, v - step)) / (2 * step)
        normal = np.cross(along, around)
        area = np.linalg.norm(normal, axis=1)
        assert area.max() < most
        kept = generator.uniform(0.0, most, len(area)) < area
        points.append(torus(u[kept], v[kept]))
        normals.append(normal[kept] / area[kept, None])
    return np.concatenate(points)[:count], np.concatenate(normals)[:count]


def write_ply(path, points):
    header = "ply\nformat binary_little_endian 1.0\nelement vertex %d\n" % len(points)
    header += "".join(f"property double {axis}\n" for axis in "xyz") + "end_header\n"
    path.write_bytes(header.encode() + points.astype("<f8").tobytes())


def poisson_seconds(points, normals, depth):
    """Processor seconds of Open3D's reconstruction; None without Open3D."""
    try:
        import open3d
    except ImportError:
        return None
    child, parent = os.pipe()
    pid = os.fork()
    if pid == 0:  # of its own, so that its memory is returned
        cloud = open3d.geometry.PointCloud(open3d.utility.Vector3dVector(points))
        cloud.normals = open3d.utility.Vector3dVector(normals)
        start = time.process_time()
        open3d.geometry.TriangleMesh.create_from_point_cloud_poisson(cloud, depth=depth, n_threads=1)
        os.write(parent, str(time.process_time() - start).encode())
        os._exit(0)
    os.close(parent)
    seconds = float(os.read(child, 64))
    os.close(child)
    os.waitpid(pid, 0)
    return seconds


def verdict(count, run, ratio):
    """A row for each target that a run decides: what, measured, target, met."""
    if count != JUDGED:
        return []
    memory, limit = run["peak_rss_mib"], f"at most {MOST_MIB:.0f} MiB"
    rows = [["peak memory", f"{memory:.0f} MiB", limit, memory <= MOST_MIB]]
    if ratio:
        rows.append(["CPU over that of the bare reconstruction", f"{ratio:.2f}",
                     f"at most {MOST_POISSON_TIMES:g}", ratio <= MOST_POISSON_TIMES])
    return [[f"{count:,} points: {row[0]}", *row[1:3], "yes" if row[3] else "**no**"] for row in rows]


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--binary", type=Path, default=ROOT / "build/release/bot2nurbs")
    parser.add_argument("--points", default="10000,100000,1000000")
    parser.add_argument("--table", type=Path)
    args = parser.parse_args()
    rows, times, targets, failed = [], [], [], False
    with tempfile.TemporaryDirectory(prefix="bot2nurbs_") as name:
        folder = Path(name)
        for count in map(int, args.points.split(",")):
            points, normals = scattered(count)
            write_ply(folder / "cloud.ply", points)
            run = bench.run_ours(args.binary.resolve(), folder / "cloud.ply", 1, folder)
            if run["exit_code"] != 0:
                failed = True
                continue
            depth = json.loads((folder / "report.json").read_text())["cloud"]["depth"]
            poisson = poisson_seconds(points, normals, depth)
            stages = bench.stage_seconds(run)
            ratio = run["cpu_seconds"] / poisson if poisson else None
            times.append((count, run["cpu_seconds"]))
            targets += verdict(count, run, ratio)
            rows.append([f"{count:,}", str(run["patches"]), f"{run['cpu_seconds']:.1f}",
                         f"{run['peak_rss_mib']:.0f}", str(depth),
                         f"{poisson:.1f}" if poisson else "-", f"{ratio:.2f}" if ratio else "-"]
                        + [f"{stages.get(s, 0.0):.1f}" for s in STAGES])
            print(rows[-1], flush=True)
    heads = ["points", "patches", "CPU s", "peak MiB", "depth", "Open3D Poisson, CPU s", "times it",
             *STAGES]
    growth = f"{bench.exponent(times):.2f}" if len(times) > 1 else "-"
    lines = [
        "# Clouds of points: time and memory", "",
        "Made by `bench/cloud_bench.py`: points scattered over a wavy torus, without normals, to a `.3dm` file, one thread. Beside it the",
        "bare reconstruction of Open3D at the same depth, of points with their true normals, in the same run.", "",
        "| " + " | ".join(heads) + " |", "|--:|" + "--:|" * (len(heads) - 1),
        *("| " + " | ".join(row) + " |" for row in rows), "",
        f"CPU grows as the number of points to the power {growth}.",
    ]
    if targets:
        lines += ["", "| what | measured | target | met |", "|---|---|---|---|",
                  *("| " + " | ".join(row) + " |" for row in targets)]
    if args.table:
        args.table.write_text("\n".join(lines) + "\n")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
