#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Checks that includes point to the left only, in the order of the data's way.

    scripts/check_layers.py [ROOT]

The order is BOT2NURBS_LAYERS of CMakeLists.txt. Rules:
1. A file of src/LAYER includes private headers of LAYER or of layers to its left.
2. A public header belongs to the layer that implements it (PUBLIC_HEADERS below); a file of
   src/LAYER, and a public header of LAYER, includes public headers of LAYER or to its left.
3. Public headers include the C++ standard library and public headers, nothing else, and name
   nothing of another library.
4. The command (cli/) includes public headers, its own, and no private header of src/.
"""

import re
import sys
from pathlib import Path

# The layer of each public header: whoever implements it.
PUBLIC_HEADERS = {
    "result": "core",
    "context": "core",
    "vec": "core",
    "version": "core",
    "tolerance": "core",
    "manifold_mesh": "mesh",
    "polygon_mesh": "mesh",
    "check_mesh": "mesh",
    "repair_mesh": "mesh",
    "closest_point": "mesh",
    "detect_features": "mesh",
    "fill_holes": "mesh",
    "surface_samples": "mesh",
    "point_cloud": "cloud",
    "clean_points": "cloud",
    "estimate_normals": "cloud",
    "find_normals": "cloud",
    "orient_normals": "cloud",
    "reconstruct_surface": "cloud",
    "map_level": "maps",
    "quad_complex": "domain",
    "quad_domain": "domain",
    "domain_file": "domain",
    "validate_domain": "domain",
    "domain_samples": "domain",
    "domain_constraints": "domain",
    "refine_domain": "domain",
    "layout_quality": "domain",
    "layout": "layout",
    "import_quads": "layout",
    "cage_surface": "layout",
    "spline_network": "spline",
    "fit_network": "fit",
    "deviation": "brep",
    "point_deviation": "brep",
    "hausdorff_bound": "brep",
    "refine_to_tolerance": "refine",
    "brep": "brep",
    "read_mesh": "io",
    "read_points": "io",
    "write_brep": "io",
    "curve_deviation": "convert",
    "report": "convert",
    "cloud_report": "convert",
    "convert": "convert",
}

# The standard headers of C++17: a public header includes these and public headers.
STANDARD_HEADERS = set(
    """algorithm any array atomic bitset cassert cfloat chrono cinttypes climits cmath complex
    condition_variable cstddef cstdint cstdio cstdlib cstring ctime deque exception filesystem
    forward_list fstream functional future initializer_list iomanip ios iosfwd iostream istream
    iterator limits list locale map memory mutex new numeric optional ostream queue random ratio
    regex set shared_mutex sstream stack stdexcept streambuf string string_view system_error thread
    tuple type_traits typeindex typeinfo unordered_map unordered_set utility valarray variant
    vector""".split()
)

FOREIGN_NAMES = re.compile(
    r"\b(Eigen|nlohmann|fmt|tbb|oneapi|CLI|lemon|tinyobj|boost|testing|nanoflann)\s*::"
    r"|\b(?:TopoDS|BRep|gp|Geom|TK)_\w+|\bON_\w+\s*[(*&]"
)

INCLUDE = re.compile(r'^\s*#\s*include\s*([<"])([^>"]+)[>"]', re.MULTILINE)


def layers_of(root):
    text = (root / "CMakeLists.txt").read_text()
    match = re.search(r"set\(BOT2NURBS_LAYERS\s+([^)]*)\)", text)
    if not match:
        sys.exit("CMakeLists.txt: set(BOT2NURBS_LAYERS ...) not found")
    return match.group(1).split()


def without_comments(text):
    return re.sub(r"//[^\n]*|/\*.*?\*/", "", text, flags=re.DOTALL)


def check(root):
    """The list of violations, as 'file: what'."""
    order = {layer: i for i, layer in enumerate(layers_of(root))}
    found = []

    def public_layer(header):
        return PUBLIC_HEADERS.get(header[len("bot2nurbs/") : -len(".h")])

    def check_file(path, layer, public):
        name = path.relative_to(root)
        text = path.read_text()
        for kind, header in INCLUDE.findall(text):
            first = header.split("/")[0]
            if header.startswith("bot2nurbs/"):
                owner = public_layer(header)
                if owner is None:
                    found.append(f"{name}: {header} has no layer in scripts/check_layers.py")
                elif layer and order[owner] > order[layer]:
                    found.append(f"{name}: {layer} includes {header} of {owner}, to its right")
            elif public:
                if kind == '"' or header not in STANDARD_HEADERS:
                    found.append(f"{name}: a public header includes {header}")
            elif kind == '"' and first in order and "/" in header:
                if layer is None:
                    found.append(f"{name}: includes the private header {header}")
                elif order[first] > order[layer]:
                    found.append(f"{name}: {layer} includes {header}, to its right")
        if public:
            for match in FOREIGN_NAMES.finditer(without_comments(text)):
                found.append(f"{name}: a public header names {match.group(0).strip()}")

    for path in sorted((root / "include/bot2nurbs").glob("*.h")):
        layer = PUBLIC_HEADERS.get(path.stem)
        if layer is None:
            found.append(f"{path.relative_to(root)}: has no layer in scripts/check_layers.py")
        else:
            check_file(path, layer, public=True)
    for layer in order:
        for path in sorted((root / "src" / layer).rglob("*")):
            if path.suffix in (".h", ".cpp"):
                check_file(path, layer, public=False)
    for path in sorted((root / "cli").glob("*")):
        if path.suffix in (".h", ".cpp"):
            check_file(path, None, public=False)
    return found


def main():
    root = Path(sys.argv[1]) if len(sys.argv) > 1 else Path(__file__).resolve().parent.parent
    found = check(root)
    for line in found:
        print(line, file=sys.stderr)
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
