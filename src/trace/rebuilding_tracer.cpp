// SPDX-License-Identifier: Apache-2.0
#include "trace/rebuilding_tracer.hpp"

#include <algorithm>
#include <utility>

#include "trace/deliver_once.hpp"

namespace vantage {

RebuildingTracer::RebuildingTracer(Make make, const TraceScene& scene, Warn warn)
    : make_(std::move(make)), scene_(scene), warn_(std::move(warn)) {
  try {
    tracer_ = make_(scene_);
  } catch (const DeviceFault& fault) {
    if (warn_) warn_(std::string(fault.what()) + "; it is set up once more");
    tracer_ = make_(scene_);
  }
  info_ = tracer_->info();
}

void RebuildingTracer::set_goal_density(double goal) {
  Tracer::set_goal_density(goal);
  ready().set_goal_density(goal);
}

Tracer& RebuildingTracer::ready() const {
  if (!tracer_)
    throw Error(Errc::device_failure, info_.device + " failed before and could not be set up anew; start again");
  return *tracer_;
}

void RebuildingTracer::set_up_anew(const DeviceFault& fault, const std::string& what_next) {
  if (warn_)
    warn_(to_string(info_.engine) + " on device " + std::to_string(info_.device_index) + ", " + info_.device + ": " +
          fault.what() + "; it is set up anew" + what_next);
  make_again();
}

void RebuildingTracer::make_again() {
  tracer_ = nullptr;  // destroy the old tracer first, to free its resources for the new one
  tracer_ = make_(scene_);
  tracer_->set_goal_density(goal_density_);
}

bool RebuildingTracer::take(const TraceScene& later, const SceneDifference& difference) {
  try {
    if (!ready().take(later, difference)) return false;
  } catch (const DeviceFault& fault) {
    set_up_anew(fault, " for the scene as it was");
    return false;
  } catch (...) {
    make_again();  // it may have taken a part
    throw;
  }
  scene_ = later;
  return true;
}

template <class Work>
auto RebuildingTracer::twice(const Work& work) {
  try {
    return work(ready());
  } catch (const DeviceFault& fault) {
    set_up_anew(fault, " and its work done again");
  }
  return work(ready());
}

void RebuildingTracer::scan(const TraceStation& station, std::uint64_t first_ray, std::uint64_t ray_count,
                            std::uint32_t outputs, RawChunk& chunk) {
  twice([&](Tracer& tracer) { tracer.scan(station, first_ray, ray_count, outputs, chunk); });
}

NetworkCounts RebuildingTracer::count(std::span<const TraceStation> stations, std::uint32_t station_count,
                                      const CountOptions& options, const Progress& progress) {
  return twice([&](Tracer& tracer) { return tracer.count(stations, station_count, options, progress); });
}

std::vector<NetworkCounts> RebuildingTracer::count_sampled(std::span<const std::vector<TraceStation>> networks,
                                                           std::span<const std::uint32_t> station_counts,
                                                           const SampleJob& job, const Progress& progress) {
  DeliverOnce deliver(job, networks.size());
  const DeliverOnce::OnCaller here = [](const std::function<void()>& what) { what(); };
  const auto all = static_cast<double>(networks.size());
  std::vector<NetworkCounts> counts;
  for (bool again = false; counts.size() < networks.size();) {
    const std::size_t first = counts.size(), size = std::min(networks_at_once_, networks.size() - first);
    const auto share = [&](double done) {
      progress((static_cast<double>(first) + static_cast<double>(size) * done) / all);
    };
    try {
      std::vector<NetworkCounts> chunk =
          ready().count_sampled(networks.subspan(first, size), station_counts.subspan(first, size),
                                deliver.chunk(first, here), {.report = share, .stop = progress.stop});
      std::ranges::move(chunk, std::back_inserter(counts));
      again = false;
    } catch (const DeviceFault& fault) {
      if (fault.code() == Errc::out_of_memory && size > 1) {
        networks_at_once_ = size / 2;
        set_up_anew(fault, " and counts " + std::to_string(networks_at_once_) + " of " +
                               std::to_string(networks.size()) + " networks at once");
      } else if (!std::exchange(again, true)) {
        set_up_anew(fault, " and its work done again");
      } else {
        throw;
      }
      continue;
    }
    if (counts.back().cancelled) break;
  }
  // Networks that were not reached before cancellation.
  NetworkCounts left;
  left.cancelled = true;
  counts.resize(networks.size(), left);
  return counts;
}

}  // namespace vantage
