// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "map/relief.hpp"
#include "vantage/placement.hpp"

namespace vantage {

inline constexpr Colour kSearchTint{0.05, 0.45, 0.25};
inline constexpr double kSearchOpacity = 0.1, kSearchRim = 0.85, kHiddenRim = 0.25;

// Tints the pixels of a map that show the search area, and draws a rim along its edge, a faint one below other
// surfaces. Pixels decide the edge, since edges of derived areas meet others anywhere along their length. `origin_z`:
// of the local frame of `heights` in the survey frame, which the mesh is in.
void tint_search_area(std::vector<std::uint32_t>& pixels, const HeightBuffer& heights, double origin_z,
                      const SearchMesh& mesh);

}  // namespace vantage
