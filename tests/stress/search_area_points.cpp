// SPDX-License-Identifier: Apache-2.0
#include "stress/search_area_points.hpp"

#include <algorithm>
#include <cmath>
#include <random>
#include <utility>

#include "vantage/placement.hpp"

namespace vantage::test {
namespace {

// Ground of columns × rows jittered cells over u in [0, width] and v in [0, 1], with 40 m per unit of v.
SearchMesh terrain(int columns, int rows, double width) {
  std::mt19937_64 rng(31);
  std::uniform_real_distribution<double> jitter(-0.3, 0.3);
  SearchMesh mesh;
  for (int j = 0; j <= rows; ++j) {
    for (int i = 0; i <= columns; ++i) {
      const bool inner = i > 0 && j > 0 && i < columns && j < rows;
      const double u = width * (i + (inner ? jitter(rng) : 0)) / columns, v = (j + (inner ? jitter(rng) : 0)) / rows;
      mesh.uvs.push_back({u, v});
      mesh.positions.push_back({40 * u, 40 * v, std::sin(3 * u) * std::cos(5 * v)});
    }
  }
  const auto at = [&](int i, int j) { return static_cast<std::uint32_t>(j * (columns + 1) + i); };
  for (int j = 0; j < rows; ++j) {
    for (int i = 0; i < columns; ++i) {
      mesh.triangles.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
      mesh.triangles.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
    }
  }
  return mesh;
}

double distance(const Vec3& a, const Vec3& b) { return std::sqrt(dot(a - b, a - b)); }

EdgePoints locate(std::string name, const SearchMesh& mesh, std::uint64_t points, bool on_bounds) {
  const SearchArea area = SearchArea::from_mesh(mesh);
  const Uv low = area.uv_min(), high = area.uv_max();
  std::mt19937_64 rng(37);
  std::uniform_real_distribution<double> unit(0, 1);
  EdgePoints result{std::move(name), 0, 0, 0, 0};
  const auto on_bound = [&](const Uv& p) { return p.u == low.u || p.u == high.u || p.v == low.v || p.v == high.v; };
  while (result.points < points) {
    const auto& t = mesh.triangles[rng() % mesh.triangles.size()];
    const std::size_t corner = rng() % 3;
    const std::uint32_t a = t[corner], b = t[(corner + 1) % 3];
    const Uv ua = mesh.uvs[a], ub = mesh.uvs[b];
    if (on_bounds && !(on_bound(ua) && on_bound(ub))) continue;
    const double x = rng() % 10 == 0 ? 0 : unit(rng);
    const Uv p{ua.u + x * (ub.u - ua.u), ua.v + x * (ub.v - ua.v)};
    ++result.points;
    const auto found = area.locate(p);
    if (!found) {
      ++result.lost;
      continue;
    }
    result.farthest_m =
        std::max(result.farthest_m, distance(*found, mesh.positions[a] * (1 - x) + mesh.positions[b] * x));
    for (const Uv q : {Uv{p.u + 1e-13, p.v}, Uv{p.u - 1e-13, p.v}, Uv{p.u, p.v + 1e-13}, Uv{p.u, p.v - 1e-13}}) {
      const auto beside = area.locate(q);
      result.lost += !beside;
      if (beside) result.jump_m = std::max(result.jump_m, distance(*found, *beside));
    }
  }
  return result;
}

}  // namespace

std::vector<EdgePoints> locate_edge_points(std::uint64_t points) {
  return {locate("terrain of 6000 triangles", terrain(60, 50, 1.15), points, false),
          locate("slivers 1 : 10⁶", terrain(40, 5, 8e-6), points, false),
          locate("slivers 1 : 10⁹", terrain(3, 3, 1e-9), points, false),
          locate("bounds of the terrain", terrain(60, 50, 1.15), points, true)};
}

}  // namespace vantage::test
