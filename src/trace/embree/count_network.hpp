// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "trace/embree/station_rays.hpp"

namespace vantage {

// Tracer::count on the CPU. `scanners`: what TraceStation::scanner counts. `scratch`: the field where options have
// none; kept from call to call, for its memory.
NetworkCounts count_network(std::span<const StationRays> scanners, std::span<const TraceStation> stations,
                            std::uint32_t station_count, double goal_density, const Tracer::CountOptions& options,
                            VoxelField& scratch, const Progress& progress);

}  // namespace vantage
