// SPDX-License-Identifier: Apache-2.0
#include "generate/ground.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace vantage::built_in {
namespace {

constexpr int kCells = 25;  // coarse cells per side; those of the search area
constexpr double kSide = 40, kCell = kSide / kCells;
constexpr double kEmbankment = 2.3;
constexpr double kSlopeNorth = 10.4, kSlopeEast = 12.0,
                 kSlopeRun = 4.8;  // all on coarse lines, so that the breaks are sharp
constexpr double kPad = 8.8;       // flat and level within this distance, for the equipment

double line(int i) { return -kSide / 2 + kCell * i; }

// Height at a corner of the coarse grid.
double height(int i, int j) {
  const double x = line(i), y = line(j);
  const double rise = std::clamp(std::max((y - kSlopeNorth) / kSlopeRun, (x - kSlopeEast) / kSlopeRun), 0.0, 1.0);
  const bool pad = std::abs(x) < kPad + 1e-9 && std::abs(y) < kPad + 1e-9;
  const double bumps = pad ? 0 : 0.045 * std::sin(0.71 * x + 0.3) * std::cos(0.63 * y - 0.2);
  return kEmbankment * rise + bumps;
}

dvec3 ground_point(double x, double y) {  // bilinear within coarse cells
  const double fx = std::clamp((x + kSide / 2) / kCell, 0.0, static_cast<double>(kCells)),
               fy = std::clamp((y + kSide / 2) / kCell, 0.0, static_cast<double>(kCells));
  const int i = std::min(static_cast<int>(fx), kCells - 1), j = std::min(static_cast<int>(fy), kCells - 1);
  const double s = fx - i, t = fy - j;
  const double z = (1 - t) * ((1 - s) * height(i, j) + s * height(i + 1, j)) +
                   t * ((1 - s) * height(i, j + 1) + s * height(i + 1, j + 1));
  return {x, y, z};
}

// Grid lines along one side: every coarse line, and `cells` cells in all, spread evenly over the coarse ones.
std::vector<double> grid_lines(int cells) {
  std::vector<double> lines{line(0)};
  for (int i = 0; i < kCells; ++i) {
    const int parts =
        static_cast<int>(static_cast<long long>(cells) * (i + 1) / kCells - static_cast<long long>(cells) * i / kCells);
    for (int k = 1; k <= parts; ++k) lines.push_back(k == parts ? line(i + 1) : line(i) + kCell * k / parts);
  }
  return lines;
}

// A height field over two sets of grid lines, with its own smooth normals.
Mesh height_field(const std::vector<double>& xs, const std::vector<double>& ys) {
  Mesh mesh;
  const auto width = static_cast<std::uint32_t>(xs.size());
  std::vector<dvec3> points, normals(xs.size() * ys.size());
  for (const double y : ys)
    for (const double x : xs) points.push_back(ground_point(x, y));
  const auto add = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    mesh.indices.insert(mesh.indices.end(), {a, b, c});
    const dvec3 normal = cross(points[b] - points[a], points[c] - points[a]);
    for (const std::uint32_t v : {a, b, c}) normals[v] = normals[v] + normal;
  };
  for (std::uint32_t j = 0; j + 1 < ys.size(); ++j)
    for (std::uint32_t i = 0; i + 1 < width; ++i) {
      const std::uint32_t a = j * width + i, b = a + 1, c = a + width, d = c + 1;
      add(a, b, d);
      add(a, d, c);
    }
  for (std::size_t v = 0; v < points.size(); ++v) {
    mesh.positions.push_back(to_float3(points[v]));
    mesh.normals.push_back(to_float3(normalize(normals[v])));
  }
  return mesh;
}

double area(const Mesh& mesh) {
  double sum = 0;
  const auto point = [&](std::uint32_t v) { return to_glm(mesh.positions[v]); };
  for (std::size_t t = 0; t < mesh.indices.size(); t += 3) {
    const dvec3 a = point(mesh.indices[t]), n = cross(point(mesh.indices[t + 1]) - a, point(mesh.indices[t + 2]) - a);
    sum += 0.5 * glm::length(n);
  }
  return sum;
}

}  // namespace

Mesh ground_mesh(std::size_t triangles) {
  // columns × rows × 2 nearest to the wish, with cells as square as possible
  const double wish = static_cast<double>(triangles) / 2;
  const int square = std::max(kCells, static_cast<int>(std::sqrt(wish)));
  int columns = square, rows = square;
  double best = 1e300;
  for (int x = square; x <= square + std::min(square / 8 + 8, 200); ++x) {
    const int y = std::max(kCells, static_cast<int>(std::lround(wish / x)));
    const double miss = std::abs(static_cast<double>(x) * y - wish);
    if (miss < best) {
      best = miss;
      columns = x;
      rows = y;
    }
  }
  return height_field(grid_lines(columns), grid_lines(rows));
}

Mesh search_mesh(const std::vector<DeckChart>& decks) {
  Mesh mesh = height_field(grid_lines(kCells), grid_lines(kCells));
  const double scale = 1 / std::sqrt(area(mesh));
  for (const Float3& p : mesh.positions)
    mesh.uvs.push_back({static_cast<float>((static_cast<double>(p.x) + kSide / 2) / kSide),
                        static_cast<float>((static_cast<double>(p.y) + kSide / 2) / kSide)});
  for (const DeckChart& chart : decks) {
    const std::size_t first = mesh.positions.size();
    const Deck& d = chart.deck;
    add_rectangle(mesh, {d.x0, d.y0, d.z}, {d.x1 - d.x0, 0, 0}, {0, d.y1 - d.y0, 0}, chart.columns, chart.rows);
    for (std::size_t v = first; v < mesh.positions.size(); ++v)
      mesh.uvs.push_back({static_cast<float>(chart.u + (static_cast<double>(mesh.positions[v].x) - d.x0) * scale),
                          static_cast<float>(chart.v + (static_cast<double>(mesh.positions[v].y) - d.y0) * scale)});
  }
  return mesh;
}

}  // namespace vantage::built_in
