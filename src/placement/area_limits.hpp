// SPDX-License-Identifier: Apache-2.0
// Levels and regions that a search area is cut to.
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
  // Throws Error invalid_argument: levels that do not rise, a ring of fewer than three corners or with one that is not
  // finite.
  explicit AreaLimits(const WalkableOptions& options);
  bool any() const { return levels_ || !within_.empty() || !without_.empty(); }
  bool allow(const Vec3& ground) const { return allow_near(ground, 0); }
  // Whether a place no farther than `margin_m` away may be allowed; so may some beyond.
  bool allow_near(const Vec3& ground, double margin_m) const;

 private:
  std::optional<std::array<double, 2>> levels_;
  std::vector<PlanRegion> within_, without_;
};

// What of the mesh, cut into pieces no longer than `spacing_m`, may hold allowed places; `cut_off` gets the area of the
// rest. Positions and (u, v) of pieces are interpolated; triangles with a position that is not finite go.
SearchMesh cut_to_limits(const SearchMesh& mesh, const AreaLimits& limits, double spacing_m, LeftOut& cut_off);

}  // namespace vantage
