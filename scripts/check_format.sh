#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Fails where a committed C++ file is not as clang-format 14 writes it; --fix rewrites the files.
set -euo pipefail
cd "$(dirname "$0")/.."

mode=(--dry-run -Werror)
[ "${1-}" = --fix ] && mode=(-i)
find include src cli tests bench fuzz \( -name node_modules -prune \) -o \
    \( -name '*.h' -o -name '*.cpp' \) -print0 2>/dev/null |
    xargs -0 -r clang-format-14 "${mode[@]}"
