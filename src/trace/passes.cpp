// SPDX-License-Identifier: Apache-2.0
#include "trace/passes.hpp"

#include <algorithm>

#include "core/add_saturating.hpp"
#include "core/parallel.hpp"
#include "core/part_of.hpp"
#include "trace/field_counts.hpp"
#include "trace/registration_sums.hpp"
#include "trace/sample_counts.hpp"

namespace vantage {
namespace {

constexpr auto kMaskBits = static_cast<std::uint32_t>(mask_bits);

// Stations of consecutive places. `word`: word of the mask; `size`: number of places.
struct Pass {
  std::size_t word;
  std::uint32_t size;
  std::vector<TraceStation> stations;
};

// Returns the passes that have a station to trace.
std::vector<Pass> passes_of(std::span<const TraceStation> stations, std::uint32_t station_count) {
  std::vector<Pass> passes;
  for (std::uint32_t first = 0; first < station_count; first += kMaskBits) {
    Pass pass{.word = first / kMaskBits, .size = std::min(kMaskBits, station_count - first), .stations = {}};
    for (const TraceStation& station : stations)
      if (station.place >= first && station.place - first < kMaskBits) pass.stations.push_back(station);
    if (!pass.stations.empty()) passes.push_back(std::move(pass));
  }
  return passes;
}

void add(std::vector<std::uint32_t>& counts, std::span<const std::uint32_t> more) {
  parallel::for_all(std::size_t{0}, counts.size(), [&](std::size_t k) { add_saturating(counts[k], more[k]); });
}

// Copies a pass's per-station figures to their places among all stations.
template <class Figure>
void place(std::vector<Figure>& all, const std::vector<Figure>& own, const Pass& pass, std::uint32_t station_count) {
  if (own.empty()) return;
  all.resize(station_count);
  std::ranges::copy(own, all.begin() + static_cast<std::ptrdiff_t>(pass.word * mask_bits));
}

}  // namespace

NetworkCounts count_in_passes(Tracer& tracer, std::span<const TraceStation> stations, std::uint32_t station_count,
                              const Tracer::CountOptions& options, VoxelField* field, const VoxelGrid& grid,
                              double goal_density, const Progress& progress) {
  if (station_count <= kMaskBits && !field) return tracer.count(stations, station_count, options, progress);
  VoxelField own;
  VoxelField& all = field ? *field : own;
  all.stations = {};
  PassField part;
  const auto count = [&](const Pass& pass, const Progress& of_pass) {
    return tracer.count(pass.stations, pass.size, {.masks = options.masks, .skip = options.skip, .field = &part},
                        of_pass);
  };
  const std::vector<Pass> passes = passes_of(stations, station_count);
  if (station_count <= kMaskBits) {
    NetworkCounts counts = count(passes.front(), progress);
    all.count = std::move(part.count);
    if (options.masks) all.stations = StationMasks(std::move(part.stations));
    return counts;
  }

  all.count.assign(grid.size(), 0);
  if (options.masks) all.stations = StationMasks(grid.size(), station_count);
  NetworkCounts told;
  for (std::size_t k = 0; k < passes.size(); ++k) {
    const Pass& pass = passes[k];
    const NetworkCounts counts = count(pass, part_of(progress, k, passes.size()));
    told.rays += counts.rays;
    told.trace_seconds += counts.trace_seconds;
    place(told.points, counts.points, pass, station_count);
    place(told.points_on_surveyed, counts.points_on_surveyed, pass, station_count);
    place(told.dropped, counts.dropped, pass, station_count);
    told.cancelled = counts.cancelled;
    if (counts.cancelled) break;
    add(all.count, part.count);
    if (options.masks) all.stations.set_words(pass.word, part.stations);
  }
  part = {};
  NetworkCounts sums = reduce_field(all, station_count, goal_density, grid.demands());
  sums.rays = told.rays, sums.trace_seconds = told.trace_seconds, sums.cancelled = told.cancelled;
  sums.points = std::move(told.points);
  sums.points_on_surveyed = std::move(told.points_on_surveyed);
  sums.dropped = std::move(told.dropped);
  return sums;
}

NetworkCounts count_sampled_in_passes(Tracer& tracer, std::span<const TraceStation> stations,
                                      std::uint32_t station_count, const Tracer::SampleJob& job, const VoxelGrid& grid,
                                      double goal_density, const Progress& progress) {
  const std::vector<Pass> passes = passes_of(stations, station_count);
  std::vector<std::vector<TraceStation>> networks;
  std::vector<std::uint32_t> sizes;
  for (const Pass& pass : passes) networks.push_back(pass.stations), sizes.push_back(pass.size);
  const std::size_t voxels = job.sample.size();
  std::vector<std::uint32_t> counts(voxels, 0);
  std::vector<std::uint64_t> masks(job.masks ? voxels * mask_words(station_count) : 0, 0);
  Tracer::SampleJob one = job;
  one.registration = nullptr;
  one.points = [&](std::size_t, std::span<const std::uint32_t> points) { add(counts, points); };
  if (job.masks)
    one.station_masks = [&](std::size_t first, std::span<const std::uint64_t> told) {
      for (std::size_t k = 0; k * voxels < told.size(); ++k)
        std::ranges::copy(told.subspan(k * voxels, voxels),
                          masks.begin() + static_cast<std::ptrdiff_t>(passes[first + k].word * voxels));
    };
  const std::vector<NetworkCounts> parts = tracer.count_sampled(networks, sizes, one, progress);

  NetworkCounts all =
      reduce_sample(counts, masks, job.groups, station_count, goal_density, grid.demands().of(job.sample));
  for (const NetworkCounts& part : parts) {
    all.rays += part.rays;
    all.trace_seconds += part.trace_seconds;
    all.cancelled = all.cancelled || part.cancelled;
  }
  if (all.cancelled) return all;
  if (job.registration)
    take_registration(all, sum_patches(*job.registration, stations, station_count, masks, job.groups));
  if (job.points) job.points(0, counts);
  if (job.station_masks) job.station_masks(0, masks);
  return all;
}

}  // namespace vantage
