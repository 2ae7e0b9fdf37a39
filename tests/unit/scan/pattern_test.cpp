// SPDX-License-Identifier: Apache-2.0
#include "scan/pattern.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace vantage {
namespace {

TEST(Pattern, DirectionsAreThoseOfTheConvention) {
  Scanner scanner;
  scanner.heading = Angle::degrees(30);
  scanner.horizontal_angle = Angle::degrees(200);
  scanner.vertical_angle = Angle::degrees(280);
  scanner.azimuth_step = Angle::degrees(0.5);
  scanner.zenith_step = Angle::degrees(0.25);
  scanner.min_range_m = 0.6;
  scanner.max_range_m = 80;
  const RayPattern pattern = make_pattern(scanner);
  ASSERT_EQ(pattern.rows(), 560u);
  ASSERT_EQ(pattern.columns(), 400u);
  ASSERT_EQ(pattern.cos_zenith.size(), 560u);
  ASSERT_EQ(pattern.cos_azimuth.size(), 400u);
  EXPECT_EQ(pattern.min_range, 0.6f);
  EXPECT_EQ(pattern.max_range, 80.0f);
  const double degree = std::acos(-1.0) / 180;
  EXPECT_DOUBLE_EQ(pattern.zenith_step, 0.25 * degree);
  EXPECT_DOUBLE_EQ(pattern.azimuth_step, 0.5 * degree);
  EXPECT_DOUBLE_EQ(pattern.first_zenith, 0.125 * degree);
  EXPECT_DOUBLE_EQ(pattern.first_azimuth, (30 - 100 + 0.25) * degree);
  for (std::uint32_t i = 0; i < 560; ++i) {
    const double zenith = (i + 0.5) * 0.25 * degree;
    EXPECT_FLOAT_EQ(pattern.sin_zenith[i], static_cast<float>(std::sin(zenith)));
    EXPECT_NEAR(pattern.cos_zenith[i], std::cos(zenith), 3.1e-8);  // half an ulp below 1
  }
  for (std::uint32_t j = 0; j < 400; ++j) {
    const double azimuth = (30 - 100 + (j + 0.5) * 0.5) * degree;
    EXPECT_NEAR(pattern.sin_azimuth[j], std::sin(azimuth), 3.1e-8);
    EXPECT_NEAR(pattern.cos_azimuth[j], std::cos(azimuth), 3.1e-8);
  }
}

TEST(Pattern, DirectionsAreUnitVectors) {
  Scanner scanner;
  scanner.azimuth_step = scanner.zenith_step = Angle::degrees(1);
  const RayPattern p = make_pattern(scanner);
  for (std::uint32_t i = 0; i < p.rows(); ++i) {
    for (std::uint32_t j = 0; j < p.columns(); ++j) {
      const double x = static_cast<double>(p.sin_zenith[i]) * p.cos_azimuth[j],
                   y = static_cast<double>(p.sin_zenith[i]) * p.sin_azimuth[j];
      EXPECT_NEAR(x * x + y * y + static_cast<double>(p.cos_zenith[i]) * p.cos_zenith[i], 1.0, 2e-7);
    }
  }
}

TEST(Pattern, StartsAtTheZenithOfTheScanner) {
  Scanner scanner;
  scanner.zenith_start = Angle::degrees(30);
  scanner.vertical_angle = Angle::degrees(200);
  scanner.zenith_step = Angle::degrees(10);
  const RayPattern p = make_pattern(scanner);
  ASSERT_EQ(p.rows(), 10u);
  EXPECT_NEAR(p.cos_zenith.front(), std::cos(35 * std::acos(-1.0) / 180), 1e-7);
  EXPECT_NEAR(p.cos_zenith.back(), std::cos(125 * std::acos(-1.0) / 180), 1e-7);
}

}  // namespace
}  // namespace vantage
