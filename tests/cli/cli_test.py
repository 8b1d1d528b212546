# SPDX-License-Identifier: MIT
"""Runs the command on good and bad input: exit codes, streams, files.

    BOT2NURBS=build/release/bot2nurbs python3 tests/cli/cli_test.py
"""

import json
import math
import os
import pty
import signal
import struct
import subprocess
import tempfile
import time
import unittest
from pathlib import Path

import schema

ROOT = Path(__file__).resolve().parent.parent.parent
COMMAND = os.environ["BOT2NURBS"]
EXAMPLES = ROOT / "examples"
SPHERE = EXAMPLES / "sphere.obj"

TETRAHEDRON = """OFF
4 4 6
0 0 0
1 0 0
0 1 0
0 0 1
3 0 2 1
3 0 1 3
3 0 3 2
3 1 2 3
"""


def off(vertices, faces):
    lines = ["OFF", f"{len(vertices)} {len(faces)} 0"]
    lines += [" ".join(map(str, v)) for v in vertices]
    lines += ["3 " + " ".join(map(str, f)) for f in faces]
    return "\n".join(lines) + "\n"


def read_obj(path):
    vertices, faces = [], []
    for line in path.read_text().splitlines():
        parts = line.split()
        if parts and parts[0] == "v":
            vertices.append(tuple(float(x) for x in parts[1:]))
        elif parts and parts[0] == "f":
            faces.append(tuple(int(x) - 1 for x in parts[1:]))
    return vertices, faces


CUBE_QUADS = ((0, 3, 2, 1), (4, 5, 6, 7), (0, 1, 5, 4), (1, 2, 6, 5), (2, 3, 7, 6), (3, 0, 4, 7))


def cube_obj(centre, half):
    """A cube of quads."""
    signs = ((-1, -1, -1), (1, -1, -1), (1, 1, -1), (-1, 1, -1))
    signs += tuple((x, y, 1) for x, y, _ in signs)
    lines = ["v " + " ".join(str(c + half * s) for c, s in zip(centre, v)) for v in signs]
    lines += ["f " + " ".join(str(i + 1) for i in q) for q in CUBE_QUADS]
    return "\n".join(lines) + "\n"


class CliTest(unittest.TestCase):
    def setUp(self):
        scratch = tempfile.TemporaryDirectory()
        self.addCleanup(scratch.cleanup)
        self.folder = Path(scratch.name)

    def run_command(self, *arguments, timeout=300, **options):
        return subprocess.run(
            [COMMAND, *map(str, arguments)],
            capture_output=True, text=True, timeout=timeout, cwd=self.folder, **options,
        )

    def write(self, name, content):
        path = self.folder / name
        path.write_bytes(content if isinstance(content, bytes) else content.encode())
        return path

    def assert_refused(self, code, words, *arguments):
        """Fails with that exit code, one line that says why, and no file but those there were."""
        before = sorted(os.listdir(self.folder))
        run = self.run_command(*arguments)
        self.assertEqual(run.returncode, code, run.stderr)
        self.assertEqual(run.stdout, "")
        errors = [line for line in run.stderr.splitlines() if line.startswith("error:")]
        self.assertEqual(len(errors), 1, run.stderr)
        self.assertIn(words.lower(), errors[0].lower())
        self.assertEqual(sorted(os.listdir(self.folder)), before)
        return run


