// SPDX-License-Identifier: Apache-2.0
#include "trace/tracer.hpp"

namespace vantage {

std::vector<NetworkCounts> Tracer::count_each(std::span<const std::vector<TraceStation>> networks,
                                              std::span<const std::uint32_t> station_counts,
                                              const CountOptions& options, const Progress& progress) {
  std::vector<NetworkCounts> all(networks.size());
  for (NetworkCounts& counts : all) counts.cancelled = true;
  const auto many = static_cast<double>(networks.size());
  for (std::size_t k = 0; k < networks.size() && !progress.stopped(); ++k) {
    const Progress own{.report = [&](double part) { progress((static_cast<double>(k) + part) / many); },
                       .stop = progress.stop};
    all[k] = count(networks[k], station_counts[k], options, own);
  }
  return all;
}

}  // namespace vantage
