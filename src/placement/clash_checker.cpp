// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <sstream>

#include "placement/mesh_tree.hpp"
#include "placement/place_head.hpp"
#include "scene/scene_data.hpp"
#include "vantage/error.hpp"
#include "vantage/placement.hpp"

namespace vantage {

namespace {

// Clearance of the mast, as a share of the security volume's radius.
constexpr double mast_share = 0.1;

}  // namespace

struct ClashChecker::Impl {
  Vec3 origin;
  SecurityVolume volume;
  MeshTree tree;
  std::optional<MeshTree> opaque;  // set if some meshes are of glass
};

ClashChecker::ClashChecker(const Scene& scene, const SecurityVolume& volume) {
  for (const auto& [name, value] :
       {std::pair{"lower_m", volume.lower_m}, {"upper_m", volume.upper_m}, {"radius_m", volume.radius_m}})
    if (!(value >= 0) || !std::isfinite(value)) {
      std::ostringstream what;
      what << "the security volume's " << name << " must be finite and not negative; it is " << value;
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
  if (v.radius_m == 0) return false;
  const glm::dvec3 local = to_glm(ground - impl_->origin);
  return impl_->tree.within(local + glm::dvec3{0, 0, v.lower_m}, v.radius_m) ||
         impl_->tree.within(local + glm::dvec3{0, 0, v.upper_m}, v.radius_m);
}

bool ClashChecker::clashes(const Vec3& ground, double height_m) const {
  const SecurityVolume& v = impl_->volume;
  if (v.radius_m == 0) return false;
  if (clashes(ground)) return true;
  const double head_radius = head_share * v.radius_m, mast_radius = mast_share * v.radius_m;
  const glm::dvec3 local = to_glm(ground - impl_->origin);
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

bool ClashChecker::inside(const Vec3& point) const { return impl_->tree.inside_solid(to_glm(point - impl_->origin)); }

std::optional<Vec3> ClashChecker::ground_below(const Vec3& point, double limit_m) const {
  const auto drop = impl_->tree.drop(to_glm(point - impl_->origin));
  if (!drop || *drop > limit_m) return std::nullopt;
  return point - Vec3{0, 0, *drop};
}

bool ClashChecker::sees(const Vec3& a, const Vec3& b) const {
  return !impl_->tree.between(to_glm(a - impl_->origin), to_glm(b - impl_->origin));
}

bool ClashChecker::ray_passes(const Vec3& a, const Vec3& b) const {
  const MeshTree& tree = impl_->opaque ? *impl_->opaque : impl_->tree;
  return !tree.between(to_glm(a - impl_->origin), to_glm(b - impl_->origin));
}

const SecurityVolume& ClashChecker::volume() const noexcept { return impl_->volume; }

double ClashChecker::distance(const Vec3& point, double limit_m) const {
  return impl_->tree.distance(to_glm(point - impl_->origin), limit_m);
}

}  // namespace vantage
