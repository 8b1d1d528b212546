#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Draws the pictures of docs/images. Needs what scripts/install_dependencies.sh --render installs.
set -euo pipefail
cd "$(dirname "$0")/.."
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

for model in bracket.ply arch.obj hood.obj knot.ply torso.off; do
    scripts/render.py "examples/$model" "$work/${model%.*}" > "$work/log" 2>&1
done
cp "$work/bracket-layout.png" docs/images/bracket.png
cp "$work/bracket-zebra.png" "$work/bracket-error.png" "$work/arch-zebra.png" docs/images
cp "$work/hood-layout.png" docs/images/hood.png
# Of docs/results/pictures.md, with the first. The scan is not ours, and is drawn where it is.
if [[ -f ../shared/data/clouds/hoppe_distcap.xyz ]]; then
    build/release/bot2nurbs ../shared/data/clouds/hoppe_distcap.xyz --quiet \
        --tessellation "$work/distcap.ply"
    scripts/render.py "$work/distcap.ply" "$work/distcap" > "$work/log" 2>&1
    cp "$work/distcap-layout.png" docs/images
fi
for model in knot torso; do
    cp "$work/$model-layout.png" "$work/$model-error.png" docs/images
done
