// SPDX-License-Identifier: MIT
#pragma once

namespace bot2nurbs {

//! How the weights of a convex map were chosen: each is tried when the one before folds in doubles.
enum class MapLevel {
    harmonic, //!< Of the shape: bounded cotangents, or mean values where these do better.
    uniform,  //!< All equal.
    exact,    //!< All equal, solved in 100 digits.
};

} // namespace bot2nurbs
