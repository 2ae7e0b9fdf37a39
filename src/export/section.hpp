// SPDX-License-Identifier: Apache-2.0
// A horizontal cut through a site: what a floor plan fills.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "export/relief.hpp"

namespace vantage {

struct Section {
  std::vector<std::uint8_t> solid;                // a pixel of the window each: 1 within something solid
  std::vector<std::array<MapPoint, 2>> outlines;  // where surfaces cross the plane, in pixels
};

// At height `z` (survey frame). Solid is what closed surfaces whose triangles face outward wind around more often than
// others, facing inward, wind back: walls as boxes, and as the space between an outer and an inner skin. A surface
// that is not closed along a row of pixels, as a wall without thickness, is an outline alone.
Section section_at(const SceneData& scene, const MapWindow& window, double z);

}  // namespace vantage
