// SPDX-License-Identifier: Apache-2.0
#include <tbb/task_arena.h>

#include <cmath>
#include <limits>
#include <mutex>
#include <string>
#include <utility>

#include "placement/area_limits.hpp"
#include "placement/plane_quadtree.hpp"
#include "placement/walkable.hpp"
#include "scene/scene_data.hpp"
#include "vantage/error.hpp"
#include "vantage/placement.hpp"

namespace vantage {

struct SearchArea::Impl {
  SearchMesh mesh;
  WalkableSurface how;  // without its mesh
  WalkableOptions options = {};
  AreaLimits limits = {};
  std::optional<PlaneQuadtree> in_uv;
  // Quadtree over the mesh seen from above. Only stations given by X, Y, Z need it, so it is built on first use.
  mutable std::once_flag plan_once;
  mutable std::vector<Uv> plan_points;
  mutable std::optional<PlaneQuadtree> in_plan;

  explicit Impl(WalkableSurface surface, const WalkableOptions& with = {})
      : mesh(std::move(surface.mesh)), how(std::move(surface)), options(with), limits(with) {
    if (mesh.uvs.size() != mesh.positions.size())
      throw Error(Errc::invalid_argument, "a search area needs one (u, v) per position; it has " +
                                              std::to_string(mesh.uvs.size()) + " for " +
                                              std::to_string(mesh.positions.size()));
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
      for (const std::uint32_t v : mesh.triangles[t])
        if (v >= mesh.positions.size())
          throw Error(Errc::invalid_argument, "triangle " + std::to_string(t) +
                                                  " of the search area refers to position " + std::to_string(v) +
                                                  "; there are " + std::to_string(mesh.positions.size()));
    // Triangles with positions that are not finite are no candidates, as these must not be interpolated.
    for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
      const Vec3& p = mesh.positions[v];
      if (!std::isfinite(p.x) || !std::isfinite(p.y) || !std::isfinite(p.z))
        mesh.uvs[v] = {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::quiet_NaN()};
    }
    in_uv.emplace(mesh.uvs, mesh.triangles);
    if (in_uv->empty())
      throw Error(Errc::invalid_argument,
                  "none of the search area's " + std::to_string(mesh.triangles.size()) +
                      " triangles has an area in (u, v); give it texture coordinates that unfold it");
  }

  Vec3 position(const TrianglePoint& at) const {  // equation 6, without h
    const auto& t = mesh.triangles[at.triangle];
    return mesh.positions[t[0]] * (1 - at.s - at.t) + mesh.positions[t[1]] * at.s + mesh.positions[t[2]] * at.t;
  }

  const PlaneQuadtree& plan() const {
    // Isolated, since a thread that waits for the tree's tasks must not take up a task of its caller that needs the
    // tree.
    std::call_once(plan_once, [this] {
      plan_points.clear();  // remains of a call that threw
      plan_points.reserve(mesh.positions.size());
      for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
        const bool usable = std::isfinite(mesh.uvs[v].u) && std::isfinite(mesh.uvs[v].v);
        plan_points.push_back(usable ? Uv{mesh.positions[v].x, mesh.positions[v].y} : mesh.uvs[v]);
      }
      tbb::this_task_arena::isolate([this] { in_plan.emplace(plan_points, mesh.triangles); });
    });
    return *in_plan;
  }
};

SearchArea SearchArea::build(const Scene& scene, const WalkableOptions& options) {
  check(options);
  const SceneData& data = scene.data();
  WalkableSurface surface;
  if (!has_station_area(data) && !data.search_uvs.empty() &&
      PlaneQuadtree::any_candidate(data.search_uvs, data.search_triangles))
    surface = {.mesh = {data.search_positions, data.search_uvs, data.search_triangles},
               .derived = false,
               .description = "as the scene marks it, with its own (u, v)"};
  else
    surface = find_walkable_surface(data, options);
  if (const AreaLimits limits(options); limits.any() && surface.left_out.empty()) {  // a marked area
    Box bounds;
    for (const Vec3& p : surface.mesh.positions)
      if (std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z)) bounds.extend(p);
    LeftOut cut_off;
    surface.mesh = cut_to_limits(surface.mesh, limits, piece_spacing(options, bounds), cut_off);
    if (surface.mesh.triangles.empty())
      throw Error(Errc::invalid_argument, "no part of the search area lies within the given levels and regions");
    if (cut_off.area_m2 > 0) surface.left_out.push_back(std::move(cut_off));
  }
  SearchArea area;
  area.impl_ = std::make_shared<const Impl>(std::move(surface), options);
  return area;
}

SearchArea SearchArea::from_mesh(SearchMesh mesh) {
  SearchArea area;
  area.impl_ = std::make_shared<const Impl>(
      WalkableSurface{.mesh = std::move(mesh), .derived = false, .description = "as given"});
  return area;
}

Uv SearchArea::uv_min() const noexcept { return impl_->in_uv->min(); }
Uv SearchArea::uv_max() const noexcept { return impl_->in_uv->max(); }
bool SearchArea::derived() const noexcept { return impl_->how.derived; }
const std::string& SearchArea::description() const noexcept { return impl_->how.description; }
const SearchMesh& SearchArea::mesh() const noexcept { return impl_->mesh; }
const WalkableOptions& SearchArea::options() const noexcept { return impl_->options; }
std::span<const LeftOut> SearchArea::left_out() const noexcept { return impl_->how.left_out; }
std::span<const ClosedPart> SearchArea::not_entered() const noexcept { return impl_->how.not_entered; }
std::span<const ClosedPart> SearchArea::entered() const noexcept { return impl_->how.entered; }
std::span<const Vec3> SearchArea::entries() const noexcept { return impl_->how.entries; }
bool SearchArea::on_plane() const noexcept { return impl_->how.on_plane; }

std::optional<Vec3> SearchArea::locate(Uv uv) const {
  const auto at = impl_->in_uv->find(uv);
  if (!at) return std::nullopt;
  const Vec3 ground = impl_->position(*at);
  if (impl_->limits.any() && !impl_->limits.allow(ground)) return std::nullopt;
  return ground;
}

std::optional<Uv> SearchArea::project(const Vec3& ground) const {
  std::optional<Uv> result;
  double nearest = std::numeric_limits<double>::infinity();
  impl_->plan().find_all({ground.x, ground.y}, [&](const TrianglePoint& at) {
    const Vec3 place = impl_->position(at);
    const double distance = std::abs(place.z - ground.z);
    if (!(distance < nearest) || (impl_->limits.any() && !impl_->limits.allow(place))) return;
    nearest = distance;
    const auto& t = impl_->mesh.triangles[at.triangle];
    const Uv i = impl_->mesh.uvs[t[0]], j = impl_->mesh.uvs[t[1]], k = impl_->mesh.uvs[t[2]];
    const double r = 1 - at.s - at.t;
    result = Uv{r * i.u + at.s * j.u + at.t * k.u, r * i.v + at.s * j.v + at.t * k.v};
  });
  return result;
}

}  // namespace vantage