class Conversion(CliTest):
    def test_a_sphere_becomes_every_format_and_says_so_on_stderr(self):
        run = self.run_command(SPHERE, "a.3dm", "a.step", "a.stp", "a.brep")
        self.assertEqual(run.returncode, 0, run.stderr)
        self.assertEqual(run.stdout, "")
        self.assertEqual(sorted(os.listdir(self.folder)), ["a.3dm", "a.brep", "a.step", "a.stp"])
        for word in ("patches", "extraordinary", "rms", "max", "bound", "joins", "solid     yes", "a.3dm"):
            self.assertIn(word, run.stderr)
        self.assertNotIn("\033", run.stderr)
        self.assertNotIn("\r", run.stderr)

    def test_the_report_on_stdout_is_json_alone_and_follows_its_schema(self):
        run = self.run_command(SPHERE, "a.3dm", "--json", "-", "--units", "cm")
        self.assertEqual(run.returncode, 0, run.stderr)
        report = json.loads(run.stdout)
        rules = json.loads((ROOT / "docs/schema/report.schema.json").read_text())
        self.assertEqual(schema.errors(report, rules), [])
        self.assertEqual(report["deviation"]["unit"], "cm")
        self.assertTrue(report["brep"]["valid"] and report["brep"]["solid"])
        self.assertEqual(report["brep"]["boundary_edges"], 0)
        self.assertEqual(report["continuity"]["max_gap"], 0)
        self.assertLessEqual(report["continuity"]["max_g1_angle_deg"], 1e-8)
        self.assertLess(report["deviation"]["rms_relative"], 5e-3)
        self.assertLessEqual(report["deviation"]["max"], report["deviation"]["upper_bound"])
        self.assertEqual(report["outputs"][0]["bytes"], os.path.getsize(self.folder / "a.3dm"))
        names = [stage["name"] for stage in report["stages"]]
        self.assertEqual(names[:3], ["read", "check", "repair"])
        self.assertEqual(names[-1], "write")

    def test_quiet_says_nothing(self):
        run = self.run_command("--quiet", SPHERE, "a.3dm", "--json", "a.json")
        self.assertEqual((run.returncode, run.stdout, run.stderr), (0, "", ""))
        self.assertEqual(json.loads((self.folder / "a.json").read_text())["components"][0]["genus"], 0)

    def test_two_components_become_two_solids(self):
        vertices, faces = read_obj(SPHERE)
        n = len(vertices)
        both = off(
            vertices + [(x + 5, y, z) for x, y, z in vertices],
            faces + [(a + n, b + n, c + n) for a, b, c in faces],
        )
        mesh = self.write("two.off", both)
        run = self.run_command(mesh, "two.3dm", "--json", "-")
        self.assertEqual(run.returncode, 0, run.stderr)
        report = json.loads(run.stdout)
        self.assertEqual(len(report["components"]), 2)
        self.assertTrue(all(c["brep"]["solid"] for c in report["components"]))
        self.assertIn("component 2 of 2", run.stderr)

    def test_a_domain_goes_out_and_comes_back_to_the_same_bytes(self):
        run = self.run_command(SPHERE, "--domain-out", "d.json")
        self.assertEqual(run.returncode, 0, run.stderr)
        self.assertEqual(os.listdir(self.folder), ["d.json"])
        self.assertEqual(self.run_command(SPHERE, "a.3dm", "a.step").returncode, 0)
        run = self.run_command(SPHERE, "b.3dm", "--domain-in", "d.json", "--domain-out", "e.json")
        self.assertEqual(run.returncode, 0, run.stderr)
        self.assertEqual((self.folder / "a.3dm").read_bytes(), (self.folder / "b.3dm").read_bytes())
        self.assertEqual((self.folder / "d.json").read_bytes(), (self.folder / "e.json").read_bytes())

        run = self.run_command("--validate-domain", "d.json", SPHERE)
        self.assertEqual(run.returncode, 0, run.stderr + run.stdout)
        self.assertIn("verdict: accepted", run.stdout)

        other = EXAMPLES / "torso.off"
        self.assert_refused(5, "d.json", other, "c.3dm", "--domain-in", "d.json")
        run = self.run_command("--validate-domain", "d.json", other)
        self.assertEqual(run.returncode, 5)
        self.assertIn("verdict: rejected (stale_domain)", run.stdout)

    def test_patches_are_steered(self):
        counts = []
        for wanted in ("20", "80"):
            run = self.run_command(SPHERE, "--patches", wanted, "--domain-out", "d.json", "--json", "-")
            self.assertEqual(run.returncode, 0, run.stderr)
            counts.append(json.loads(run.stdout)["domain"]["faces"])
        self.assertTrue(20 / 1.5 <= counts[0] <= 20 * 1.5, counts)
        self.assertTrue(80 / 1.5 <= counts[1] <= 80 * 1.5, counts)

    def test_a_tolerance_is_met_by_a_proven_bound(self):
        for tolerance, relative in (("0.5%", True), ("0.02", False)):
            run = self.run_command(SPHERE, "a.step", "--tolerance", tolerance, "--json", "-")
            self.assertEqual(run.returncode, 0, run.stderr)
            report = json.loads(run.stdout)
            rules = json.loads((ROOT / "docs/schema/report.schema.json").read_text())
            self.assertEqual(schema.errors(report, rules), [])
            wanted = 0.005 * report["deviation"]["diagonal"] if relative else 0.02
            self.assertTrue(report["fit"]["tolerance_met"])
            self.assertEqual(report["fit"]["termination"], "tolerance_met")
            result = report["components"][0]["tolerance"]
            self.assertAlmostEqual(result["tolerance"], wanted, delta=1e-12)
            self.assertLessEqual(result["upper_bound"], result["tolerance"])
            self.assertEqual(result["rounds"][result["best"]]["patches"], report["brep"]["faces"])
            self.assertEqual(result["rounds"][result["best"]]["beyond"], 0)

    def test_a_tolerance_that_is_not_met_is_exit_code_7_and_says_where(self):
        run = self.run_command(
            SPHERE, "a.3dm", "--tolerance", "1e-5%", "--max-patches", "40", "--json", "-"
        )
        self.assertEqual(run.returncode, 7, run.stderr)
        self.assertTrue((self.folder / "a.3dm").is_file())
        report = json.loads(run.stdout)
        rules = json.loads((ROOT / "docs/schema/report.schema.json").read_text())
        self.assertEqual(schema.errors(report, rules), [])
        self.assertFalse(report["fit"]["tolerance_met"])
        self.assertEqual(report["fit"]["termination"], "patch_limit")
        self.assertTrue(report["brep"]["solid"])
        self.assertLessEqual(report["brep"]["faces"], 40)
        result = report["components"][0]["tolerance"]
        self.assertGreater(result["worst"]["distance"], result["tolerance"])
        warning = [w for w in report["warnings"] if w["code"] == "tolerance_not_met"]
        self.assertEqual(len(warning), 1)
        self.assertEqual(warning[0]["element"], result["worst"]["patch"])
        self.assertIn(f"patch {result['worst']['patch']} near", run.stderr)

    def read_report(self, name):
        report = json.loads((self.folder / name).read_text())
        rules = json.loads((ROOT / "docs/schema/report.schema.json").read_text())
        self.assertEqual(schema.errors(report, rules), [])
        return report

    def test_quads_of_a_file_become_the_patches(self):
        vertices, _ = read_obj(SPHERE)
        low = [min(v[k] for v in vertices) for k in range(3)]
        high = [max(v[k] for v in vertices) for k in range(3)]
        centre = [(a + b) / 2 for a, b in zip(low, high)]
        quads = self.write("cube.obj", cube_obj(centre, (high[0] - low[0]) / 2 / math.sqrt(3)))
        run = self.run_command(
            SPHERE, "a.3dm", "--layout", "quads=cube.obj", "--json", "report.json"
        )
        self.assertEqual(run.returncode, 0, run.stderr)
        self.assertIn("solid     yes", run.stderr)
        report = self.read_report("report.json")
        self.assertEqual(report["options"]["layout"], "quads=cube.obj")
        self.assertEqual(report["domain"]["source"], "quads")
        self.assertEqual(report["brep"]["faces"], 6)
        self.assertLess(report["components"][0]["quads"]["largest_detour"], 2)

        for path in ("a.3dm", "report.json"):
            (self.folder / path).unlink()
        quads.write_text(cube_obj([c + 9 for c in centre], 1))
        self.assert_refused(
            5, "must lie near its mesh", SPHERE, "a.3dm", "--layout", "quads=cube.obj"
        )

    def test_a_cage_becomes_its_smooth_surface(self):
        self.write("cage.obj", cube_obj((0, 0, 0), 1))
        run = self.run_command("--cage", "cage.obj", "a.step", "--json", "report.json")
        self.assertEqual(run.returncode, 0, run.stderr)
        self.assertIn("solid     yes", run.stderr)
        report = self.read_report("report.json")
        self.assertEqual(report["domain"]["source"], "cage")
        self.assertEqual(report["brep"]["faces"], 6)
        self.assertLess(report["continuity"]["max_g1_angle_deg"], 1e-8)
        for path in ("a.step", "report.json"):
            (self.folder / path).unlink()
        self.assert_refused(5, "no quads", "--cage", SPHERE, "a.step")

    def test_a_file_that_was_there_is_replaced(self):
        target = self.write("a.3dm", "old")
        self.assertEqual(self.run_command(SPHERE, target).returncode, 0)
        self.assertTrue(target.read_bytes().startswith(b"3D Geometry File Format"))


