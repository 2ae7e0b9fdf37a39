// SPDX-License-Identifier: Apache-2.0
#include "placement/walkable.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "core/parallel.hpp"
#include "core/parse.hpp"
#include "core/setting_table.hpp"
#include "core/site_reach.hpp"
#include "placement/area_limits.hpp"
#include "placement/charts.hpp"
#include "placement/drawn_face_down.hpp"
#include "placement/ground_field.hpp"
#include "placement/mesh_tree.hpp"
#include "placement/no_ground.hpp"
#include "placement/plan_hull.hpp"
#include "placement/surface_pieces.hpp"
#include "scene/positions.hpp"
#include "vantage/error.hpp"

namespace vantage {
namespace {

// Parts nearer than this share of the model's largest extent are connected.
constexpr double kWeldShare = 1e-5;
// Walkable surfaces form a ground if, in the lower half of the model, the reached ones and their continuations cover
// this share of the model's outline seen from above. Flat parts of a machine are clear as well, but scattered or on its
// top, where nobody stands to scan it. Surfaces also form a ground if as much area, reached or not, lies under a cover,
// as in a building, or if floors with walls around them, reached or not, are this share of what is built.
constexpr double kGroundShare = 0.3, kFloorShare = 0.5;
constexpr double kLowerHalf = 0.5;
// A part without room for a disc of this radius, in sides of the smallest square part, is the top of a pipe or a rail.
// Parts of `kSurelyWide` times the smallest area are not tested.
constexpr double kDiscShare = 0.25;
constexpr double kSurelyWide = 100;

glm::dvec3 unit_normal(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c) {
  const glm::dvec3 n = cross(b - a, c - a);
  return length(n) > 0 ? normalize(n) : glm::dvec3(0);
}

std::string square_metres(double area) {
  std::ostringstream text;
  text.precision(4);
  text << area << " m²";
  return text.str();
}

std::string charts_text(std::size_t count, double area) {
  return std::to_string(count) + (count == 1 ? " chart, " : " charts, ") + square_metres(area);
}

double total_area(const std::vector<GroundChart>& charts) {
  double sum = 0;
  for (const GroundChart& c : charts) sum += c.area;
  return sum;
}

double extent_of(const Box& bounds) {
  const Vec3 size = bounds.size();
  return std::max({size.x, size.y, size.z});
}

// Returns the marked triangles of the first non-empty class: gentle and upward; gentle, either side up; not vertical.
std::vector<Triangle> standing_triangles(const std::vector<glm::dvec3>& points, std::span<const Triangle> triangles,
                                         double least_up) {
  std::array<std::vector<Triangle>, 3> classes;
  for (const Triangle& t : triangles) {
    const double up = unit_normal(points[t[0]], points[t[1]], points[t[2]]).z;
    if (up >= least_up) classes[0].push_back(t);
    if (std::abs(up) >= least_up) classes[1].push_back(t);
    if (std::abs(up) > 1e-6) classes[2].push_back(t);
  }
  for (auto& some : classes)
    if (!some.empty()) return std::move(some);
  return {};
}

WalkableSurface unfold_marked(const SceneData& scene, const WalkableOptions& options) {
  WalkableSurface surface;
  surface.derived = false;
  std::vector<glm::dvec3> points;
  Box bounds;
  for (const Vec3& p : scene.search_positions) {
    points.push_back(to_glm(p - scene.origin));
    if (std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z)) bounds.extend(p - scene.origin);
  }
  // NaN compares false, so a triangle with such a position has no class.
  auto triangles = standing_triangles(points, scene.search_triangles, std::cos(options.max_slope.in_radians()));
  if (triangles.empty()) return surface;
  SurfacePieces pieces{std::move(points), std::move(triangles), {}};
  for (std::uint32_t i = 0; i < pieces.triangles.size(); ++i) pieces.source.push_back(i);
  const auto charts = make_charts(pieces, kWeldShare * extent_of(bounds));
  surface.mesh = unfold(pieces, charts, scene.origin);
  surface.description = "as the scene marks it, (u, v) generated: " + charts_text(charts.size(), total_area(charts));
  return surface;
}

// Headroom is measured from this height above a surface, to skip the surface itself and anything flat on it.
double first_height(const Box& bounds, double headroom_m) {
  return std::max(0.01 * headroom_m, 1e-5 * extent_of(bounds));
}

// Outcome at a place, used as a kind of piece.
enum Reach : std::uint8_t { kept = 1, first_left_out };

std::uint8_t kind_of(LeftOutReason reason) {
  return static_cast<std::uint8_t>(first_left_out + static_cast<std::uint8_t>(reason));
}

LeftOutReason reason_of(Access access) {
  switch (access) {
    case Access::headroom: return LeftOutReason::headroom;
    case Access::unreachable: return LeftOutReason::unreachable;
    case Access::sealed: return LeftOutReason::sealed;
    case Access::narrow:
    case Access::reached: break;
  }
  return LeftOutReason::narrow;
}

// Returns the areas of the pieces of each kind except `kept`, and of the charts that are too small.
std::vector<LeftOut> gather_left_out(const SurfacePieces& pieces, const SurfacePieces& clear,
                                     const std::vector<GroundChart>& small, const Vec3& origin) {
  std::vector<LeftOut> all;
  const auto add = [&](LeftOut& to, const SurfacePieces& from, std::uint32_t piece) {
    const auto first = static_cast<std::uint32_t>(to.positions.size());
    for (const std::uint32_t v : from.triangles[piece]) to.positions.push_back(to_vec3(from.points[v]) + origin);
    to.triangles.push_back({first, first + 1, first + 2});
    to.area_m2 += piece_area(from, piece);
  };
  for (const LeftOutReason reason : {LeftOutReason::unreachable, LeftOutReason::sealed, LeftOutReason::narrow,
                                     LeftOutReason::headroom, LeftOutReason::limits}) {
    LeftOut out{.reason = reason};
    for (std::uint32_t i = 0; i < pieces.triangles.size(); ++i)
      if (pieces.kind[i] == kind_of(reason)) add(out, pieces, i);
    if (!out.triangles.empty()) all.push_back(std::move(out));
  }
  LeftOut out{.reason = LeftOutReason::small};
  for (const GroundChart& chart : small)
    for (const std::uint32_t piece : chart.pieces) add(out, clear, piece);
  if (!out.triangles.empty()) all.push_back(std::move(out));
  std::stable_sort(all.begin(), all.end(), [](const LeftOut& a, const LeftOut& b) { return a.area_m2 > b.area_m2; });
  return all;
}

// Returns charts of at least the smallest area that are not mere strips; moves the others to `small`.
std::vector<GroundChart> wide_charts(const SurfacePieces& pieces, std::vector<GroundChart> charts,
                                     const WalkableOptions& options, std::vector<GroundChart>& small) {
  std::vector<char> fit(charts.size());
  parallel::for_all(std::size_t{0}, charts.size(), [&](std::size_t i) {
    const GroundChart& c = charts[i];
    fit[i] = c.plan_area > 0 && c.area >= options.min_area_m2 &&
             (c.area >= kSurelyWide * options.min_area_m2 ||
              holds_disc(pieces, c, kDiscShare * std::sqrt(options.min_area_m2)));
  });
  std::vector<GroundChart> wide;
  for (std::size_t i = 0; i < charts.size(); ++i) (fit[i] ? wide : small).push_back(std::move(charts[i]));
  return wide;
}

std::string place_text(const Vec3& p) {
  std::ostringstream text;
  text.precision(3);
  text << std::fixed << p.x << "," << p.y << "," << p.z;
  return text.str();
}

[[noreturn]] void refuse_limits() {
  throw Error(Errc::invalid_argument, "no ground to stand on lies within the given levels and regions");
}

// Returns surfaces with room for a scanner, from `upward` triangles at places that the field reaches; with
// `any_access`, also at unreached places with room.
WalkableSurface derive_from(const SceneData& scene, const MeshTree& tree, const GroundField& field,
                            const std::vector<glm::dvec3>& points, const std::vector<Triangle>& upward,
                            const WalkableOptions& options, bool any_access) {
  const AreaLimits limits(options);
  const double extent = extent_of(scene.local_bounds);
  const double from = first_height(scene.local_bounds, options.headroom_m), to = std::max(options.headroom_m, 2 * from);
  const double spacing = piece_spacing(options, scene.local_bounds);
  const SurfacePieces pieces = sort_pieces(points, upward, spacing, [&](const glm::dvec3& p) -> std::uint8_t {
    const Access access = field.at(p);
    const bool room = access != Access::narrow && access != Access::headroom;
    if (access != Access::reached && !(any_access && room)) return kind_of(reason_of(access));
    if (limits.any() && !limits.allow_near(to_vec3(p) + scene.origin, spacing)) return kind_of(LeftOutReason::limits);
    if (tree.covered(p, from, to)) return kind_of(LeftOutReason::headroom);
    if (field.is_ridge(tree, p)) return kind_of(LeftOutReason::narrow);
    // No way leads into a solid, so reached places lie in none, whatever side its faces show.
    if (access != Access::reached && tree.inside_solid(p + glm::dvec3{0, 0, (from + to) / 2}))
      return kind_of(LeftOutReason::sealed);
    return kept;
  });
  const SurfacePieces clear = pieces_of_kind(pieces, kept);
  std::vector<GroundChart> small;
  const std::vector<GroundChart> charts = wide_charts(clear, make_charts(clear, kWeldShare * extent), options, small);
  WalkableSurface surface;
  surface.left_out = gather_left_out(pieces, clear, small, scene.origin);
  if (charts.empty()) {
    if (limits.any() && std::any_of(surface.left_out.begin(), surface.left_out.end(),
                                    [](const LeftOut& out) { return out.reason == LeftOutReason::limits; }))
      refuse_limits();
    return surface;
  }
  surface.mesh = unfold(clear, charts, scene.origin);
  surface.description = charts_text(charts.size(), total_area(charts));
  return surface;
}

bool is_upward(const std::array<Float3, 3>& p, double least_up) {
  return unit_normal(to_glm(p[0]), to_glm(p[1]), to_glm(p[2])).z >= least_up;
}

// Turns a triangle that was drawn face down.
template <class Corner>
void turn_if(std::array<Corner, 3>& corners, std::uint32_t triangle, std::span<const std::uint32_t> turned) {
  if (std::ranges::binary_search(turned, triangle)) std::swap(corners[1], corners[2]);
}

// Returns meshes whose surfaces may be stood on.
std::vector<MeshRange> standing_meshes(const SceneData& scene, bool station_area) {
  std::vector<MeshRange> meshes;
  for (std::size_t m = 0; m < scene.meshes.size(); ++m)
    if (!scene.meshes[m].door && (!station_area || scene.meshes[m].station_area)) meshes.push_back(scene.ranges[m]);
  return meshes;
}

// Returns indices into the scene's positions. REQUIRES: it shares no meshes.
std::vector<Triangle> upward_triangles(const SceneData& scene, std::span<const std::uint32_t> turned,
                                       const WalkableOptions& options, bool station_area) {
  const double least_up = std::cos(options.max_slope.in_radians());
  std::vector<Triangle> upward;
  for (const MeshRange& range : standing_meshes(scene, station_area))
    for (std::uint32_t i = range.first_triangle; i < range.first_triangle + range.triangle_count; ++i) {
      std::array<Float3, 3> p = scene.corners(i);
      turn_if(p, i, turned);
      if (!is_upward(p, least_up)) continue;
      turn_if(upward.emplace_back(scene.triangles[i]), i, turned);
    }
  return upward;
}

// Does the same if nodes share meshes, with corners in `points`. Takes only those of shared meshes that may be reached,
// or that are wider than the pieces: the tops of many machines would fill the memory.
std::vector<Triangle> reached_triangles(const SceneData& scene, std::span<const std::uint32_t> turned,
                                        const GroundField& field, const WalkableOptions& options, bool station_area,
                                        std::vector<glm::dvec3>& points) {
  constexpr std::uint32_t kBlock = 1 << 16;
  const double least_up = std::cos(options.max_slope.in_radians());
  const double spacing = piece_spacing(options, scene.local_bounds);
  const auto wanted = [&](std::uint32_t triangle, const std::array<Float3, 3>& p) {
    if (scene.instance_of(triangle).place == MeshInstance::kNoPlace) return true;
    const glm::dvec3 a = to_glm(p[0]), b = to_glm(p[1]), c = to_glm(p[2]);
    const Access access = field.at((a + b + c) * (1.0 / 3));
    return access == Access::reached || (station_area && access != Access::narrow && access != Access::headroom) ||
           std::max({length(b - a), length(c - b), length(a - c)}) > spacing;
  };
  for (const MeshRange& range : standing_meshes(scene, station_area)) {
    std::vector<std::vector<glm::dvec3>> found((range.triangle_count + kBlock - 1) / kBlock);
    parallel::for_all(std::size_t{0}, found.size(), [&](std::size_t block) {
      const auto first = range.first_triangle + static_cast<std::uint32_t>(block) * kBlock;
      for (std::uint32_t t = first; t < std::min(range.first_triangle + range.triangle_count, first + kBlock); ++t) {
        std::array<Float3, 3> p = scene.corners(t);
        turn_if(p, t, turned);
        if (is_upward(p, least_up) && wanted(t, p))
          for (const Float3& corner : p) found[block].push_back(to_glm(corner));
      }
    });
    for (const auto& some : found) points.insert(points.end(), some.begin(), some.end());
  }
  std::vector<Triangle> triangles(points.size() / 3);
  for (std::uint32_t t = 0; t < triangles.size(); ++t) triangles[t] = {3 * t, 3 * t + 1, 3 * t + 2};
  return triangles;
}

std::vector<glm::dvec3> stored_points(const SceneData& scene) {
  std::vector<glm::dvec3> points;
  points.reserve(scene.positions.size());
  for (const Float3& p : scene.positions) points.push_back(to_glm(p));
  return points;
}

// Returns the area of the model's convex outline seen from above.
double outline_area(const SceneData& scene) {
  using Hull = std::vector<Uv>;
  const auto hull_of = [](std::uint32_t count, const auto& add) {
    return parallel::reduce_in_order(
        tbb::blocked_range<std::uint32_t>(0, count, 1 << 14), Hull{},
        [&](const tbb::blocked_range<std::uint32_t>& range, Hull own) {
          for (std::uint32_t k = range.begin(); k != range.end(); ++k) add(own, k);
          return convex_hull(std::move(own));
        },
        [](Hull a, const Hull& b) {
          a.insert(a.end(), b.begin(), b.end());
          return convex_hull(std::move(a));
        });
  };
  const auto hull_of_triangles = [&](std::uint32_t first, std::uint32_t count) {
    return hull_of(count, [&](Hull& hull, std::uint32_t k) {
      for (const Float3& p : scene.corners(first + k)) hull.push_back({p.x, p.y});
    });
  };
  if (!scene.shares()) return hull_area(hull_of_triangles(0, scene.triangle_count()));
  std::vector<Hull> hulls(scene.instances.size());
  parallel::for_all(std::size_t{0}, hulls.size(), [&](std::size_t k) {
    const MeshInstance& run = scene.instances[k];
    if (run.place == MeshInstance::kNoPlace) {
      hulls[k] = hull_of_triangles(run.first_triangle, run.triangle_count);
      return;
    }
    const std::pair vertices = corner_range(scene.stored(run));  // each belongs to a triangle
    hulls[k] = hull_of(vertices.second - vertices.first + 1, [&](Hull& hull, std::uint32_t v) {
      const Float3 p = scene.placed(scene.places[run.place], scene.positions[vertices.first + v]);
      hull.push_back({p.x, p.y});
    });
  });
  Hull all;
  for (const Hull& hull : hulls) all.insert(all.end(), hull.begin(), hull.end());
  return hull_area(convex_hull(std::move(all)));
}

std::vector<glm::dvec3> local_entries(const SceneData& scene, const WalkableOptions& options) {
  std::vector<glm::dvec3> entries;
  for (const Vec3& enter : options.enter) entries.push_back(to_glm(enter - scene.origin));
  return entries;
}

ClosedPart told(const GroundField::ClosedPart& part, const SceneData& scene, double all_m2) {
  ClosedPart out{.area_m2 = part.area_m2,
                 .share = all_m2 > 0 ? part.area_m2 / all_m2 : 0,
                 .place = to_vec3(part.middle) + scene.origin,
                 .kind = part.kind,
                 .bar = part.bar,
                 .height_m = part.height_m};
  for (const std::uint32_t mesh : part.doors) out.doors.push_back(scene.meshes[mesh].name);
  return out;
}

void tell_entries(WalkableSurface& surface, GroundField& field, const MeshTree& tree, const SceneData& scene) {
  for (const glm::dvec3& entry : field.entries()) surface.entries.push_back(to_vec3(entry) + scene.origin);
  const std::vector<GroundField::ClosedPart> closed = field.not_entered(tree);
  double all = field.reached_area();
  for (const GroundField::ClosedPart& part : closed) all += part.area_m2;
  for (const GroundField::ClosedPart& part : closed) surface.not_entered.push_back(told(part, scene, all));
  for (const GroundField::ClosedPart& part : field.entered()) surface.entered.push_back(told(part, scene, all));
}

// Adds floors of gratings, which have no triangle wide enough to stand on, to the upward triangles.
void add_thin_floors(const GroundField& field, std::vector<glm::dvec3>& points, std::vector<Triangle>& upward) {
  for (const auto& [low, high] : field.thin_floors()) {
    const auto first = static_cast<std::uint32_t>(points.size());
    points.insert(points.end(), {low, {high.x, low.y, low.z}, {high.x, high.y, low.z}, {low.x, high.y, low.z}});
    upward.push_back({first, first + 1, first + 2}), upward.push_back({first, first + 2, first + 3});
  }
}

// Returns true for a model made from scans: nothing is known beyond it, and each face shows the side that was seen.
bool is_scanned(const SceneData& scene) {
  const auto defaults = nlohmann::json::parse(scene.defaults_json, nullptr, false);
  const auto scanned = defaults.is_object() ? defaults.find("scanned") : defaults.end();
  return scanned != defaults.end() && scanned->is_boolean() && scanned->get<bool>();
}

std::vector<std::uint32_t> turned_in(const SceneData& scene, const MeshTree& tree, const WalkableOptions& options) {
  return is_scanned(scene) ? std::vector<std::uint32_t>{} : drawn_face_down(scene, tree, options.headroom_m);
}

WalkableSurface use_station_area(const SceneData& scene, const MeshTree& tree, const WalkableOptions& options) {
  const std::vector<std::uint32_t> turned = turned_in(scene, tree, options);
  GroundField field(scene, options, turned);
  field.reach(tree, local_entries(scene, options));
  std::vector<glm::dvec3> points;
  if (!scene.shares()) points = stored_points(scene);
  const std::vector<Triangle> upward = scene.shares() ? reached_triangles(scene, turned, field, options, true, points)
                                                      : upward_triangles(scene, turned, options, true);
  WalkableSurface surface = derive_from(scene, tree, field, points, upward, options, true);
  if (surface.mesh.triangles.empty())
    throw NoGround(
        "none of the surfaces that stations are to stand on has room for one: they are steep, covered, narrow or "
        "smaller than the smallest area");
  surface.derived = false;
  surface.description = "the surfaces of the station area, as far as there is room: " + surface.description;
  return surface;
}

WalkableSurface derive_walkable(const SceneData& scene, const MeshTree& tree, const WalkableOptions& options) {
  const std::vector<std::uint32_t> turned = turned_in(scene, tree, options);
  std::vector<glm::dvec3> points;
  std::vector<Triangle> upward;
  if (!scene.shares()) {
    upward = upward_triangles(scene, turned, options, false);
    if (upward.empty()) return {};
    points = stored_points(scene);
  }
  GroundField field(scene, options, turned);
  field.reach(tree, local_entries(scene, options));
  const Box& bounds = scene.local_bounds;
  const double lower_half_z = bounds.min.z + kLowerHalf * bounds.size().z;
  // Inside, floor is compared with the built area, as a bent tunnel fills little of its hull.
  const auto inside = [&] { return field.covered_area() >= kGroundShare * field.outline(); };
  const auto around = [&] { return field.ground_area(lower_half_z) >= kGroundShare * outline_area(scene); };
  const auto floors = [&] { return field.walled_area(tree, lower_half_z) >= kFloorShare * field.outline(); };
  const auto under_the_sky = [&] { return field.open_ground_area(tree) >= kGroundShare * field.outline(); };
  if (field.entries().empty()) return {};
  if (options.enter.empty() && !inside() && !around() && !floors() && !under_the_sky()) return {};
  if (options.enter.empty() && options.enter_closed) field.enter_closed(tree);
  if (scene.shares()) upward = reached_triangles(scene, turned, field, options, false, points);
  add_thin_floors(field, points, upward);
  WalkableSurface surface = derive_from(scene, tree, field, points, upward, options, false);
  if (surface.mesh.triangles.empty()) return surface;
  tell_entries(surface, field, tree, scene);
  std::string entries;
  for (const Vec3& entry : surface.entries) entries += (entries.empty() ? "" : " and ") + place_text(entry);
  surface.description = "derived from walkable surfaces, entered near " + entries + ": " + surface.description;
  if (const auto beyond = field.high_steps()) {
    std::ostringstream text;
    text.precision(3);
    text << "; " << beyond->area_m2 << " m² more lie beyond steps of up to " << beyond->highest_m
         << " m, higher than a person is taken to climb";
    surface.description += text.str();
  }
  if (!turned.empty())
    surface.description += "; of the model " + std::to_string(turned.size()) +
                           " triangles that face down are taken for ground, drawn upside down";
  return surface;
}

WalkableSurface lay_plane(const SceneData& scene, const MeshTree& tree, const WalkableOptions& options) {
  const Box& b = scene.local_bounds;
  const AreaLimits limits(options);
  double reach = extent_of(b);
  if (!(reach > 0)) reach = 1;
  const glm::dvec3 low{b.min.x - reach, b.min.y - reach, b.min.z}, high{b.max.x + reach, b.max.y + reach, b.min.z};
  std::vector<glm::dvec3> points{low, {high.x, low.y, low.z}, high, {low.x, high.y, low.z}};
  const std::vector<Triangle> triangles{{0, 1, 2}, {0, 2, 3}};
  GroundField field(scene, options, {}, GroundField::Plane{reach, b.min.z});
  field.reach(tree, local_entries(scene, options));
  // Nobody can stand under the model itself.
  const double from = 1e-4 * reach, to = b.size().z + reach, spacing = std::max(high.x - low.x, high.y - low.y) / 256;
  const SurfacePieces pieces =
      sort_pieces(std::move(points), triangles, spacing, [&](const glm::dvec3& p) -> std::uint8_t {
        const Access access = field.at(p);
        if (tree.covered(p, from, to)) return kind_of(LeftOutReason::headroom);
        if (access != Access::reached)
          return kind_of(access == Access::unreachable ? LeftOutReason::sealed : reason_of(access));
        if (limits.any() && !limits.allow_near(to_vec3(p) + scene.origin, spacing))
          return kind_of(LeftOutReason::limits);
        return kept;
      });
  const SurfacePieces clear = pieces_of_kind(pieces, kept);
  const auto charts = make_charts(clear, kWeldShare * reach);
  WalkableSurface surface;
  surface.left_out = gather_left_out(pieces, clear, {}, scene.origin);
  if (charts.empty()) {
    if (limits.any()) refuse_limits();
    throw NoGround("there is no ground around the model, and no room on a plane laid under it; mark a search area");
  }
  surface.mesh = unfold(clear, charts, scene.origin);
  std::ostringstream text;
  text << "a horizontal plane laid under the model, at its lowest point (z = " << b.min.z + scene.origin.z
       << "), reaching " << reach << " m beyond it on every side, as no walkable ground was found around it: "
       << charts_text(charts.size(), total_area(charts));
  surface.description = text.str();
  surface.on_plane = true;
  return surface;
}

}  // namespace

