// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "map/plan_levels.hpp"
#include "map/relief.hpp"
#include "vantage/placement.hpp"

namespace vantage {

inline constexpr Colour kLeftOutTint{0.62, 0.20, 0.16};
inline constexpr double kLeftOutOpacity = 0.30;

// Hatches the pixels of a map that show ground left out of a derived search area (roofs, furniture, unreachable
// ground), only of one floor if `level` is given, and not those that show `ground`, under whose slab a lawn may go on.
// Returns whether there were any. `origin_z`: of the local frame of
// `heights` in the survey frame.
bool hatch_left_out(std::vector<std::uint32_t>& pixels, const HeightBuffer& heights, double origin_z,
                    std::span<const LeftOut> left_out, const PlanLevel* level, const SearchMesh& ground = {});

}  // namespace vantage
