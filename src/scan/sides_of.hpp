// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>

#include "vantage/simulator.hpp"

namespace vantage {

class VoxelPlanes;

// The planes on one side of which stations have to be to share a voxel; null unless the simulator is one of
// `surroundings_of()`.
const VoxelPlanes* sides_of(const Simulator& simulator);
// How many sides a voxel has, and on which a place is (survey frame); one, and 0, without planes.
std::uint32_t count_sides(const Simulator& simulator, std::uint64_t voxel_index);
std::uint32_t side_of(const Simulator& simulator, std::uint64_t voxel_index, const Vec3& place);
// Makes `shared` of counts that were added up elsewhere what the simulator's own would be. `masks`: word w of the k-th
// of the voxels at w · voxel_indices.size() + k.
void share_one_sided(const Simulator& simulator, NetworkCounts& counts, const Network& network,
                     std::span<const std::uint32_t> voxel_indices, std::span<const std::uint64_t> masks);

}  // namespace vantage
