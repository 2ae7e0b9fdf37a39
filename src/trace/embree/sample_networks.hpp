// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "core/lru_cache.hpp"
#include "trace/embree/sampled_voxels.hpp"
#include "trace/embree/station_rays.hpp"

namespace vantage {

// Tracer::count_sampled on the CPU. `scanners`: indexed by TraceStation::scanner. `kept`: samples of the last calls.
std::vector<NetworkCounts> sample_networks(std::span<const StationRays> scanners,
                                           std::span<const std::vector<TraceStation>> networks,
                                           std::span<const std::uint32_t> station_counts, double goal_density,
                                           const Tracer::SampleJob& job, LruCache<SampledVoxels>& kept,
                                           const Progress& progress);

}  // namespace vantage
