# SPDX-License-Identifier: MIT
"""scripts/check_layers.py finds each kind of violation, and none where there is none."""

import importlib.util
import tempfile
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent.parent
spec = importlib.util.spec_from_file_location("check_layers", ROOT / "scripts/check_layers.py")
check_layers = importlib.util.module_from_spec(spec)
spec.loader.exec_module(check_layers)


class CheckLayers(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.root = Path(self.folder.name)
        self.write("CMakeLists.txt", "set(BOT2NURBS_LAYERS core mesh domain spline)\n")
        self.write("include/bot2nurbs/vec.h", "#include <array>\n")
        self.write("include/bot2nurbs/manifold_mesh.h", '#include "bot2nurbs/vec.h"\n')
        self.write("src/mesh/a.cpp", '#include "core/b.h"\n#include <Eigen/Core>\n')
        self.write("cli/main.cpp", '#include "bot2nurbs/manifold_mesh.h"\n#include "options.h"\n')

    def tearDown(self):
        self.folder.cleanup()

    def write(self, name, text):
        path = self.root / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text)

    def expect_one(self, words):
        found = check_layers.check(self.root)
        self.assertEqual(len(found), 1, found)
        self.assertIn(words, found[0])

    def test_a_tree_that_points_left_has_no_violation(self):
        self.assertEqual(check_layers.check(self.root), [])

    def test_a_private_header_to_the_right_is_found(self):
        self.write("src/mesh/bad.cpp", '#include "spline/masks.h"\n')
        self.expect_one("src/mesh/bad.cpp: mesh includes spline/masks.h")

    def test_a_public_header_to_the_right_is_found(self):
        self.write("src/mesh/bad.cpp", '#include "bot2nurbs/spline_network.h"\n')
        self.expect_one("mesh includes bot2nurbs/spline_network.h of spline")

    def test_a_public_header_that_includes_one_to_its_right_is_found(self):
        self.write("include/bot2nurbs/vec.h", '#include "bot2nurbs/manifold_mesh.h"\n')
        self.expect_one("core includes bot2nurbs/manifold_mesh.h of mesh")

    def test_a_foreign_include_in_a_public_header_is_found(self):
        self.write("include/bot2nurbs/vec.h", "#include <Eigen/Core>\n")
        self.expect_one("a public header includes Eigen/Core")

    def test_a_foreign_name_in_a_public_header_is_found_outside_comments(self):
        self.write("include/bot2nurbs/vec.h", "//! As Eigen::Vector3d.\nstruct Vec3;\n")
        self.assertEqual(check_layers.check(self.root), [])
        self.write("include/bot2nurbs/vec.h", "void f(const Eigen::VectorXd &);\n")
        self.expect_one("a public header names Eigen")

    def test_a_public_header_without_a_layer_is_found(self):
        self.write("include/bot2nurbs/unheard_of.h", "#pragma once\n")
        self.expect_one("has no layer")

    def test_a_private_header_in_the_command_is_found(self):
        self.write("cli/bad.cpp", '#include "mesh/closest_point.h"\n')
        self.expect_one("includes the private header mesh/closest_point.h")

    def test_this_repository_has_no_violation(self):
        self.assertEqual(check_layers.check(ROOT), [])


if __name__ == "__main__":
    unittest.main()
