// SPDX-License-Identifier: Apache-2.0
// What a network captures, as Python sees it: the library's counts with all that its measures need.
#pragma once

#include <optional>

#include "arrays.hpp"

namespace vantage::python {

struct Evaluation {
  NetworkCounts counts = {};
  double goal_density = 1;
  std::uint64_t voxels = 0;  ///< Of the site.
  std::optional<RegistrationOptions> registration = std::nullopt;
  std::optional<VoxelField> field = std::nullopt;
  /// The same network's counts on all surfaces, and how many voxels these have, where registration goes by them.
  NetworkCounts surroundings = {};
  std::uint64_t surroundings_voxels = 0;
};

/// An overlap matrix as an array that shares its numbers.
inline py::array_t<double> matrix_of(OverlapMatrix matrix) {
  const auto n = static_cast<py::ssize_t>(matrix.size());
  if (n == 0) return py::array_t<double>(Shape{0, 0});
  auto kept = std::make_unique<OverlapMatrix>(std::move(matrix));
  const double* data = kept->row(0).data();
  const py::capsule owner(kept.get(), [](void* held) { delete static_cast<OverlapMatrix*>(held); });
  kept.release();
  return py::array_t<double>(Shape{n, n}, data, owner);
}

}  // namespace vantage::python
