// SPDX-License-Identifier: Apache-2.0
// Counts the rays of one station.
#pragma once

#include <cstdint>

#include "trace/embree/point_buckets.hpp"
#include "trace/embree/station_rays.hpp"

namespace vantage {

struct StationTotals {
  std::uint64_t rays = 0, points = 0, points_on_surveyed = 0;
  DroppedPoints dropped = {};
  friend StationTotals operator+(const StationTotals& a, const StationTotals& b) {
    return {a.rays + b.rays, a.points + b.points, a.points_on_surveyed + b.points_on_surveyed, a.dropped + b.dropped};
  }
};

// Adds the station's points to the field, through `points`, and their sums to `totals`. `skip`: as in
// Tracer::CountOptions. Returns false if it was stopped before the end.
bool count_station(const StationRays& rays, const TraceStation& station, bool skip, PassField& field,
                   PointBuckets& points, StationTotals& totals, const Progress& progress);

}  // namespace vantage
