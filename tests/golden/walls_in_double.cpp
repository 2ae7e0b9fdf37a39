// SPDX-License-Identifier: Apache-2.0
#include "golden/walls_in_double.hpp"

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

namespace vantage::test {
namespace {

constexpr double pi = 3.14159265358979323846;
constexpr double user_size = 0.01, spacing = 0.006, diffuse = 0.1, head = 1.5, wide = 5, high = 2.5;

// Table 1 at the diffuse coefficients that a wall of 0.1 shows: between its rows of 8 % and 21 %, and along the first
// row below it.
double sigma(double distance, double reflectivity) {
  constexpr std::array<double, 5> distances{5, 10, 20, 40, 60}, black{0.5, 0.6, 0.7, 2.5, 5.0},
      grey{0.4, 0.5, 0.6, 0.8, 2.0};
  std::size_t i = 0;
  while (i < 3 && distance > distances[i + 1]) ++i;
  const double along = (distance - distances[i]) / (distances[i + 1] - distances[i]);
  const double row = (reflectivity - 0.08) / (0.21 - 0.08);
  const auto at = [&](const std::array<double, 5>& values) { return values[i] + along * (values[i + 1] - values[i]); };
  return std::max(0.0, at(black) + row * (at(grey) - at(black))) * 1e-3;
}

// A wall's voxels: one layer in x, and an interval in y and in z.
struct Wall {
  double x, y_low;
  std::int64_t layer = 0, first_y = 0, first_z = 0, columns = 0, rows = 0;
  std::array<std::vector<std::uint32_t>, 2> count = {};  // without noise, with noise
  std::uint64_t points = 0;
  std::array<std::uint64_t, 2> on_surface{};
};

}  // namespace

WallCounts count_walls_in_double(const WallCase& where) {
  WallCounts result;
  const double step = where.step;
  std::array<Wall, 3> walls{
      {{10, -wide / 2}, {where.far, where.aside - wide / 2}, {where.far, -where.aside - wide / 2}}};

  // Equation 2: a cube 1.002 times the largest extent, around the middle of the walls.
  double side = 1.002 * (2 * where.aside + wide), voxel = side;
  while (voxel > user_size) voxel /= 2;
  if (where.voxel_size > 0) side *= where.voxel_size / voxel, voxel = where.voxel_size;
  const std::array<double, 3> middle{(10 + where.far) / 2, 0, high / 2};
  const auto cell = [&](double value, std::size_t axis) {
    return static_cast<std::int64_t>(std::floor((value - (middle[axis] - side / 2)) / voxel));
  };
  for (Wall& wall : walls) {
    wall.layer = cell(wall.x, 0);
    wall.first_y = cell(wall.y_low, 1), wall.columns = cell(wall.y_low + wide, 1) - wall.first_y + 1;
    wall.first_z = cell(0, 2), wall.rows = cell(high, 2) - wall.first_z + 1;
    for (auto& count : wall.count) count.resize(static_cast<std::size_t>(wall.columns * wall.rows));
    result.voxels += wall.count[0].size();
  }

  // Adds a point to the counts; returns whether it lies in a voxel of a wall.
  const auto add = [&](double x, double y, double z, std::size_t noisy) {
    for (Wall& wall : walls) {
      const std::int64_t column = cell(y, 1) - wall.first_y, row = cell(z, 2) - wall.first_z;
      if (cell(x, 0) != wall.layer || column < 0 || column >= wall.columns || row < 0 || row >= wall.rows) continue;
      ++wall.count[noisy][static_cast<std::size_t>(row * wall.columns + column)];
      return true;
    }
    return false;
  };
  std::mt19937_64 random(1);
  std::normal_distribution<double> normal;
  result.least_sigma = 1;
  struct Azimuth {
    double cosine, sine;
  };
  std::vector<Azimuth> ahead;  // columns that face the walls
  for (int j = 0; j < static_cast<int>(2 * pi / step); ++j) {
    const double azimuth = (j + 0.5) * step - pi;
    if (std::abs(azimuth) < pi / 2) ahead.push_back({std::cos(azimuth), std::sin(azimuth)});
  }
  for (int i = 0; i < static_cast<int>(150 * pi / 180 / step); ++i) {
    const double zenith = (i + 0.5) * step, sine = std::sin(zenith), cosine = std::cos(zenith);
    for (const Azimuth& azimuth : ahead) {
      const double dx = sine * azimuth.cosine, dy = sine * azimuth.sine;
      for (Wall& wall : walls) {  // nearest first
        const double t = wall.x / dx, y = t * dy, z = head + t * cosine;
        if (y < wall.y_low || y > wall.y_low + wide || z < 0 || z > high) continue;
        const double s = sigma(t, diffuse * dx), moved = t + s * normal(random);
        ++wall.points;
        wall.on_surface[0] += add(wall.x, y, z, 0);
        wall.on_surface[1] += add(moved * dx, moved * dy, head + moved * cosine, 1);
        result.least_sigma = std::min(result.least_sigma, s);
        result.most_sigma = std::max(result.most_sigma, s);
        break;
      }
    }
  }

  result.voxel_size = voxel;
  result.goal_density = voxel * voxel / (spacing * spacing);
  for (std::size_t noisy : {0, 1}) {
    WallCounts::Side& out = noisy ? result.noisy : result.clean;
    double sum = 0;
    for (std::size_t w = 0; w < walls.size(); ++w) {
      if (!noisy) result.points += walls[w].points;
      out.on_surface += walls[w].on_surface[noisy];
      out.lost[w] = 1 - static_cast<double>(walls[w].on_surface[noisy]) / static_cast<double>(walls[w].points);
      for (const std::uint32_t n : walls[w].count[noisy]) sum += std::min(n / result.goal_density, 1.0);
    }
    out.coverage = sum / static_cast<double>(result.voxels);
  }
  return result;
}

}  // namespace vantage::test
