#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Runs clang-tidy with the rules of .clang-tidy over the library and the command, or over the
# source files given. Needs a configured build (build/release); installs clang-tidy where missing.
set -euo pipefail
cd "$(dirname "$0")/.."

scripts/install_dependencies.sh --tidy
[ -f build/release/compile_commands.json ] || cmake --preset release
files=("$@")
[ ${#files[@]} -gt 0 ] || mapfile -t files < <(find src cli -name '*.cpp' | sort)
printf '%s\0' "${files[@]}" |
    xargs -0 -n 1 -P "$(nproc)" clang-tidy-16 -p build/release --quiet --warnings-as-errors='*'
