// SPDX-License-Identifier: Apache-2.0
// Networks of more stations than a mask's word has bits: an engine counts them in passes of 64 places, which are put
// together here. What a pass counts does not depend on the others, so the sums are those of one pass over all.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "trace/tracer.hpp"

namespace vantage {

// `Tracer::count` for any number of stations up to `max_stations`; of one pass it is that very call. `weights`: of the
// grid's voxels, or none.
NetworkCounts count_in_passes(Tracer& tracer, std::span<const TraceStation> stations, std::uint32_t station_count,
                              const Tracer::CountOptions& options, const VoxelGrid& grid, double goal_density,
                              const Progress& progress);

// `Tracer::count_sampled` of one network. `job.station_masks` is told masks of as many words as it takes, as in
// `VoxelField`.
NetworkCounts count_sampled_in_passes(Tracer& tracer, std::span<const TraceStation> stations,
                                      std::uint32_t station_count, const Tracer::SampleJob& job, const VoxelGrid& grid,
                                      double goal_density, const Progress& progress);

}  // namespace vantage
