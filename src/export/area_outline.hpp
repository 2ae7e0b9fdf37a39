// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "vantage/placement.hpp"

namespace vantage {

// The rim of a triangle mesh as closed lines, the area on their left seen from above; corners only, each ring without
// repeating its first point. Vertices within 0.1 mm of each other are one, and an edge that ends within another one
// (as those of derived areas do) parts that. Where triangles lie on each other the rim is that of their sum. A rim that
// does not close (a mesh that folds back on itself) ends where it ends.
std::vector<std::vector<Vec3>> area_outline(const SearchMesh& mesh);

}  // namespace vantage