class Usage(CliTest):
    def assert_usage_error(self, words, *arguments):
        run = self.run_command(*arguments)
        self.assertEqual(run.returncode, 2, run.stderr)
        self.assertEqual(run.stdout, "")
        self.assertIn(words, run.stderr)
        self.assertEqual(os.listdir(self.folder), [])

    def test_help_and_version_go_to_stdout(self):
        for argument, word in (("--help", "Exit codes"), ("--version", "bot2nurbs 0.")):
            run = self.run_command(argument)
            self.assertEqual((run.returncode, run.stderr), (0, ""))
            self.assertIn(word, run.stdout)

    def test_wrong_use_is_exit_code_2(self):
        self.assert_usage_error("INPUT")
        self.assert_usage_error("no output file", SPHERE)
        self.assert_usage_error("--no-such-option", SPHERE, "a.3dm", "--no-such-option")
        self.assert_usage_error("extension", SPHERE, "a.xyz")
        self.assert_usage_error("extension", "missing.off", "a")
        self.assert_usage_error("--patches", SPHERE, "a.3dm", "--patches", "many")
        self.assert_usage_error("--patches", SPHERE, "a.3dm", "--patches", "2")
        self.assert_usage_error("--patches", SPHERE, "a.3dm", "--patches", "-7")
        self.assert_usage_error("--tolerance", SPHERE, "a.3dm", "--tolerance", "fine")
        self.assert_usage_error("--tolerance", SPHERE, "a.3dm", "--tolerance", "0")
        self.assert_usage_error("--tolerance", SPHERE, "a.3dm", "--tolerance", "-1%")
        self.assert_usage_error("--tolerance", SPHERE, "a.3dm", "--max-patches", "100")
        self.assert_usage_error(
            "--max-patches", SPHERE, "a.3dm", "--tolerance", "1%", "--max-patches", "3"
        )
        self.assert_usage_error("--threads", SPHERE, "a.3dm", "--threads", "0")
        self.assert_usage_error("--knots", SPHERE, "a.3dm", "--knots", "c2")
        self.assert_usage_error("--archive-version", SPHERE, "a.3dm", "--archive-version", "9")
        self.assert_usage_error("--layout", SPHERE, "a.3dm", "--layout", "quads")
        self.assert_usage_error("--layout", SPHERE, "a.3dm", "--layout", "quads=")
        self.assert_usage_error("--cage", SPHERE, "--check", "--cage")
        self.assert_usage_error("--step-schema", SPHERE, "a.step", "--step-schema", "AP203")
        self.assert_usage_error("unit", SPHERE, "a.step", "--units", "furlong")
        self.assert_usage_error("C1", SPHERE, "a.3dm", "--spline", "eck-hoppe", "--knots", "c1")
        self.assert_usage_error("writes no output", "--check", SPHERE, "a.3dm")
        self.assert_usage_error("twice", SPHERE, "a.3dm", "a.3dm")
        self.assert_usage_error("contradicts", SPHERE, "a.3dm", "--patches", "9", "--domain-in", "d")


