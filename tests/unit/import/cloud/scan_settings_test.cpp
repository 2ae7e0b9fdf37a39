// SPDX-License-Identifier: Apache-2.0
#include "import/cloud/scan_settings.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace vantage::importer {
namespace {

using Cell = std::array<std::uint32_t, 2>;

Eigen::Vector3d at(double azimuth_deg, double zenith_deg, double range_m) {
  const double a = azimuth_deg * std::numbers::pi / 180, z = zenith_deg * std::numbers::pi / 180;
  return range_m * Eigen::Vector3d(std::sin(z) * std::cos(a), std::sin(z) * std::sin(a), std::cos(z));
}

// Azimuths from `first`, `columns` steps of `step[0]` degrees, and zeniths from `top`, `rows` of `step[1]`.
ScanSettings sweep(double first, std::uint32_t columns, double top, std::uint32_t rows, std::array<double, 2> step,
                   bool grid) {
  ScanSettings settings;
  for (std::uint32_t c = 0; c < columns; ++c)
    for (std::uint32_t r = 0; r < rows; ++r) {
      if ((r * 7 + c) % 5 == 0) continue;  // what was not hit
      settings.add(at(first + (c + 0.5) * step[0], top + (r + 0.5) * step[1], 3 + 2.0 * (c % 2)),
                   grid ? std::optional(Cell{r, c}) : std::nullopt);
    }
  return settings;
}

TEST(ScanSettings, StepsAreThoseOfTheGrid) {
  const auto told = sweep(0, 1200, 0, 600, {0.3, 0.25}, true).as_json();
  EXPECT_TRUE(told["by_grid"].get<bool>());
  EXPECT_NEAR(told["step"][0].get<double>(), 0.3, 1e-9);
  EXPECT_NEAR(told["step"][1].get<double>(), 0.25, 1e-9);
  EXPECT_EQ(told["azimuth"], (nlohmann::json{0, 360}));
  EXPECT_EQ(told["zenith"], (nlohmann::json{0, 150}));
  EXPECT_NEAR(told["range"][0].get<double>(), 3, 0.2);
  EXPECT_NEAR(told["range"][1].get<double>(), 5, 0.3);
}

// Columns of half a turn, whose rows go up one side and down the other.
TEST(ScanSettings, AMirrorThatTurnsOverTheTopHasTheSameSteps) {
  ScanSettings settings;
  for (std::uint32_t c = 0; c < 600; ++c)
    for (std::uint32_t r = 0; r < 1000; ++r) {
      const double zenith = 0.3 * (r + 0.5) - 150;
      settings.add(at(0.3 * c + (zenith < 0 ? 180 : 0), std::abs(zenith), 4), Cell{r, c});
    }
  const auto told = settings.as_json();
  EXPECT_TRUE(told["by_grid"].get<bool>());
  EXPECT_NEAR(told["step"][0].get<double>(), 0.3, 1e-9);
  EXPECT_NEAR(told["step"][1].get<double>(), 0.3, 1e-9);
  EXPECT_EQ(told["azimuth"], (nlohmann::json{0, 360}));
}

TEST(ScanSettings, WithoutAGridTheDensityTellsTheStep) {
  const auto told = sweep(0, 3600, 0, 1500, {0.1, 0.1}, false).as_json();
  EXPECT_FALSE(told["by_grid"].get<bool>());
  EXPECT_NEAR(told["step"][0].get<double>(), 0.1 / std::sqrt(0.8), 0.005);  // a fifth of the rays hit nothing
  EXPECT_EQ(told["step"][0], told["step"][1]);
}

TEST(ScanSettings, APartOfATurnHasItsMiddle) {
  const auto told = sweep(150, 450, 40, 400, {0.2, 0.2}, true).as_json();  // over 180°
  EXPECT_EQ(told["azimuth"], (nlohmann::json{-165, 90}));
  EXPECT_EQ(told["zenith"], (nlohmann::json{40, 120}));
}

TEST(ScanSettings, LonePointsAndFewPointsTellNothing) {
  ScanSettings settings = sweep(0, 90, 60, 45, {1, 1}, false);
  settings.add(at(-90, 170, 1e6), std::nullopt);
  const auto told = settings.as_json();
  EXPECT_EQ(told["zenith"], (nlohmann::json{60, 105}));
  EXPECT_LT(told["range"][1].get<double>(), 6);
  EXPECT_TRUE(told["step"].is_null());
  ScanSettings none;
  none.add({0, 0, 0}, std::nullopt);
  EXPECT_TRUE(none.as_json().is_null());
}

}  // namespace
}  // namespace vantage::importer
