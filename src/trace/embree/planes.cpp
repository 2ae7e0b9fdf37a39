// SPDX-License-Identifier: Apache-2.0
#include "trace/embree/planes.hpp"

#include <algorithm>
#include <utility>

#include "core/parallel.hpp"

namespace vantage {

Planes::Planes(std::shared_ptr<const SceneData> scene) : scene_(std::move(scene)), shared_(scene_->shares()) {
  if (shared_) return;
  const SceneData& s = *scene_;
  planes_.resize(s.triangles.size());
  balls_.resize(s.triangles.size());
  parallel::for_all(tbb::blocked_range<std::uint32_t>(0, s.triangle_count(), 4096), [&](const auto& range) {
    for (std::uint32_t i = range.begin(); i < range.end(); ++i) {
      const auto corners = s.corners(i);
      planes_[i] = plane_of(corners);
      balls_[i] = ball_of(corners);
    }
  });
}

Planes::Plane Planes::plane_of(const std::array<Float3, 3>& corners) {
  const Vec3 a = widen(corners[0]);
  Vec3 n = cross(widen(corners[1]) - a, widen(corners[2]) - a);
  const double length = std::sqrt(dot(n, n));
  if (length > 0) n = n * (1 / length);
  return {n.x, n.y, n.z, dot(n, a)};
}

Planes::Ball Planes::ball_of(const std::array<Float3, 3>& corners) {
  const Vec3 a = widen(corners[0]), b = widen(corners[1]), c = widen(corners[2]), middle = (a + b + c) * (1.0 / 3);
  double radius = 0, size = 0;
  for (const Vec3& corner : {a, b, c}) {
    radius = std::max(radius, std::sqrt(dot(corner - middle, corner - middle)));
    size = std::max(size, std::sqrt(dot(corner, corner)));
  }
  const double wide = 1.5 * radius + 0x1p-21 * size;  // the middle is rounded
  return {static_cast<float>(middle.x), static_cast<float>(middle.y), static_cast<float>(middle.z),
          static_cast<float>(wide * wide)};
}

double Planes::within(std::uint32_t triangle, const Float3& o, const Float3& d, double t) const {
  const auto corners = scene_->corners(triangle);
  const Vec3 way = widen(d) * (1 / dot(widen(d), widen(d)));
  const double a = dot(widen(corners[0]) - widen(o), way), b = dot(widen(corners[1]) - widen(o), way),
               c = dot(widen(corners[2]) - widen(o), way);
  const double nearest = std::min({a, b, c}), farthest = std::max({a, b, c});
  return t > nearest ? std::min(t, farthest) : nearest;  // NaN becomes the nearest
}

}  // namespace vantage
