#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Installs what is missing, builds the command, converts an example model, and shows what came out.
set -euo pipefail
cd "$(dirname "$0")/.."

scripts/install_dependencies.sh
cmake --preset release
cmake --build --preset release --target bot2nurbs_cli

model=examples/bracket.ply
out=build/demo
mkdir -p "$out"
build/release/bot2nurbs "$model" "$out/bracket.3dm" "$out/bracket.step" --json "$out/bracket.json"

echo
echo "From $model ($(stat -c %s "$model") bytes) came, in $PWD/$out:"
(cd "$out" && ls -l bracket.3dm bracket.step bracket.json | awk '{printf "  %10d bytes  %s\n", $5, $NF}')
python3 - "$out/bracket.json" <<'PYTHON'
import json, sys
r = json.load(open(sys.argv[1]))
d, c, b = r["deviation"], r["continuity"], r["brep"]
print(f"  {b['faces']} bicubic patches, {r['domain']['extraordinary']} extraordinary vertices")
print(f"  distance to the mesh: rms {100 * d['rms_relative']:.3f} %, max {100 * d['max_relative']:.3f} % of the diagonal")
print(f"  joins: largest gap {c['max_gap']:g}, largest angle between normals {c['max_g1_angle_deg']:.1e} degrees")
print(f"  valid: {b['valid']}, solid: {b['solid']}")
PYTHON
