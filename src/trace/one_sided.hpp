// SPDX-License-Identifier: Apache-2.0
// Voxels that stations share, if a surface seen from behind counts as another surface.
#pragma once

#include <cstdint>
#include <span>

#include "trace/tracer.hpp"
#include "voxel/voxel_planes.hpp"

namespace vantage {

// Replaces `shared` of a network's counts: two stations share a voxel only on one side of its planes. `seen` stays.
// Every engine's counts are replaced alike, from whole numbers. Parallel.
void share_one_sided(NetworkCounts& counts, std::span<const TraceStation> stations, const VoxelPlanes& planes,
                     const StationMasks& masks);
// Does the same over a sample of voxels and its interleaved groups. `masks`: word w of voxel number k at w ·
// voxel_indices.size() + k.
void share_one_sided(NetworkCounts& counts, std::span<const TraceStation> stations, const VoxelPlanes& planes,
                     std::span<const std::uint32_t> voxel_indices, std::span<const std::uint64_t> masks);

}  // namespace vantage
