// SPDX-License-Identifier: Apache-2.0
#include "trace/embree/planes.hpp"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <utility>

namespace vantage {

Planes::Planes(std::shared_ptr<const SceneData> scene) : scene_(std::move(scene)) {
  const SceneData& s = *scene_;
  planes_.resize(s.triangles.size());
  balls_.resize(s.triangles.size());
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, s.triangles.size(), 4096), [&](const auto& range) {
    for (std::size_t i = range.begin(); i < range.end(); ++i) {
      const Triangle& t = s.triangles[i];
      const Vec3 a = widen(s.positions[t[0]]);
      Vec3 n = cross(widen(s.positions[t[1]]) - a, widen(s.positions[t[2]]) - a);
      const double length = std::sqrt(dot(n, n));
      if (length > 0) n = n * (1 / length);
      planes_[i] = {n.x, n.y, n.z, dot(n, a)};
      const Vec3 b = widen(s.positions[t[1]]), c = widen(s.positions[t[2]]), middle = (a + b + c) * (1.0 / 3);
      double radius = 0, size = 0;
      for (const Vec3& corner : {a, b, c}) {
        radius = std::max(radius, std::sqrt(dot(corner - middle, corner - middle)));
        size = std::max(size, std::sqrt(dot(corner, corner)));
      }
      const double wide = 1.5 * radius + 0x1p-21 * size;  // the middle is rounded
      balls_[i] = {static_cast<float>(middle.x), static_cast<float>(middle.y), static_cast<float>(middle.z),
                   static_cast<float>(wide * wide)};
    }
  });
}

double Planes::within(std::uint32_t triangle, const Float3& o, const Float3& d, double t) const {
  const Triangle& indices = scene_->triangles[triangle];
  const Vec3 way = widen(d) * (1 / dot(widen(d), widen(d)));
  const double a = dot(widen(scene_->positions[indices[0]]) - widen(o), way),
               b = dot(widen(scene_->positions[indices[1]]) - widen(o), way),
               c = dot(widen(scene_->positions[indices[2]]) - widen(o), way);
  const double nearest = std::min({a, b, c}), farthest = std::max({a, b, c});
  return t > nearest ? std::min(t, farthest) : nearest;  // NaN becomes the nearest
}

}  // namespace vantage
