// SPDX-License-Identifier: Apache-2.0
#include "map/relief.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "core/parallel.hpp"

namespace vantage {
namespace {

constexpr std::uint32_t kNothing = 0xFFFFFFFFu;
// Steeper surfaces have no area in plan view; they are drawn as lines, so that walls without thickness do not vanish.
constexpr double kSteep = 0.1;
// Width of such a line in pixels of the buffer: big walls stand out, small parts keep their shape.
constexpr double kWidest = 14;
double line_width(double length) { return std::clamp(0.15 * length, 3.0, kWidest); }

class Painter {
 public:
  Painter(HeightBuffer& target, double z_cut, std::span<const float> cuts, const RowBand& band)
      : target_(target), z_cut_(z_cut), cuts_(cuts), band_(band) {}

  // True if anything of a triangle, or of a line along it, may lie in the band.
  bool reaches(const std::array<MapPoint, 3>& c) const {
    const auto [left, right] = std::minmax({c[0].x, c[1].x, c[2].x});
    const auto [low, high] = std::minmax({c[0].y, c[1].y, c[2].y});
    const double beside = line_width(std::max(right - left, high - low)) / 2 + 1;
    return high + beside >= static_cast<double>(band_.first) && low - beside <= static_cast<double>(band_.end);
  }

  void triangle(const std::array<MapPoint, 3>& c, const std::array<double, 3>& z, std::uint32_t id) {
    for_each_pixel(
        target_.window, c,
        [&](std::size_t pixel, const std::array<double, 3>& weights) {
          put(pixel, weights[0] * z[0] + weights[1] * z[1] + weights[2] * z[2], id);
        },
        band_);
  }

  void line(const MapPoint& a, const MapPoint& b, double z_a, double z_b, std::uint32_t id) {
    const double dx = b.x - a.x, dy = b.y - a.y, length = std::max(std::abs(dx), std::abs(dy));
    const double half = line_width(length) / 2;
    const int steps = static_cast<int>(std::ceil(length)) + 1;
    for (int s = 0; s <= steps; ++s) {
      const double t = static_cast<double>(s) / steps, x = a.x + t * dx, y = a.y + t * dy;
      const auto [x0, x1] = pixels_between(x - half, x + half, target_.window.columns);
      const auto [y0, y1] = pixels_between(y - half, y + half, target_.window.rows);
      for (std::size_t j = std::max(y0, band_.first); j < std::min(y1, band_.end); ++j)
        for (std::size_t i = x0; i < x1; ++i) put(j * target_.window.columns + i, z_a + t * (z_b - z_a), id);
    }
  }

 private:
  void put(std::size_t k, double z, std::uint32_t id) {
    if (z > z_cut_ && (cuts_.empty() || z > cuts_[k])) return;
    if (static_cast<float>(z) <= target_.z[k]) return;
    target_.z[k] = static_cast<float>(z), target_.triangle[k] = id;
  }

