// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "report/relief.hpp"
#include "vantage/placement.hpp"

namespace vantage {

inline constexpr Colour kSearchTint{0.05, 0.45, 0.25};
inline constexpr double kSearchOpacity = 0.1, kSearchRim = 0.85;

// Tints the pixels of a map under which the search area lies, on whatever floor, with a rim along its edge. It goes by pixels, as
// the mesh's own edges do not tell: those of derived areas meet other edges anywhere along their length.
void tint_search_area(std::vector<std::uint32_t>& pixels, const MapWindow& window, const SearchMesh& mesh);

}  // namespace vantage
