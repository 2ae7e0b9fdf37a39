// SPDX-License-Identifier: Apache-2.0
#include "trace/embree/planes.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "core/parallel.hpp"

namespace vantage {

Planes::Planes(std::shared_ptr<const SceneData> scene) : scene_(std::move(scene)), shared_(scene_->shares()) {
  if (shared_) return;
  planes_.resize(scene_->triangles.size());
  balls_.resize(scene_->triangles.size());
  fill(0, scene_->triangle_count());
}

void Planes::take(std::shared_ptr<const SceneData> scene, const SceneDifference& difference) {
  const std::size_t triangles = scene->triangles.size();
  if (difference.shifted() || triangles != planes_.size()) {
    std::vector<Plane> planes(triangles);
    std::vector<Ball> balls(triangles);
    for (const KeptRun& run : difference.kept)
      parallel::for_all(tbb::blocked_range<std::uint32_t>(0, run.count, 1 << 16), [&](const auto& range) {
        std::copy_n(planes_.begin() + run.first + range.begin(), range.size(),
                    planes.begin() + run.other + range.begin());
        std::copy_n(balls_.begin() + run.first + range.begin(), range.size(),
                    balls.begin() + run.other + range.begin());
      });
    planes_ = std::move(planes);
    balls_ = std::move(balls);
  }
  scene_ = std::move(scene);
  for (const KeptRun& run : not_kept(difference.kept, static_cast<std::uint32_t>(triangles)))
    fill(run.first, run.count);
}

void Planes::fill(std::uint32_t first, std::uint32_t count) {
  parallel::for_all(tbb::blocked_range<std::uint32_t>(first, first + count, 4096), [&](const auto& range) {
    for (std::uint32_t i = range.begin(); i < range.end(); ++i) {
      const auto corners = scene_->corners(i);
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
  const Vec3 direction = widen(d), way = direction * (1 / dot(direction, direction));
  std::array<Vec3, 3> across;  // from the ray to the corners
  std::array<double, 3> along;
  double farthest = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    const Vec3 v = widen(corners[k]) - widen(o);
    along[k] = dot(v, way);
    across[k] = v - direction * along[k];
    farthest = std::max(farthest, std::sqrt(dot(v, v)));
  }
  // A needle that points at the head has no edge by which Embree could exclude a ray. Rays far beside it come as hits
  // if they are traced together with others that pass its box.
  double beside = std::numeric_limits<double>::infinity(), longest = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    const Vec3 &a = across[k], ab = across[(k + 1) % 3] - a;
    const double all = dot(ab, ab);
    const Vec3 nearest = a + ab * (all > 0 ? std::clamp(-dot(a, ab) / all, 0.0, 1.0) : 0.0);
    beside = std::min(beside, std::sqrt(dot(nearest, nearest)));
    longest = std::max(longest, std::sqrt(all));
  }
  const Vec3 twice_area = cross(across[1] - across[0], across[2] - across[0]);
  const double thick = longest > 0 ? std::sqrt(dot(twice_area, twice_area)) / longest : 0;  // rays in it are no further
  if (beside > thick + 0x1p-12 * farthest) return std::numeric_limits<double>::infinity();
  const auto [first, last] = std::minmax({along[0], along[1], along[2]});
  return t > first ? std::min(t, last) : first;  // NaN becomes the first
}

}  // namespace vantage
