// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "trace/embree/station_rays.hpp"

namespace vantage {

// Tracer::count on the CPU.
NetworkCounts count_network(const StationRays& rays, std::span<const TraceStation> stations,
                            std::uint32_t station_count, double goal_density, const Tracer::CountOptions& options,
                            const Progress& progress);

}  // namespace vantage
