// SPDX-License-Identifier: Apache-2.0
// Arrays of an evaluation.
#pragma once

#include <memory>

#include "arrays.hpp"
#include "vantage/evaluation.hpp"

namespace vantage::python {

/// A matrix of pairs as an array that takes over its numbers.
inline py::array_t<double> matrix_of(PairMatrix matrix) {
  const auto n = static_cast<py::ssize_t>(matrix.size());
  if (n == 0) return py::array_t<double>(Shape{0, 0});
  auto kept = std::make_unique<PairMatrix>(std::move(matrix));
  const double* data = kept->row(0).data();
  const py::capsule owner(kept.get(), [](void* held) { delete static_cast<PairMatrix*>(held); });
  kept.release();
  return py::array_t<double>(Shape{n, n}, data, owner);
}

using Data = Typed<"Optional[Dict[str, float]]">;
/// Returns the data in the scans of an evaluation; None if it is not known.
Data data_of(const Evaluation& e);
extern const char* const kData;  // its docstring

}  // namespace vantage::python