double piece_spacing(const WalkableOptions& options, const Box& bounds) {
  return std::max(options.headroom_m / 5, extent_of(bounds) / 512);
}

void check(const WalkableOptions& options) {
  // Lengths are limited to the reach of positions; beyond, floats of rays overflow.
  constexpr Interval kLengths{.low = 0, .high = kSiteReach_m};
  check_number(whole_degrees(options.max_slope), "the largest slope of a walkable surface",
               {.low = 0, .high = 90, .high_included = false});
  check_number(options.headroom_m, "the headroom above a walkable surface, in metres,", kLengths);
  check_number(options.min_area_m2, "the smallest area of a walkable part, in m²,", kNotNegative);
  check_number(options.passage_width_m, "the width of the narrowest passage, in metres,",
               {.low = 0, .high = kSiteReach_m, .low_included = false});
  check_number(options.climb_m, "the highest step, in metres,", kLengths);
  check_number(options.passage_height_m, "the height of the lowest passage, in metres,",
               {.low = options.climb_m, .high = kSiteReach_m, .low_included = false});
  AreaLimits{options};
}

bool has_station_area(const SceneData& scene) {
  return std::any_of(scene.meshes.begin(), scene.meshes.end(), [](const MeshInfo& m) { return m.station_area; });
}

WalkableSurface find_walkable_surface(const SceneData& scene, const WalkableOptions& options) {
  const bool named = has_station_area(scene);
  if (!named && !scene.search_triangles.empty()) {
    WalkableSurface marked = unfold_marked(scene, options);
    if (!marked.mesh.triangles.empty()) return marked;
  }
  if (scene.triangle_count() == 0 || scene.local_bounds.empty())
    throw NoGround(
        "the scene has neither a mesh nor a usable search area to stand on; mark one with the role \"search\" "
        "or add a ground");
  const MeshTree tree(scene);
  if (named) return use_station_area(scene, tree, options);
  WalkableSurface walkable = derive_walkable(scene, tree, options);
  if (!walkable.mesh.triangles.empty()) return walkable;
  if (is_scanned(scene))
    throw NoGround(
        "no ground for a station shows in the points, and what lies beside them is unknown; give a cloud with "
        "the ground around, an entrance (enter), or the nodes to stand on (station-area)");
  return lay_plane(scene, tree, options);
}

}  // namespace vantage
