// SPDX-License-Identifier: Apache-2.0
#include "trace/rays_of_box.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>

#include "support/trace_scenes.hpp"

namespace vantage {
namespace {

bool crosses(const Vec3& d, const Vec3& low, const Vec3& high) {
  double first = 0, last = std::numeric_limits<double>::infinity();
  const auto clip = [&](double c, double a, double b) {
    if (c == 0) {
      if (a > 0 || b < 0) last = -1;
      return;
    }
    first = std::max(first, std::min(a / c, b / c));
    last = std::min(last, std::max(a / c, b / c));
  };
  clip(d.x, low.x, high.x);
  clip(d.y, low.y, high.y);
  clip(d.z, low.z, high.z);
  return first <= last;
}

Scanner scanner_of(double horizontal, double vertical, double step, double heading) {
  Scanner scanner;
  scanner.horizontal_angle = Angle::degrees(horizontal);
  scanner.vertical_angle = Angle::degrees(vertical);
  scanner.azimuth_step = Angle::degrees(step);
  scanner.zenith_step = Angle::degrees(step * 1.3);
  scanner.heading = Angle::degrees(heading);
  return scanner;
}

bool holds(const RayRanges& ranges, std::uint32_t row, std::uint32_t column) {
  const auto in = [](const RayRanges::Range& r, std::uint32_t k) { return k >= r.begin && k < r.end; };
  return in(ranges.rows, row) && (in(ranges.columns[0], column) || in(ranges.columns[1], column));
}

TEST(RaysOfBox, NoCrossingRayIsLeftOut) {
  RandomStream random(42);
  Scanner uneven = scanner_of(340, 300, 0.8, 40);
  std::vector<Angle> zeniths;
  for (double zenith = 0.5; zenith < 180; zenith += 0.1 + 2.5 * random.uniform())
    zeniths.push_back(Angle::degrees(zenith));
  uneven.set_row_zeniths(zeniths);
  const Scanner scanners[] = {scanner_of(360, 300, 1.0, 0), scanner_of(360, 360, 0.7, 123),
                              scanner_of(200, 180, 0.9, -170), scanner_of(33, 90, 0.5, 90), uneven};
  for (const Scanner& scanner : scanners) {
    const RayPattern pattern = make_pattern(scanner);
    std::uint64_t listed = 0, crossing = 0;
    for (int k = 0; k < 120; ++k) {
      SCOPED_TRACE("box " + std::to_string(k));
      // Boxes near and far, some around the vertical axis, some around the head, some across the seam.
      const double size = std::pow(10.0, -2.5 + 2.5 * random.uniform());
      Vec3 centre{4 * random.uniform() - 2, 4 * random.uniform() - 2, 4 * random.uniform() - 2};
      if (k % 5 == 1) centre.x = centre.y = size * (random.uniform() - 0.5) * 2.2;
      if (k % 5 == 2)
        centre = Vec3{random.uniform() - 0.5, random.uniform() - 0.5, random.uniform() - 0.5} * (1.5 * size);
      if (k % 5 == 3) centre.y = size * (random.uniform() - 0.5);
      const Vec3 half = Vec3{0.3 + random.uniform(), 0.3 + random.uniform(), 0.3 + random.uniform()} * (size / 2);
      const RayRanges ranges = rays_of_box(pattern, centre - half, centre + half);
      ASSERT_LE(ranges.rows.end, pattern.rows());
      for (const auto& columns : ranges.columns) ASSERT_LE(columns.end, pattern.columns());
      if (!ranges.columns[1].empty()) {
        ASSERT_LE(ranges.columns[1].end, ranges.columns[0].empty() ? pattern.columns() : ranges.columns[0].begin)
            << "a ray is listed twice";
      }
      for (std::uint32_t i = 0; i < pattern.rows(); ++i) {
        for (std::uint32_t j = 0; j < pattern.columns(); ++j) {
          const Vec3 d{pattern.sin_zenith[i] * pattern.cos_azimuth[j], pattern.sin_zenith[i] * pattern.sin_azimuth[j],
                       pattern.cos_zenith[i]};
          const bool crossed = crosses(d, centre - half, centre + half), held = holds(ranges, i, j);
          ASSERT_TRUE(held || !crossed) << "ray " << i << ", " << j;
          crossing += crossed;
          listed += held;
        }
      }
    }
    EXPECT_GT(crossing, 0u);
    EXPECT_LT(listed, 6 * crossing + 2000) << "bounds are loose";
  }
}

TEST(RaysOfBoxes, SayWhatOneBoxAloneSays) {
  RandomStream random(7);
  const auto boxes = std::make_unique<BoxBatch>();
  const Scanner scanners[] = {scanner_of(360, 300, 1.0, 0), scanner_of(360, 360, 0.07, 123),
                              scanner_of(200, 180, 0.9, -170)};
  for (const Scanner& scanner : scanners) {
    const RayPattern pattern = make_pattern(scanner);
    boxes->size = BoxBatch::kCapacity - 3;
    for (std::uint32_t i = 0; i < boxes->size; ++i) {
      const double size = std::pow(10.0, -3 + 3 * random.uniform()), reach = i % 4 == 0 ? size : 2;
      boxes->x[i] = reach * (2 * random.uniform() - 1);
      boxes->y[i] = reach * (2 * random.uniform() - 1);
      boxes->z[i] = i % 8 == 0 ? 0 : reach * (2 * random.uniform() - 1);
      boxes->half_x[i] = size * random.uniform();
      boxes->half_y[i] = i % 3 == 0 ? 0 : size * random.uniform();
      boxes->half_z[i] = size * random.uniform();
    }
    boxes->x[0] = boxes->y[0] = boxes->z[0] = 0;
    rays_of_boxes(pattern, *boxes);
    std::uint32_t simple = 0;
    for (std::uint32_t i = 0; i < boxes->size; ++i) {
      SCOPED_TRACE("box " + std::to_string(i));
      if (!boxes->simple[i]) continue;
      ++simple;
      const Vec3 centre{boxes->x[i], boxes->y[i], boxes->z[i]},
          half{boxes->half_x[i], boxes->half_y[i], boxes->half_z[i]};
      const RayRanges alone = rays_of_box(pattern, centre - half, centre + half);
      EXPECT_TRUE(alone.columns[1].empty());
      const bool empty = boxes->row_begin[i] >= boxes->row_end[i] || boxes->column_begin[i] >= boxes->column_end[i];
      ASSERT_EQ(empty, alone.empty());
      if (empty) continue;
      // Corners round differently, so a ray at the very edge may be in one and not in the other.
      EXPECT_NEAR(boxes->row_begin[i], alone.rows.begin, 1);
      EXPECT_NEAR(boxes->row_end[i], alone.rows.end, 1);
      EXPECT_NEAR(boxes->column_begin[i], alone.columns[0].begin, 1);
      EXPECT_NEAR(boxes->column_end[i], alone.columns[0].end, 1);
    }
    EXPECT_GT(simple, boxes->size / 2);
    EXPECT_LT(simple, boxes->size);
    EXPECT_FALSE(boxes->simple[0]);
  }
}

}  // namespace
}  // namespace vantage
