// SPDX-License-Identifier: Apache-2.0
#include "image/srgb.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace vantage {
namespace {

double decode(double code) {
  const double s = code / 255;
  return s <= 0.04045 ? s / 12.92 : std::pow((s + 0.055) / 1.055, 2.4);
}

TEST(Srgb, EveryCodeComesBack) {
  for (int code = 0; code < 256; ++code) {
    EXPECT_NEAR(linear_from_srgb8(static_cast<std::uint8_t>(code)), decode(code), 1e-7);
    EXPECT_EQ(srgb8_from_linear(linear_from_srgb8(static_cast<std::uint8_t>(code))), code);
  }
}

TEST(Srgb, CodesAreTheNearest) {
  for (int k = 0; k <= 200'000; ++k) {
    const float linear = static_cast<float>(k) / 200'000;
    const int code = srgb8_from_linear(linear);
    const double s =
        linear <= 0.0031308 ? 12.92 * linear : 1.055 * std::pow(static_cast<double>(linear), 1 / 2.4) - 0.055;
    ASSERT_LE(std::abs(code - 255 * s), 0.5 + 1e-3) << linear;
  }
  EXPECT_EQ(srgb8_from_linear(-1), 0);
  EXPECT_EQ(srgb8_from_linear(7), 255);
  EXPECT_EQ(srgb8_from_linear(std::numeric_limits<float>::quiet_NaN()), 0);
  EXPECT_EQ(srgb8_from_linear(std::nextafter(1.0f, 0.0f)), 255);
}

}  // namespace
}  // namespace vantage
