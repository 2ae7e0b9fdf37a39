// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>

#include "vantage/simulator.hpp"

namespace vantage {

class VoxelPlanes;

// Returns the planes that stations sharing a voxel must be on one side of; null unless the simulator is one of
// `surroundings_of()`.
const VoxelPlanes* sides_of(const Simulator& simulator);
// Return the number of a voxel's sides, and the side of a place (survey frame); 1, and 0, without planes.
std::uint32_t count_sides(const Simulator& simulator, std::uint64_t voxel_index);
std::uint32_t side_of(const Simulator& simulator, std::uint64_t voxel_index, const Vec3& place);
// Sets `shared` of counts that were added up elsewhere to the simulator's own values. `masks`: word w of the k-th of
// the voxels at w · voxel_indices.size() + k.
void share_one_sided(const Simulator& simulator, NetworkCounts& counts, const Network& network,
                     std::span<const std::uint32_t> voxel_indices, std::span<const std::uint64_t> masks);

}  // namespace vantage
