// SPDX-License-Identifier: Apache-2.0
// Shaded relief of a site in plan view.
#pragma once

#include <tbb/task_arena.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <utility>
#include <vector>

#include "core/parallel.hpp"
#include "map/colour.hpp"
#include "scene/scene_data.hpp"

namespace vantage {

inline constexpr Colour kSurveyedTint{0.93, 0.78, 0.52}, kBlockingTint{0.87, 0.88, 0.89};

// A window of the survey frame's x-y plane, cut into square pixels; row 0 is the northernmost (largest y).
struct MapPoint {
  double x = 0, y = 0;  // in pixels from the north-western corner
};
struct MapWindow {
  double x_min = 0, y_max = 0;
  double pixel_m = 1;
  std::size_t columns = 0, rows = 0;

  MapPoint at(const Vec3& p) const { return {(p.x - x_min) / pixel_m, (y_max - p.y) / pixel_m}; }
};

// Pixels of an axis with `size` pixels whose centres lie between low and high.
inline std::pair<std::size_t, std::size_t> pixels_between(double low, double high, std::size_t size) {
  const double first = std::clamp(std::ceil(low - 0.5), 0.0, static_cast<double>(size));
  const double past = std::clamp(std::floor(high - 0.5) + 1, first, static_cast<double>(size));
  return {static_cast<std::size_t>(first), static_cast<std::size_t>(past)};
}

// Rows of a window from `first` on, without `end`: what one thread paints.
struct RowBand {
  std::size_t first = 0, end = std::numeric_limits<std::size_t>::max();
};
// Calls paint(band) for bands that share the rows of a window among all threads.
template <class Paint>
void for_row_bands(const MapWindow& window, const Paint& paint) {
  const auto bands = std::min(static_cast<std::size_t>(tbb::this_task_arena::max_concurrency()), window.rows);
  parallel::for_all(std::size_t{0}, bands, [&](std::size_t k) {
    paint(RowBand{window.rows * k / bands, window.rows * (k + 1) / bands});
  });
}

// About the least and the largest x at which a triangle's sides cross the row through y.
inline std::pair<double, double> row_within(const std::array<MapPoint, 3>& c, double y) {
  double low = std::numeric_limits<double>::infinity(), high = -low;
  for (std::size_t k = 0; k < 3; ++k) {
    const MapPoint &from = c[k], &to = c[(k + 1) % 3];
    if (y < std::min(from.y, to.y) || y > std::max(from.y, to.y)) continue;
    const double share = from.y == to.y ? 0 : (y - from.y) / (to.y - from.y), x = from.x + share * (to.x - from.x);
    low = std::min({low, x, from.y == to.y ? to.x : x}), high = std::max({high, x, from.y == to.y ? to.x : x});
  }
  return {low, high};
}

// Calls put(pixel, weights of the corners) for each pixel of the band whose centre lies in the triangle.
template <class Put>
void for_each_pixel(const MapWindow& window, const std::array<MapPoint, 3>& c, Put&& put, const RowBand& band = {}) {
  const double area = (c[1].x - c[0].x) * (c[2].y - c[0].y) - (c[2].x - c[0].x) * (c[1].y - c[0].y);
  if (area == 0) return;
  const auto [x0, x1] =
      pixels_between(std::min({c[0].x, c[1].x, c[2].x}), std::max({c[0].x, c[1].x, c[2].x}), window.columns);
  const auto [y0, y1] =
      pixels_between(std::min({c[0].y, c[1].y, c[2].y}), std::max({c[0].y, c[1].y, c[2].y}), window.rows);
  for (std::size_t y = std::max(y0, band.first); y < std::min(y1, band.end); ++y) {
    const double py = static_cast<double>(y) + 0.5;
    const auto [low, high] = row_within(c, py);
    // A pixel more on both sides, since the weights decide.
    const auto [first, end] = pixels_between(low - 1, high + 1, window.columns);
    for (std::size_t x = std::max(x0, first); x < std::min(x1, end); ++x) {
      const double px = static_cast<double>(x) + 0.5;
      const double a = ((c[1].x - px) * (c[2].y - py) - (c[2].x - px) * (c[1].y - py)) / area;
      const double b = ((c[2].x - px) * (c[0].y - py) - (c[0].x - px) * (c[2].y - py)) / area;
      if (a >= 0 && b >= 0 && a + b <= 1) put(y * window.columns + x, std::array{a, b, 1 - a - b});
    }
  }
}

// The topmost surface below `z_cut` (survey frame) under each pixel's centre; with `cuts` (local frame, one a pixel),
// below the higher of both. Steep surfaces cover no area and are lines along their edges, except those that the cut
// crosses, which section.hpp draws.
struct HeightBuffer {
  MapWindow window;
  std::vector<float> z;                 // local frame; −infinity in empty pixels
  std::vector<std::uint32_t> triangle;  // of the scene; 2^32 − 1 in empty pixels
};

// Cells along the longer side of the ground, where its parts are told apart.
inline constexpr std::size_t kAcross = 400;
// Ground lower than this below the topmost surface does not show.
inline constexpr double kHidden_m = 0.3;

HeightBuffer look_from_above(const SceneData& scene, const MapWindow& window, double z_cut,
                             std::span<const float> cuts = {});

// Shaded relief, light from the north-west, surveyed meshes tinted. 0xAARRGGBB, premultiplied; empty pixels are
// transparent.
std::vector<std::uint32_t> shade(const SceneData& scene, const HeightBuffer& heights);

// A colour over an opaque pixel, or over white paper.
std::uint32_t laid_over(std::uint32_t pixel, const Colour& colour, double opacity);

// Halves both sides by averaging two by two pixels. REQUIRES: even numbers of columns and rows.
std::vector<std::uint32_t> halve(const std::vector<std::uint32_t>& pixels, std::size_t columns);

// Calls put(pixel, z) for each pixel of the band whose centre lies in triangle `t` of a mesh; z is `from` plus the
// triangle's height there.
template <class Mesh, class Put>
void for_each_pixel(const MapWindow& window, const Mesh& mesh, const std::array<std::uint32_t, 3>& t, double from,
                    Put&& put, const RowBand& band = {}) {
  std::array<MapPoint, 3> c;
  for (std::size_t k = 0; k < 3; ++k) c[k] = window.at(mesh.positions[t[k]]);
  for_each_pixel(
      window, c,
      [&](std::size_t pixel, const std::array<double, 3>& weights) {
        double z = from;
        for (std::size_t k = 0; k < 3; ++k) z += weights[k] * mesh.positions[t[k]].z;
        put(pixel, z);
      },
      band);
}

}  // namespace vantage