class BadInput(CliTest):
    def test_a_missing_file_cannot_be_read(self):
        self.assert_refused(3, "missing.off", "missing.off", "a.3dm")

    def test_a_folder_cannot_be_read(self):
        (self.folder / "mesh.off").mkdir()
        self.assert_refused(3, "mesh.off", "mesh.off", "a.3dm")

    def test_an_empty_file_is_refused(self):
        for name in ("a.off", "a.stl", "a.ply", "a.obj"):
            self.write(name, "")
            run = self.run_command(name, "out.3dm")
            self.assertIn(run.returncode, (3, 5), run.stderr)
            self.assertIn("error:", run.stderr)
            self.assertFalse((self.folder / "out.3dm").exists())

    def test_vertices_without_faces_are_points_and_three_are_too_few(self):
        mesh = self.write("a.off", "OFF\n3 0 0\n0 0 0\n1 0 0\n0 1 0\n")
        self.assert_refused(5, "too few", mesh, "a.3dm")

    def test_truncated_files_cannot_be_read(self):
        self.assert_refused(3, "a.off", self.write("a.off", TETRAHEDRON[:60]), "a.3dm")
        ply = (EXAMPLES / "bracket.ply").read_bytes()
        self.assert_refused(3, "a.ply", self.write("a.ply", ply[: len(ply) // 2]), "a.3dm")
        stl = b"\0" * 80 + struct.pack("<I", 1000) + b"\0" * 500
        self.assert_refused(3, "a.stl", self.write("a.stl", stl), "a.3dm")

    def test_an_index_out_of_range_cannot_be_read(self):
        mesh = self.write("a.off", TETRAHEDRON.replace("3 1 2 3", "3 1 2 9"))
        self.assert_refused(3, "9", mesh, "a.3dm")

    def test_coordinates_that_are_no_numbers_are_rejected(self):
        for bad in ("nan", "inf"):
            mesh = self.write("a.off", TETRAHEDRON.replace("0 0 1\n3", f"0 0 {bad}\n3"))
            run = self.run_command(mesh, "a.3dm")
            self.assertIn(run.returncode, (3, 5), run.stderr)
            self.assertIn("finite", run.stderr)
            self.assertFalse((self.folder / "a.3dm").exists())

    def test_an_open_mesh_is_no_solid(self):
        vertices, faces = read_obj(SPHERE)
        mesh = self.write("a.off", off(vertices, faces[1:]))
        run = self.assert_refused(5, "1 boundary loop", mesh, "a.3dm", "--solid")
        self.assertIn("vertex", run.stderr)
        self.assertIn("leave out --solid", run.stderr)

    def test_a_closed_mesh_without_volume_is_rejected(self):
        vertices, faces = read_obj(SPHERE)
        mesh = self.write("a.off", off([(x, y, 0.0) for x, y, _ in vertices], faces))
        self.assert_refused(5, "no volume", mesh, "a.3dm")

    def test_a_non_manifold_mesh_is_rejected_with_the_edge(self):
        vertices, faces = read_obj(SPHERE)
        a, b, _ = faces[0]
        mesh = self.write("a.off", off(vertices + [(3, 3, 3)], faces + [(a, b, len(vertices))]))
        self.assert_refused(5, "edge", mesh, "a.3dm")

    def test_a_mobius_band_is_rejected(self):
        vertices, faces = [], []
        n = 12
        for i in range(n):
            t = 2 * math.pi * i / n
            for s in (-0.3, 0.3):
                r = 1 + s * math.cos(t / 2)
                vertices.append((r * math.cos(t), r * math.sin(t), s * math.sin(t / 2)))
        for i in range(n):
            a, b = 2 * i, 2 * i + 1
            c, d = (2 * i + 2, 2 * i + 3) if i + 1 < n else (1, 0)
            faces += [(a, c, b), (b, c, d)]
        mesh = self.write("a.off", off(vertices, faces))
        self.assert_refused(5, "one-sided", mesh, "a.3dm")

    def test_an_output_folder_that_is_missing_is_noticed_before_work(self):
        run = self.assert_refused(4, "no folder", SPHERE, "no/such/a.3dm")
        self.assertNotIn("read ...", run.stderr)

    @unittest.skipIf(os.geteuid() == 0, "root may write everywhere")
    def test_an_output_folder_without_permission_is_noticed_before_work(self):
        (self.folder / "locked").mkdir(mode=0o500)
        self.assert_refused(4, "permission", SPHERE, "locked/a.3dm")

    def test_a_device_that_is_full_cannot_be_written(self):
        self.assert_refused(4, "/dev/full", SPHERE, "--domain-out", "/dev/full")

    def test_the_report_tells_of_the_failure(self):
        vertices, faces = read_obj(SPHERE)
        mesh = self.write("a.off", off(vertices, faces[1:]))
        run = self.run_command(mesh, "a.3dm", "--solid", "--json", "-")
        self.assertEqual(run.returncode, 5)
        report = json.loads(run.stdout)
        rules = json.loads((ROOT / "docs/schema/report.schema.json").read_text())
        self.assertEqual(schema.errors(report, rules), [])
        self.assertEqual(report["error"]["code"], "open_mesh")
        self.assertEqual(report["error"]["exit_code"], 5)

    def test_no_repair_and_strict_say_which_option_would_let_the_input_pass(self):
        vertices, faces = read_obj(SPHERE)
        a, b, c = faces[0]
        flipped = self.write("flipped.off", off(vertices, [(a, c, b)] + faces[1:]))
        self.assert_refused(5, "--no-repair", flipped, "a.3dm", "--no-repair")
        n = len(vertices)
        crossing = self.write("crossing.off", off(
            vertices + [(x + 0.7, y + 0.1, z + 0.2) for x, y, z in vertices],
            faces + [(a + n, b + n, c + n) for a, b, c in faces],
        ))
        self.assert_refused(5, "--strict", crossing, "a.3dm", "--strict")
        run = self.run_command(crossing, "a.3dm")
        self.assertEqual(run.returncode, 0, run.stderr)
        self.assertIn("warning:", run.stderr)


class OpenMeshes(CliTest):
    def open_sphere(self):
        vertices, faces = read_obj(SPHERE)
        return self.write("a.off", off(vertices, [f for f in faces if 0 not in f]))

    def report(self, *arguments):
        run = self.run_command(*arguments, "--json", "r.json")
        self.assertEqual(run.returncode, 0, run.stderr)
        report = json.loads((self.folder / "r.json").read_text())
        rules = json.loads((ROOT / "docs/schema/report.schema.json").read_text())
        self.assertEqual(schema.errors(report, rules), [])
        return report

    def test_the_report_measures_every_boundary_loop_both_ways(self):
        report = self.report(self.open_sphere(), "a.3dm", "--open")
        self.assertFalse(report["brep"]["solid"])
        [loop] = report["components"][0]["boundary"]
        limit = 0.002 * report["deviation"]["diagonal"]
        for side in ("source_to_surface", "surface_to_source"):
            self.assertGreater(loop[side]["samples"], 0)
            self.assertLess(loop[side]["max"], limit)

    def test_holes_are_filled_up_to_the_size_asked_for(self):
        mesh = self.open_sphere()
        report = self.report(mesh, "a.3dm", "--fill-holes", "50%", "--solid")
        self.assertTrue(report["brep"]["solid"])
        [filled] = [r for r in report["input"]["repairs"] if r["code"] == "hole_filled"]
        self.assertIn("vertex", filled["message"])
        self.assert_refused(5, "1 boundary loop", mesh, "b.3dm", "--fill-holes", "0.01%", "--solid")
        run = self.run_command(mesh, "b.3dm", "--fill-holes", "wide")
        self.assertEqual(run.returncode, 2)
        self.assertIn("--fill-holes wide", run.stderr)

    def test_components_are_converted_as_asked(self):
        vertices, faces = read_obj(SPHERE)
        n = len(vertices)
        moved = [(0.5 * x + 3, 0.5 * y, 0.5 * z) for x, y, z in vertices]
        mesh = self.write("two.off", off(
            moved + vertices, faces + [(a + n, b + n, c + n) for a, b, c in faces]))
        report = self.report(mesh, "a.3dm")
        self.assertEqual(len(report["components"]), 2)
        report = self.report(mesh, "b.3dm", "--components", "largest")
        self.assertEqual([c["first_face"] for c in report["components"]], [len(faces)])
        self.assertIn("components_left_out", [w["code"] for w in report["warnings"]])
        report = self.report(mesh, "c.3dm", "c.step", "--components", "split")
        self.assertEqual([o["path"] for o in report["outputs"]],
                         ["c-1.3dm", "c-2.3dm", "c-1.step", "c-2.step"])
        for output in report["outputs"]:
            self.assertTrue((self.folder / output["path"]).is_file())


class Points(CliTest):
    def sphere(self, count=1500, keep=lambda p: True):
        points = []
        for i in range(count):
            z = 1 - (2 * i + 1) / count
            r, a = math.sqrt(1 - z * z), math.pi * (3 - math.sqrt(5)) * i
            points.append((r * math.cos(a), r * math.sin(a), z))
        return [p for p in points if keep(p)]

    def cloud(self, name, points):
        return self.write(name, "".join("%.9g %.9g %.9g\n" % p for p in points))

    def test_points_become_a_solid_with_a_report_that_follows_its_schema(self):
        cloud = self.cloud("scan.xyz", self.sphere())
        run = self.run_command(cloud, "a.step", "--json", "a.json", "--solid")
        self.assertEqual(run.returncode, 0, run.stderr)
        for word in ("points    1500", "noise", "topology  closed", "to points rms", "solid     yes"):
            self.assertIn(word, run.stderr)
        report = json.loads((self.folder / "a.json").read_text())
        rules = json.loads((ROOT / "docs/schema/report.schema.json").read_text())
        self.assertEqual(schema.errors(report, rules), [])
        self.assertEqual(report["input"]["points"], 1500)
        self.assertEqual(report["cloud"]["topology"], "closed")
        names = [stage["name"] for stage in report["stages"]]
        self.assertLess(names.index("normals"), names.index("reconstruct"))
        self.assertLess(names.index("reconstruct"), names.index("check"))

    def test_a_ply_without_faces_and_an_obj_of_vertices_are_points(self):
        points = self.sphere(600)
        ply = ("ply\nformat ascii 1.0\nelement vertex %d\nproperty float x\nproperty float y\n"
               "property float z\nend_header\n" % len(points))
        ply += "".join("%.9g %.9g %.9g\n" % p for p in points)
        obj = "".join("v %.9g %.9g %.9g\n" % p for p in points)
        for name, text in (("a.ply", ply), ("b.obj", obj)):
            run = self.run_command("--check", self.write(name, text))
            self.assertEqual(run.returncode, 0, run.stderr)
            self.assertIn("mesh made of 600 points", run.stdout)

    def test_a_view_from_one_side_is_open_and_refused_as_a_solid_with_the_place(self):
        cloud = self.cloud("scan.xyz", self.sphere(3000, lambda p: p[2] > 0.2))
        run = self.run_command(cloud, "a.step", "--viewpoint", "0,0,9")
        self.assertEqual(run.returncode, 0, run.stderr)
        self.assertIn("topology  open", run.stderr)
        self.assertIn("solid     no (valid: yes)", run.stderr)
        self.assert_refused(5, "the points do not close", cloud, "b.step", "--solid")

    def test_wrong_use_is_exit_code_2(self):
        cloud = self.cloud("scan.xyz", self.sphere(100))
        for words in (["--viewpoint", "1,2"], ["--viewpoint", "1,2,x"], ["--viewpoint", "1,2,nan"],
                      ["--depth", "2"], ["--depth", "99"], ["--normals", "some"]):
            run = self.run_command(cloud, "a.step", *words)
            self.assertEqual(run.returncode, 2, (words, run.stderr))

    def test_clouds_that_show_no_surface_are_exit_code_5(self):
        self.assert_refused(5, "too few", self.cloud("few.xyz", self.sphere(12)), "a.step")
        line = [(i * 0.1, i * 0.2, 0.0) for i in range(100)]
        self.assert_refused(5, "line", self.cloud("line.xyz", line), "a.step")
        self.assert_refused(5, "too few", self.cloud("same.xyz", [(1.0, 2.0, 3.0)] * 500), "a.step")
        bare = self.cloud("bare.xyz", self.sphere(200))
        self.assert_refused(5, "no normal", bare, "a.step", "--normals", "given")


class Constraints(CliTest):
    def constraints(self):
        return json.loads((self.folder / "c.json").read_text())

    def test_what_a_run_writes_gives_a_domain_with_the_same_vertices(self):
        run = self.run_command(SPHERE, "--constraints-out", "c.json", "--domain-out", "d.json")
        self.assertEqual(run.returncode, 0, run.stderr)
        rules = json.loads((ROOT / "docs/schema/constraints.schema.json").read_text())
        self.assertEqual(schema.errors(self.constraints(), rules), [])
        run = self.run_command(SPHERE, "a.3dm", "--constraints", "c.json", "--domain-out", "e.json")
        self.assertEqual(run.returncode, 0, run.stderr)
        before, after = (
            json.loads((self.folder / name).read_text())["components"][0]
            for name in ("d.json", "e.json")
        )
        self.assertLessEqual(len(before["vertices"]), len(after["vertices"]))
        wanted = [s["vertex"] for s in self.constraints()["sites"] if "vertex" in s]
        for v in wanted:
            self.assertIn(v, after["vertices"])

    def test_a_conflict_names_the_items_and_writes_nothing(self):
        self.run_command(SPHERE, "--constraints-out", "c.json")
        c = self.constraints()
        for crossing in ([0, 1], [1, 0]):
            c["pairings"] = [{"demand": "required", "sites": [0, 1]}]
            c["adjacencies"] = [{"demand": "forbidden", "sites": crossing}]
            self.write("c.json", json.dumps(c))
            run = self.assert_refused(5, "pairing 0", SPHERE, "a.3dm", "--constraints", "c.json")
            self.assertIn("adjacency 0", run.stderr)

    def test_constraints_of_another_mesh_are_refused(self):
        self.run_command(SPHERE, "--constraints-out", "c.json")
        self.assert_refused(5, "signature", str(EXAMPLES / "torso.off"), "a.3dm",
                            "--constraints", "c.json")

    def test_a_constraint_that_is_misspelt_is_refused_by_pointer(self):
        self.run_command(SPHERE, "--constraints-out", "c.json")
        c = self.constraints()
        c["sites"][3] = {"vertx": 7}
        self.write("c.json", json.dumps(c))
        self.assert_refused(5, "/sites/3", SPHERE, "a.3dm", "--constraints", "c.json")

    def test_a_domain_and_constraints_contradict_each_other(self):
        self.assert_refused(2, "--constraints", SPHERE, "a.3dm", "--constraints", "c.json",
                            "--domain-in", "d.json")


class Check(CliTest):
    def test_a_good_mesh_is_accepted_on_stdout(self):
        run = self.run_command("--check", SPHERE, "--quiet")
        self.assertEqual((run.returncode, run.stderr), (0, ""))
        self.assertIn("verdict: accepted", run.stdout)

    def test_a_bad_mesh_is_rejected_with_its_defects(self):
        vertices, faces = read_obj(SPHERE)
        mesh = self.write("a.off", off(vertices, faces[1:]))
        run = self.run_command("--check", mesh, "--solid", "--json", "-")
        self.assertEqual(run.returncode, 5)
        report = json.loads(run.stdout)
        self.assertEqual(report["schema"], "bot2nurbs.check/1")
        self.assertIn("open_boundary", [d["code"] for d in report["defects"]])
        self.assertEqual(len(report["boundary_loops"][0]), 3)
        self.assertEqual(report["rejection"]["code"], "open_mesh")
        self.assertEqual(os.listdir(self.folder), ["a.off"])


class Interruption(CliTest):
    def interrupt_in(self, stage):
        """Starts a conversion, sends SIGINT when the stage is announced; the seconds it took."""
        with subprocess.Popen(
            [COMMAND, str(EXAMPLES / "knot.ply"), "a.3dm", "a.step", "--domain-out", "d.json"],
            stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, cwd=self.folder,
        ) as process:
            for line in process.stderr:
                if line.startswith(stage):
                    break
            sent = time.monotonic()
            process.send_signal(signal.SIGINT)
            process.communicate(timeout=60)
            took = time.monotonic() - sent
        self.assertEqual(process.returncode, 130)
        self.assertEqual(os.listdir(self.folder), [])
        return took

    def test_ctrl_c_leaves_no_file_and_ends_soon(self):
        # 50 ms between polls, with room for a busy machine.
        for stage in ("layout", "fit"):
            self.assertLess(self.interrupt_in(stage), 2.0, stage)


class OnATerminal(CliTest):
    def run_on_terminal(self, **environment):
        master, slave = pty.openpty()
        process = subprocess.Popen(
            [COMMAND, "missing.off", "a.3dm"], stderr=slave, stdout=subprocess.PIPE,
            cwd=self.folder, env={**os.environ, **environment},
        )
        os.close(slave)
        text = b""
        try:
            while chunk := os.read(master, 4096):
                text += chunk
        except OSError:
            pass  # The other end is closed.
        os.close(master)
        process.communicate()
        return text.decode()

    def test_errors_have_colour_only_without_no_color(self):
        environment = {"NO_COLOR": ""}
        self.assertIn("\033[31merror:", self.run_on_terminal(**environment))
        self.assertNotIn("\033[31m", self.run_on_terminal(NO_COLOR="1"))

    def test_progress_is_a_bar(self):
        self.assertIn("] ", self.run_on_terminal())


if __name__ == "__main__":
    unittest.main()
