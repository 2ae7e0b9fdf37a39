// SPDX-License-Identifier: Apache-2.0
// Inverse of the ray pattern: the rays that pass through a box.
#pragma once

#include <array>
#include <cstdint>

#include "trace/tracer.hpp"

namespace vantage {

// Every ray that meets the box lies in one of these rows and column ranges; so may other rays. There are two column
// ranges if the box lies across the pattern's seam.
struct RayRanges {
  struct Range {
    std::uint32_t begin = 0, end = 0;
    bool empty() const { return begin >= end; }
  };
  Range rows;
  std::array<Range, 2> columns;
  bool empty() const { return rows.empty() || (columns[0].empty() && columns[1].empty()); }
};

// `low` and `high`: corners of the box relative to the head. REQUIRES: the pattern is no list. Bounds are widened by
// more than the rounding of directions.
RayRanges rays_of_box(const RayPattern& pattern, const Vec3& low, const Vec3& high);

// Returns the angles of a box, also widened, for patterns that are a list.
AngleWindow angles_of_box(const Vec3& low, const Vec3& high);

// Returns rays with a zenith between two and an azimuth in [azimuth, azimuth + width], radians; also widened.
RayRanges rays_between(const RayPattern& pattern, double least_zenith, double most_zenith, double azimuth,
                       double width);

// Replaces a box, relative to the head of a turned scanner, by one in the scanner's own frame that contains it. It is
// widened for the rounding of turned directions.
void turn_back(const Turn& turn, Vec3& low, Vec3& high);

// Batch of boxes seen from one head. Small and distant boxes, the majority, are handled several at once.
struct BoxBatch {
  static constexpr std::uint32_t kCapacity = 512;
  std::uint32_t size = 0;
  // Middle, relative to the head, and half extents.
  alignas(64) double x[kCapacity], y[kCapacity], z[kCapacity];
  alignas(64) double half_x[kCapacity], half_y[kCapacity], half_z[kCapacity];
  // Output: one range of rows and one of columns, either possibly empty. Unless `simple`, rays_of_box() must be called.
  alignas(64) std::int32_t row_begin[kCapacity], row_end[kCapacity], column_begin[kCapacity], column_end[kCapacity];
  alignas(64) std::int32_t simple[kCapacity];
};
void rays_of_boxes(const RayPattern& pattern, BoxBatch& boxes);
void turn_back(const Turn& turn, BoxBatch& boxes);

// Returns the margin for each side of a box within which float arithmetic may put a point into the box. A point is
// origin + t·d, and its cell the floor of (p − min)·inverse_size: five roundings of at most 2^−24 of `reach`, the
// largest magnitude involved (coordinates of head, box and grid, distance). The margin is three times that.
double rounding_pad(double reach);

}  // namespace vantage
