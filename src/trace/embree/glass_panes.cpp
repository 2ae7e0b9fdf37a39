// SPDX-License-Identifier: Apache-2.0
#include "trace/embree/glass_panes.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "shared/trace_types.h"
#include "trace/glass_faces.hpp"

namespace vantage {
namespace {

// Returns the distance up to which glass before a hit counts, so that a film on the surface does not.
float before_hit(float t) { return t * (1 - face_gap_share) - face_gap_m; }

}  // namespace

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

void GlassPanes::pass(Passed& passed, float& next, float t, std::uint32_t triangle, const Float3& d) const {
  if (t < next || passed.share == 0) return;
  next = t * (1 + face_gap_share) + face_gap_m;
  const double cosine = dot(planes_->normal(triangle), widen(d));
  if (cosine * cosine >= static_cast<double>(pane_return_square)) {
    passed = {0, triangle, t};
    return;
  }
  const double share = passed_of_pane(cosine);
  passed.share *= of_solid_[triangle - first_] ? std::sqrt(share) : share;
  if (passed.share < static_cast<double>(least_passed)) passed.share = 0;
}

void GlassPanes::follow_all(const std::vector<RayCaster::Crossing>& faces, const RayBundle& rays,
                            const std::uint32_t* slot, std::span<Passed> passed) const {
  std::uint32_t ray = RayBundle::kNoHit;
  float next = 0;
  for (const RayCaster::Crossing& face : faces) {
    if (face.ray != ray) next = 0;
    ray = face.ray;
    pass(passed[slot ? slot[ray] : ray], next, face.t, face.triangle, {rays.x[ray], rays.y[ray], rays.z[ray]});
  }
}

bool GlassPanes::follow(RayBundle& rays, std::span<Passed> passed) const {
  for (std::uint32_t k = 0; k < rays.size; ++k) rays.end[k] = before_hit(rays.end[k]);
  const std::vector<RayCaster::Crossing> faces = caster_.crossings(rays);
  if (faces.empty()) return false;
  std::fill_n(passed.begin(), rays.size, Passed{1, RayBundle::kNoHit, 0});
  follow_all(faces, rays, nullptr, passed);
  return true;
}

bool GlassPanes::follow(const Float3& origin, const Hits& hits, const PaneView* view, std::span<Passed> passed) const {
  RayBundle rays;
  rays.origin = origin;
  if (!view) {
    rays.size = hits.size;
    std::copy_n(hits.x, hits.size, rays.x);
    std::copy_n(hits.y, hits.size, rays.y);
    std::copy_n(hits.z, hits.size, rays.z);
    std::copy_n(hits.t, hits.size, rays.end);
    return follow(rays, passed);
  }
  alignas(64) float end[Hits::kCapacity];
  for (std::uint32_t k = 0; k < hits.size; ++k) end[k] = before_hit(hits.t[k]);
  PaneView::Crossings found;
  if (!view->find(hits, end, found)) return false;
  std::fill_n(passed.begin(), hits.size, Passed{1, RayBundle::kNoHit, 0});
  std::uint32_t slot[RayBundle::kCapacity];
  for (std::uint32_t k = 0; k < hits.size; ++k) {
    const Float3 d{hits.x[k], hits.y[k], hits.z[k]};
    if (found.count[k] == PaneView::Crossings::kUnsure) {
      slot[rays.size] = k;
      rays.x[rays.size] = d.x, rays.y[rays.size] = d.y, rays.z[rays.size] = d.z;
      rays.end[rays.size++] = end[k];
      continue;
    }
    float next = 0;
    for (std::uint32_t i = 0; i < found.count[k]; ++i) pass(passed[k], next, found.t[k][i], found.triangle[k][i], d);
  }
  follow_all(caster_.crossings(rays), rays, slot, passed);
  return true;
}

std::unique_ptr<const PaneView> GlassPanes::view(const Float3& origin) const {
  if (scene_->triangle_count() - first_ > PaneView::kMostFaces) return nullptr;
  return std::make_unique<const PaneView>(scene_, planes_, origin);
}

double GlassPanes::share(const Float3& origin, const Float3& d, float start, float end) const {
  RayBundle ray = one_ray(origin, d, start, end);
  Passed passed;
  return follow(ray, {&passed, 1}) ? passed.share : 1;
}

}  // namespace vantage
