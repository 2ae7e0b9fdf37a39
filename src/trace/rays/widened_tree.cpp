// SPDX-License-Identifier: Apache-2.0
#include "trace/rays/widened_tree.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <string>
#include <utility>

#include "scene/local_from_mesh.hpp"
#include "trace/embree/ray_caster.hpp"

namespace vantage {
namespace {

// Bounds roundings of a ray to float, as shares of the scene's size: of the origin, of the direction over the way
// through the scene, and of Embree's own boxes and distances; some 2^-22 in all. A ray that is moved into a shared
// mesh's frame has more, by the condition of the mesh's place.
constexpr double kRounding = 0x1p-20;

// Largest coordinate of the scene plus the way through it, metres.
double extent_of(const Box& box) {
  if (box.empty()) return 0;
  const Vec3 way = box.size();
  const auto most = [](double low, double high) { return std::max(std::abs(low), std::abs(high)); };
  return most(box.min.x, box.max.x) + most(box.min.y, box.max.y) + most(box.min.z, box.max.z) +
         std::sqrt(dot(way, way));
}

// Returns the part of a ray in the box widened by `margin`: from first to second; none if first is larger.
std::pair<double, double> passage(const Box& box, double margin, const Vec3& origin, const Vec3& unit) {
  double in = -std::numeric_limits<double>::infinity(), out = -in;
  const auto clip = [&](double low, double high, double at, double way) {
    low -= margin, high += margin;
    if (way == 0) {
      if (at < low || at > high) out = -std::numeric_limits<double>::infinity();
      return;
    }
    const auto [near, far] = std::minmax({(low - at) / way, (high - at) / way});
    in = std::max(in, near), out = std::min(out, far);
  };
  clip(box.min.x, box.max.x, origin.x, unit.x);
  clip(box.min.y, box.max.y, origin.y, unit.y);
  clip(box.min.z, box.max.z, origin.z, unit.z);
  return {in, out};
}

struct Walk {
  embree::Context rtc;  // first member: Embree passes its address to the callback
  const std::vector<MeshInstance>& runs;
  WidenedTree::Query& query;
  double moved, slack;  // begin of Embree's ray; its end exceeds the reach by `slack`
};

float end_of(const Walk& walk, double reach) {
  return static_cast<float>((reach - walk.moved) * (1 + 0x1p-20) + walk.slack);
}

// Handles single rays.
void meet(const RTCIntersectFunctionNArguments* arguments) {
  if (arguments->valid[0] == 0) return;
  const Walk& walk = *reinterpret_cast<const Walk*>(arguments->context);
  const unsigned instance = arguments->context->instID[0];
  const MeshInstance& run = walk.runs[instance == RTC_INVALID_GEOMETRY_ID ? arguments->geomID : instance];
  float& end = RTCRayN_tfar(RTCRayHitN_RayN(arguments->rayhit, arguments->N), arguments->N, 0);
  end = std::min(end, end_of(walk, walk.query.take(run.first_triangle + arguments->primID)));
}

}  // namespace

WidenedTree::WidenedTree(std::shared_ptr<const SceneData> scene)
    : scene_(std::move(scene)),
      runs_(scene_->instances),
      size_(extent_of(scene_->local_bounds)),
      widening_(kRounding * size_),
      device_(embree::new_device()),
      tree_(embree::new_scene(device_.get())) {
  if (runs_.empty()) runs_.push_back({.first_triangle = 0, .triangle_count = scene_->triangle_count()});
  for (std::size_t k = 0; k < runs_.size(); ++k)
    if (runs_[k].place == MeshInstance::kNoPlace) add_boxes(tree_.get(), runs_[k], widening_, static_cast<unsigned>(k));
  add_shared_meshes();
  rtcCommitScene(tree_.get());
  embree::check(device_.get(),
                "building the tree of boxes over " + std::to_string(scene_->triangle_count()) + " triangles");
}

void WidenedTree::add_boxes(RTCScene to, const MeshInstance& run, double widening, unsigned id) {
  boxes_.push_back(std::make_unique<Boxes>(Boxes{scene_.get(), run.first_stored, widening}));
  const embree::Geometry geometry(rtcNewGeometry(device_.get(), RTC_GEOMETRY_TYPE_USER));
  rtcSetGeometryUserPrimitiveCount(geometry.get(), run.triangle_count);
  rtcSetGeometryUserData(geometry.get(), boxes_.back().get());
  rtcSetGeometryBoundsFunction(
      geometry.get(),
      [](const RTCBoundsFunctionArguments* arguments) {
        const Boxes& own = *static_cast<const Boxes*>(arguments->geometryUserPtr);
        Box box;
        for (const std::uint32_t corner : own.scene->triangles[own.first_stored + arguments->primID])
          box.extend(widen(own.scene->positions[corner]));
        // Rounds to float, which the widening covers.
        RTCBounds& out = *arguments->bounds_o;
        const double by = own.widening;
        out.lower_x = static_cast<float>(box.min.x - by), out.upper_x = static_cast<float>(box.max.x + by);
        out.lower_y = static_cast<float>(box.min.y - by), out.upper_y = static_cast<float>(box.max.y + by);
        out.lower_z = static_cast<float>(box.min.z - by), out.upper_z = static_cast<float>(box.max.z + by);
      },
      nullptr);
  rtcSetGeometryIntersectFunction(geometry.get(), meet);
  rtcCommitGeometry(geometry.get());
  rtcAttachGeometryByID(to, geometry.get(), id);
}

void WidenedTree::add_shared_meshes() {
  struct Mesh {
    MeshInstance run = {};
    double widening = 0;  // in the mesh's frame, for all its places
    RTCScene scene = nullptr;
  };
  std::map<std::uint32_t, Mesh> meshes;  // by first stored triangle
  for (const MeshInstance& run : runs_) {
    if (run.place == MeshInstance::kNoPlace) continue;
    const MeshPlace& place = scene_->places[run.place];
    // The shortest column is at least the norm divided by the condition; the inverse's norm is at most the condition
    // divided by the norm.
    const double norm = std::sqrt(dot(place.x, place.x) + dot(place.y, place.y) + dot(place.z, place.z));
    const double conditioned = condition(place.x, place.y, place.z);
    Mesh& mesh = meshes[run.first_stored];
    mesh.run = run;
    mesh.widening = std::max(mesh.widening, 4 * widening_ * conditioned * conditioned / norm);
  }
  for (auto& [first, mesh] : meshes) {
    shared_.push_back(embree::new_scene(device_.get()));
    mesh.scene = shared_.back().get();
    add_boxes(mesh.scene, mesh.run, mesh.widening, 0);
    rtcCommitScene(mesh.scene);
  }
  for (std::size_t k = 0; k < runs_.size(); ++k) {
    if (runs_[k].place == MeshInstance::kNoPlace) continue;
    const embree::Geometry geometry(rtcNewGeometry(device_.get(), RTC_GEOMETRY_TYPE_INSTANCE));
    rtcSetGeometryInstancedScene(geometry.get(), meshes[runs_[k].first_stored].scene);
    const std::array<float, 12> columns = local_from_mesh(*scene_, scene_->places[runs_[k].place]);
    rtcSetGeometryTransform(geometry.get(), 0, RTC_FORMAT_FLOAT3X4_COLUMN_MAJOR, columns.data());
    rtcCommitGeometry(geometry.get());
    rtcAttachGeometryByID(tree_.get(), geometry.get(), static_cast<unsigned>(k));
  }
}

std::optional<WidenedTree::Way> WidenedTree::way_of(const Vec3& origin, const Vec3& unit, double from,
                                                    double reach) const {
  const auto [in, out] = passage(scene_->local_bounds, widening_, origin, unit);
  const Way way{std::max(from, in), std::min(reach, out)};
  return way.begin <= way.end ? std::optional(way) : std::nullopt;
}

void WidenedTree::run(const Vec3& origin, const Vec3& unit, double from, double reach, Query& query) const {
  const auto way = way_of(origin, unit, from, reach);
  if (!way) return;
  const auto [begin, end] = *way;
  // Starts Embree's ray at the scene: a direction rounded far away would pass beside it.
  const Vec3 at = origin + unit * begin;
  Walk walk{{}, runs_, query, begin, widening_};
  RTCRayHit hit{};
  hit.ray.org_x = static_cast<float>(at.x);
  hit.ray.org_y = static_cast<float>(at.y);
  hit.ray.org_z = static_cast<float>(at.z);
  hit.ray.dir_x = RayCaster::safe(static_cast<float>(unit.x));
  hit.ray.dir_y = RayCaster::safe(static_cast<float>(unit.y));
  hit.ray.dir_z = RayCaster::safe(static_cast<float>(unit.z));
  hit.ray.tfar = end_of(walk, end);
  hit.ray.mask = ~0u;
  hit.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  hit.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
  embree::intersect(tree_.get(), walk.rtc, hit);
}

}  // namespace vantage
