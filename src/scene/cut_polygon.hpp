// SPDX-License-Identifier: Apache-2.0
// Cuts areas out of plane polygons.
#pragma once

#include <atomic>
#include <cstdint>
#include <vector>

#include "core/glm.hpp"

namespace vantage {

using PlanePoint = glm::dvec2;
using ConvexPolygon = std::vector<PlanePoint>;  // counter-clockwise

// Limits on cutting, over all polygons that share the object, from any thread. Adverse holes in a plane leave many
// times as many parts between them.
struct CutAllowance {
  std::atomic<std::int64_t> parts = std::int64_t{1} << 24;   // parts made
  std::atomic<std::int64_t> visits = std::int64_t{1} << 27;  // visits of holes to parts; some seconds
};

// Returns the part of `polygon` that none of `holes` covers, as convex parts. Parts reach `slack` / 4 into the holes
// and into each other, so that later rounding of corners opens no gap; parts thinner than `slack` are dropped. Throws
// Error out_of_memory if `allowance` is used up.
std::vector<ConvexPolygon> cut_away(const ConvexPolygon& polygon, const std::vector<ConvexPolygon>& holes, double slack,
                                    CutAllowance& allowance);

}  // namespace vantage
