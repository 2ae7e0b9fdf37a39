// SPDX-License-Identifier: Apache-2.0
// Cuts areas out of plane polygons.
#pragma once

#include <vector>

#include "core/glm.hpp"

namespace vantage {

using PlanePoint = glm::dvec2;
using ConvexPolygon = std::vector<PlanePoint>;  // counter-clockwise

// Part of `polygon` that none of `holes` covers, as convex parts. Parts reach `slack` / 4 into the holes and into each
// other, so that later rounding of corners opens no gap; parts thinner than `slack` are dropped.
std::vector<ConvexPolygon> cut_away(const ConvexPolygon& polygon, const std::vector<ConvexPolygon>& holes,
                                    double slack);

}  // namespace vantage
