// SPDX-License-Identifier: Apache-2.0
#include "support/reference_tracer.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "core/normal_table.hpp"
#include "core/philox.hpp"
#include "scan/noise_model.hpp"

namespace vantage::test {
namespace {

constexpr std::uint32_t block_side = 8;
constexpr double pi = 3.14159265358979323846;

double length(const Vec3& v) { return std::sqrt(dot(v, v)); }
Vec3 unit(const Vec3& v) { return v * (1 / length(v)); }

double distance_to_segment(const Vec3& p, const Vec3& a, const Vec3& b) {
  const Vec3 ab = b - a;
  const double along = std::clamp(dot(p - a, ab) / std::max(dot(ab, ab), 1e-300), 0.0, 1.0);
  return length(p - (a + ab * along));
}

Float3 turned(const Turn& turn, const Float3& d) {
  const auto along = [&](const Float3& row) {
    const float x = row.x * d.x, y = row.y * d.y, z = row.z * d.z;
    const float xy = x + y;
    return xy + z;
  };
  return {along(turn.x), along(turn.y), along(turn.z)};
}

struct Crossing {
  bool inside = false;
  double t = 0, u = 0, v = 0;  // u, v: weights of the second and third vertex
  double boundary = 1e300;     // from the plane's point to the triangle's boundary
};

Crossing cross_plane(const std::array<Vec3, 3>& corner, const Vec3& o, const Vec3& d) {
  Crossing c;
  const Vec3 e1 = corner[1] - corner[0], e2 = corner[2] - corner[0];
  const Vec3 n = cross(e1, e2);
  const double slope = dot(n, d);
  if (slope == 0) return c;
  c.t = dot(n, corner[0] - o) / slope;
  const Vec3 p = o + d * c.t, q = p - corner[0];
  const double area = dot(n, n);
  c.u = dot(cross(q, e2), n) / area;
  c.v = dot(cross(e1, q), n) / area;
  c.inside = c.u >= 0 && c.v >= 0 && c.u + c.v <= 1;
  for (int k = 0; k < 3; ++k) c.boundary = std::min(c.boundary, distance_to_segment(p, corner[k], corner[(k + 1) % 3]));
  return c;
}

class RayTest {
 public:
  RayTest(const TraceScene& scene, const TraceStation& station)
      : s_(scene), scanner_(scene.scanners[station.scanner]), station_(station), origin_(widen(station.origin)) {}

  ReferenceHit trace(std::uint64_t ray, const Vec3& d, const std::vector<std::uint32_t>& candidates) const {
    ReferenceHit hit;
    const double start = scanner_.pattern->min_range, end = scanner_.pattern->max_range;
    Crossing best;
    std::vector<std::pair<double, double>> near;  // distance along the ray, boundary distance
    std::vector<double> inside;
    for (const std::uint32_t triangle : candidates) {
      const Crossing c = cross_plane(corners(triangle), origin_, d);
      if (c.boundary < 1e-2) near.emplace_back(c.t, c.boundary);
      if (!c.inside) continue;
      near.emplace_back(c.t, std::min(std::abs(c.t - start), std::abs(c.t - end)));
      if (c.t < start || c.t > end) continue;
      inside.push_back(c.t);
      if (hit.triangle != ReferenceHit::none && c.t >= best.t) continue;
      best = c;
      hit.triangle = triangle;
    }
    const bool found = hit.triangle != ReferenceHit::none;
    for (const auto& [t, boundary] : near) {
      if (!found || t <= best.t + 1e-3) hit.edge_distance = std::min(hit.edge_distance, boundary);
    }
    if (!found) return hit;
    for (const double t : inside) {
      if (t > best.t) hit.gap = std::min(hit.gap, t - best.t);
    }
    hit.t = hit.range = best.t;
    shade(best, d, hit);
    if (scanner_.noise && scanner_.noise->enabled()) {
      const std::uint32_t bits = random_bits(scanner_.noise->seed, ray, noise_stream);
      hit.range += normal_from_bits(bits, normal_table()) * model_sigma(*scanner_.noise, hit.t, hit.reflectivity);
      hit.range = std::max(hit.range, 0.0);
    }
    hit.point = origin_ + d * hit.range;
    place(hit, ray);
    return hit;
  }

 private:
  std::uint32_t random_bits(std::uint64_t seed, std::uint64_t ray, std::uint32_t stream) const {
    return philox4x32(
        seed, {static_cast<std::uint32_t>(ray), static_cast<std::uint32_t>(ray >> 32), station_.place, stream})[0];
  }
  std::array<Vec3, 3> corners(std::uint32_t triangle) const {
    const auto p = s_.scene->corners(triangle);
    return {widen(p[0]), widen(p[1]), widen(p[2])};
  }

