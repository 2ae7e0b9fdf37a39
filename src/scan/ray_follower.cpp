// SPDX-License-Identifier: Apache-2.0
#include "scan/ray_follower.hpp"

#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "core/parallel.hpp"
#include "trace/embree/hits.hpp"
#include "trace/embree/point_judge.hpp"
#include "trace/embree/range_noise.hpp"

namespace vantage {
namespace {

constexpr std::size_t kMostReflections = 16;
// A reflected ray starts this far from its mirror, in metres: more than the rounding of its origin, less than anything
// stands off a mirror.
constexpr float kOffMirror_m = 1e-4f;

Vec3 reflected(const Vec3& d, const Vec3& normal) { return d - normal * (2 * dot(d, normal)); }

}  // namespace

Float3 direction_of(const RayPattern& pattern, const TraceStation& station, std::uint64_t ray) {
  const std::uint64_t row = ray / pattern.columns(), column = ray % pattern.columns();
  const Float3 d = pattern.direction(row, column);
  return station.turn ? (*station.turn)(d) : d;
}

RayFollower::RayFollower(std::shared_ptr<const SceneData> scene)
    : scene_(std::move(scene)),
      planes_(std::make_shared<Planes>(scene_)),
      caster_(scene_, planes_),
      surface_(scene_, planes_),
      glass_(scene_->has_glass() ? std::make_unique<const GlassPanes>(scene_, planes_) : nullptr) {}

RayFollower::Seen RayFollower::seen(const Float3& origin, const Float3& direction, float t,
                                    std::uint32_t triangle) const {
  const Facet facet = surface_.facet(triangle);
  const auto weights = facet.weights(origin, direction, t);
  const Vec3 normal = facet.normal(direction, weights);
  return {triangle,
          t,
          facet.reflectivity(direction, normal),
          -dot(normal, widen(direction)),
          narrow(normal),
          {static_cast<float>(weights[0]), static_cast<float>(weights[1])}};
}

RayFollower::Seen RayFollower::follow(const Float3& origin, const Float3& direction, float start, float end) const {
  std::array<Vec3, kMostReflections> normals;
  Float3 from = origin;
  Vec3 d = widen(direction);
  float way = 0;  // to the last mirror
  double passed = 1;
  for (std::size_t reflections = 0; reflections < kMostReflections && way < end; ++reflections) {
    const Float3 narrowed = narrow(d);
    RayBundle ray = one_ray(from, narrowed, reflections == 0 ? start : kOffMirror_m, end - way);
    caster_.cast(ray);
    const std::uint32_t triangle = ray.primitive[0];
    if (triangle == RayBundle::kNoHit) break;
    if (glass_) passed *= glass_->share(from, narrowed, reflections == 0 ? 0 : kOffMirror_m, ray.t[0]);
    if (!is_mirror(triangle)) {
      Seen last = seen(from, narrowed, ray.t[0], triangle);
      last.t += way;
      last.passed = passed;
      Vec3 normal = widen(last.normal);
      for (std::size_t k = reflections; k-- > 0;) normal = reflected(normal, normals[k]);
      last.normal = narrow(normal);
      return last;
    }
    way += ray.t[0];
    from = narrow(widen(from) + d * static_cast<double>(ray.t[0]));
    normals[reflections] = planes_->normal(triangle);
    d = reflected(d, normals[reflections]);
  }
  return {.triangle = RayBundle::kNoHit, .t = 0, .reflectivity = 0, .cosine = 0, .normal = {}, .weights = {}};
}

double RayFollower::distance_from_plane(std::uint32_t triangle, const Vec3& point) const {
  return std::abs(dot(planes_->normal(triangle), point - widen(scene_->corners(triangle)[0])));
}

void RayFollower::show_ghosts(const TraceScanner& scanner, const TraceStation& station, std::uint64_t first_ray,
                              Tracer::RawChunk& raw, std::span<std::uint8_t> ghost) const {
  const RangeNoise noise(scanner.noise);
  const bool limited = scanner.limits && scanner.limits->enabled();
  parallel::for_all(tbb::blocked_range<std::size_t>(0, ghost.size(), 4096), [&](const auto& range) {
    for (std::size_t k = range.begin(); k < range.end(); ++k) {
      if (raw.primitive[k] == RayBundle::kNoHit || !is_mirror(raw.primitive[k])) continue;
      const std::uint64_t ray = first_ray + k;
      const Float3 d = direction_of(*scanner.pattern, station, ray);
      const Seen found = follow(station.origin, d, scanner.pattern->min_range, scanner.pattern->max_range);
      const float reach = limited && found.triangle != RayBundle::kNoHit
                              ? scanner.limits->meshes[mesh(found.triangle)].largest_reach_square
                              : 0;
      const bool point =
          found.triangle != RayBundle::kNoHit &&
          (reach == 0 || PointJudge::detected(static_cast<double>(reach) * found.passed, found.cosine, found.t));
      float t = std::numeric_limits<float>::infinity();
      if (point) t = noise.enabled() ? noise.displaced(found.t, found.reflectivity, ray, station.place) : found.t;
      raw.primitive[k] = point ? found.triangle : RayBundle::kNoHit;
      ghost[k] = point ? 1 : 0;
      if (!raw.range.empty()) raw.range[k] = t;
      if (!raw.position.empty() && point) raw.position[k] = point_at(station.origin, d, t);
      if (!raw.normal.empty()) raw.normal[k] = point ? found.normal : Float3{};
      if (!raw.reflectivity.empty()) raw.reflectivity[k] = point ? found.reflectivity : 0;
      if (!raw.barycentric.empty()) raw.barycentric[k] = point ? found.weights : Float2{};
      if (!raw.voxel.empty()) raw.voxel[k] = kNoVoxel;
    }
  });
}

}  // namespace vantage
