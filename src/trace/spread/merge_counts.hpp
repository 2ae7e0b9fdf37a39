// SPDX-License-Identifier: Apache-2.0
// Merges counts of different stations of a network, and counts over different voxels.
#pragma once

#include "trace/tracer.hpp"

namespace vantage {

// Adds another part's counts voxel by voxel. An empty `field` becomes the part.
void add_field(PassField& field, PassField&& part);
// Adds per-station sums and rays; values reduced from voxels stay as they are.
void add_station_sums(NetworkCounts& counts, const NetworkCounts& part);
// Adds the counts of the same network over other voxels of a sample. REQUIRES: without groups and registration.
void add_voxels(NetworkCounts& counts, const NetworkCounts& part);

}  // namespace vantage
