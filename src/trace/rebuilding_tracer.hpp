// SPDX-License-Identifier: Apache-2.0
// Tracer on a device that may fail. After a fault it is set up anew, once for each piece of work, and repeats the
// piece. Counts equal those of a device that never failed.
#pragma once

#include <functional>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "trace/device_fault.hpp"
#include "trace/tracer.hpp"

namespace vantage {

class RebuildingTracer final : public Tracer {
 public:
  using Make = std::function<std::unique_ptr<Tracer>(const TraceScene& scene)>;
  using Warn = std::function<void(const std::string&)>;
  // Calls `make` again after a DeviceFault, thrown by `make` or by the tracer that it made. `warn` is called for each
  // fault, on the calling thread. A second failure is thrown.
  RebuildingTracer(Make make, const TraceScene& scene, Warn warn);

  const EngineInfo& info() const override { return info_; }
  void set_goal_density(double goal) override;
  std::uint64_t uploaded_bytes() const override { return tracer_ ? tracer_->uploaded_bytes() : 0; }
  std::uint64_t preferred_scan_rays(std::uint32_t scanner) const override {
    return ready().preferred_scan_rays(scanner);
  }

  void scan(const TraceStation& station, std::uint64_t first_ray, std::uint64_t ray_count, std::uint32_t outputs,
            RawChunk& chunk) override;
  NetworkCounts count(std::span<const TraceStation> stations, std::uint32_t station_count, const CountOptions& options,
                      const Progress& progress) override;
  // Halves the networks in flight, permanently, if the device's memory is too small for all of them.
  std::vector<NetworkCounts> count_sampled(std::span<const std::vector<TraceStation>> networks,
                                           std::span<const std::uint32_t> station_counts, const SampleJob& job,
                                           const Progress& progress) override;
  bool take(const TraceScene& later, const SceneDifference& difference) override;

 private:
  Tracer& ready() const;
  void make_again();
  void set_up_anew(const DeviceFault& fault, const std::string& what_next);
  // Calls `work` on the tracer, and after a failure once more on a new tracer.
  template <class Work>
  auto twice(const Work& work);

  Make make_;
  TraceScene scene_;
  Warn warn_;
  std::unique_ptr<Tracer> tracer_;  // null: it failed and could not be set up anew
  EngineInfo info_;
  std::size_t networks_at_once_ = std::numeric_limits<std::size_t>::max();
};

}  // namespace vantage
