// SPDX-License-Identifier: Apache-2.0
// Polygons in a plane, with some of their area cut away.
#pragma once

#include <vector>

#include "core/glm.hpp"

namespace vantage {

using PlanePoint = glm::dvec2;
using ConvexPolygon = std::vector<PlanePoint>;  // counter-clockwise

// What of `polygon` none of `holes` covers, as convex parts. Parts reach `slack` / 4 into the holes and into each
// other, so that no gap opens where their corners are rounded later; what is thinner than `slack` is left out.
std::vector<ConvexPolygon> cut_away(const ConvexPolygon& polygon, const std::vector<ConvexPolygon>& holes,
                                    double slack);

}  // namespace vantage
