#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""Checks that results do not depend on what they should not; writes docs/results/invariance.md.

    scripts/invariance.py [--binary FILE] [--models NAME ...] [--limit 300] [--report FILE]

Models of examples/ at scales 1e-6 to 1e6, far from the origin, turned, and with vertices and faces
in another order must give results as good as the model itself; with 1, 2 and 8 threads and run
after run the same bytes. Exit code 0 when they do. Needs numpy (Debian: python3-numpy).
"""

import argparse
import hashlib
import sys
import tempfile
from pathlib import Path

import numpy as np

import random_mesh
import verdict

# Another scale or place changes the rounding of the input only, another order or axes the choices
# among equals too: the same quality is asked, not the same layout.
MAX_RMS_RATIO = 1.5
MAX_PATCH_RATIO = 1.25
THREADS = (1, 2, 8)


def read(path):
    """The meshes of examples/: OBJ and OFF of triangles, PLY of floats and triangles."""
    data = path.read_bytes()
    if path.suffix == ".ply":
        head, body = data.split(b"end_header\n", 1)
        words = head.split()
        counts = [int(words[i + 2]) for i, w in enumerate(words) if w == b"element"]
        vertices = np.frombuffer(body, "<f4", 3 * counts[0]).reshape(-1, 3).astype(float)
        faces = np.frombuffer(body, [("n", "u1"), ("v", "<i4", 3)], counts[1], 12 * counts[0])
        return random_mesh.Mesh(vertices, faces["v"].astype(int))
    rows = [l.split() for l in data.decode().splitlines() if l and l[0] != "#"]
    if path.suffix == ".obj":
        vertices = [r[1:4] for r in rows if r[0] == "v"]
        triangles = np.array([r[1:4] for r in rows if r[0] == "f"], int) - 1
    else:
        n = int(rows[1][0])
        vertices, triangles = rows[2 : 2 + n], np.array([r[1:4] for r in rows[2 + n :]], int)
    return random_mesh.Mesh(np.array(vertices, float), triangles)


def variants(mesh):
    """Name and mesh of each."""
    rng = np.random.default_rng(1)
    p, t = mesh.vertices, mesh.triangles
    diagonal = np.linalg.norm(p.max(0) - p.min(0))
    yield "as it is", mesh
    for scale in (1e-6, 1e6):
        yield f"scale {scale:g}", random_mesh.Mesh(scale * p, t)
    for far in (1e3,):
        offset = far * diagonal * random_mesh.direction(rng)
        yield f"{far:g} diagonals away", random_mesh.Mesh(p + offset, t)
    for number in (1, 2):
        yield f"turned {number}", random_mesh.Mesh(p @ random_mesh.rotation(rng).T, t)
    for number in (1, 2):
        yield f"shuffled {number}", random_mesh.shuffled(mesh, rng)


def numbers(run):
    (c,) = run.report["components"]
    return {
        "patches": c["brep"]["faces"],
        "extraordinary": c["domain"]["extraordinary"],
        "rms": c["deviation"]["rms_relative"],
        "max": c["deviation"]["max_relative"],
        "angle": c["continuity"]["max_g1_angle_deg"],
    }


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--binary", help="default: the newest build/*/bot2nurbs")
    parser.add_argument("--models", nargs="+", default=["sphere.obj", "torso.off", "bracket.ply"])
    parser.add_argument("--limit", type=float, default=300.0, help="seconds of processor time each")
    parser.add_argument("--report", type=Path, default=verdict.ROOT / "docs/results/invariance.md")
    arguments = parser.parse_args()
    binary = verdict.find_binary(arguments.binary)
    failures, rows, byte_rows = [], [], []
    with tempfile.TemporaryDirectory(prefix="bot2nurbs_") as folder:
        file = Path(folder) / "mesh.off"
        for model in arguments.models:
            mesh = read(verdict.ROOT / "examples" / model)
            first = None
            for name, variant in variants(mesh):
                random_mesh.write_off(file, variant)
                run = verdict.convert(binary, file, arguments.limit)
                found = verdict.faults(run, [mesh.genus])
                if run.code != 0:
                    found.append(run.message)
                if found:
                    rows.append([model, name, "", "", "", "", "", "**" + "; ".join(found) + "**"])
                else:
                    n = numbers(run)
                    first = first or n
                    ratio = n["rms"] / first["rms"]
                    patches = n["patches"] / first["patches"]
                    if max(ratio, 1 / ratio) > MAX_RMS_RATIO:
                        found.append(f"rms changes by {ratio:.2f}")
                    if max(patches, 1 / patches) > MAX_PATCH_RATIO:
                        found.append(f"number of patches changes by {patches:.2f}")
                    rows.append(
                        [
                            model,
                            name,
                            n["patches"],
                            n["extraordinary"],
                            f"{100 * n['rms']:.4f} %",
                            f"{100 * n['max']:.3f} %",
                            f"{n['angle']:.1e}",
                            "**" + "; ".join(found) + "**" if found else "same quality",
                        ]
                    )
                failures += found
                print(*rows[-1], sep="\t", flush=True)
            random_mesh.write_off(file, mesh)
            digests = {}
            for threads in (*THREADS, THREADS[-1]):
                kept = Path(folder) / "kept.3dm"
                kept.unlink(missing_ok=True)
                run = verdict.convert(binary, file, arguments.limit, threads, keep=kept)
                data = kept.read_bytes() if kept.exists() else run.message.encode()
                digest = hashlib.sha256(data).hexdigest()[:16]
                digests.setdefault(digest, []).append(threads)
            same = len(digests) == 1
            if not same:
                failures.append(f"{model}: bytes differ by threads")
            words = ", ".join(f"{d} ({' '.join(map(str, t))})" for d, t in digests.items())
            byte_rows.append([model, words, "same bytes" if same else "**they differ**"])
            print(*byte_rows[-1], sep="\t", flush=True)
    lines = [
        "# Scale, place, order, threads",
        "",
        "Written by `scripts/invariance.py`. The same models at other scales, far from the origin, turned, with",
        f"vertices and faces shuffled: sound, rms within a factor {MAX_RMS_RATIO:g}, number of patches within a factor",
        f"{MAX_PATCH_RATIO:g}. Lengths are fractions of the diagonal, the angle (largest between normals at a join) is in degrees.",
        "",
    ]
    header = ["model", "variant", "patches", "extraordinary", "rms", "max", "angle", "verdict"]
    lines += verdict.table(header, rows)
    lines += ["", "The `.3dm` file (start of its SHA-256) with 1, 2, 8 and again 8 threads:", ""]
    lines += verdict.table(["model", "digest (threads)", "verdict"], byte_rows)
    arguments.report.parent.mkdir(parents=True, exist_ok=True)
    arguments.report.write_text("\n".join(lines) + "\n")
    print(f"{len(failures)} failures")
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main())
