// SPDX-License-Identifier: Apache-2.0
#include "trace/embree/glass_panes.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "shared/trace_types.h"
#include "trace/glass_faces.hpp"

namespace vantage {

double passed_of_pane(double cosine) {
  constexpr double kIndexSquare = 1.5 * 1.5;
  const double square = cosine * cosine, inner = kIndexSquare - 1 + square;
  const double q = 1 / (square + inner) + kIndexSquare / (kIndexSquare * kIndexSquare * square + inner);
  return square * inner * q * q;
}

GlassPanes::GlassPanes(std::shared_ptr<const SceneData> scene, std::shared_ptr<const Planes> planes)
    : scene_(std::move(scene)),
      planes_(std::move(planes)),
      caster_(scene_, planes_, RayCaster::Of::glass),
      first_(scene_->opaque_count()),
      of_solid_(faces_of_solids(*scene_)) {}

bool GlassPanes::follow(RayBundle& rays, std::span<Passed> passed) const {
  for (std::uint32_t k = 0; k < rays.size; ++k) rays.end[k] = rays.end[k] * (1 - face_gap_share) - face_gap_m;
  const std::vector<RayCaster::Crossing> faces = caster_.crossings(rays);
  if (faces.empty()) return false;
  std::fill_n(passed.begin(), rays.size, Passed{1, RayBundle::no_hit, 0});
  std::uint32_t ray = RayBundle::no_hit;
  float next = 0;  // where faces count again
  for (const RayCaster::Crossing& face : faces) {
    if (face.ray != ray) next = 0;
    ray = face.ray;
    Passed& own = passed[ray];
    if (face.t < next || own.share == 0) continue;
    next = face.t * (1 + face_gap_share) + face_gap_m;
    const Vec3 n = planes_->normal(face.triangle);
    const double cosine = dot(n, widen(Float3{rays.x[ray], rays.y[ray], rays.z[ray]}));
    if (cosine * cosine >= static_cast<double>(pane_return_square)) {
      own = {0, face.triangle, face.t};
      continue;
    }
    const double share = passed_of_pane(cosine);
    own.share *= of_solid_[face.triangle - first_] ? std::sqrt(share) : share;
    if (own.share < static_cast<double>(least_passed)) own.share = 0;
  }
  return true;
}

bool GlassPanes::follow(const Float3& origin, const Hits& hits, std::span<Passed> passed) const {
  RayBundle rays;
  rays.origin = origin;
  rays.size = hits.size;
  std::copy_n(hits.x, hits.size, rays.x);
  std::copy_n(hits.y, hits.size, rays.y);
  std::copy_n(hits.z, hits.size, rays.z);
  std::copy_n(hits.t, hits.size, rays.end);
  return follow(rays, passed);
}

double GlassPanes::share(const Float3& origin, const Float3& d, float t) const {
  RayBundle ray = one_ray(origin, d, 0, t);
  Passed passed;
  return follow(ray, {&passed, 1}) ? passed.share : 1;
}

}  // namespace vantage
