// SPDX-License-Identifier: Apache-2.0
#include "trace/direction_list.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "core/philox.hpp"

namespace vantage {
namespace {

constexpr double kFullTurn = 2 * std::numbers::pi;

bool within(const AngleWindow& window, double zenith, double azimuth) {
  if (zenith < window.least_zenith || zenith > window.most_zenith) return false;
  const double from = azimuth - window.azimuth;
  return window.width >= kFullTurn || from - std::floor(from / kFullTurn) * kFullTurn <= window.width;
}

// Each ray of a window is found once, and few others are.
TEST(DirectionList, FindsEachRayOfAWindowOnce) {
  RandomStream random(11);
  for (const double tall : {0.0, 1e-9, 0.3, std::numbers::pi}) {
    for (const double wide : {0.0, 0.7, kFullTurn}) {
      for (const std::size_t rays : {std::size_t{1}, std::size_t{2}, std::size_t{5000}}) {
        std::vector<double> zeniths, azimuths;
        for (std::size_t k = 0; k < rays; ++k) {
          zeniths.push_back((std::numbers::pi - tall) / 2 + tall * random.uniform());
          azimuths.push_back(k % 50 == 0 ? -1e-20 : wide * random.uniform() - 2 * kFullTurn * (k % 2 == 0 ? 1 : 0));
        }
        const DirectionList list(zeniths, azimuths);
        for (int k = 0; k < 200; ++k) {
          const double height = 0.1 * random.uniform(), middle = zeniths[random.bits() % rays];
          AngleWindow window{
              middle - height, middle + height, 4 * kFullTurn * (random.uniform() - 0.5),
              k % 9 == 0 ? (1 + random.uniform()) * kFullTurn : kFullTurn * std::pow(random.uniform(), 3)};
          if (k % 10 == 1) window.azimuth = -0.1, window.width = 0.2;
          if (k % 10 == 2) window.width = std::nextafter(kFullTurn, 0);
          if (k % 10 == 3) window.least_zenith = -1, window.most_zenith = 4;
          if (k % 10 == 4) window.least_zenith = 4, window.most_zenith = 5;
          std::vector<int> found(rays);
          list.each_near(window, [&](std::span<const std::uint32_t> near) {
            EXPECT_FALSE(near.empty());
            for (const std::uint32_t ray : near) ++found[ray];
          });
          std::size_t in_window = 0, in_all = 0;
          for (std::size_t ray = 0; ray < rays; ++ray) {
            const bool in = within(window, zeniths[ray], azimuths[ray]);
            ASSERT_LE(found[ray], 1) << "listed twice";
            // The test's own rounding decides at an edge.
            AngleWindow inner = window;
            inner.azimuth += 1e-12, inner.width = std::max(0.0, inner.width - 2e-12);
            if (in && within(inner, zeniths[ray], azimuths[ray])) {
              ASSERT_EQ(found[ray], 1) << "ray " << ray;
            }
            in_window += in, in_all += static_cast<std::size_t>(found[ray]);
          }
          if (rays == 5000 && tall > 1 && wide > 1 && window.width < 1) {
            EXPECT_LE(in_all, 3 * in_window + 250) << "windows are loose";
          }
        }
      }
    }
  }
}

}  // namespace
}  // namespace vantage
