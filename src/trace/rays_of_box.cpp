// SPDX-License-Identifier: Apache-2.0
#include "trace/rays_of_box.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/target_clones.hpp"
#include "trace/fast_atan2.hpp"

namespace vantage {
namespace {

// Widening of angles. Components of a direction are products of two values rounded to 24 bits, which shifts angles by
// less than 2^−22; fast_atan2 adds 2^−25.
constexpr double kAnglePad = 0x1p-20;

// Returns the indices k in [0, count) with low <= first + k·step <= high.
[[gnu::always_inline]] inline RayRanges::Range indices(double low, double high, double first, double step,
                                                       std::uint32_t count) {
  const double begin = std::ceil((low - first) / step), end = std::floor((high - first) / step) + 1;
  if (!(begin < end) || end <= 0 || begin >= count) return {};
  return {static_cast<std::uint32_t>(std::max(begin, 0.0)),
          static_cast<std::uint32_t>(std::min(end, static_cast<double>(count)))};
}

// Returns the rows whose zeniths lie in [low, high].
[[gnu::always_inline]] inline RayRanges::Range rows_of(const RayPattern& pattern, double low, double high) {
  if (pattern.zeniths.empty()) return indices(low, high, pattern.first_zenith, pattern.zenith_step, pattern.rows());
  const auto begin = std::ranges::lower_bound(pattern.zeniths, low),
             end = std::ranges::upper_bound(pattern.zeniths, high);
  return {static_cast<std::uint32_t>(begin - pattern.zeniths.begin()),
          static_cast<std::uint32_t>(end - pattern.zeniths.begin())};
}

// Returns the columns whose azimuths lie in [begin, begin + width], modulo a turn.
[[gnu::always_inline]] inline std::array<RayRanges::Range, 2> columns_of(const RayPattern& pattern, double begin,
                                                                         double width) {
  constexpr double kTurn = 2 * std::numbers::pi;
  const std::uint32_t columns = pattern.columns();
  begin -= pattern.first_azimuth;
  begin -= std::floor(begin / kTurn) * kTurn;
  const RayRanges::Range first = indices(begin, begin + width, 0, pattern.azimuth_step, columns);
  const RayRanges::Range second = indices(begin - kTurn, begin - kTurn + width, 0, pattern.azimuth_step, columns);
  // Both ends of nearly a full turn, or a pattern of more than a turn, give one range.
  if (!first.empty() && second.end > first.begin) return {{{0, columns}, {}}};
  return {first, second};
}

// Returns the rays whose angles lie in a window.
[[gnu::always_inline]] inline RayRanges rays_in(const RayPattern& pattern, const AngleWindow& window) {
  RayRanges ranges;
  ranges.rows = rows_of(pattern, window.least_zenith, window.most_zenith);
  if (ranges.rows.empty()) return ranges;
  if (window.width >= 2 * std::numbers::pi) {
    ranges.columns[0] = {0, pattern.columns()};
  } else {
    ranges.columns = columns_of(pattern, window.azimuth, window.width);
  }
  return ranges;
}

// Returns the angles of a box, widened.
[[gnu::always_inline]] inline AngleWindow window_of_box(const Vec3& low, const Vec3& high) {
  constexpr double kTurn = 2 * std::numbers::pi;
  const double cx = (low.x + high.x) / 2, cy = (low.y + high.y) / 2, cz = (low.z + high.z) / 2;
  const double hx = (high.x - low.x) / 2, hy = (high.y - low.y) / 2, hz = (high.z - low.z) / 2;
  const double r = std::sqrt(cx * cx + cy * cy);
  // Half extents of the box along and across the horizontal direction to its middle, times r.
  const double along = std::abs(cx) * hx + std::abs(cy) * hy, across = std::abs(cy) * hx + std::abs(cx) * hy;
  if (along >= r * r) {  // the box may lie across the vertical axis, where every azimuth meets it
    if (low.z <= 0 && high.z >= 0) return {-kAnglePad, std::numbers::pi + kAnglePad, 0, kTurn};
    const double far = r + std::sqrt(hx * hx + hy * hy);
    const double least = high.z > 0 ? 0 : fast_atan2(far, high.z),
                 most = low.z > 0 ? fast_atan2(far, low.z) : std::numbers::pi;
    return {least - kAnglePad, most + kAnglePad, 0, kTurn};
  }
  // Seen from above, the box lies within its middle's azimuth ± across / (r² − along), since no point is further across
  // or nearer. In the plane of axis distance and height, it likewise lies in a rectangle around its middle.
  const double radial = (along + across) / r;
  const double distance = std::sqrt(r * r + cz * cz);
  const double depth = distance - (r * radial + std::abs(cz) * hz) / distance;
  const double rise = (std::abs(cz) * radial + r * hz) / distance;
  AngleWindow window{-kAnglePad, std::numbers::pi + kAnglePad, 0, 0};
  if (depth > 0) {
    const double zenith = fast_atan2(r, cz), half = rise / depth + kAnglePad;
    window.least_zenith = zenith - half, window.most_zenith = zenith + half;
  }
  const double azimuth = fast_atan2(std::abs(cy), cx) * (cy < 0 ? -1 : 1), half = across / (r * r - along) + kAnglePad;
  window.azimuth = azimuth - half, window.width = 2 * half;
  return window;
}

// Turns a box's middle into the scanner's frame, and the half extents into those of an enclosing box. Rounding of the
// turn and of the direction moves a turned direction by less than 2^−21.
void turn_box(const Turn& turn, Vec3& middle, Vec3& half) {
  constexpr double kDoubt = 0x1p-20;
  const Vec3 m = middle, h = half;
  const Vec3 rows[3] = {{turn.x.x, turn.x.y, turn.x.z}, {turn.y.x, turn.y.y, turn.y.z}, {turn.z.x, turn.z.y, turn.z.z}};
  const auto size = [](const Vec3& v) { return Vec3{std::abs(v.x), std::abs(v.y), std::abs(v.z)}; };
  const Vec3 reach = size(m) + h;
  const double pad = kDoubt * (reach.x + reach.y + reach.z);
  middle = rows[0] * m.x + rows[1] * m.y + rows[2] * m.z;
  half = size(rows[0]) * h.x + size(rows[1]) * h.y + size(rows[2]) * h.z + Vec3{pad, pad, pad};
}

}  // namespace

void turn_back(const Turn& turn, Vec3& low, Vec3& high) {
  Vec3 middle = (low + high) * 0.5, half = (high - low) * 0.5;
  turn_box(turn, middle, half);
  low = middle - half;
  high = middle + half;
}

void turn_back(const Turn& turn, BoxBatch& boxes) {
  for (std::uint32_t i = 0; i < boxes.size; ++i) {
    Vec3 middle{boxes.x[i], boxes.y[i], boxes.z[i]}, half{boxes.half_x[i], boxes.half_y[i], boxes.half_z[i]};
    turn_box(turn, middle, half);
    boxes.x[i] = middle.x, boxes.y[i] = middle.y, boxes.z[i] = middle.z;
    boxes.half_x[i] = half.x, boxes.half_y[i] = half.y, boxes.half_z[i] = half.z;
  }
}

RayRanges rays_between(const RayPattern& pattern, double least_zenith, double most_zenith, double azimuth,
                       double width) {
  return rays_in(pattern,
                 {least_zenith - kAnglePad, most_zenith + kAnglePad, azimuth - kAnglePad, width + 2 * kAnglePad});
}

double rounding_pad(double reach) { return 0x1p-20 * reach; }

VANTAGE_TARGET_CLONES
RayRanges rays_of_box(const RayPattern& pattern, const Vec3& low, const Vec3& high) {
  return rays_in(pattern, window_of_box(low, high));
}

VANTAGE_TARGET_CLONES
AngleWindow angles_of_box(const Vec3& low, const Vec3& high) { return window_of_box(low, high); }

// Works as rays_of_box() for boxes that neither surround the axis nor cross the seam, on even rows; branch-free.
VANTAGE_TARGET_CLONES
void rays_of_boxes(const RayPattern& pattern, BoxBatch& boxes) {
  constexpr double kTurn = 2 * std::numbers::pi;
  const double rows = pattern.rows(), columns = pattern.columns();
  const double first_zenith = pattern.first_zenith, zenith_step = pattern.zenith_step;
  const double first_azimuth = pattern.first_azimuth, azimuth_step = pattern.azimuth_step;
  const auto clamped = [](double index, double count) {
    return static_cast<std::int32_t>(std::min(count, std::max(0.0, index)));
  };
  const std::uint32_t n = boxes.size;
  if (!pattern.zeniths.empty()) {  // rows that must be searched, box by box
    std::fill_n(boxes.simple, n, 0);
    return;
  }
  for (std::uint32_t i = 0; i < n; ++i) {
    const double cx = boxes.x[i], cy = boxes.y[i], cz = boxes.z[i];
    const double hx = boxes.half_x[i], hy = boxes.half_y[i], hz = boxes.half_z[i];
    const double ax = std::abs(cx), ay = std::abs(cy), az = std::abs(cz);
    const double along = ax * hx + ay * hy, across = ay * hx + ax * hy;
    const double square = cx * cx + cy * cy, gap = square - along;
    const double r = std::sqrt(square), radial = (along + across) / r;
    const double distance = std::sqrt(square + cz * cz);
    const double depth = distance - (r * radial + az * hz) / distance;
    const double rise = (az * radial + r * hz) / distance;
    const double zenith = fast_atan2(r, cz), tall = rise / depth + kAnglePad;
    const double side = fast_atan2(ay, cx), wide = across / gap + kAnglePad;
    const double from = (cy < 0 ? -1.0 : 1.0) * side - wide - first_azimuth;
    const double begin = from - std::floor(from / kTurn) * kTurn;
    const double end = begin + 2 * wide;
    boxes.simple[i] = std::min(std::min(gap, depth), kTurn - end) > 0 ? 1 : 0;
    boxes.row_begin[i] = clamped(std::ceil((zenith - tall - first_zenith) / zenith_step), rows);
    boxes.row_end[i] = clamped(std::floor((zenith + tall - first_zenith) / zenith_step) + 1, rows);
    boxes.column_begin[i] = clamped(std::ceil(begin / azimuth_step), columns);
    boxes.column_end[i] = clamped(std::floor(end / azimuth_step) + 1, columns);
  }
}

}  // namespace vantage
