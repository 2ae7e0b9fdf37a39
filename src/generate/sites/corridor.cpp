// SPDX-License-Identifier: Apache-2.0
// A corridor of 60 × 1.8 m with closed doors on both sides, entered by a doorway at one end. Only the reveals of the
// doors and the ends keep a scan from sliding along it.
#include "generate/sites/shapes.hpp"

namespace vantage::sites {

Site corridor() {
  constexpr double kLength = 60, kWidth = 1.8, kHeight = 2.6, kWall = 0.3, kReveal = 0.08, kApron = 4;
  Site site;
  site.entry = {1, kWidth / 2, 0};
  add_box(add_part(site, "floor", kConcrete, Surface::floor),
          block(-kApron, kLength + kWall, -kApron, kWidth + kApron, -0.2, 0));
  add_box(add_part(site, "ceiling", kPlaster, Surface::roof),
          block(-kWall, kLength + kWall, -kWall, kWidth + kWall, kHeight, kHeight + 0.2));
  std::vector<Box> holes{block(0, kLength, 0, kWidth, 0, kHeight),
                         block(-kWall, 0, kWidth / 2 - 0.5, kWidth / 2 + 0.5, 0, 2.1)};
  for (double x = 4; x < kLength - 2; x += 8) {
    holes.push_back(block(x, x + 0.9, -kReveal, 0, 0, 2.05));
    holes.push_back(block(x + 4, x + 4.9, kWidth, kWidth + kReveal, 0, 2.05));
  }
  carve(add_part(site, "walls", kPlaster, Surface::roof),
        {block(-kWall, kLength + kWall, -kWall, kWidth + kWall, 0, kHeight)}, holes);
  site.places = {{"corridor", 0, 0, kLength, 0, kWidth, 0, false}};
  return site;
}

}  // namespace vantage::sites
