// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "trace/embree/station_rays.hpp"

namespace vantage {

// Tracer::count on the CPU. `scanners`: what TraceStation::scanner counts. `scratch`: the field where options have
// none; kept from call to call, for its memory.
NetworkCounts count_network(std::span<const StationRays> scanners, std::span<const TraceStation> stations,
                            std::uint32_t station_count, double goal_density, const Tracer::CountOptions& options,
                            VoxelField& scratch, const Progress& progress);

// Tracer::count_each. A station that several networks have is traced once, as long as there is room to keep its points:
// networks of one front have half of their stations in common.
std::vector<NetworkCounts> count_networks(std::span<const StationRays> scanners,
                                          std::span<const std::vector<TraceStation>> networks,
                                          std::span<const std::uint32_t> station_counts, double goal_density,
                                          const Tracer::CountOptions& options, VoxelField& scratch,
                                          const Progress& progress);

}  // namespace vantage
