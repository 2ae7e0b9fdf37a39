// SPDX-License-Identifier: Apache-2.0
// Box constraints. Optimisers work in unit coordinates, [0, 1] along each axis; without bounds these are the user's
// own.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "vantage/optimiser.hpp"

namespace vantage::optimise {

class BoxConstraints {
 public:
  // Throws Error invalid_argument for a pair that is missing, not finite or not in order.
  BoxConstraints(std::size_t dimension, const std::optional<Bounds>& bounds);

  bool bounded() const { return !lower_.empty(); }
  std::span<const double> lower() const { return lower_; }
  std::span<const double> upper() const { return upper_; }
  // Never outside the bounds, whatever the rounding.
  double from_unit(double t, std::size_t axis) const;
  double to_unit(double x, std::size_t axis) const;
  bool contains(std::span<const double> x) const;
  // Throws Error invalid_argument, naming the coordinate, unless x has the right size, is finite and within the bounds.
  void require_inside(std::span<const double> x) const;

 private:
  std::size_t dimension_;
  std::vector<double> lower_, upper_;
};

// Smooth transform that lets CMA-ES search without bounds: the identity inside, quadratic towards each bound, mirrored
// beyond (Hansen's piecewise quadratic "BoxConstraintsLinQuadTransformation"). Unit coordinates on both sides.
double squeeze(double genotype);
// The genotype in [−margin, 1 + margin] that squeeze() maps to t in [0, 1].
double unsqueeze(double t);

}  // namespace vantage::optimise
