// SPDX-License-Identifier: Apache-2.0
/// Where a scanner may stand: the search area in (u, v) and the security volume (sections 4.2 and 4.3).
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "vantage/scene.hpp"
#include "vantage/settings.hpp"
#include "vantage/station_setup.hpp"
#include "vantage/types.hpp"

namespace vantage {

/// A region seen from above, survey frame: what an odd number of its rings goes around.
struct PlanRegion {
  std::vector<std::vector<std::array<double, 2>>> rings;  ///< Corners (x, y); closed whether or not the first returns.
  std::string file = {};                                  ///< Where it was read from, if it was.
  bool holds(double x, double y) const;
};

/// A region in survey coordinates: the Polygons and MultiPolygons of a GeoJSON file (.json, .geojson), or the corners
/// of one polygon, x,y a line, of any other. Throws Error: io, malformed_file.
PlanRegion read_region(const std::string& file);

/// How a search area is derived where the scene marks none: upward, gentle and clear surfaces that a person with a
/// tripod gets to from where one enters.
struct WalkableOptions {
  Angle max_slope = Angle::degrees(25);  ///< Between a triangle's normal and up; most pitched roofs are steeper.
  double headroom_m = 2.0;               ///< Clear height needed above the surface.
  double min_area_m2 = 0.25;       ///< Connected parts smaller than this, or far narrower than its side, are left out.
  double passage_width_m = 0.6;    ///< Of the narrowest opening that a person passes.
  double passage_height_m = 1.9;   ///< Of the lowest.
  double climb_m = 0.25;           ///< The highest step that a person takes.
  std::optional<Vec3> enter = {};  ///< Where one enters the site, survey frame; empty: found by itself.
  /// Heights of ground, lowest and highest, survey frame. Like the two below it also holds for a marked search area.
  std::optional<std::array<double, 2>> levels = {};
  std::vector<PlanRegion> within = {};   ///< Where not empty: only ground in one of these.
  std::vector<PlanRegion> without = {};  ///< No ground in any of these.
};

Settings settings(const WalkableOptions& options);

/// A triangle mesh with (u, v) per vertex, survey frame. What `SearchArea` is built from and can hand out for drawing.
struct SearchMesh {
  std::vector<Vec3> positions;
  std::vector<Uv> uvs;
  std::vector<std::array<std::uint32_t, 3>> triangles;
};

/// Why a surface that one could stand on is no part of a derived search area.
enum class LeftOutReason {
  unreachable,  ///< Nothing leads there: a roof, a table, the top of a wall.
  sealed,       ///< No opening that a person passes leads there, or it is inside something solid.
  narrow,       ///< No room for a person beside what stands there.
  headroom,     ///< Something hangs too low above it.
  limits,       ///< Outside of the levels and regions that were asked for.
  small,        ///< A connected part below the smallest area.
};
std::string to_string(LeftOutReason);

/// What was left out for one reason.
struct LeftOut {
  LeftOutReason reason = LeftOutReason::unreachable;
  double area_m2 = 0;
  std::vector<Vec3> positions = {};  ///< Survey frame.
  std::vector<std::array<std::uint32_t, 3>> triangles = {};
};

/// The search area: maps (u, v) to the ground through a quadtree (section 4.2).
/// Immutable; copies share storage; safe to read from any thread.
class SearchArea {
 public:
  /// The scene's marked search area; where it has none, or none with (u, v), charts in true proportion are made.
  /// Meshes with `MeshInfo::station_area` go before both. Where no ground is found around the model, a horizontal plane
  /// is laid under it, at its lowest point, and reaches out on every side by the model's largest extent.
  /// `description()` says what was done. Throws Error: invalid_argument when the scene has neither a mesh nor a usable
  /// search area, an option is out of its range, or nothing is left within the levels and regions.
  static SearchArea build(const Scene& scene, const WalkableOptions& options = {});
  /// Throws Error: invalid_argument when no triangle has an area in (u, v), or the arrays do not fit together.
  static SearchArea from_mesh(SearchMesh mesh);