  void shade(const Crossing& c, const Vec3& d, ReferenceHit& hit) const {
    const std::array<Vec3, 3> corner = corners(hit.triangle);
    Vec3 n;
    if (!s_.scene->normals.empty()) {
      const auto normals = s_.scene->corner_normals(hit.triangle);
      n = widen(normals[0]) * (1 - c.u - c.v) + widen(normals[1]) * c.u + widen(normals[2]) * c.v;
    }
    if (length(n) == 0) n = cross(corner[1] - corner[0], corner[2] - corner[0]);
    n = unit(n);
    if (dot(n, d) > 0) n = n * -1;
    hit.normal = n;
    hit.reflectivity = std::clamp(-dot(n, d) * s_.scene->meshes[s_.scene->mesh_of(hit.triangle)].diffuse, 0.0, 1.0);
  }

  void place(ReferenceHit& hit, std::uint64_t ray) const {
    if (s_.scene->meshes[s_.scene->mesh_of(hit.triangle)].role != Role::surveyed) return;
    const VoxelGrid& grid = *s_.grid;
    const std::array<double, 3> p{hit.point.x, hit.point.y, hit.point.z};
    std::array<std::uint32_t, 3> cell;
    bool inside = true;
    for (int axis = 0; axis < 3; ++axis) {
      const double scaled = (p[axis] - grid.min()[axis]) / grid.voxel_size();
      hit.face_distance = std::min(hit.face_distance, std::abs(scaled - std::round(scaled)) * grid.voxel_size());
      inside &= scaled >= 0 && scaled < static_cast<double>(1u << grid.depth());
      cell[axis] = inside ? static_cast<std::uint32_t>(scaled) : 0;
    }
    if (inside) hit.voxel = grid.find(morton_encode(cell[0], cell[1], cell[2]));
    if (hit.voxel == kNoVoxel || !scanner_.limits || !scanner_.limits->enabled()) return;
    hold_to_limits(hit, ray);
    if (hit.dropped.points > 0) hit.voxel = kNoVoxel;
  }

  // Share of the echo that passes the glass before a hit, there and back, from the reflectances of a face in both
  // polarisations; 0 if a pane returns the beam. Triangles of the mesh "block" are faces, all others panes.
  double passed(ReferenceHit& hit) const {
    constexpr double index = 1.5, largest_return = pi / 180;
    const SceneData& scene = *s_.scene;
    const Vec3 d = direction_of(hit);
    double share = 1;
    std::vector<double> faces;
    for (std::uint32_t t = scene.opaque_count(); t < scene.triangle_count(); ++t) {
      const std::array<Vec3, 3> corner = corners(t);
      const Crossing c = cross_plane(corner, origin_, d);
      if (c.t < 0 || c.t > hit.t + 1e-3) continue;
      hit.edge_distance = std::min({hit.edge_distance, c.boundary, std::abs(hit.t - 1e-4 - c.t)});
      if (!c.inside || c.t > hit.t - 1e-4) continue;
      // Both triangles at an edge are one face.
      if (std::ranges::any_of(faces, [&](double other) { return std::abs(other - c.t) < 1e-4; })) continue;
      faces.push_back(c.t);
      const double angle =
          std::acos(std::min(std::abs(dot(unit(cross(corner[1] - corner[0], corner[2] - corner[0])), d)), 1.0));
      hit.limit_distance = std::min(hit.limit_distance, std::abs(angle - largest_return) / largest_return);
      if (angle <= largest_return) share = 0;
      const double inner = std::asin(std::sin(angle) / index);
      const double across = (std::cos(angle) - index * std::cos(inner)) / (std::cos(angle) + index * std::cos(inner)),
                   along = (index * std::cos(angle) - std::cos(inner)) / (index * std::cos(angle) + std::cos(inner));
      double of_pane = 0;  // (1 - R)² (1 + R² + R⁴ + …)
      for (const double r : {across * across, along * along}) of_pane += (1 - r) / (1 + r) / 2;
      share *= scene.meshes[scene.mesh_of(t)].name == "block" ? of_pane : of_pane * of_pane;
    }
    return share;
  }

