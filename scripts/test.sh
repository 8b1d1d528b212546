#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Installs what is missing, builds with warnings as errors, and runs every check and test.
set -euo pipefail
cd "$(dirname "$0")/.."

scripts/install_dependencies.sh
scripts/check_layers.py
scripts/check_format.sh

cmake --preset release -DBOT2NURBS_WERROR=ON -DBOT2NURBS_TESTS=ON
cmake --build --preset release
ctest --test-dir build/release --output-on-failure -j "$(nproc)"
