#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Fails where a committed C++ file is not as clang-format 14 writes it; --fix rewrites the files.
set -euo pipefail
cd "$(dirname "$0")/.."

mode=(--dry-run -Werror)
[ "${1-}" = --fix ] && mode=(-i)
git ls-files -z '*.h' '*.cpp' | xargs -0 -r clang-format-14 "${mode[@]}"