  // Uses angle, length and standard deviation themselves.
  void hold_to_limits(ReferenceHit& hit, std::uint64_t ray) const {
    const LimitModel& model = *scanner_.limits;
    const LimitModel::Limits& limits = model.meshes[s_.scene->mesh_of(hit.triangle)];
    const double cosine = -dot(hit.normal, direction_of(hit)), incidence = std::acos(std::min(cosine, 1.0));
    const double axis = std::hypot(model.exit_diameter, model.divergence * hit.t) / cosine;
    const auto hold = [&](double value, double largest) -> std::uint64_t {
      hit.limit_distance = std::min(hit.limit_distance, std::abs(value - largest) / largest);
      return value > largest ? 1 : 0;
    };
    if (limits.least_cosine_square > 0)
      hit.dropped.incidence = hold(incidence, std::acos(std::sqrt(static_cast<double>(limits.least_cosine_square))));
    if (limits.largest_footprint_square > 0)
      hit.dropped.footprint = hold(axis, std::sqrt(static_cast<double>(limits.largest_footprint_square)));
    if (limits.largest_sigma > 0)
      hit.dropped.noise = hold(model_sigma(*model.noise, hit.t, hit.reflectivity), limits.largest_sigma);
    if (limits.largest_reach_square > 0)
      hit.dropped.echo = hold(hit.t, std::sqrt(static_cast<double>(limits.largest_reach_square) * cosine *
                                               (model.glass ? passed(hit) : 1)));
    if (static_cast<double>(random_bits(model.seed, ray, dropout_stream)) < static_cast<double>(model.lost_below))
      hit.dropped.echo = 1;
    hit.dropped.points =
        hit.dropped.incidence + hit.dropped.footprint + hit.dropped.noise + hit.dropped.echo > 0 ? 1 : 0;
  }

  Vec3 direction_of(const ReferenceHit& hit) const { return unit(hit.point - origin_); }

  const TraceScene& s_;
  const TraceScanner& scanner_;
  const TraceStation& station_;
  Vec3 origin_;
};

}  // namespace

std::vector<ReferenceHit> ReferenceTracer::scan(const TraceStation& station) const {
  const RayPattern& pattern = *scene_.scanners[station.scanner].pattern;
  const SceneData& scene = *scene_.scene;
  const Vec3 origin = widen(station.origin);
  struct Sphere {
    Vec3 centre;
    double radius;
  };
  std::vector<Sphere> spheres;
  for (std::uint32_t t = 0; t < scene.opaque_count(); ++t) {
    const auto p = scene.corners(t);
    const Vec3 a = widen(p[0]), b = widen(p[1]), c = widen(p[2]);
    const Vec3 centre = (a + b + c) * (1.0 / 3) - origin;
    spheres.push_back(
        {centre, std::max({length(a - origin - centre), length(b - origin - centre), length(c - origin - centre)})});
  }

  const std::uint32_t rows = pattern.rows(), columns = pattern.columns();
  std::vector<ReferenceHit> hits(std::size_t{rows} * columns);
  const std::uint32_t wide = (columns + block_side - 1) / block_side, tall = (rows + block_side - 1) / block_side;
  const RayTest test(scene_, station);
  tbb::parallel_for(std::uint32_t{0}, wide * tall, [&](std::uint32_t block) {
    std::vector<std::pair<std::uint64_t, Vec3>> rays;
    Vec3 axis;
    for (std::uint32_t i = block / wide * block_side; i < std::min(rows, (block / wide + 1) * block_side); ++i) {
      for (std::uint32_t j = block % wide * block_side; j < std::min(columns, (block % wide + 1) * block_side); ++j) {
        // The float products are the definition of a direction, turned or not.
        Float3 d = pattern.direction(i, j);
        if (station.turn) d = turned(*station.turn, d);
        rays.emplace_back(std::uint64_t{i} * columns + j, widen(d));
        axis = axis + widen(d);
      }
    }
    axis = unit(axis);
    double half = 0;
    for (const auto& [ray, d] : rays) half = std::max(half, std::acos(std::clamp(dot(axis, unit(d)), -1.0, 1.0)));
    std::vector<std::uint32_t> candidates;
    for (std::size_t t = 0; t < spheres.size(); ++t) {
      const double away = length(spheres[t].centre), radius = spheres[t].radius + 1e-2;
      const bool meets = away <= radius || std::acos(std::clamp(dot(axis, spheres[t].centre) / away, -1.0, 1.0)) <=
                                               half + std::asin(radius / away) + 1e-6;
      if (meets) candidates.push_back(static_cast<std::uint32_t>(t));
    }
    for (const auto& [ray, d] : rays) hits[ray] = test.trace(ray, d, candidates);
  });
  return hits;
}

}  // namespace vantage::test
