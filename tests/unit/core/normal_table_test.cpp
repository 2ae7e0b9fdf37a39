// SPDX-License-Identifier: Apache-2.0
#include "core/normal_table.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/philox.hpp"

namespace vantage {
namespace {

// g by bisection on erfc, independent of the library's method.
double quantile_by_bisection(double p) {
  const double beyond = 0.5 * std::erfc(5 / std::sqrt(2.0));
  const double q = beyond + p * (1 - 2 * beyond);
  double low = 0, high = 5;
  for (int i = 0; i < 70; ++i) {
    const double z = 0.5 * (low + high);
    (0.5 * std::erfc(z / std::sqrt(2.0)) > q ? low : high) = z;
  }
  return 0.5 * (low + high);
}

double tail_probability(std::uint32_t m) { return (m + 0.5) * 0x1p-32; }

TEST(TruncatedNormalQuantile, AgreesWithBisection) {
  EXPECT_NEAR(truncated_normal_quantile(0.5), 0.0, 1e-15);
  RandomStream random(1);
  for (int i = 0; i < 2000; ++i) {
    const double p = 0.5 * std::pow(2.0, -32 * random.uniform());
    EXPECT_NEAR(truncated_normal_quantile(p), quantile_by_bisection(p), 1e-12) << p;
  }
}

TEST(NormalTable, HasTheDocumentedShape) {
  ASSERT_EQ(normal_table().size(), 4u * normal_rows);
  for (const float c : normal_table()) EXPECT_TRUE(std::isfinite(c));
}

TEST(NormalTable, CubicsFallAndMeet) {
  const auto rows = normal_table();
  for (std::uint32_t row = 0; row + 1 < normal_rows; ++row) {
    const double c0 = rows[4 * row], c1 = rows[4 * row + 1], c2 = rows[4 * row + 2], c3 = rows[4 * row + 3];
    // The derivative is a parabola: its maximum on [0, 1] is at an end or at the vertex.
    const double at_vertex = c3 < 0 && -c2 / (3 * c3) > 0 && -c2 / (3 * c3) < 1 ? c1 - c2 * c2 / (3 * c3) : c1;
    EXPECT_LT(std::max({c1, c1 + 2 * c2 + 3 * c3, at_vertex}), 0.0) << "row " << row;
    const double next = row + 2 < normal_rows ? rows[4 * (row + 1)] : 0.0;
    EXPECT_NEAR(c0 + c1 + c2 + c3, next, 1e-8) << "row " << row;
  }
}

TEST(NormalTable, EdgeCases) {
  const auto rows = normal_table();
  for (const std::uint32_t m : {0u, 1u, 2u, 3u, 4u, 0x7FFFFFFEu, 0x7FFFFFFFu, 0x40000000u, 0x3FFFFFFFu}) {
    const float z = normal_from_bits(m, rows);
    EXPECT_NEAR(z, quantile_by_bisection(tail_probability(m)), 1e-6) << m;
    EXPECT_GE(z, 0.0f) << m;
    EXPECT_EQ(normal_from_bits(m | 0x80000000u, rows), -z) << m;
  }
  EXPECT_GT(normal_from_bits(0, rows), 4.9999f);
  EXPECT_LE(normal_from_bits(0, rows), 5.0f);
  EXPECT_LT(normal_from_bits(0x7FFFFFFFu, rows), 1e-8f);     // 2^31 − 1
  EXPECT_LT(normal_from_bits(0x80000000u, rows), -4.9999f);  // 2^31
  EXPECT_GT(normal_from_bits(0xFFFFFFFFu, rows), -1e-8f);    // 2^32 − 1
}

// Compares every row at its start, its end and eleven places between with the true quantile.
TEST(NormalTable, EveryRowIsWithinAMillionth) {
  const auto rows = normal_table();
  for (std::uint32_t e = 4; e < normal_octaves; ++e) {
    for (std::uint32_t s = 0; s < normal_segments; ++s) {
      const std::uint64_t begin = (std::uint64_t{16} + s) << (e - 4), length = std::uint64_t{1} << (e - 4);
      for (std::uint64_t k = 0; k <= 12; ++k) {
        const auto m = static_cast<std::uint32_t>(begin + std::min(length * k / 12, length - 1));
        ASSERT_NEAR(normal_from_bits(m, rows), quantile_by_bisection(tail_probability(m)), 1e-6) << m;
      }
    }
  }
}

// 10^7 inputs spread evenly over all 2^32, and all below 2^16: finite, bounded, symmetric, and falling with m except
// for the last place.
TEST(NormalTable, StratifiedInputs) {
  const auto rows = normal_table();
  constexpr std::uint32_t draws = 5'000'000;  // per sign
  double sum_of_squares = 0, worst_rise = 0;
  std::uint32_t bad = 0;
  float before = 5.0f;
  const auto check = [&](std::uint32_t m) {
    const float z = normal_from_bits(m, rows);
    bad += !(z >= 0.0f && z <= 5.0f) || normal_from_bits(m | 0x80000000u, rows) != -z;
    worst_rise = std::max(worst_rise, static_cast<double>(z) - static_cast<double>(before));
    before = z;
    return static_cast<double>(z);
  };
  for (std::uint32_t m = 0; m < 65'536; ++m) check(m);
  before = 5.0f;
  for (std::uint32_t k = 0; k < draws; ++k) {
    const double z = check(static_cast<std::uint32_t>((k + 0.5) * 2147483648.0 / draws));
    sum_of_squares += z * z;
  }
  EXPECT_EQ(bad, 0u);
  EXPECT_LE(worst_rise, 0.0);
  // Variance of the truncated normal: 1 − 2·5·φ(5) / (1 − 2Φ(−5)).
  EXPECT_NEAR(sum_of_squares / draws, 1 - 10 * 1.4867195147342979e-6, 2e-6);
}

// The finest steps: every input of the last segment, where the value goes to zero.
TEST(NormalTable, LastSegmentNeverCrossesZero) {
  const auto rows = normal_table();
  std::uint32_t negative = 0;
  double worst_rise = 0;
  float before = 5.0f;
  for (std::uint32_t m = 0x7FFFFFFFu - (1u << 22); m < 0x7FFFFFFFu; ++m) {
    const float z = normal_from_bits(m, rows);
    negative += z < 0;
    worst_rise = std::max(worst_rise, static_cast<double>(z) - static_cast<double>(before));
    before = z;
  }
  EXPECT_EQ(negative, 0u);
  EXPECT_LE(worst_rise, 1e-8);
}

}  // namespace
}  // namespace vantage
