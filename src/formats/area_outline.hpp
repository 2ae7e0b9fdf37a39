// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "vantage/placement.hpp"

namespace vantage {

// Returns the rim of a triangle mesh as closed lines of corners, with the area on their left in plan view; a ring does
// not repeat its first point. Vertices within 0.1 mm of each other are one. An edge is split where another one ends
// within it, as in derived areas. The rim of overlapping triangles is that of their sum. A rim that does not close (a
// mesh that folds back on itself) stays open.
std::vector<std::vector<Vec3>> area_outline(const SearchMesh& mesh);

}  // namespace vantage
