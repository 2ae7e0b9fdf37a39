// SPDX-License-Identifier: Apache-2.0
// Counts of some of a network's stations, and of others, made one; and counts over some voxels, and over others.
#pragma once

#include "trace/tracer.hpp"

namespace vantage {

// Adds another part's counts voxel by voxel. An empty `field` becomes the part.
void add_field(VoxelField& field, VoxelField&& part);
// Adds what is summed for each station, and the rays; what is reduced from voxels is left as it is.
void add_station_sums(NetworkCounts& counts, const NetworkCounts& part);
// Adds the counts of the same network over other voxels of a sample. REQUIRES: without groups and registration.
void add_voxels(NetworkCounts& counts, const NetworkCounts& part);

}  // namespace vantage
