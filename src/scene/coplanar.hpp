// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>

#include "scene/scene_data.hpp"

namespace vantage {

// How many triangles of surveyed meshes overlap a triangle of a blocking one in its own plane, to the rounding of float
// coordinates. Which of the two a ray hits there is up to rounding. Triangles that only touch do not count.
// Throws Error: out_of_memory, device_failure.
std::size_t count_coplanar(std::span<const Float3> positions, std::span<const Triangle> triangles,
                           std::span<const MeshRange> ranges, std::span<const MeshInfo> meshes);

}  // namespace vantage
