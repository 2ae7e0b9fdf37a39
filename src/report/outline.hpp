// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <utility>
#include <vector>

#include "vantage/placement.hpp"

namespace vantage {

// Edges of the search mesh with a triangle on one side only. Vertices at one place count as one, so that seams in (u, v) are no edges.
std::vector<std::pair<Vec3, Vec3>> outline(const SearchMesh& mesh);

}  // namespace vantage
