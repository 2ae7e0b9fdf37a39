// SPDX-License-Identifier: Apache-2.0
// Counts networks with more stations than a mask word has bits, in passes of 64 stations. A pass's counts do not depend
// on the other passes, so the sums are those of one pass over all stations.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "trace/tracer.hpp"

namespace vantage {

// `Tracer::count` for any number of stations up to `max_stations`; a single pass is that very call. Fills `field`, if
// given. REQUIRES: options.field is null.
NetworkCounts count_in_passes(Tracer& tracer, std::span<const TraceStation> stations, std::uint32_t station_count,
                              const Tracer::CountOptions& options, VoxelField* field, const VoxelGrid& grid,
                              double goal_density, const Progress& progress);

// `Tracer::count_sampled` of one network. `job.station_masks` receives masks of as many words as needed: word w of the
// sample's voxel k is at w · sample.size() + k.
NetworkCounts count_sampled_in_passes(Tracer& tracer, std::span<const TraceStation> stations,
                                      std::uint32_t station_count, const Tracer::SampleJob& job, const VoxelGrid& grid,
                                      double goal_density, const Progress& progress);

}  // namespace vantage
