// SPDX-License-Identifier: Apache-2.0
// One tracer over several, each on its own device. Workers take chunks of sampled populations, networks of every ray,
// and rows of a scan. One network of every ray is split by stations if that saves more time than merging takes. A chunk
// of a population is some of its networks, or some of the sample's voxels. All counts are integers, so the result does
// not depend on who counted what.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "trace/spread/worker_pool.hpp"
#include "trace/tracer.hpp"

namespace vantage {

class SpreadTracer final : public Tracer {
 public:
  // When to split one network by its stations.
  enum class Split { where_it_pays, always };
  // Division of a sampled population. With voxels, each worker sees all stations. This suits GPUs: rays from
  // neighbouring stations to a voxel share their way, so half the stations are more than half the work. With networks,
  // each worker gets only the stations of its networks, which suits workers far away.
  enum class Population { by_networks, by_voxels };
  struct Options {
    Split split = Split::where_it_pays;
    Population population = Population::by_networks;
    std::optional<EngineInfo> info = std::nullopt;  // name of the whole; empty: the workers' devices
  };
  // All tracers are of one scene. REQUIRES: at least one.
  SpreadTracer(std::vector<std::unique_ptr<Tracer>> tracers, const TraceScene& scene, WorkerPool::Warn warn,
               Options options);

  const EngineInfo& info() const override { return info_; }
  void set_goal_density(double goal) override;
  std::uint64_t uploaded_bytes() const override;

  void scan(const TraceStation& station, std::uint64_t first_ray, std::uint64_t ray_count, std::uint32_t outputs,
            RawChunk& chunk) override;
  std::uint64_t preferred_scan_rays(std::uint32_t scanner) const override;
  NetworkCounts count(std::span<const TraceStation> stations, std::uint32_t station_count, const CountOptions& options,
                      const Progress& progress) override;
  std::vector<NetworkCounts> count_each(std::span<const std::vector<TraceStation>> networks,
                                        std::span<const std::uint32_t> station_counts, const CountOptions& options,
                                        const Progress& progress) override;
  std::vector<NetworkCounts> count_sampled(std::span<const std::vector<TraceStation>> networks,
                                           std::span<const std::uint32_t> station_counts, const SampleJob& job,
                                           const Progress& progress) override;

 private:
  NetworkCounts count_whole(std::span<const TraceStation> stations, std::uint32_t station_count,
                            const CountOptions& options, const Progress& progress);
  NetworkCounts count_by_station(std::span<const TraceStation> stations, std::uint32_t station_count,
                                 const CountOptions& options, const Progress& progress);
  bool split_pays(std::size_t stations) const;
  std::vector<NetworkCounts> count_by_voxels(std::span<const std::vector<TraceStation>> networks,
                                             std::span<const std::uint32_t> station_counts, const SampleJob& job,
                                             const Progress& progress);
  std::vector<NetworkCounts> count_by_networks(std::span<const std::vector<TraceStation>> networks,
                                               std::span<const std::uint32_t> station_counts, const SampleJob& job,
                                               const Progress& progress);

  EngineInfo info_;
  std::shared_ptr<const VoxelGrid> grid_;
  std::vector<TraceScanner> scanners_;
  WorkerPool pool_;
  Split split_;
  Population population_;
  WorkerRates rows_, networks_, samples_, stations_;
  WorkerRates runs_{.of_rest = 1};
  double seconds_a_station_ = 0;  // of networks counted whole, last measured; 0: not yet
  double merge_seconds_a_voxel_;
};

}  // namespace vantage
