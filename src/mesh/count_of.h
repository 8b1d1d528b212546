// SPDX-License-Identifier: MIT
#pragma once

#include "bot2nurbs/result.h"

#include <string>

namespace bot2nurbs {

//! A number and its noun: "1 face", "2 faces".
inline std::string count_of(Index n, const char* one, const char* many)
{
    return std::to_string(n) + " " + (n == 1 ? one : many);
}

} // namespace bot2nurbs
