// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <compare>
#include <cstdint>
#include <span>
#include <vector>

#include "scene/scene_data.hpp"

namespace vantage {

// Two triangles that overlap in one plane, within the rounding of float coordinates, which decides which of them a ray
// hits. Triangles that only touch are no pair.
struct CoplanarPair {
  std::uint32_t blocking = 0, surveyed = 0;
  friend auto operator<=>(const CoplanarPair&, const CoplanarPair&) = default;
};

struct Coplanar {
  double slack_m = 0;               // planes no farther apart counted as one
  std::vector<CoplanarPair> pairs;  // ascending
};

// Finds triangles of surveyed meshes that lie in the plane of a blocking one and overlap it. `beside`: bounds of
// further surveyed triangles, which overlap none. Throws Error: out_of_memory, also for more than `most_pairs` pairs;
// device_failure.
Coplanar find_coplanar(std::span<const Float3> positions, std::span<const Triangle> triangles,
                       std::span<const MeshRange> ranges, std::span<const MeshInfo> meshes,
                       std::uint64_t most_pairs = std::uint64_t{1} << 25, const Box& beside = {});

}  // namespace vantage
