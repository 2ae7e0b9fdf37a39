// SPDX-License-Identifier: Apache-2.0
#include "core/normal_table.hpp"

#include <array>
#include <cmath>
#include <numbers>
#include <vector>

namespace vantage {
namespace {

double upper_tail(double z) { return 0.5 * std::erfc(z / std::numbers::sqrt2); }

double density(double z) { return std::exp(-0.5 * z * z) / std::sqrt(2 * std::numbers::pi); }

// Returns the coefficients of the cubic with the given values at 0, ⅓, ⅔ and 1.
std::array<double, 4> cubic_through(const std::array<double, 4>& y) {
  const double d1 = y[1] - y[0], d2 = y[2] - y[0], d3 = y[3] - y[0];
  return {y[0], 9 * d1 - 4.5 * d2 + d3, -22.5 * d1 + 18 * d2 - 4.5 * d3, 13.5 * d1 - 13.5 * d2 + 4.5 * d3};
}

std::vector<float> make_table() {
  const auto quantile_of = [](double m) { return truncated_normal_quantile((m + 0.5) * 0x1p-32); };
  const std::uint32_t segments = normal_octaves * normal_segments;
  // Both ends of every cubic are floats shared with the neighbour, so rounding of c0 makes no step at a joint.
  std::vector<float> joints(segments + 1);
  const auto start_of = [](std::uint32_t row) {
    return std::ldexp(1.0 + static_cast<double>(row % normal_segments) / normal_segments,
                      static_cast<int>(row / normal_segments));
  };
  for (std::uint32_t row = 0; row < segments; ++row) joints[row] = static_cast<float>(quantile_of(start_of(row)));
  joints[segments] = 0;  // p = ½

  std::vector<float> table;
  table.reserve(std::size_t{4} * normal_rows);
  for (std::uint32_t row = 0; row < segments; ++row) {
    const double begin = start_of(row), end = start_of(row + 1);
    std::array<double, 4> y{quantile_of(begin), quantile_of(begin + (end - begin) / 3),
                            quantile_of(begin + (end - begin) * 2 / 3), row + 1 < segments ? quantile_of(end) : 0.0};
    const double at_begin = joints[row] - y[0], at_end = joints[row + 1] - y[3];
    for (int i = 0; i < 4; ++i) y[i] += at_begin + (at_end - at_begin) * i / 3;
    for (const double c : cubic_through(y)) table.push_back(static_cast<float>(c));
  }
  table.insert(table.end(), {static_cast<float>(quantile_of(0)), 0.0f, 0.0f, 0.0f});
  return table;
}

}  // namespace

double truncated_normal_quantile(double p) {
  const double beyond = upper_tail(kNormalLimit);
  const double q = beyond + p * (1 - 2 * beyond);
  // Newton on log Q(z) = log q: concave and falling, so from 0 it overshoots once and then converges to the root.
  double z = 0;
  for (int i = 0; i < 60; ++i) {
    const double tail = upper_tail(z);
    const double step = std::log(tail / q) * tail / density(z);
    z += step;
    if (std::abs(step) <= 1e-16 * (1 + z)) break;
  }
  return z;
}

std::span<const float> normal_table() {
  static const std::vector<float> table = make_table();
  return table;
}

}  // namespace vantage
