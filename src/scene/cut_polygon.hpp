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

// What cutting may come to, over all polygons that share one of these, from any thread: holes in a plane can be laid so
// that the parts between them are many times as many.
struct CutAllowance {
  std::atomic<std::int64_t> parts = std::int64_t{1} << 24;   // made
  std::atomic<std::int64_t> visits = std::int64_t{1} << 27;  // of holes to parts; some seconds
};

// What of `polygon` none of `holes` covers, as convex parts. Parts reach `slack` / 4 into the holes and into each
// other, so that no gap opens where their corners are rounded later; what is thinner than `slack` is left out.
// Throws Error out_of_memory where that is more than `allowance` has left.
std::vector<ConvexPolygon> cut_away(const ConvexPolygon& polygon, const std::vector<ConvexPolygon>& holes, double slack,
                                    CutAllowance& allowance);

}  // namespace vantage
