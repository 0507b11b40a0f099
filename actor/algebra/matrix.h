// SPDX-License-Identifier: Apache-2.0
// Matrices and vectors. The only user of Eigen: what computes with matrices names them by these.
#pragma once

#include <Eigen/Dense>

namespace corridor {

// Of doubles, of a size that the compiler knows: control.
template <int kRows, int kColumns>
using Matrix = Eigen::Matrix<double, kRows, kColumns>;

// Of floats, of any size: networks. Maps look at memory of others'.
using Vector = Eigen::VectorXf;
using VectorView = Eigen::Ref<const Vector>;
using VectorMap = Eigen::Map<const Vector>;
using RowMajorMap =
    Eigen::Map<const Eigen::Matrix<float, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>>;

}  // namespace corridor