  HeightBuffer& target_;
  double z_cut_;  // local frame
  std::span<const float> cuts_;
  RowBand band_;
};

// Unit normal, upwards.
std::array<double, 3> normal_of(const std::array<Float3, 3>& p) {
  const double ax = double{p[1].x} - p[0].x, ay = double{p[1].y} - p[0].y, az = double{p[1].z} - p[0].z;
  const double bx = double{p[2].x} - p[0].x, by = double{p[2].y} - p[0].y, bz = double{p[2].z} - p[0].z;
  std::array<double, 3> n{ay * bz - az * by, az * bx - ax * bz, ax * by - ay * bx};
  const double length = std::hypot(n[0], n[1], n[2]);
  const double sign = n[2] < 0 ? -1 : 1;
  for (double& c : n) c = length > 0 ? sign * c / length : 0;
  return n;
}

// Mean of z over a square of 2r + 1 pixels, by running sums of columns and rows; `floor` replaces empty pixels.
std::vector<float> box_mean(const HeightBuffer& heights, std::size_t r, float floor) {
  const std::size_t w = heights.window.columns, h = heights.window.rows;
  const std::size_t band = std::max(std::size_t{256}, 4 * r);  // rows that one task goes down
  std::vector<float> mean(w * h);
  parallel::for_all(std::size_t{0}, (h + band - 1) / band, [&](std::size_t task) {
    std::vector<double> columns(w, 0.0);  // of the rows from `first` to `end`
    const auto add = [&](std::size_t row, double times) {
      const float* const z = heights.z.data() + row * w;
      for (std::size_t x = 0; x < w; ++x) columns[x] += times * std::max(z[x], floor);
    };
    std::size_t first = task * band > r ? task * band - r : 0, end = first;
    for (std::size_t y = task * band; y < std::min(h, (task + 1) * band); ++y) {
      while (end < std::min(h, y + r + 1)) add(end++, 1);
      while (first + r < y) add(first++, -1);
      double sum = 0;
      for (std::size_t x = 0; x < std::min(w, r); ++x) sum += columns[x];
      for (std::size_t x = 0; x < w; ++x) {
        if (x + r < w) sum += columns[x + r];
        if (x > r) sum -= columns[x - r - 1];
        const std::size_t count = (end - first) * (std::min(w, x + r + 1) - (x > r ? x - r : 0));
        mean[y * w + x] = static_cast<float>(sum / static_cast<double>(count));
      }
    }
  });
  return mean;
}

}  // namespace

namespace {

constexpr std::uint32_t kBlock = 1024;  // triangles that follow each other, mostly of one mesh

// The least and the largest row that each block of triangles touches, lines along them included.
std::vector<std::pair<double, double>> rows_of_blocks(const SceneData& scene, const MapWindow& window,
                                                      std::uint32_t triangles) {
  std::vector<std::pair<double, double>> rows((triangles + kBlock - 1) / kBlock);
  parallel::for_all(std::size_t{0}, rows.size(), [&](std::size_t block) {
    double low = std::numeric_limits<double>::infinity(), high = -low;
    const auto first = static_cast<std::uint32_t>(block) * kBlock;
    for (std::uint32_t t = first; t < std::min(first + kBlock, triangles); ++t)
      for (const Float3& corner : scene.corners(t)) {
        const double y = window.at(scene.origin + widen(corner)).y;
        low = std::min(low, y), high = std::max(high, y);
      }
    rows[block] = {low - kWidest / 2 - 1, high + kWidest / 2 + 1};
  });
  return rows;
}

}  // namespace

HeightBuffer look_from_above(const SceneData& scene, const MapWindow& window, double z_cut,
                             std::span<const float> cuts) {
  HeightBuffer heights{window, {}, {}};
  heights.z.assign(window.columns * window.rows, -std::numeric_limits<float>::infinity());
  heights.triangle.assign(window.columns * window.rows, kNothing);
  const std::uint32_t opaque = scene.opaque_count();  // the search goes on below a glass roof
  std::vector<std::pair<double, double>> rows;
  if (!scene.shares()) rows = rows_of_blocks(scene, window, opaque);
  for_row_bands(window, [&](const RowBand& band) {
    Painter painter(heights, z_cut - scene.origin.z, cuts, band);
    const auto paint = [&](std::uint32_t first, std::uint32_t count) {
      for (std::uint32_t t = first; t < first + count; ++t) {
        std::array<MapPoint, 3> c;
        std::array<double, 3> z;
        const auto p = scene.corners(t);
        for (std::size_t k = 0; k < 3; ++k) {
          c[k] = window.at(scene.origin + widen(p[k]));
          z[k] = p[k].z;
        }
        if (!painter.reaches(c)) continue;
        painter.triangle(c, z, t);
        // Parts in the cutting plane are drawn as its section.
        const bool below = z_cut - scene.origin.z >= std::max({z[0], z[1], z[2]});
        if (below && normal_of(p)[2] < kSteep)
          for (std::size_t k = 0; k < 3; ++k) painter.line(c[k], c[(k + 1) % 3], z[k], z[(k + 1) % 3], t);
      }
    };
    for (std::uint32_t block = 0; block < rows.size(); ++block)
      if (rows[block].second >= static_cast<double>(band.first) && rows[block].first <= static_cast<double>(band.end))
        paint(block * kBlock, std::min(kBlock, opaque - block * kBlock));
    for (const MeshInstance& run : scene.instances) {
      if (run.first_triangle >= opaque) break;
      const MapPoint low = window.at(scene.origin + run.bounds.min), high = window.at(scene.origin + run.bounds.max);
      if (run.bounds.empty() || painter.reaches({low, high, high})) paint(run.first_triangle, run.triangle_count);
    }
  });
  return heights;
}

std::vector<std::uint32_t> shade(const SceneData& scene, const HeightBuffer& heights) {
  const std::size_t w = heights.window.columns, h = heights.window.rows;
  float low = std::numeric_limits<float>::max(), high = std::numeric_limits<float>::lowest();
  for (const float z : heights.z)
    if (std::isfinite(z)) low = std::min(low, z), high = std::max(high, z);
  std::vector<std::uint32_t> pixels(w * h, 0);
  if (low > high) return pixels;

  // Two scales of "lower than the surroundings": pipes among each other, and tanks above the ground.
  const double extent = static_cast<double>(std::max(w, h));
  const auto near = box_mean(heights, static_cast<std::size_t>(extent * 0.004) + 1, low);
  const auto far = box_mean(heights, static_cast<std::size_t>(extent * 0.02) + 1, low);
  const double near_scale = extent * 0.010 * heights.window.pixel_m,
               far_scale = extent * 0.045 * heights.window.pixel_m;
  constexpr double kLight[3] = {-0.5, 0.5, 0.7071067811865476};  // from the north-west, 45° high

  parallel::for_all(std::size_t{0}, h, [&](std::size_t y) {
    std::uint32_t last = kNothing;  // one triangle has many pixels side by side
    double facing = 0;
    Colour base;
    for (std::size_t x = 0; x < w; ++x) {
      const std::size_t k = y * w + x;
      const std::uint32_t t = heights.triangle[k];
      if (t == kNothing) continue;
      if (t != last) {
        const auto n = normal_of(scene.corners(t));
        const double lit = std::max(0.0, n[0] * kLight[0] + n[1] * kLight[1] + n[2] * kLight[2]);
        facing = n[2] < kSteep ? 0.62 : 0.58 + 0.52 * lit;
        const bool surveyed = scene.meshes[scene.mesh_of(t)].role == Role::surveyed;
        base = surveyed ? kSurveyedTint : kBlockingTint;
        last = t;
      }
      double light = facing;
      light *= 1 - 0.38 * std::clamp((double{near[k]} - heights.z[k]) / near_scale, 0.0, 1.0);
      light *= 1 - 0.38 * std::clamp((double{far[k]} - heights.z[k]) / far_scale, 0.0, 1.0);
      const auto c = to_bytes({base.r * light, base.g * light, base.b * light});
      pixels[k] = 0xFF000000u | std::uint32_t{c[0]} << 16 | std::uint32_t{c[1]} << 8 | c[2];
    }
  });
  return pixels;
}

std::vector<std::uint32_t> halve(const std::vector<std::uint32_t>& pixels, std::size_t columns) {
  const std::size_t w = columns / 2, h = pixels.size() / columns / 2;
  std::vector<std::uint32_t> half(w * h);
  parallel::for_all(std::size_t{0}, h, [&](std::size_t y) {
    for (std::size_t x = 0; x < w; ++x) {
      std::uint32_t mean = 0;
      for (int shift = 0; shift < 32; shift += 8) {
        std::uint32_t sum = 2;
        for (const std::size_t k : {2 * y * columns + 2 * x, 2 * y * columns + 2 * x + 1, (2 * y + 1) * columns + 2 * x,
                                    (2 * y + 1) * columns + 2 * x + 1})
          sum += pixels[k] >> shift & 255u;
        mean |= sum / 4 << shift;
      }
      half[y * w + x] = mean;
    }
  });
  return half;
}

std::uint32_t laid_over(std::uint32_t pixel, const Colour& colour, double opacity) {
  const auto bytes = to_bytes(colour);
  const std::uint32_t paper = 255 - (pixel >> 24);
  std::uint32_t mixed = 0xFF000000u;
  for (int k = 0; k < 3; ++k) {
    const int shift = 16 - 8 * k;
    const double below = (pixel >> shift & 255u) + paper;
    mixed |= static_cast<std::uint32_t>(std::lround(below + opacity * (bytes[static_cast<std::size_t>(k)] - below)))
             << shift;
  }
  return mixed;
}

}  // namespace vantage
