// SPDX-License-Identifier: Apache-2.0
#include "trace/embree/sample_networks.hpp"

#include "trace/embree/count_network.hpp"
#include "trace/sample_counts.hpp"

namespace vantage {

std::vector<NetworkCounts> sample_networks(const StationRays& rays, std::span<const std::vector<TraceStation>> networks,
                                           std::span<const std::uint32_t> station_counts, double goal_density,
                                           const Tracer::SampleJob& job, const Progress& progress) {
  std::vector<NetworkCounts> results;
  for (std::size_t n = 0; n < networks.size(); ++n) {
    VoxelField field;
    Tracer::CountOptions options;
    options.masks = job.masks;
    options.field = &field;
    const NetworkCounts full =
        count_network(rays, networks[n], station_counts[n], goal_density, options, {{}, progress.stop});
    std::vector<std::uint32_t> counts;
    std::vector<std::uint64_t> masks;
    for (const std::uint32_t rank : job.sample) {
      counts.push_back(field.count[rank]);
      if (job.masks) masks.push_back(field.stations[rank]);
    }
    results.push_back(reduce_sample(counts, masks, job.groups, station_counts[n], goal_density));
    results.back().rays = full.rays;
    results.back().trace_seconds = full.trace_seconds;
    results.back().cancelled = full.cancelled;
    progress(static_cast<double>(n + 1) / static_cast<double>(networks.size()));
  }
  return results;
}

}  // namespace vantage
