// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <sstream>
#include <string>
#include <utility>

#include "core/parallel.hpp"
#include "core/site_reach.hpp"
#include "core/text.hpp"
#include "placement/mesh_tree.hpp"
#include "placement/place_head.hpp"
#include "scene/scene_data.hpp"
#include "vantage/error.hpp"
#include "vantage/placement.hpp"

namespace vantage {

namespace {

// Clearance of the mast, as a share of the security volume's radius.
constexpr double kMastShare = 0.1;

}  // namespace

struct ClashChecker::Impl {
  Vec3 origin;
  SecurityVolume volume;
  MeshTree tree;
  std::optional<MeshTree> opaque;  // set if some meshes are of glass

  // Converts to the local frame. Embree ends the process for positions out of reach.
  glm::dvec3 local(const Vec3& point) const {
    require_in_reach(point, origin, "the checked position is");
    return to_glm(point - origin);
  }
};

ClashChecker::ClashChecker(const Scene& scene, const SecurityVolume& volume) {
  for (const auto& [name, value] :
       {std::pair{"lower_m", volume.lower_m}, {"upper_m", volume.upper_m}, {"radius_m", volume.radius_m}})
    if (!(value >= 0 && value <= kSiteReach_m)) {
      std::ostringstream what;
      what << "the security volume's " << name << " must be 0 to 1e6 m; it is " << value;
      throw Error(Errc::invalid_argument, what.str());
    }
  if (volume.radius_m > 0 && volume.radius_m >= volume.lower_m) {
    std::ostringstream what;
    what << "the security volume's radius of " << volume.radius_m
         << " m must be less than the height of its lower sphere, " << volume.lower_m
         << " m, or the ground itself would clash; 0 switches the check off";
    throw Error(Errc::invalid_argument, what.str());
  }
  const SceneData& data = scene.data();
  const std::uint32_t opaque = data.opaque_count();
  impl_ = std::make_shared<const Impl>(
      Impl{data.origin, volume, MeshTree(data),
           opaque < data.triangle_count() ? std::optional<MeshTree>(MeshTree(data, opaque)) : std::nullopt});
}

bool ClashChecker::clashes(const Vec3& ground) const {
  const SecurityVolume& v = impl_->volume;
  const glm::dvec3 local = impl_->local(ground);
  if (v.radius_m == 0) return false;
  return impl_->tree.within(local + glm::dvec3{0, 0, v.lower_m}, v.radius_m) ||
         impl_->tree.within(local + glm::dvec3{0, 0, v.upper_m}, v.radius_m);
}

bool ClashChecker::clashes(const Vec3& ground, double height_m) const {
  const SecurityVolume& v = impl_->volume;
  impl_->local(ground + Vec3{0, 0, height_m});
  if (clashes(ground)) return true;
  if (v.radius_m == 0) return false;
  const double head_radius = kHeadShare * v.radius_m, mast_radius = kMastShare * v.radius_m;
  const glm::dvec3 local = impl_->local(ground);
  const auto up = [&](double height) { return local + glm::dvec3{0, 0, height}; };
  if (impl_->tree.within(up(height_m), head_radius)) return true;
  // Parts of the mast well within a sphere need no test.
  const double within = std::sqrt(v.radius_m * v.radius_m - mast_radius * mast_radius);
  double from = v.lower_m - v.radius_m + mast_radius;
  for (const double sphere : {std::min(v.lower_m, v.upper_m), std::max(v.lower_m, v.upper_m)}) {
    const double to = std::min(sphere - within, height_m);
    if (to > from && impl_->tree.within_of_segment(up(from), up(to), mast_radius)) return true;
    from = std::max(from, sphere + within);
  }
  return height_m > from && impl_->tree.within_of_segment(up(from), up(height_m), mast_radius);
}

bool ClashChecker::inside(const Vec3& point) const { return impl_->tree.inside_solid(impl_->local(point)); }

std::optional<Vec3> ClashChecker::ground_below(const Vec3& point, double limit_m) const {
  const auto drop = impl_->tree.drop(impl_->local(point));
  if (!drop || *drop > limit_m) return std::nullopt;
  return point - Vec3{0, 0, *drop};
}

bool ClashChecker::sees(const Vec3& a, const Vec3& b) const {
  return !impl_->tree.between(impl_->local(a), impl_->local(b));
}

std::vector<std::uint8_t> ClashChecker::sees(std::span<const Vec3> a, std::span<const Vec3> b) const {
  if (a.size() != b.size() && a.size() != 1 && b.size() != 1)
    throw Error(Errc::invalid_argument, "sees: there are " + std::to_string(a.size()) + " points and " +
                                            std::to_string(b.size()) +
                                            " to be seen from them; give as many of each, or one for all");
  for (const auto& [points, name] : {std::pair{a, "a"}, {b, "b"}})
    for (std::size_t k = 0; k < points.size(); ++k)
      if (!in_reach(points[k], impl_->origin))
        refuse_position(points[k], std::string("sees: the point in row ") + std::to_string(k) +
                                       ", counted from 0, of " + name + " is");
  std::vector<std::uint8_t> free(a.size() == 1 ? b.size() : a.size());
  constexpr std::size_t kGrain = 256;
  parallel::for_all(tbb::blocked_range<std::size_t>(0, free.size(), kGrain), [&](const auto& range) {
    for (std::size_t k = range.begin(); k < range.end(); ++k)
      free[k] = sees(a[a.size() == 1 ? 0 : k], b[b.size() == 1 ? 0 : k]) ? 1 : 0;
  });
  return free;
}

bool ClashChecker::ray_passes(const Vec3& a, const Vec3& b) const {
  const MeshTree& tree = impl_->opaque ? *impl_->opaque : impl_->tree;
  return !tree.between(impl_->local(a), impl_->local(b));
}

const SecurityVolume& ClashChecker::volume() const noexcept { return impl_->volume; }

double ClashChecker::distance(const Vec3& point, double limit_m) const {
  if (!(limit_m >= 0))
    throw Error(Errc::invalid_argument,
                "clash checker: the limit of a distance is " + number(limit_m) + " m, but must be 0 or more");
  return impl_->tree.distance(impl_->local(point), limit_m);
}

}  // namespace vantage
