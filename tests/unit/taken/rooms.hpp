// SPDX-License-Identifier: Apache-2.0
// Two equal rooms side by side, with a doorway between them, and scans of them.
#pragma once

#include <optional>
#include <vector>

#include "core/glm.hpp"
#include "vantage/scene_builder.hpp"
#include "vantage/site.hpp"
#include "vantage/taken_scans.hpp"

namespace vantage::test {

// Each is 6 × 5 × 2.8 m; x from 0 to 6 and from 6.2 to 12.2. The doorway is 0.9 m wide and 2.1 m high.
struct Rooms {
  std::vector<Box> things = {};  // boxes that block, and are not surveyed
  bool door_closed = false;      // by the blocking mesh "door leaf"
  double step_deg = 0.5;
  double noise_m = 0;
};
Site site_of(const Rooms& rooms);

inline const Vec3 kInFirst{2, 2, 1.85}, kAcross{4.5, 3.5, 1.85}, kInSecond{9, 2, 1.85};
inline const Box kCupboard{{3.2, 0.9, 0}, {4.4, 1.5, 2}};

// The scan of a station, one point a ray.
TakenScan scan_at(Site& site, const Vec3& head);
// As in a frame that is turned about the head by `turn` (radians, about the direction of that vector) and shifted.
TakenScan moved(TakenScan scan, const glm::dvec3& turn, const Vec3& shift);

}  // namespace vantage::test
