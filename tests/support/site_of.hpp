// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <utility>

#include "vantage/site.hpp"

namespace vantage::test {

// A site of exactly this simulator; ground and clash checks are of its scene unless the ground is given.
inline vantage::Site site_of(Simulator simulator, std::optional<SearchArea> area = {},
                             const SecurityVolume& volume = {}) {
  const Scene scene = simulator.scene();
  if (!area) area = SearchArea::build(scene);
  return vantage::Site{std::move(simulator), *std::move(area), ClashChecker(scene, volume)};
}

}  // namespace vantage::test
