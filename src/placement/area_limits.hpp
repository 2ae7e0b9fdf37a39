// SPDX-License-Identifier: Apache-2.0
// Levels and regions that limit a search area.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "vantage/placement.hpp"

namespace vantage {

// Survey frame.
class AreaLimits {
 public:
  AreaLimits() = default;
  // Throws Error invalid_argument: levels that do not ascend, a ring with fewer than three corners or with one that is
  // not finite.
  explicit AreaLimits(const WalkableOptions& options);
  bool any() const { return levels_ || !within_.empty() || !without_.empty(); }
  bool allow(const Vec3& ground) const { return allow_near(ground, 0); }
  // Returns true if a place within `margin_m` may be allowed; also true for some places further away.
  bool allow_near(const Vec3& ground, double margin_m) const;

 private:
  std::optional<std::array<double, 2>> levels_;
  std::vector<PlanRegion> within_, without_;
};

// Cuts the mesh into pieces up to `spacing_m` and returns those that may hold allowed places; `cut_off` gets the area
// of the rest. Positions and (u, v) of pieces are interpolated. Triangles with a position that is not finite are
// dropped.
SearchMesh cut_to_limits(const SearchMesh& mesh, const AreaLimits& limits, double spacing_m, LeftOut& cut_off);

}  // namespace vantage
