// SPDX-License-Identifier: Apache-2.0
#include "optimise/box_constraints.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "vantage/error.hpp"

namespace vantage::optimise {
namespace {

constexpr double kMargin = 0.05;  // width of the quadratic part, as a share of the range

}  // namespace

BoxConstraints::BoxConstraints(std::size_t dimension, const std::optional<Bounds>& bounds) : dimension_(dimension) {
  if (dimension == 0)
    throw Error(Errc::invalid_argument, "optimiser: the dimension is 0; give at least one coordinate");
  if (!bounds) return;
  if (bounds->lower.size() != dimension || bounds->upper.size() != dimension)
    throw Error(Errc::invalid_argument, "optimiser: " + std::to_string(bounds->lower.size()) + " lower and " +
                                            std::to_string(bounds->upper.size()) + " upper bounds for " +
                                            std::to_string(dimension) + " coordinates; give one pair for each");
  for (std::size_t i = 0; i < dimension; ++i) {
    const double low = bounds->lower[i], high = bounds->upper[i];
    if (!(low < high) || !std::isfinite(high - low))
      throw Error(Errc::invalid_argument, "optimiser: bounds [" + std::to_string(low) + ", " + std::to_string(high) +
                                              "] of coordinate " + std::to_string(i) +
                                              " must be finite and the lower one smaller; leave out fixed coordinates");
  }
  lower_ = bounds->lower;
  upper_ = bounds->upper;
}

double BoxConstraints::from_unit(double t, std::size_t axis) const {
  if (!bounded()) return t;
  return std::clamp(lower_[axis] + t * (upper_[axis] - lower_[axis]), lower_[axis], upper_[axis]);
}

double BoxConstraints::to_unit(double x, std::size_t axis) const {
  if (!bounded()) return x;
  return std::clamp((x - lower_[axis]) / (upper_[axis] - lower_[axis]), 0.0, 1.0);
}

bool BoxConstraints::contains(std::span<const double> x) const {
  if (x.size() != dimension_) return false;
  for (std::size_t i = 0; i < x.size(); ++i)
    if (!(bounded() ? lower_[i] <= x[i] && x[i] <= upper_[i] : std::isfinite(x[i]))) return false;
  return true;
}

void BoxConstraints::require_inside(std::span<const double> x) const {
  if (x.size() != dimension_)
    throw Error(Errc::invalid_argument, "optimiser: a point has " + std::to_string(x.size()) +
                                            " coordinates instead of " + std::to_string(dimension_));
  for (std::size_t i = 0; i < x.size(); ++i) {
    if (bounded() ? lower_[i] <= x[i] && x[i] <= upper_[i] : std::isfinite(x[i])) continue;
    throw Error(Errc::invalid_argument,
                "optimiser: coordinate " + std::to_string(i) + " of a point is " + std::to_string(x[i]) +
                    (bounded() ? ", outside [" + std::to_string(lower_[i]) + ", " + std::to_string(upper_[i]) + "]"
                               : ", not a finite number"));
  }
}

double squeeze(double genotype) {
  constexpr double kLow = -kMargin, kLength = 1 + 2 * kMargin;
  // Mirrors at both ends of the preimage.
  double t = std::fmod(genotype - kLow, 2 * kLength);
  if (t < 0) t += 2 * kLength;
  if (t > kLength) t = 2 * kLength - t;
  t += kLow;
  if (t < kMargin) return std::clamp((t + kMargin) * (t + kMargin) / (4 * kMargin), 0.0, 1.0);
  if (t <= 1 - kMargin) return t;
  return std::clamp(1 - (1 + kMargin - t) * (1 + kMargin - t) / (4 * kMargin), 0.0, 1.0);
}

double unsqueeze(double t) {
  if (t < kMargin) return 2 * std::sqrt(kMargin * t) - kMargin;
  if (t <= 1 - kMargin) return t;
  return 1 + kMargin - 2 * std::sqrt(kMargin * (1 - t));
}

}  // namespace vantage::optimise
