// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "map/relief.hpp"
#include "vantage/placement.hpp"

namespace vantage {

// Height of the floor to cut above (survey frame) if most of the search area is covered, so that a plan view would show
// roofs.
std::optional<double> covered_floor(const SearchMesh& mesh, const HeightBuffer& heights, const SceneData& scene);

}  // namespace vantage
