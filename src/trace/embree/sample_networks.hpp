// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "trace/embree/station_rays.hpp"

namespace vantage {

// Tracer::count_sampled on the CPU.
std::vector<NetworkCounts> sample_networks(const StationRays& rays, std::span<const std::vector<TraceStation>> networks,
                                           std::span<const std::uint32_t> station_counts, double goal_density,
                                           const Tracer::SampleJob& job, const Progress& progress);

}  // namespace vantage
