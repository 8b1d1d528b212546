#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Installs what is missing to build and test bot2nurbs on Debian 12 (or a system with its packages).
# Works as root, or through sudo. Does nothing, and needs no network, where nothing is missing.
#
#   scripts/install_dependencies.sh [--render] [--tidy] [--bench]
#
# --render adds what scripts/render.py needs, --tidy what scripts/tidy.sh needs, --bench what
# BOT2NURBS_BENCH needs.
set -euo pipefail
cd "$(dirname "$0")/.."

packages=(
    build-essential cmake ninja-build ccache clang-format-14 python3
    libeigen3-dev libnanoflann-dev liblemon-dev libtbb-dev nlohmann-json3-dev libcli11-dev libfmt-dev
    libocct-foundation-dev libocct-modeling-data-dev libocct-modeling-algorithms-dev
    libocct-data-exchange-dev libboost-dev libgtest-dev pkg-config)
for argument in "$@"; do
    case $argument in
    --render) packages+=(python3-vtk9 python3-numpy python3-matplotlib xvfb xauth) ;;
    --tidy) packages+=(clang-tidy-16) ;;
    --bench) packages+=(libbenchmark-dev) ;;
    *)
        echo "usage: scripts/install_dependencies.sh [--render] [--tidy] [--bench]" >&2
        exit 2
        ;;
    esac
done

# The judge of .3dm files is openNURBS as a Node package; Node 18 or later runs it.
has_node() {
    command -v node >/dev/null && command -v npm >/dev/null &&
        [ "$(node -p 'process.versions.node.split(".")[0]')" -ge 18 ]
}
has_node || packages+=(nodejs npm)

missing=()
for package in "${packages[@]}"; do
    [ "$(dpkg-query -W -f='${db:Status-Status}' "$package" 2>/dev/null)" = installed ] ||
        missing+=("$package")
done

if [ ${#missing[@]} -gt 0 ]; then
    root=()
    if [ "$(id -u)" -ne 0 ]; then
        command -v sudo >/dev/null || {
            echo "Missing packages: ${missing[*]}. Install them, or run this as root or with sudo." >&2
            exit 1
        }
        root=(sudo)
    fi
    echo "Installing: ${missing[*]}"
    "${root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get update -q
    "${root[@]}" env DEBIAN_FRONTEND=noninteractive \
        apt-get install -q -y --no-install-recommends "${missing[@]}"
fi

# The lock file pins the judge's version; npm leaves a copy of it beside what it installed.
if [ -f tests/judges/package-lock.json ] &&
    [ ! tests/judges/node_modules/.package-lock.json -nt tests/judges/package-lock.json ]; then
    (cd tests/judges && npm ci --no-audit --no-fund)
    touch tests/judges/node_modules/.package-lock.json
fi
