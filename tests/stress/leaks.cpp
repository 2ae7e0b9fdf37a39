// SPDX-License-Identifier: Apache-2.0
#include "stress/leaks.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <random>
#include <set>
#include <stdexcept>
#include <utility>

#include "trace/tracer.hpp"

namespace vantage::test {
namespace {

using std::numbers::pi;
using Edge = std::pair<std::uint32_t, std::uint32_t>;

double length(const Vec3& v) { return std::sqrt(dot(v, v)); }

std::vector<Edge> edges_of(const std::vector<Triangle>& triangles) {
  std::map<Edge, int> uses;
  for (const Triangle& t : triangles)
    for (int k = 0; k < 3; ++k) ++uses[std::minmax(t[k], t[(k + 1) % 3])];
  std::vector<Edge> edges;
  for (const auto& [edge, count] : uses) {
    if (count != 2) throw std::logic_error("the mesh is not closed");
    edges.push_back(edge);
  }
  return edges;
}

// A uniformly random rotation, by a random unit quaternion.
struct Turn {
  Vec3 x, y, z;
  explicit Turn(std::mt19937_64& rng) {
    std::normal_distribution<double> normal;
    double q[4];
    for (double& c : q) c = normal(rng);
    const double n = std::sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
    const double a = q[0] / n, b = q[1] / n, c = q[2] / n, w = q[3] / n;
    x = {1 - 2 * (b * b + c * c), 2 * (a * b + w * c), 2 * (a * c - w * b)};
    y = {2 * (a * b - w * c), 1 - 2 * (a * a + c * c), 2 * (b * c + w * a)};
    z = {2 * (a * c + w * b), 2 * (b * c - w * a), 1 - 2 * (a * a + b * b)};
  }
  Vec3 operator()(const Vec3& p) const { return x * p.x + y * p.y + z * p.z; }
};

}  // namespace

ClosedMesh cube() {
  ClosedMesh mesh{"cube", {}, {}, 0.5};
  for (int i = 0; i < 8; ++i) mesh.positions.push_back({i & 1 ? 1.0 : -1.0, i & 2 ? 1.0 : -1.0, i & 4 ? 1.0 : -1.0});
  mesh.triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                    {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  return mesh;
}

ClosedMesh bumpy_sphere() {
  ClosedMesh mesh{"bumpy sphere", {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}}, {}, 0.05};
  mesh.triangles = {{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4}, {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}};
  for (int level = 0; level < 5; ++level) {
    std::map<Edge, std::uint32_t> middles;
    const auto middle = [&](std::uint32_t a, std::uint32_t b) {
      const auto [at, fresh] =
          middles.try_emplace(std::minmax(a, b), static_cast<std::uint32_t>(mesh.positions.size()));
      if (fresh) mesh.positions.push_back((mesh.positions[a] + mesh.positions[b]) * 0.5);
      return at->second;
    };
    std::vector<Triangle> finer;
    for (const auto& [a, b, c] : mesh.triangles) {
      const std::uint32_t ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
      for (const Triangle& t : {Triangle{a, ab, ca}, Triangle{ab, b, bc}, Triangle{ca, bc, c}, Triangle{ab, bc, ca}})
        finer.push_back(t);
    }
    mesh.triangles = std::move(finer);
  }
  for (Vec3& p : mesh.positions) {
    p = p * (1 / length(p));
    p = p * (1 + 0.08 * std::sin(5 * p.x + 1) * std::sin(6 * p.y) * std::cos(4 * p.z));
  }
  return mesh;
}

ClosedMesh sliver_prism() {
  // Points of the outline lie in eight clusters, 2e-6 m from one to the next.
  ClosedMesh mesh{"slivers 1 : 10⁶", {{0, 0, -1}, {0, 0, 1}}, {}, 0.3};
  constexpr std::uint32_t clusters = 8, in_cluster = 5, outline = clusters * in_cluster;
  for (std::uint32_t k = 0; k < outline; ++k) {
    const double angle = 2 * pi * (k / in_cluster) / clusters + 2e-6 * (k % in_cluster);
    for (const double z : {-1.0, 1.0}) mesh.positions.push_back({std::cos(angle), std::sin(angle), z});
  }
  for (std::uint32_t k = 0; k < outline; ++k) {
    const std::uint32_t low = 2 + 2 * k, high = low + 1, next_low = 2 + 2 * ((k + 1) % outline),
                        next_high = next_low + 1;
    mesh.triangles.push_back({0, next_low, low});
    mesh.triangles.push_back({1, high, next_high});
    mesh.triangles.push_back({low, next_low, high});
    mesh.triangles.push_back({next_low, next_high, high});
  }
  return mesh;
}

ClosedMesh shaft() {
  ClosedMesh mesh{"shaft 80 × 1 × 1 m", {}, {}, 0.3};
  constexpr std::uint32_t storeys = 80;
  const Vec3 corners[] = {{-0.5, -0.5, 0}, {0.5, -0.5, 0}, {0.5, 0.5, 0}, {-0.5, 0.5, 0}};
  for (std::uint32_t z = 0; z <= storeys; ++z)
    for (const Vec3& corner : corners) mesh.positions.push_back({corner.x, corner.y, z - 0.5 * storeys});
  for (std::uint32_t z = 0; z < storeys; ++z)
    for (std::uint32_t k = 0; k < 4; ++k) {
      const std::uint32_t low = 4 * z + k, next = 4 * z + (k + 1) % 4;
      mesh.triangles.push_back({low, next, next + 4});
      mesh.triangles.push_back({low, next + 4, low + 4});
    }
  constexpr std::uint32_t top = 4 * storeys;
  for (const Triangle& t :
       {Triangle{0, 2, 1}, Triangle{0, 3, 2}, Triangle{top, top + 1, top + 2}, Triangle{top, top + 2, top + 3}})
    mesh.triangles.push_back(t);
  return mesh;
}

std::vector<ClosedMesh> closed_meshes() { return {cube(), bumpy_sphere(), sliver_prism(), shaft()}; }

Leaks count_leaks(const EngineInfo& engine, const ClosedMesh& mesh, std::uint64_t rays) {
  constexpr std::uint64_t most_at_once = 1'000'000;  // columns of one row
  std::mt19937_64 rng(20);
  std::uniform_real_distribution<double> unit(0, 1);
  const std::vector<Edge> edges = edges_of(mesh.triangles);
  Leaks leaks;
  for (std::uint64_t done = 0; done < rays;) {
    const std::uint64_t n = std::min(most_at_once, rays - done);
    std::vector<Vec3> turned;
    const Turn turn(rng);
    for (const Vec3& p : mesh.positions) turned.push_back(done == 0 ? p : turn(p));
    const Scene scene = Scene::from_triangles(turned, mesh.triangles);
    const auto kept = std::make_shared<const SceneData>(scene.data());
    if (kept->triangles.size() != mesh.triangles.size()) throw std::logic_error("the mesh lost triangles");
    TraceStation station;
    do {
      station.origin = {static_cast<float>((2 * unit(rng) - 1) * mesh.core_m),
                        static_cast<float>((2 * unit(rng) - 1) * mesh.core_m),
                        static_cast<float>((2 * unit(rng) - 1) * mesh.core_m)};
    } while (length({station.origin.x, station.origin.y, station.origin.z}) > mesh.core_m);
    const Vec3 origin{station.origin.x, station.origin.y, station.origin.z};

    // One row: all rays share a z, so columns can aim anywhere on that side.
    auto pattern = std::make_shared<RayPattern>();
    const double side = rng() % 2 == 0 ? 0.5 : -0.5;
    pattern->sin_zenith = {1};
    pattern->cos_zenith = {static_cast<float>(side)};
    pattern->min_range = 1e-3f;
    pattern->max_range = 100;
    std::vector<bool> at_vertex;
    const auto corner = [&](std::uint32_t v) {
      const Float3& p = kept->positions[v];
      return Vec3{p.x, p.y, p.z};
    };
    while (at_vertex.size() < n) {
      const bool vertex = rng() % 2 == 0;
      const Edge& edge = edges[rng() % edges.size()];
      const double s = vertex ? static_cast<double>(rng() % 2) : unit(rng);
      const Vec3 d = corner(edge.first) * (1 - s) + corner(edge.second) * s - origin;
      if (d.z * side < 0.1 * length(d)) continue;
      pattern->cos_azimuth.push_back(static_cast<float>(d.x * side / d.z));
      pattern->sin_azimuth.push_back(static_cast<float>(d.y * side / d.z));
      at_vertex.push_back(vertex);
    }
    const auto tracer = make_tracer(engine.engine, engine.device_index,
                                    {kept,
                                     std::make_shared<const VoxelGrid>(VoxelGrid::build(*kept, 0.5)),
                                     {{pattern, std::make_shared<const NoiseModel>()}},
                                     0,
                                     false});
    Tracer::RawChunk chunk;
    tracer->scan(station, 0, n, Tracer::primitive, chunk);
    for (std::size_t k = 0; k < n; ++k) {
      const bool escaped = chunk.primitive[k] == 0xFFFFFFFFu;
      ++(at_vertex[k] ? leaks.vertex_rays : leaks.edge_rays);
      if (escaped) ++(at_vertex[k] ? leaks.vertex_escapes : leaks.edge_escapes);
    }
    done += n;
  }
  return leaks;
}

}  // namespace vantage::test
