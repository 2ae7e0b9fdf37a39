// SPDX-License-Identifier: Apache-2.0
// A smooth tunnel of 200 m, a half circle of 3 m over a flat floor, open at both ends. Nothing in it keeps a scan from
// sliding along it.
#include <cmath>
#include <numbers>

#include "generate/sites/shapes.hpp"

namespace vantage::sites {
namespace {

// Closed, around the bore.
void add_lining(Part& part, double length, double radius, double thickness) {
  constexpr std::uint32_t kSides = 32, kRings = 20;
  const auto first = static_cast<std::uint32_t>(part.positions.size());
  for (std::uint32_t i = 0; i <= kRings; ++i)
    for (const double r : {radius, radius + thickness})
      for (std::uint32_t k = 0; k <= kSides; ++k) {
        const double angle = std::numbers::pi * k / kSides;
        part.positions.push_back({length * i / kRings, -r * std::cos(angle), r * std::sin(angle)});
      }
  const auto at = [&](std::uint32_t ring, bool outer, std::uint32_t side) {
    return first + (2 * ring + (outer ? 1u : 0u)) * (kSides + 1) + side;
  };
  const auto quad = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d) {
    part.triangles.push_back({a, b, c});
    part.triangles.push_back({a, c, d});
  };
  for (std::uint32_t i = 0; i < kRings; ++i) {
    for (std::uint32_t k = 0; k < kSides; ++k) {
      quad(at(i, false, k), at(i, false, k + 1), at(i + 1, false, k + 1), at(i + 1, false, k));
      quad(at(i, true, k), at(i + 1, true, k), at(i + 1, true, k + 1), at(i, true, k + 1));
    }
    quad(at(i, true, 0), at(i, false, 0), at(i + 1, false, 0), at(i + 1, true, 0));
    quad(at(i, false, kSides), at(i, true, kSides), at(i + 1, true, kSides), at(i + 1, false, kSides));
  }
  for (std::uint32_t k = 0; k < kSides; ++k) {
    quad(at(0, false, k), at(0, true, k), at(0, true, k + 1), at(0, false, k + 1));
    quad(at(kRings, false, k), at(kRings, false, k + 1), at(kRings, true, k + 1), at(kRings, true, k));
  }
}

}  // namespace

Site tunnel() {
  constexpr double kLength = 200, kRadius = 3, kLining = 0.3;
  Site site;
  site.entry = {1, 0, 0};
  add_box(add_part(site, "carriageway", kConcrete, Surface::floor),
          block(0, kLength, -kRadius - kLining, kRadius + kLining, -0.3, 0));
  add_lining(add_part(site, "lining", kConcrete, Surface::roof), kLength, kRadius, kLining);
  site.places = {{"tunnel", 0, 0.5, kLength - 0.5, -2, 2, 0, false}};
  return site;
}

}  // namespace vantage::sites
