// SPDX-License-Identifier: Apache-2.0
#include "trace/embree/sample_networks.hpp"

#include <tbb/task_arena.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <cmath>

#include "core/add_saturating.hpp"
#include "core/parallel.hpp"
#include "core/seconds_since.hpp"
#include "trace/embree/shared_stations.hpp"
#include "trace/embree/voxel_counter.hpp"
#include "trace/rays_of_box.hpp"
#include "trace/registration_sums.hpp"
#include "trace/sample_counts.hpp"

namespace vantage {
namespace {

constexpr std::size_t kBlock = SampledVoxelCounter::kBlock;
constexpr std::size_t kPairsAtOnce = std::size_t{1} << 22;  // (network, voxel) pairs, to bound memory

// Bounds coordinates in sight, relative or absolute. Returns a power of two, so that most calls keep the last call's
// sample.
double magnitude(const VoxelGrid& grid, std::span<const std::vector<TraceStation>> networks) {
  const Vec3 min{grid.min()[0], grid.min()[1], grid.min()[2]};
  double farthest = 0;
  for (const std::vector<TraceStation>& network : networks) {
    for (const TraceStation& station : network) {
      const Vec3 head{station.origin.x, station.origin.y, station.origin.z};
      farthest = std::max(farthest, std::sqrt(dot(head, head)));
    }
  }
  const double sum = farthest + std::sqrt(dot(min, min)) + 2 * grid.voxel_size() * (1 << grid.depth());
  return std::exp2(std::ceil(std::log2(sum)));
}

// A station with the networks that have it.
struct SharedStation {
  struct Use {
    std::size_t network;
    std::uint32_t bit;
  };
  std::vector<TraceStation> station;  // alone
  std::vector<Use> uses;
};

// Returns the stations of networks that share half of their stations or more. It is empty if they share fewer, since
// shared counting does not end at a network's goal.
std::vector<SharedStation> shared_stations(std::span<const StationRays> scanners,
                                           std::span<const std::vector<TraceStation>> networks) {
  const StationIds ids = station_ids(scanners, networks);
  std::size_t all = 0;
  for (const std::vector<TraceStation>& network : networks) all += network.size();
  if (2 * ids.different > all) return {};
  std::vector<SharedStation> shared(ids.different);
  for (std::size_t k = 0; k < networks.size(); ++k)
    for (std::size_t s = 0; s < networks[k].size(); ++s) {
      SharedStation& one = shared[ids.of[k][s]];
      one.station = {networks[k][s]};
      one.uses.push_back({k, networks[k][s].bit()});
    }
  return shared;
}

}  // namespace

std::vector<NetworkCounts> sample_networks(std::span<const StationRays> scanners,
                                           std::span<const std::vector<TraceStation>> networks,
                                           std::span<const std::uint32_t> station_counts, double goal_density,
                                           const Tracer::SampleJob& job, LruCache<SampledVoxels>& kept,
                                           const Progress& progress) {
  const SceneData& scene = scanners.front().scene();
  const VoxelGrid& grid = scanners.front().grid();
  const double size = magnitude(grid, networks), pad = rounding_pad(size);
  float farthest = 0;
  for (const StationRays& rays : scanners)
    farthest = std::max(farthest, rays.noise().reach_within(static_cast<float>(size) + rays.noise().reach()));
  const double reach = farthest;
  const SampledVoxels& voxels = kept.get([&](const SampledVoxels& one) { return one.made_for(job.sample, pad, reach); },
                                         [&] {
                                           return SampledVoxels(scene, grid, scanners.front().sample_triangles(),
                                                                job.sample, pad, reach, reach + triangle_margin(pad));
                                         });

  const std::size_t n = voxels.size(), blocks = (n + kBlock - 1) / kBlock;
  const std::size_t at_once =
      std::clamp<std::size_t>(kPairsAtOnce / std::max<std::size_t>(n, 1), 1, std::max<std::size_t>(networks.size(), 1));
  const auto threads = static_cast<std::size_t>(tbb::this_task_arena::max_concurrency());
  const std::size_t chunk = 32 * threads;
  std::vector<std::uint32_t> counts(at_once * n);
  std::vector<std::uint64_t> masks(job.masks ? at_once * n : 0);

  const VoxelDemands demands = grid.demands().of(job.sample);

  std::vector<NetworkCounts> results(networks.size());
  bool cancelled = false;
  for (std::size_t first = 0; first < networks.size(); first += at_once) {
    const auto begun = std::chrono::steady_clock::now();
    const std::size_t here = std::min(at_once, networks.size() - first);
    std::fill(counts.begin(), counts.end(), 0u);
    std::fill(masks.begin(), masks.end(), std::uint64_t{0});
    std::vector<std::uint64_t> traced(here);
    // Returns the counts of a part of the voxels, from `start` on, of the network in place k.
    const auto counts_of = [&](std::size_t k, std::size_t start, std::size_t many) {
      return std::span(counts).subspan(k * n + start, many);
    };
    const auto masks_of = [&](std::size_t k, std::size_t start, std::size_t many) {
      return job.masks ? std::span(masks).subspan(k * n + start, many) : std::span<std::uint64_t>();
    };
    const auto left_out = [&](std::size_t start, std::size_t many) {
      return job.leave_out.empty() ? job.leave_out : job.leave_out.subspan(start, many);
    };
    const std::vector<SharedStation> shared = shared_stations(scanners, networks.subspan(first, here));
    const auto count_network = [&](SampledVoxelCounter& counter, std::size_t k, std::size_t start, std::size_t many) {
      const std::uint64_t before = counter.traced();
      counter.count(networks[first + k], start, job.stop_at, counts_of(k, start, many), masks_of(k, start, many),
                    left_out(start, many));
      std::atomic_ref(traced[k]).fetch_add(counter.traced() - before, std::memory_order_relaxed);
    };
    // Uses the rays of the first network that has the station.
    const auto count_shared = [&](SampledVoxelCounter& counter, std::size_t start, std::size_t many) {
      std::array<std::uint32_t, kBlock> points{};
      for (const SharedStation& one : shared) {
        const std::uint64_t before = counter.traced();
        std::fill_n(points.begin(), many, 0u);
        counter.count(one.station, start, job.stop_at, std::span(points).first(many), {}, left_out(start, many));
        for (const SharedStation::Use& use : one.uses) {
          const std::span<std::uint32_t> sums = counts_of(use.network, start, many);
          for (std::size_t v = 0; v < sums.size(); ++v) add_saturating(sums[v], points[v]);
          const std::span<std::uint64_t> seen = masks_of(use.network, start, many);
          for (std::size_t v = 0; v < seen.size(); ++v) seen[v] |= std::uint64_t{points[v] > 0} << use.bit;
        }
        std::atomic_ref(traced[one.uses.front().network])
            .fetch_add(counter.traced() - before, std::memory_order_relaxed);
      }
    };
    // Tasks are blocks of each network, or of all shared stations together.
    const std::size_t tasks = shared.empty() ? here * blocks : blocks;
    const std::size_t together = shared.empty() ? chunk : std::max(chunk / shared.size(), 4 * threads);
    for (std::size_t begin = 0; begin < tasks && !cancelled; begin += together) {
      const std::size_t end = std::min(tasks, begin + together);
      parallel::for_all(tbb::blocked_range<std::size_t>(begin, end, 1), [&](const auto& range) {
        SampledVoxelCounter counter(scanners, voxels, pad);
        for (std::size_t task = range.begin(); task < range.end(); ++task) {
          const std::size_t start = task % blocks * kBlock, many = std::min(kBlock, n - start);
          if (shared.empty())
            count_network(counter, task / blocks, start, many);
          else
            count_shared(counter, start, many);
        }
      });
      cancelled = progress.stopped();
      const double done = static_cast<double>(end) / static_cast<double>(tasks) * static_cast<double>(here);
      progress((static_cast<double>(first) + done) / static_cast<double>(networks.size()));
    }
    for (std::size_t k = 0; k < here; ++k) {
      const std::span<const std::uint32_t> own_counts(counts.data() + k * n, n);
      const std::span<const std::uint64_t> own_masks(masks.data() + (job.masks ? k * n : 0), job.masks ? n : 0);
      results[first + k] =
          reduce_sample(own_counts, own_masks, job.groups, station_counts[first + k], goal_density, demands);
      results[first + k].rays = traced[k];
      if (job.points && !cancelled) job.points(first + k, own_counts);
    }
    if (job.registration && !cancelled)
      parallel::for_all(std::size_t{0}, here, [&](std::size_t k) {
        take_registration(results[first + k],
                          sum_patches(*job.registration, networks[first + k], station_counts[first + k],
                                      std::span(masks).subspan(k * n, n), job.groups));
      });
    if (job.station_masks && !cancelled) job.station_masks(first, std::span(masks).first(here * n));
    const double seconds = seconds_since(begun) / static_cast<double>(here);
    for (std::size_t k = 0; k < here; ++k) results[first + k].trace_seconds = seconds;
  }
  for (NetworkCounts& result : results) result.cancelled = cancelled;
  return results;
}

}  // namespace vantage
