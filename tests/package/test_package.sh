#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Builds and runs the consumer project against bot2nurbs.
#
#   test_package.sh find_package|pkg_config BUILD    the build is installed into a scratch prefix
#   test_package.sh add_subdirectory SOURCE BUILD    the sources are a part of the consumer
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
mode=$1
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT

configure=(cmake -S "$here/consumer" -B "$scratch/build" -G Ninja -DCMAKE_BUILD_TYPE=Release)
case $mode in
find_package | pkg_config)
    cmake --install "$2" --prefix "$scratch/prefix" >/dev/null
    test -x "$scratch/prefix/bin/bot2nurbs"
    ;;&
find_package)
    "${configure[@]}" -DCMAKE_PREFIX_PATH="$scratch/prefix"
    ;;
pkg_config)
    export PKG_CONFIG_PATH
    PKG_CONFIG_PATH=$(dirname "$(find "$scratch/prefix" -name bot2nurbs.pc)")
    mkdir "$scratch/build"
    read -ra flags < <(pkg-config --define-variable=prefix="$scratch/prefix" \
        --cflags --libs --static bot2nurbs)
    c++ -std=c++17 "$here/consumer/main.cpp" -o "$scratch/build/consumer" "${flags[@]}"
    ;;
add_subdirectory)
    # The same build type and compiler cache as the tested build: nearly nothing compiles twice.
    werror=$(sed -n 's/^BOT2NURBS_WERROR:BOOL=//p' "$3/CMakeCache.txt")
    "${configure[@]}" -DBOT2NURBS_SOURCE="$2" -DBOT2NURBS_WERROR="$werror"
    # As a part it brings neither its command nor its tests nor its install rules.
    ! grep -E '^BOT2NURBS_(CLI|TESTS|INSTALL):BOOL=ON' "$scratch/build/CMakeCache.txt"
    ;;
esac
[ "$mode" = pkg_config ] || cmake --build "$scratch/build" --target consumer
"$scratch/build/consumer"
