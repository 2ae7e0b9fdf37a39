// SPDX-License-Identifier: Apache-2.0
#include "trace/embree/count_network.hpp"

#include <chrono>
#include <utility>

#include "core/part_of.hpp"
#include "core/seconds_since.hpp"
#include "trace/embree/count_station.hpp"
#include "trace/embree/shared_stations.hpp"
#include "trace/field_counts.hpp"

namespace vantage {
namespace {

// Collects a network's counts.
class Tally {
 public:
  Tally(PassField& field, const StationRays& scanner, std::uint32_t stations, const Tracer::CountOptions& options)
      : field_(field),
        grid_(scanner.grid()),
        stations_(stations),
        points_(options.skip ? 0 : stations),
        on_surveyed_(stations),
        dropped_(scanner.limited() ? stations : 0) {  // either all scanners are limited or none
    field.count.assign(grid_.size(), 0);
    field.stations.assign(options.masks ? grid_.size() : 0, 0);
  }

  PassField& field() { return field_; }
  // Adds a station's sums, which the field does not hold.
  void add(const TraceStation& station, const StationTotals& totals) {
    rays_ += totals.rays;
    on_surveyed_[station.bit()] = totals.points_on_surveyed;
    if (!points_.empty()) points_[station.bit()] = totals.points;
    if (!dropped_.empty()) dropped_[station.bit()] = totals.dropped;
  }
  NetworkCounts finish(double goal_density) {
    NetworkCounts counts = reduce_field(field_.count, field_.stations, stations_, goal_density, grid_.demands());
    counts.rays = rays_;
    counts.points = std::move(points_);
    counts.points_on_surveyed = std::move(on_surveyed_);
    counts.dropped = std::move(dropped_);
    counts.trace_seconds = seconds_since(begun_);
    return counts;
  }

 private:
  const std::chrono::steady_clock::time_point begun_ = std::chrono::steady_clock::now();
  PassField& field_;
  const VoxelGrid& grid_;
  std::uint32_t stations_;
  std::uint64_t rays_ = 0;
  std::vector<std::uint64_t> points_, on_surveyed_;
  std::vector<DroppedPoints> dropped_;
};

}  // namespace

NetworkCounts count_network(std::span<const StationRays> scanners, std::span<const TraceStation> stations,
                            std::uint32_t station_count, double goal_density, const Tracer::CountOptions& options,
                            PassField& scratch, const Progress& progress) {
  Tally tally(options.field ? *options.field : scratch, scanners.front(), station_count, options);
  PointBuckets points(scanners.front().grid().size());
  bool cancelled = false;
  for (std::size_t s = 0; s < stations.size() && !cancelled; ++s) {
    StationTotals totals;
    cancelled = !count_station(scanners[stations[s].scanner], stations[s], options.skip, tally.field(), points, totals,
                               part_of(progress, s, stations.size()));
    tally.add(stations[s], totals);
  }
  NetworkCounts counts = tally.finish(goal_density);
  counts.cancelled = cancelled;
  return counts;
}

std::vector<NetworkCounts> count_networks(std::span<const StationRays> scanners,
                                          std::span<const std::vector<TraceStation>> networks,
                                          std::span<const std::uint32_t> station_counts, double goal_density,
                                          const Tracer::CountOptions& options, PassField& scratch,
                                          const Progress& progress) {
  std::vector<NetworkCounts> all(networks.size());
  for (NetworkCounts& counts : all) counts.cancelled = true;
  const std::size_t voxels = scanners.front().grid().size();
  SharedStations shared(scanners, networks, voxels * sizeof(std::uint32_t));  // at most the memory of the counts
  PointBuckets points(voxels);
  PassField alone;  // field of one station whose points are needed again
  std::size_t traced = 0;
  for (const std::size_t n : shared.order()) {
    if (progress.stopped()) break;
    Tally tally(scratch, scanners.front(), station_counts[n], options);
    for (std::size_t s = 0; s < networks[n].size(); ++s) {
      const TraceStation& station = networks[n][s];
      const SharedStations::Use use = shared.next(n, s);
      if (use.points) {
        use.points->add_to(tally.field(), std::uint64_t{1} << station.bit());
        tally.add(station, use.points->totals());
        continue;
      }
      if (use.again) alone.count.assign(voxels, 0);
      // Stations for which there was no room are traced again, without progress.
      const Progress own =
          traced < shared.different() ? part_of(progress, traced, shared.different()) : Progress{.stop = progress.stop};
      ++traced;
      StationTotals totals;
      if (!count_station(scanners[station.scanner], station, options.skip, use.again ? alone : tally.field(), points,
                         totals, own))
        return all;
      tally.add(station, totals);
      if (!use.again) continue;
      StationPoints found(alone.count, totals);
      found.add_to(tally.field(), std::uint64_t{1} << station.bit());
      shared.keep(use.id, std::move(found));
    }
    all[n] = tally.finish(goal_density);
  }
  return all;
}

}  // namespace vantage
