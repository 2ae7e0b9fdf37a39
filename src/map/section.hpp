// SPDX-License-Identifier: Apache-2.0
// A horizontal cut through a site, which a floor plan fills.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "map/relief.hpp"

namespace vantage {

struct Section {
  using Lines = std::vector<std::array<MapPoint, 2>>;
  std::vector<std::uint8_t> solid;  // one for each pixel of the window: 1 within a solid, 2 within one of glass
  Lines outlines, glass_outlines;   // lines where surfaces cross the plane, in pixels
};

// Number of the connected surface of each stored point; those of a mesh that nodes share are each place's own.
std::vector<std::uint32_t> surfaces_of(const SceneData& scene);

// Cuts the scene at height `z` (survey frame). A pixel is solid if outward closed surfaces wind around it more often
// than inward ones: walls as boxes, and the space between an outer and an inner skin. Surfaces that are not closed
// along a row of pixels, such as walls without thickness, are outlines only. Surfaces around a known `free` place (x,
// y), such as a tunnel's lining in one sheet, are too, except for solids inside.
Section section_at(const SceneData& scene, const MapWindow& window, double z, std::span<const Vec3> free = {});
// The same for several windows of a scene. `surfaces`: `surfaces_of()` it.
Section section_at(const SceneData& scene, std::span<const std::uint32_t> surfaces, const MapWindow& window, double z,
                   std::span<const Vec3> free = {});

// The lines (x, y) alone along which surfaces cross a height, survey frame, metres.
std::vector<std::array<Vec3, 2>> section_lines(const SceneData& scene, double z);

}  // namespace vantage
