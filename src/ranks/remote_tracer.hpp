// SPDX-License-Identifier: Apache-2.0
// Proxy on rank 0 for another rank's tracer: sends stations and receives counts. Data that stays the same between
// calls, the sample and the planes of its voxels, is sent once.
#pragma once

#include "ranks/session.hpp"
#include "trace/tracer.hpp"

namespace vantage::ranks {

class RemoteTracer final : public Tracer {
 public:
  // `tracer`: the number that the rank gave it. `scan_rays`: a good chunk for scan(), as for the tracer here.
  RemoteTracer(std::shared_ptr<Session> session, int rank, std::uint32_t tracer, EngineInfo info,
               std::vector<std::uint64_t> scan_rays);

  const EngineInfo& info() const override { return info_; }
  void set_goal_density(double goal) override;
  std::uint64_t preferred_scan_rays(std::uint32_t scanner) const override { return scan_rays_[scanner]; }
  void scan(const TraceStation& station, std::uint64_t first_ray, std::uint64_t ray_count, std::uint32_t outputs,
            RawChunk& chunk) override;
  NetworkCounts count(std::span<const TraceStation> stations, std::uint32_t station_count, const CountOptions& options,
                      const Progress& progress) override;
  std::vector<NetworkCounts> count_each(std::span<const std::vector<TraceStation>> networks,
                                        std::span<const std::uint32_t> station_counts, const CountOptions& options,
                                        const Progress& progress) override;
  std::vector<NetworkCounts> count_sampled(std::span<const std::vector<TraceStation>> networks,
                                           std::span<const std::uint32_t> station_counts, const SampleJob& job,
                                           const Progress& progress) override;

 private:
  Writer message() const;
  std::optional<Message> asked(Kind kind, Message body, const Progress& progress);
  void send_sample(std::span<const std::uint32_t> sample);
  void send_patches(const RegistrationJob& job);

  std::shared_ptr<Session> session_;
  int rank_;
  std::uint32_t tracer_;
  EngineInfo info_;
  std::vector<std::uint64_t> scan_rays_;
  Session::Sample sample_;   // sample that the rank has
  RegistrationJob patches_;  // patches that the rank has
};

}  // namespace vantage::ranks
