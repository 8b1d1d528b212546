// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>

namespace bot2nurbs {

using Matrix16 = Eigen::Matrix<double, 16, 16>;

//! Exact thin-plate energy of a bicubic Bezier patch over the unit square: for coefficients x
//! (number 4 i + j), x^T E x = integral of x_uu^2 + 2 x_uv^2 + x_vv^2. \cite eck_hoppe_1996
const Matrix16& thin_plate_matrix();

//! A 13 x 16 matrix R with R^T R = thin_plate_matrix(): the energy as least-squares rows (its
//! kernel is 1, u and v).
const Eigen::Matrix<double, 13, 16>& thin_plate_rows();

} // namespace bot2nurbs
