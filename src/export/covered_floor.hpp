// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "export/relief.hpp"
#include "vantage/placement.hpp"

namespace vantage {

// The floor to cut above (survey frame) where most of the search area lies under something, so that a view from above
// would show roofs.
std::optional<double> covered_floor(const SearchMesh& mesh, const HeightBuffer& heights, const SceneData& scene);

}  // namespace vantage
