// SPDX-License-Identifier: Apache-2.0
// Eigen arrays as spans, for states and the public interface; matrices column by column.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <span>

namespace vantage {

inline std::span<double> as_span(Eigen::VectorXd& v) { return {v.data(), static_cast<std::size_t>(v.size())}; }
inline std::span<const double> as_span(const Eigen::VectorXd& v) {
  return {v.data(), static_cast<std::size_t>(v.size())};
}
inline std::span<const double> as_span(const Eigen::MatrixXd& a) {
  return {a.data(), static_cast<std::size_t>(a.size())};
}

}  // namespace vantage
