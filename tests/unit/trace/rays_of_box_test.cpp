// SPDX-License-Identifier: Apache-2.0
#include "trace/rays_of_box.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "trace_scenes.hpp"

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
  const Scanner scanners[] = {scanner_of(360, 300, 1.0, 0), scanner_of(360, 360, 0.7, 123),
                              scanner_of(200, 180, 0.9, -170), scanner_of(33, 90, 0.5, 90)};
  for (const Scanner& scanner : scanners) {
    const RayPattern pattern = make_pattern(scanner);
    std::uint64_t listed = 0, crossing = 0;
    for (int k = 0; k < 120; ++k) {
      SCOPED_TRACE("box " + std::to_string(k));
      // Near and far, some around the vertical axis, some around the head itself, some across the seam.
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

}  // namespace
}  // namespace vantage
