// SPDX-License-Identifier: Apache-2.0
#include "report/surface_mesh.hpp"

#include <meshoptimizer.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>
#include <utility>

#include "core/disjoint_sets.hpp"

namespace vantage {
namespace {

constexpr float kMostError = 0.02F;      // of an edge collapse, as a share of the site's extent
constexpr float kMostClustered = 0.05F;  // of clusters, likewise

// Vertices distinguished by place and role alone; `indices` into them.
struct Welded {
  std::vector<Float3> positions;
  std::vector<std::uint8_t> kinds;
  std::vector<std::uint32_t> indices;
};

double largest_scale(const MeshPlace& place) {
  return std::sqrt(std::max({dot(place.x, place.x), dot(place.y, place.y), dot(place.z, place.z)}));
}

// Returns the scene with each shared mesh simplified to its share of the triangles, so that all its instances have
// about `triangles` in total.
SceneData thinned(const SceneData& scene, std::size_t triangles, double& error_m) {
  const double share = static_cast<double>(triangles) / scene.triangle_count();
  SceneData thin;
  thin.origin = scene.origin;
  thin.positions = scene.positions;
  thin.places = scene.places;
  thin.meshes = scene.meshes;
  thin.ranges.resize(scene.ranges.size());
  struct Simple {
    std::uint32_t first_stored, count;
    double error;  // in the mesh's frame
  };
  std::map<std::uint32_t, Simple> simple;  // by first stored triangle
  const auto simplify = [&](std::span<const Triangle> triangles_in) {
    const auto [low, high] = corner_range(triangles_in);
    std::vector<std::uint32_t> indices;
    for (const Triangle& t : triangles_in)
      for (const std::uint32_t v : t) indices.push_back(v - low);
    const float* const positions = &scene.positions[low].x;
    const std::size_t vertices = high - low + 1;
    float error = 0;
    indices.resize(
        meshopt_simplify(indices.data(), indices.data(), indices.size(), positions, vertices, sizeof(Float3),
                         static_cast<std::size_t>(std::ceil(share * static_cast<double>(triangles_in.size()))) * 3,
                         kMostError, 0, &error));
    const Simple out{static_cast<std::uint32_t>(thin.triangles.size()), static_cast<std::uint32_t>(indices.size() / 3),
                     error * meshopt_simplifyScale(positions, vertices, sizeof(Float3))};
    for (std::size_t k = 0; k < indices.size(); k += 3)
      thin.triangles.push_back({indices[k] + low, indices[k + 1] + low, indices[k + 2] + low});
    return out;
  };
  std::vector<MeshInstance> instances;
  std::uint32_t next = 0;
  for (const MeshInstance& instance : scene.instances) {
    MeshRange& range = thin.ranges[scene.mesh_of(instance.first_triangle)];
    if (range.triangle_count == 0) range.first_triangle = next;
    MeshInstance own{next, instance.triangle_count, static_cast<std::uint32_t>(thin.triangles.size()), instance.place};
    if (instance.place == MeshInstance::kNoPlace) {
      const std::span<const Triangle> own_triangles = scene.stored(instance);
      thin.triangles.insert(thin.triangles.end(), own_triangles.begin(), own_triangles.end());
    } else {
      const auto [known, first] = simple.emplace(instance.first_stored, Simple{});
      if (first) known->second = simplify(scene.stored(instance));
      own.first_stored = known->second.first_stored, own.triangle_count = known->second.count;
      error_m = std::max(error_m, known->second.error * largest_scale(scene.places[instance.place]));
    }
    next += own.triangle_count, range.triangle_count += own.triangle_count;
    if (own.triangle_count > 0) instances.push_back(own);
  }
  thin.set_instances(std::move(instances));
  return thin;
}

Welded weld(const SceneData& scene) {
  struct Corner {
    Float3 at;
    std::uint8_t kind;
    std::uint32_t place;
  };
  std::vector<Corner> corners;
  corners.reserve(3 * std::size_t{scene.triangle_count()});
  for (std::size_t m = 0; m < scene.ranges.size(); ++m) {
    if (scene.meshes[m].glass) continue;  // glass would hide the surfaces behind it
    const MeshRange& range = scene.ranges[m];
    const std::uint8_t kind = scene.meshes[m].role == Role::surveyed ? kSurveyedVertex : 0;
    for (std::uint32_t t = range.first_triangle; t < range.first_triangle + range.triangle_count; ++t)
      for (const Float3& p : scene.corners(t)) corners.push_back({p, kind, static_cast<std::uint32_t>(corners.size())});
  }
  const auto key = [](const Corner& c) { return std::tuple(c.at.x, c.at.y, c.at.z, c.kind); };
  std::ranges::sort(corners, {}, key);
  Welded welded;
  welded.indices.resize(corners.size());
  for (std::size_t k = 0; k < corners.size(); ++k) {
    if (k == 0 || key(corners[k]) != key(corners[k - 1])) {
      welded.positions.push_back(corners[k].at);
      welded.kinds.push_back(corners[k].kind);
    }
    welded.indices[corners[k].place] = static_cast<std::uint32_t>(welded.positions.size() - 1);
  }
  return welded;
}

// Marks the vertices of closed surfaces: connected triangles that pass every edge equally often in both
// directions.
void mark_solids(Welded& mesh) {
  DisjointSets surfaces(mesh.positions.size());
  std::vector<std::pair<std::uint64_t, int>> edges;  // both ends, lower first; whether passed upward
  edges.reserve(mesh.indices.size());
  for (std::size_t k = 0; k < mesh.indices.size(); k += 3)
    for (const std::size_t j : {0u, 1u, 2u}) {
      const std::uint32_t a = mesh.indices[k + j], b = mesh.indices[k + (j + 1) % 3];
      edges.emplace_back(std::uint64_t{std::min(a, b)} << 32 | std::max(a, b), a < b ? 1 : -1);
      surfaces.join(a, b);
    }
  std::ranges::sort(edges, {}, &std::pair<std::uint64_t, int>::first);
  std::vector<bool> open(mesh.positions.size(), false);
  for (std::size_t k = 0; k < edges.size();) {
    int sum = 0;
    const std::uint64_t edge = edges[k].first;
    for (; k < edges.size() && edges[k].first == edge; ++k) sum += edges[k].second;
    if (sum != 0) open[surfaces.find(static_cast<std::uint32_t>(edge))] = true;
  }
  for (std::uint32_t v = 0; v < surfaces.size(); ++v)
    if (!open[surfaces.find(v)]) mesh.kinds[v] |= kSolidVertex;
}

// Simplifies each kind separately, to its share of the triangles, since Meshoptimizer knows no kinds.
std::vector<std::uint32_t> simplified(const Welded& mesh, std::size_t triangles, double& error_m) {
  const std::size_t all = mesh.indices.size() / 3;
  if (all <= triangles) return mesh.indices;
  const float* positions = &mesh.positions[0].x;
  const double extent = meshopt_simplifyScale(positions, mesh.positions.size(), sizeof(Float3));
  std::vector<std::uint32_t> result;
  for (std::uint8_t kind = 0; kind < 4; ++kind) {
    std::vector<std::uint32_t> part;
    for (std::size_t k = 0; k < mesh.indices.size(); k += 3)
      if (mesh.kinds[mesh.indices[k]] == kind)
        part.insert(part.end(), mesh.indices.begin() + static_cast<std::ptrdiff_t>(k),
                    mesh.indices.begin() + static_cast<std::ptrdiff_t>(k + 3));
    if (part.empty()) continue;
    const std::size_t wanted = part.size() / 3 * triangles / all * 3;
    std::vector<std::uint32_t> simple(part.size());
    float error = 0;
    simple.resize(meshopt_simplify(simple.data(), part.data(), part.size(), positions, mesh.positions.size(),
                                   sizeof(Float3), wanted, kMostError, 0, &error));
    error_m = std::max(error_m, error * extent);
    if (simple.size() > wanted + wanted / 4) {
      std::vector<std::uint32_t> sloppy(simple.size());
      sloppy.resize(meshopt_simplifySloppy(sloppy.data(), simple.data(), simple.size(), positions,
                                           mesh.positions.size(), sizeof(Float3), wanted, kMostClustered, &error));
      error_m = std::max(error_m, error * extent);
      simple = std::move(sloppy);
    }
    result.insert(result.end(), simple.begin(), simple.end());
  }
  return result;
}

}  // namespace

SurfaceMesh surface_mesh(const SceneData& scene, std::size_t triangles) {
  SurfaceMesh mesh;
  if (scene.triangle_count() == 0) return mesh;
  constexpr std::size_t kThinned = 8;  // times what is wanted
  const bool many = scene.shares() && scene.triangle_count() > kThinned * triangles;
  Welded welded = many ? weld(thinned(scene, kThinned * triangles, mesh.error_m)) : weld(scene);
  mark_solids(welded);
  std::vector<std::uint32_t> indices = simplified(welded, triangles, mesh.error_m);
  meshopt_optimizeVertexCache(indices.data(), indices.data(), indices.size(), welded.positions.size());
  std::vector<std::uint32_t> place(welded.positions.size());
  const std::size_t used =
      meshopt_optimizeVertexFetchRemap(place.data(), indices.data(), indices.size(), welded.positions.size());
  meshopt_remapIndexBuffer(indices.data(), indices.data(), indices.size(), place.data());
  meshopt_remapVertexBuffer(welded.positions.data(), welded.positions.data(), welded.positions.size(), sizeof(Float3),
                            place.data());
  meshopt_remapVertexBuffer(welded.kinds.data(), welded.kinds.data(), welded.kinds.size(), 1, place.data());
  welded.positions.resize(used), welded.kinds.resize(used);

  for (std::size_t v = 0; v < used; ++v) {
    const Float3& p = welded.positions[v];
    mesh.box.extend({p.x, p.y, p.z});
    if (welded.kinds[v] & kSurveyedVertex) mesh.surveyed.extend({p.x, p.y, p.z});
  }
  const Vec3 low = mesh.box.min, size = mesh.box.size();
  const auto step = [](double value, double from, double length) {
    return static_cast<std::uint16_t>(length > 0 ? std::lround((value - from) / length * 65535) : 0);
  };
  for (const Float3& p : welded.positions)
    mesh.positions.push_back({step(p.x, low.x, size.x), step(p.y, low.y, size.y), step(p.z, low.z, size.z)});
  mesh.kinds = std::move(welded.kinds);
  mesh.triangles = std::move(indices);
  return mesh;
}

}  // namespace vantage
