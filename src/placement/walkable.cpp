// SPDX-License-Identifier: Apache-2.0
#include "placement/walkable.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <sstream>
#include <utility>
#include <vector>

#include "placement/charts.hpp"
#include "placement/mesh_tree.hpp"
#include "placement/surface_pieces.hpp"
#include "scene/positions.hpp"
#include "vantage/error.hpp"

namespace vantage {
namespace {

// Parts this near the model's largest extent to each other are connected.
constexpr double weld_share = 1e-5;
// Walkable surfaces are a ground when, in the lower half of the model, those of about one height cover this share of
// its outline seen from above. The flat parts of a machine are clear too, but lie at many heights, or on its top, and
// are not where one stands to scan it.
constexpr double ground_share = 0.3;
constexpr double one_height = 0.1;  // of the model's height
constexpr double lower_half = 0.5;
// A part that is large enough but holds no disc of this radius, in sides of the smallest square part, is the top of a
// pipe or a rail. Parts so many times the smallest area need no look.
constexpr double disc_share = 0.25;
constexpr double surely_wide = 100;

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

double total_area(const std::vector<Chart>& charts) {
  double sum = 0;
  for (const Chart& c : charts) sum += c.area;
  return sum;
}

double extent_of(const Box& bounds) {
  const Vec3 size = bounds.size();
  return std::max({size.x, size.y, size.z});
}

// The marked triangles, in the first of these classes that has any: gentle and upward; gentle, either side up; not
// vertical.
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
  const auto charts = make_charts(pieces, weld_share * extent_of(bounds));
  surface.mesh = unfold(pieces, charts, scene.origin);
  surface.description = "as the scene marks it, (u, v) generated: " + charts_text(charts.size(), total_area(charts));
  return surface;
}

// Headroom is felt from this high above a surface, so that neither the surface itself nor what lies flat on it counts.
double first_height(const Box& bounds, double headroom_m) {
  return std::max(0.01 * headroom_m, 1e-5 * extent_of(bounds));
}

bool is_ground(const std::vector<Chart>& charts, const Box& bounds, double outline_area) {
  std::vector<std::pair<double, double>> levels;  // (height, area) of each chart
  const double height = bounds.size().z;
  for (const Chart& c : charts)
    if (c.mean_z <= bounds.min.z + lower_half * height) levels.emplace_back(c.mean_z, c.plan_area);
  std::sort(levels.begin(), levels.end());
  double most = 0, sum = 0;
  for (std::size_t first = 0, last = 0; last < levels.size(); ++last) {
    sum += levels[last].second;
    for (; levels[last].first - levels[first].first > one_height * height; ++first) sum -= levels[first].second;
    most = std::max(most, sum);
  }
  return most > 0 && most >= ground_share * outline_area;
}

WalkableSurface derive_walkable(const SceneData& scene, const MeshTree& tree, const std::vector<glm::dvec3>& points,
                                const WalkableOptions& options) {
  WalkableSurface surface;
  const double extent = extent_of(scene.local_bounds), least_up = std::cos(options.max_slope.in_radians());
  std::vector<Triangle> upward;
  for (const Triangle& t : scene.triangles)
    if (unit_normal(points[t[0]], points[t[1]], points[t[2]]).z >= least_up) upward.push_back(t);
  if (upward.empty()) return surface;

  const double from = first_height(scene.local_bounds, options.headroom_m), to = std::max(options.headroom_m, 2 * from);
  const double spacing = std::max(options.headroom_m / 5, extent / 512);
  const SurfacePieces pieces = clear_pieces(points, upward, spacing, [&](const glm::dvec3& p) {
    return !tree.covered(p, from, to) &&
           !tree.inside_solid(p + glm::dvec3{0, 0, (from + to) / 2});  // above bumps of the ground
  });
  std::vector<Chart> charts = make_charts(pieces, weld_share * extent);
  std::vector<char> fit(charts.size());
  tbb::parallel_for(std::size_t{0}, charts.size(), [&](std::size_t i) {
    const Chart& c = charts[i];
    fit[i] = c.plan_area > 0 && c.area >= options.min_area_m2 &&
             (c.area >= surely_wide * options.min_area_m2 ||
              holds_disc(pieces, c, disc_share * std::sqrt(options.min_area_m2)));
  });
  std::vector<Chart> wide;
  for (std::size_t i = 0; i < charts.size(); ++i)
    if (fit[i]) wide.push_back(std::move(charts[i]));
  charts = std::move(wide);

  if (!is_ground(charts, scene.local_bounds, plan_hull_area(points))) return surface;
  surface.mesh = unfold(pieces, charts, scene.origin);
  surface.description = "derived from walkable surfaces: " + charts_text(charts.size(), total_area(charts));
  return surface;
}

WalkableSurface lay_plane(const SceneData& scene, const MeshTree& tree) {
  const Box& b = scene.local_bounds;
  double reach = extent_of(b);
  if (!(reach > 0)) reach = 1;
  const glm::dvec3 low{b.min.x - reach, b.min.y - reach, b.min.z}, high{b.max.x + reach, b.max.y + reach, b.min.z};
  std::vector<glm::dvec3> points{low, {high.x, low.y, low.z}, high, {low.x, high.y, low.z}};
  const std::vector<Triangle> triangles{{0, 1, 2}, {0, 2, 3}};
  // Under the model itself there is no place to stand.
  const double from = 1e-4 * reach, to = b.size().z + reach, spacing = std::max(high.x - low.x, high.y - low.y) / 256;
  const SurfacePieces pieces = clear_pieces(std::move(points), triangles, spacing,
                                            [&](const glm::dvec3& p) { return !tree.covered(p, from, to); });
  const auto charts = make_charts(pieces, weld_share * reach);
  WalkableSurface surface;
  surface.mesh = unfold(pieces, charts, scene.origin);
  std::ostringstream text;
  text << "a horizontal plane laid under the model, at its lowest point (z = " << b.min.z + scene.origin.z
       << "), reaching " << reach << " m beyond it on every side, as no walkable ground was found around it: "
       << charts_text(charts.size(), total_area(charts));
  surface.description = text.str();
  return surface;
}

void check(const WalkableOptions& options) {
  const double slope = options.max_slope.in_degrees();
  const auto refuse = [](const char* what, double value, const char* wanted) {
    std::ostringstream text;
    text << what << " must be " << wanted << "; it is " << value;
    throw Error(Errc::invalid_argument, text.str());
  };
  if (!(slope >= 0 && slope < 90)) refuse("the largest slope of a walkable surface", slope, "in [0°, 90°)");
  if (!(options.headroom_m >= 0) || !std::isfinite(options.headroom_m))
    refuse("the headroom above a walkable surface, in metres,", options.headroom_m, "finite and not negative");
  if (!(options.min_area_m2 >= 0) || !std::isfinite(options.min_area_m2))
    refuse("the smallest area of a walkable part, in m²,", options.min_area_m2, "finite and not negative");
}

}  // namespace

WalkableSurface find_walkable_surface(const SceneData& scene, const WalkableOptions& options) {
  check(options);
  if (!scene.search_triangles.empty()) {
    WalkableSurface marked = unfold_marked(scene, options);
    if (!marked.mesh.triangles.empty()) return marked;
  }
  if (scene.triangles.empty() || scene.local_bounds.empty())
    throw Error(Errc::invalid_argument,
                "the scene has neither a mesh nor a usable search area to stand on; mark one with the role \"search\" "
                "or add a ground");
  const MeshTree tree(scene);
  std::vector<glm::dvec3> points;
  points.reserve(scene.positions.size());
  for (const Float3& p : scene.positions) points.push_back(to_glm(p));
  WalkableSurface walkable = derive_walkable(scene, tree, points, options);
  return walkable.mesh.triangles.empty() ? lay_plane(scene, tree) : walkable;
}

}  // namespace vantage
