// SPDX-License-Identifier: Apache-2.0
#include "trace/embree/sample_networks.hpp"

#include <tbb/task_arena.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <utility>

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

constexpr std::size_t block = SampledVoxelCounter::block;
constexpr std::size_t pairs_at_once = std::size_t{1} << 22;  // (network, voxel) pairs, to bound memory
constexpr std::size_t most_kept = 4 * pairs_at_once;         // (station, voxel) pairs of stations that networks share

// Upper bound on coordinates in sight, relative or absolute. A power of two, so that most calls keep the last call's
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

// Stations of networks that share half of theirs or more, each as a network of its own. Empty if they share fewer, for
// which counting would not end at a network's goal, or if the counts of all would take too much memory.
std::vector<std::vector<TraceStation>> shared_stations(const StationIds& ids,
                                                       std::span<const std::vector<TraceStation>> networks,
                                                       std::size_t voxels) {
  std::size_t all = 0;
  for (const std::vector<TraceStation>& network : networks) all += network.size();
  if (2 * ids.different > all || ids.different * voxels > most_kept) return {};
  std::vector<std::vector<TraceStation>> alone(ids.different);
  for (std::size_t k = 0; k < networks.size(); ++k)
    for (std::size_t s = 0; s < networks[k].size(); ++s) alone[ids.of[k][s]] = {networks[k][s]};
  return alone;
}

// Adds a station's points in each voxel to those of its network, and marks where it has one. `masks` may be empty.
void add_station(const TraceStation& station, std::span<const std::uint32_t> points, std::span<std::uint32_t> counts,
                 std::span<std::uint64_t> masks) {
  for (std::size_t v = 0; v < points.size(); ++v) add_saturating(counts[v], points[v]);
  for (std::size_t v = 0; v < masks.size(); ++v) masks[v] |= std::uint64_t{points[v] > 0} << station.bit();
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

  const std::size_t n = voxels.size(), blocks = (n + block - 1) / block;
  const std::size_t at_once = std::clamp<std::size_t>(pairs_at_once / std::max<std::size_t>(n, 1), 1,
                                                      std::max<std::size_t>(networks.size(), 1));
  const std::size_t chunk = 32 * static_cast<std::size_t>(tbb::this_task_arena::max_concurrency());
  std::vector<std::uint32_t> counts(at_once * n);
  std::vector<std::uint64_t> masks(job.masks ? at_once * n : 0);

  const VoxelDemands demands = grid.demands().of(job.sample);

  bool cancelled = false;
  // Counts in all voxels of some networks, which are the part from `begun` to `done` of the whole job.
  const auto count = [&](std::span<const std::vector<TraceStation>> some, std::span<std::uint32_t> points,
                         std::span<std::uint64_t> seen, std::span<std::uint64_t> traced, double begun, double done) {
    for (std::size_t begin = 0; begin < some.size() * blocks && !cancelled; begin += chunk) {
      const std::size_t end = std::min(some.size() * blocks, begin + chunk);
      parallel::for_all(tbb::blocked_range<std::size_t>(begin, end, 1), [&](const auto& range) {
        SampledVoxelCounter counter(scanners, voxels, pad);
        for (std::size_t task = range.begin(); task < range.end(); ++task) {
          const std::size_t network = task / blocks, start = task % blocks * block;
          const std::size_t many = std::min(block, n - start);
          const std::uint64_t before = counter.traced();
          counter.count(some[network], start, job.stop_at, points.subspan(network * n + start, many),
                        seen.empty() ? seen : seen.subspan(network * n + start, many),
                        job.leave_out.empty() ? job.leave_out : job.leave_out.subspan(start, many));
          std::atomic_ref(traced[network]).fetch_add(counter.traced() - before, std::memory_order_relaxed);
        }
      });
      cancelled = progress.stopped();
      progress(begun + (done - begun) * static_cast<double>(end) / static_cast<double>(some.size() * blocks));
    }
  };

  const auto many = static_cast<double>(networks.size());
  const auto started = std::chrono::steady_clock::now();
  const StationIds ids = station_ids(scanners, networks);
  const std::vector<std::vector<TraceStation>> alone = shared_stations(ids, networks, n);
  std::vector<std::uint32_t> station_points(alone.size() * n);
  std::vector<std::uint64_t> station_rays(alone.size());
  if (!alone.empty()) count(alone, station_points, {}, station_rays, 0, 1);
  const double shared_seconds = seconds_since(started);

  std::vector<NetworkCounts> results(networks.size());
  for (std::size_t first = 0; first < networks.size(); first += at_once) {
    const auto begun = std::chrono::steady_clock::now();
    const std::size_t here = std::min(at_once, networks.size() - first);
    std::fill(counts.begin(), counts.end(), 0u);
    std::fill(masks.begin(), masks.end(), std::uint64_t{0});
    std::vector<std::uint64_t> traced(here);
    if (alone.empty()) {
      count(networks.subspan(first, here), counts, masks, traced, static_cast<double>(first) / many,
            static_cast<double>(first + here) / many);
    } else {
      parallel::for_all(std::size_t{0}, here, [&](std::size_t k) {
        for (std::size_t s = 0; s < networks[first + k].size(); ++s)
          add_station(networks[first + k][s], std::span(station_points).subspan(ids.of[first + k][s] * n, n),
                      std::span(counts).subspan(k * n, n),
                      job.masks ? std::span(masks).subspan(k * n, n) : std::span<std::uint64_t>());
      });
      // The rays of a shared station are those of the first network that has it.
      for (std::size_t k = 0; k < here; ++k)
        for (const std::size_t id : ids.of[first + k]) traced[k] += std::exchange(station_rays[id], 0);
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
    const double seconds = seconds_since(begun) / static_cast<double>(here) + shared_seconds / many;
    for (std::size_t k = 0; k < here; ++k) results[first + k].trace_seconds = seconds;
  }
  for (NetworkCounts& result : results) result.cancelled = cancelled;
  return results;
}

}  // namespace vantage