  Uv uv_min() const noexcept;
  Uv uv_max() const noexcept;
  bool derived() const noexcept;  ///< True: made from walkable surfaces, or a plane laid under the model.
  const std::string& description() const noexcept;  ///< Where the search area comes from, for logs and reports.
  const SearchMesh& mesh() const noexcept;
  const WalkableOptions& options() const noexcept;  ///< What it was built with.
  /// By reason, the largest first; of a marked search area only what lies outside of the limits.
  std::span<const LeftOut> left_out() const noexcept;
  /// Ground point under (u, v), survey frame; empty in a hole. Points on an edge or a vertex are always found, and so
  /// is what lies outside by no more than 1e-9 of the (u, v) extent. Where charts overlap, the first triangle of the
  /// mesh wins.
  std::optional<Vec3> locate(Uv uv) const;
  /// (u, v) of the point of the search area straight above or below `ground`, the nearest in height; empty outside.
  std::optional<Uv> project(const Vec3& ground) const;

 private:
  struct Impl;
  std::shared_ptr<const Impl> impl_;
};

/// What became of one station: of a decision vector, typed, or there already.
enum class StationStatus {
  ok,
  hole,        ///< No ground under its (u, v).
  clash,       ///< Something stands within its security volume, or touches its mast or its head.
  inside,      ///< Its head is within something solid.
  off_ground,  ///< A given head with nothing to stand on at about the scanner's height below it.
  outside,     ///< A given head whose tripod stands on something, but not on the search area.
};
std::string to_string(StationStatus);
/// What is wrong, as the end of a sentence that begins with the station's name; empty for `ok`.
std::string explain(StationStatus);

struct PlacedStation {
  Uv uv;
  Vec3 position;     ///< The scanner's head, survey frame; the ground plus the height. (0, 0, 0) in a hole.
  Vec3 ground = {};  ///< Under the head, where the tripod stands, survey frame. (0, 0, 0) in a hole.
  StationStatus status = StationStatus::ok;
  bool kept = false;  ///< Was there before the plan.
  StationSetup setup = {};
};
/// Whether it adds to what its network measures: it is in no hole, in nothing solid and in no clash. A kept station was
/// scanned, so that a clash says something of the scene only. Heads off the ground and outside of the search area
/// count.
bool active(const PlacedStation& station);

/// The security volume of section 4.3: two spheres above the ground.
struct SecurityVolume {
  double lower_m = 0.6;   ///< h1: height of the lower sphere's centre above the ground.
  double upper_m = 1.35;  ///< h2.
  double radius_m = 0.5;  ///< r; 0 switches the check off.
};

Settings settings(const SecurityVolume& volume);

/// Distance queries against all surveyed and blocking meshes. Safe to use from any thread. Unless the check is off, a
/// station's head keeps a fifth of the security volume's radius from everything (0.1 m by default) and the mast below
/// it a tenth of it.
class ClashChecker {
 public:
  /// Throws Error invalid_argument where radius_m >= lower_m (the ground itself would clash), unless the check is off,
  /// or where a value is negative or not finite.
  ClashChecker(const Scene& scene, const SecurityVolume& volume = {});
  /// Whether one of the spheres above `ground` (survey frame) comes closer to a mesh than its radius.
  bool clashes(const Vec3& ground) const;
  /// The same, or whether something comes too near to the head, `height_m` above `ground`, or to the mast, from the
  /// lower sphere's bottom to the head.
  bool clashes(const Vec3& ground, double height_m) const;
  /// Whether a point (survey frame) lies within a closed solid whose triangles face outward.
  bool inside(const Vec3& point) const;
  /// The first surface straight below a point, at most `limit_m` lower.
  std::optional<Vec3> ground_below(const Vec3& point, double limit_m) const;
  /// Whether nothing stands between two points (survey frame), as two scanners' heads.
  bool sees(const Vec3& a, const Vec3& b) const;
  /// Distance from a point to the nearest mesh, at most `limit_m`.
  double distance(const Vec3& point, double limit_m) const;
  const SecurityVolume& volume() const noexcept;

 private:
  struct Impl;
  std::shared_ptr<const Impl> impl_;
};

/// A station given by its head (survey frame), checked as those of a search are. Its ground is the search area's at
/// `uv`, where that is given and lies below the head; or else the search area, or what mesh there is, where that lies
/// under the head by `height_m` to half of it more or less; without any, the point `height_m` lower. `area` may be
/// null.
struct PlacedHead {
  PlacedStation station;  ///< (u, v) as given, or of the search area above or below the ground.
  bool has_uv = false;    ///< Whether there are such.
};
PlacedHead place_head(const SearchArea* area, const ClashChecker& clash, double height_m, const Vec3& head,
                      std::optional<Uv> uv = {});

}  // namespace vantage
