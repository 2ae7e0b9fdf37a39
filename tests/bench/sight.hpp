// SPDX-License-Identifier: Apache-2.0
// Surfaces that stations see, by rays of Embree alone: the truth that links are compared with. It knows no voxels.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/embree.hpp"
#include "scene/scene_data.hpp"
#include "vantage/scanner.hpp"
#include "vantage/types.hpp"

namespace vantage::bench {

class Sight {
 public:
  // Spreads `spots` points evenly over the area of all surfaces that stop rays. `spacing_m`: wanted distance of points.
  Sight(const SceneData& scene, const Scanner& scanner, double spacing_m, std::size_t spots, std::uint64_t seed = 1);

  // True if nothing stands between two points, survey frame.
  bool free(const Vec3& a, const Vec3& b) const { return !blocked(a - origin_, b - origin_, 0); }

  struct View {
    std::vector<std::int8_t> sides;  // of each spot: 0 unseen, 1 seen from the front, -1 from behind
    std::size_t seen = 0;            // spots
    double median_m = 0;             // distance to the captured spots: points at the wanted distance, or fewer in part
  };
  View from(const Vec3& head) const;  // survey frame

 private:
  struct Spot {
    Vec3 at, normal;
  };
  bool blocked(const Vec3& a, const Vec3& b, double short_m) const;  // local frame; ends `short_m` before b

  Vec3 origin_;
  double nearest_m_, farthest_m_, dense_m2_;  // dense: squared distance at which points are as dense as wanted
  embree::Device device_;
  embree::Scene tree_;
  std::vector<Spot> spots_;
};

// Spots that both see from the same side, as a share of those of the view with fewer.
double shared(const Sight::View& a, const Sight::View& b);

}  // namespace vantage::bench
