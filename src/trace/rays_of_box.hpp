// SPDX-License-Identifier: Apache-2.0
// The inverse of the ray pattern: which rays pass through a box.
#pragma once

#include <array>
#include <cstdint>

#include "trace/tracer.hpp"

namespace vantage {

// Every ray that meets the box lies in one of these rows and one of these column ranges (two where the box lies across
// the pattern's seam); other rays may too.
struct RayRanges {
  struct Range {
    std::uint32_t begin = 0, end = 0;
    bool empty() const { return begin >= end; }
  };
  Range rows;
  std::array<Range, 2> columns;
  bool empty() const { return rows.empty() || (columns[0].empty() && columns[1].empty()); }
};

// `low` and `high`: corners of the box relative to the head. Bounds are widened by more than the directions' rounding.
RayRanges rays_of_box(const RayPattern& pattern, const Vec3& low, const Vec3& high);

// For a turned scanner: corners of a box, relative to the head, become those of one in the scanner's own frame that
// holds it, wide enough for the rounding of turned directions.
void turn_back(const Turn& turn, Vec3& low, Vec3& high);

// Many boxes from one head, of which most are small and far off: those are done several at once.
struct BoxBatch {
  static constexpr std::uint32_t capacity = 512;
  std::uint32_t size = 0;
  // Middle, relative to the head, and half of the extent.
  alignas(64) double x[capacity], y[capacity], z[capacity];
  alignas(64) double half_x[capacity], half_y[capacity], half_z[capacity];
  // Out: one range of rows and one of columns, either may be empty; where not `simple`, rays_of_box() must be asked.
  alignas(64) std::int32_t row_begin[capacity], row_end[capacity], column_begin[capacity], column_end[capacity];
  alignas(64) std::int32_t simple[capacity];
};
void rays_of_boxes(const RayPattern& pattern, BoxBatch& boxes);
void turn_back(const Turn& turn, BoxBatch& boxes);

// How far a box must be widened on each side so that no point that float arithmetic puts into it lies outside: a point
// is origin + t·d, and its cell the floor of (p − min)·inverse_size, five roundings of at most 2^−24 of `reach`, the
// largest of the magnitudes involved (coordinates of head, box and grid, and the distance). Three times that.
double rounding_pad(double reach);

}  // namespace vantage
