// SPDX-License-Identifier: Apache-2.0
#include "sight.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "bare_embree.hpp"
#include "core/philox.hpp"

namespace vantage::bench {
namespace {

// Rays to a spot end this much before it, above the rounding of local coordinates.
constexpr double kBefore_m = 2e-3;
// Cosine of the largest angle of incidence at which a surface counts as seen.
constexpr double kSteepest = 0.02;

Vec3 wide(const Float3& p) { return {p.x, p.y, p.z}; }
double length(const Vec3& v) { return std::sqrt(dot(v, v)); }

}  // namespace

Sight::Sight(const SceneData& scene, const Scanner& scanner, double spacing_m, std::size_t spots, std::uint64_t seed)
    : origin_(scene.origin),
      nearest_m_(scanner.min_range_m),
      farthest_m_(scanner.max_range_m),
      dense_m2_(spacing_m * spacing_m / (scanner.azimuth_step.in_radians() * scanner.zenith_step.in_radians())),
      device_(embree::new_device()),
      tree_(tree_of(device_.get(), scene.positions, scene.opaque_triangles())) {
  std::vector<double> upto;  // area of the triangles up to each
  double area = 0;
  const auto corners = [&](const Triangle& t) {
    return std::array{wide(scene.positions[t[0]]), wide(scene.positions[t[1]]), wide(scene.positions[t[2]])};
  };
  for (const Triangle& t : scene.opaque_triangles()) {
    const auto [a, b, c] = corners(t);
    upto.push_back(area += length(cross(b - a, c - a)) / 2);
  }
  RandomStream random(seed);
  for (std::size_t k = 0; k < spots && area > 0; ++k) {
    const double at = area * (static_cast<double>(k) + random.uniform()) / static_cast<double>(spots);
    const auto found =
        std::min(static_cast<std::size_t>(std::ranges::lower_bound(upto, at) - upto.begin()), upto.size() - 1);
    const auto [a, b, c] = corners(scene.opaque_triangles()[found]);
    const double root = std::sqrt(random.uniform()), along = random.uniform();
    const Vec3 normal = cross(b - a, c - a);
    spots_.push_back({a * (1 - root) + b * (root * (1 - along)) + c * (root * along), normal * (1 / length(normal))});
  }
}

bool Sight::blocked(const Vec3& a, const Vec3& b, double short_m) const {
  const Vec3 way = b - a;
  const double metres = length(way);
  if (metres <= short_m) return false;
  RTCRay ray{};
  ray.org_x = static_cast<float>(a.x), ray.org_y = static_cast<float>(a.y), ray.org_z = static_cast<float>(a.z);
  ray.dir_x = static_cast<float>(way.x), ray.dir_y = static_cast<float>(way.y), ray.dir_z = static_cast<float>(way.z);
  ray.tfar = static_cast<float>(1 - short_m / metres);
  ray.mask = 0xFFFFFFFFu;
#if VANTAGE_EMBREE_MAJOR >= 4
  rtcOccluded1(tree_.get(), &ray, nullptr);
#else
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  rtcOccluded1(tree_.get(), &context, &ray);
#endif
  return ray.tfar < 0;  // as Embree marks a hit
}

Sight::View Sight::from(const Vec3& head) const {
  const Vec3 local = head - origin_;
  View view;
  view.sides.resize(spots_.size());
  std::vector<std::pair<double, double>> captured;  // distance, share of the wanted points
  for (std::size_t k = 0; k < spots_.size(); ++k) {
    const Vec3 way = local - spots_[k].at;
    const double metres = length(way), cosine = dot(way, spots_[k].normal) / std::max(metres, kBefore_m);
    if (metres < nearest_m_ || metres > farthest_m_ || std::abs(cosine) < kSteepest) continue;
    if (blocked(local, spots_[k].at, kBefore_m / std::abs(cosine))) continue;
    view.sides[k] = cosine > 0 ? 1 : -1;
    ++view.seen;
    captured.emplace_back(metres, std::min(1.0, dense_m2_ * std::abs(cosine) / (metres * metres)));
  }
  std::ranges::sort(captured);
  double all = 0, sum = 0;
  for (const auto& [metres, share] : captured) all += share;
  for (const auto& [metres, share] : captured)
    if ((sum += share) >= all / 2) {
      view.median_m = metres;
      break;
    }
  return view;
}

double shared(const Sight::View& a, const Sight::View& b) {
  const std::size_t fewer = std::min(a.seen, b.seen);
  if (fewer == 0) return 0;
  std::size_t both = 0;
  for (std::size_t k = 0; k < a.sides.size(); ++k) both += a.sides[k] != 0 && a.sides[k] == b.sides[k] ? 1 : 0;
  return static_cast<double>(both) / static_cast<double>(fewer);
}

}  // namespace vantage::bench
