// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "trace/embree/station_rays.hpp"

namespace vantage {

// Tracer::count on the CPU. `scanners`: indexed by TraceStation::scanner. `scratch`: used as the field if options have
// none; kept between calls to reuse its memory.
NetworkCounts count_network(std::span<const StationRays> scanners, std::span<const TraceStation> stations,
                            std::uint32_t station_count, double goal_density, const Tracer::CountOptions& options,
                            PassField& scratch, const Progress& progress);

// Tracer::count_each on the CPU. A station of several networks is traced once, as long as there is room for its points.
// Networks of one front share half of their stations.
std::vector<NetworkCounts> count_networks(std::span<const StationRays> scanners,
                                          std::span<const std::vector<TraceStation>> networks,
                                          std::span<const std::uint32_t> station_counts, double goal_density,
                                          const Tracer::CountOptions& options, PassField& scratch,
                                          const Progress& progress);

}  // namespace vantage
