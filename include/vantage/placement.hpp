// SPDX-License-Identifier: Apache-2.0
/// Positions of a scanner: the search area in (u, v) and the security volume (sections 4.2 and 4.3).
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

/// A region seen from above, survey frame: points inside an odd number of its rings.
struct PlanRegion {
  std::vector<std::vector<std::array<double, 2>>> rings;  ///< Corners (x, y); a ring is closed whether or not it
                                                          ///< repeats its first corner.
  std::string file = {};                                  ///< File it was read from, if any.
  bool holds(double x, double y) const;                   ///< True for a point in it; survey frame, metres.
};

/// Reads a region in survey coordinates: the Polygons and MultiPolygons of a GeoJSON file (.json, .geojson), or the
/// corners of one polygon, x,y a line, from any other file. Throws Error: io, malformed_file.
PlanRegion read_region(const std::string& file);

/// Settings for deriving a search area if the scene marks none. It consists of upward, gentle and clear surfaces that a
/// person with a tripod can reach from the entrance.
struct WalkableOptions {
  Angle max_slope = Angle::degrees(25);  ///< Between a triangle's normal and up; most pitched roofs are steeper.
  double headroom_m = 2.0;               ///< Clear height needed above the surface.
  double min_area_m2 = 0.25;      ///< Connected parts smaller than this, or far narrower than its side, are left out.
  double passage_width_m = 0.6;   ///< Width of the narrowest opening that a person passes.
  double passage_height_m = 1.9;  ///< Height of the lowest such opening.
  double climb_m = 0.25;          ///< Highest step that a person takes.
  std::vector<Vec3> enter = {};   ///< Entrances of the site, survey frame; empty: found automatically.
  /// Adds large parts that something bars the way to to the search area, unless `enter` is given: ground
  /// under the sky and rooms, from a tenth of the reached floor or 20 m² on. `SearchArea::entered()` lists them.
  bool enter_closed = true;
  /// Lowest and highest level of the ground, survey frame. Like the two below, it also limits a marked search area.
  std::optional<std::array<double, 2>> levels = {};
  std::vector<PlanRegion> within = {};   ///< If not empty, only ground in one of these.
  std::vector<PlanRegion> without = {};  ///< No ground in any of these.
};

/// Its members as named values, for results and configuration files.
Settings settings(const WalkableOptions& options);

/// A triangle mesh with (u, v) per vertex, survey frame. `SearchArea` is built from one and can return it for drawing.
struct SearchMesh {
  std::vector<Vec3> positions;                          ///< Corners, survey frame, metres.
  std::vector<Uv> uvs;                                  ///< (u, v) of each corner.
  std::vector<std::array<std::uint32_t, 3>> triangles;  ///< Indices of corners.
};

/// Why a surface that one could stand on is left out of a derived search area.
enum class LeftOutReason {
  unreachable,  ///< Not reachable: a roof, a table, the top of a wall.
  sealed,       ///< Behind openings that no person passes, or inside a solid.
  narrow,       ///< No room for a person beside obstacles.
  headroom,     ///< Something hangs too low above it.
  limits,       ///< Outside the requested levels and regions.
  small,        ///< A connected part below the smallest area.
};
/// A phrase for people: "too narrow".
std::string to_string(LeftOutReason);

/// Surface left out for one reason.
struct LeftOut {
  LeftOutReason reason = LeftOutReason::unreachable;         ///< The reason.
  double area_m2 = 0;                                        ///< Its area.
  std::vector<Vec3> positions = {};                          ///< Survey frame.
  std::vector<std::array<std::uint32_t, 3>> triangles = {};  ///< Indices into `positions`.
};

/// Obstacle to a part of the floor, on the easiest way there.
enum class Bar {
  door,      ///< A closed leaf, gate or pane.
  headroom,  ///< A low opening, in which a person stoops.
  climb,     ///< A ladder, or a stair as steep as one.
  step,      ///< A step higher than a person takes.
  no_way,    ///< Nothing in the model leads there.
};
std::string to_string(Bar);  ///< The name of the enumerator.

/// Kinds of closed parts of the floor.
enum class ClosedKind {
  room,    ///< A room, a storey or a platform.
  ground,  ///< Ground under the sky.
  attic,   ///< Under a slope of the roof, with no way up.
  top,     ///< The top of something that stands on the floor.
  hollow,  ///< Inside something without an opening.
  low,     ///< Floor on which a person stoops all over; `ClosedPart::height_m` is its headroom.
};
std::string to_string(ClosedKind);  ///< The name of the enumerator.

/// Floor that something bars the way to.
struct ClosedPart {
  double area_m2 = 0;  ///< Its area.
  double share = 0;    ///< Share of all floor, reached and closed.
  Vec3 place;          ///< In its middle, survey frame; as one of `WalkableOptions::enter` it opens the part.
  ClosedKind kind = ClosedKind::room;  ///< Kind of the part.
  Bar bar = Bar::no_way;               ///< Obstacle on the way to it.
  double height_m = 0;  ///< Least headroom (`headroom`) or highest step (`climb`, `step`) on the way there.
  /// Names of the closed leaves and panes on the way to it.
  std::vector<std::string> doors = {};
  /// True if the surveyor has to decide whether it belongs to the survey: a room, ground or a low floor, as opposed to
  /// an attic, or most of all floor.
  bool to_decide() const {
    return kind == ClosedKind::room || kind == ClosedKind::ground || kind == ClosedKind::low || share >= 0.5;
  }
};

/// The search area: maps (u, v) to the ground through a quadtree (section 4.2). Immutable; copies share storage; safe
/// to read from any thread.
class SearchArea {
 public:
  /// Returns the scene's marked search area; meshes with `MeshInfo::station_area` take precedence. If there is no such
  /// mesh, or none with (u, v), charts in true proportion are made. If no ground is found around or inside the model, a
  /// horizontal plane is laid under its lowest point; it extends beyond every side by the model's largest extent.
  /// `description()` says what was done.
  /// Throws Error: invalid_argument when the scene has neither a mesh nor a usable search area, an option is out of its
  /// range, nothing is left within the levels and regions, or a point cloud shows no ground.
  static SearchArea build(const Scene& scene, const WalkableOptions& options = {});
  /// Throws Error: invalid_argument when no triangle has an area in (u, v), or the arrays do not fit together.
  static SearchArea from_mesh(SearchMesh mesh);

  Uv uv_min() const noexcept;     ///< Lower end of (u, v).
  Uv uv_max() const noexcept;     ///< Upper end of (u, v).
  bool derived() const noexcept;  ///< True: made from walkable surfaces, or a plane laid under the model.
  const std::string& description() const noexcept;  ///< Origin of the search area, for logs and reports.
  const SearchMesh& mesh() const noexcept;          ///< Its triangles, survey frame.
  const WalkableOptions& options() const noexcept;  ///< Options it was built with.
  /// Largest area first. For a marked search area, only what lies outside the limits.
  std::span<const LeftOut> left_out() const noexcept;
  std::span<const ClosedPart> not_entered() const noexcept;  ///< Closed parts that it leaves out, largest first.
  std::span<const ClosedPart> entered() const noexcept;      ///< Closed parts that it holds, largest first.
  std::span<const Vec3> entries() const noexcept;            ///< Places at which one enters the site, survey frame.
  bool on_plane() const noexcept;                            ///< True if a plane was laid under the model.
  /// Ground point under (u, v), survey frame; empty in a hole. Points on an edge or a vertex are always found, and so
  /// are points at most 1e-9 of the (u, v) extent outside. If charts overlap, the first triangle of the mesh wins.
  std::optional<Vec3> locate(Uv uv) const;
  /// (u, v) of the search area straight above or below `ground`, at the nearest height; empty outside.
  std::optional<Uv> project(const Vec3& ground) const;

 private:
  struct Impl;
  std::shared_ptr<const Impl> impl_;
};

/// Outcome of placing one station, whether from a decision vector, given or existing.
enum class StationStatus {
  ok,          ///< A scanner can stand there.
  hole,        ///< No ground under its (u, v).
  clash,       ///< Something stands within its security volume, or touches its mast or its head.
  inside,      ///< Its head is within something solid.
  off_ground,  ///< A given head without support at about the scanner's height below it.
  outside,     ///< A given head whose tripod stands on something outside the search area.
};
std::string to_string(StationStatus);  ///< The name of the enumerator.
/// Says what is wrong, as the end of a sentence that begins with the station's name; empty for `ok`.
std::string explain(StationStatus);

/// A station on its ground, and how it stands there.
struct PlacedStation {
  Uv uv = {};          ///< (u, v) of its ground in the search area.
  Vec3 position = {};  ///< Scanner's head, survey frame: the ground plus the height. (0, 0, 0) in a hole.
  Vec3 ground = {};    ///< Point under the head where the tripod stands, survey frame. (0, 0, 0) in a hole.
  StationStatus status = StationStatus::ok;  ///< Tells if a scanner can stand there, or why not.
  bool existing = false;                     ///< Existing station, scanned before the plan.
  StationSetup setup = {};                   ///< Scanner on it, and its orientation.
};
/// True if the station counts in measures: it is not in a hole, a solid or a clash. An existing station was scanned, so
/// it counts despite a clash in the model. Heads off the ground and outside the search area count.
bool active(const PlacedStation& station);
/// Number of existing stations in a network. They come first in it.
std::size_t existing_count(std::span<const PlacedStation> stations);

/// The security volume of section 4.3: two spheres above the ground.
struct SecurityVolume {
  double lower_m = 0.6;   ///< h1: height of the lower sphere's centre above the ground.
  double upper_m = 1.35;  ///< h2.
  double radius_m = 0.5;  ///< r; 0 switches the check off.
};

/// Its members as named values, for results and configuration files.
Settings settings(const SecurityVolume& volume);

/// Distance queries against all surveyed and blocking meshes. Safe to use from any thread. Unless the check is off, a
/// station's head keeps a fifth of the security volume's radius (0.1 m by default) from everything, and the mast below
/// it a tenth.
class ClashChecker {
 public:
  /// Throws Error invalid_argument if a value is negative or not finite, or if radius_m >= lower_m (the ground itself
  /// would clash) while the check is on.
  ClashChecker(const Scene& scene, const SecurityVolume& volume = {});
  /// True if a mesh comes closer to a sphere above `ground` (survey frame) than its radius.
  bool clashes(const Vec3& ground) const;
  /// Also checks the head, `height_m` above `ground`, and the mast from the lower sphere's bottom to the head.
  bool clashes(const Vec3& ground, double height_m) const;
  /// True if a point (survey frame) lies within a closed solid whose triangles face outward.
  bool inside(const Vec3& point) const;
  /// First surface straight below a point, at most `limit_m` lower.
  std::optional<Vec3> ground_below(const Vec3& point, double limit_m) const;
  /// True if the line between two points (survey frame), e.g. two heads, is free.
  bool sees(const Vec3& a, const Vec3& b) const;
  /// The same of many pairs, 1 if free, else 0; an array of one element is for all of the other. Throws Error
  /// invalid_argument, with the row, for a point that is not in reach, and for arrays that do not fit together.
  std::vector<std::uint8_t> sees(std::span<const Vec3> a, std::span<const Vec3> b) const;
  /// Tells whether a scanner's ray gets from `a` to `b`: as `sees`, but through glass.
  bool ray_passes(const Vec3& a, const Vec3& b) const;
  /// Distance from a point to the nearest mesh, at most `limit_m`.
  double distance(const Vec3& point, double limit_m) const;
  const SecurityVolume& volume() const noexcept;  ///< As it was given.

 private:
  struct Impl;
  std::shared_ptr<const Impl> impl_;
};

/// Default distance from a head up to which `Site::nearest_place` searches.
inline constexpr double nearest_place_reach_m = 5;

/// Advice for a station that does not stand well.
struct StationMove {
  std::size_t station = 0;                         ///< Its place in the network, from 0.
  std::optional<PlacedStation> to = std::nullopt;  ///< The nearest place that may hold it; empty: there is none.
  double reach_m = nearest_place_reach_m;          ///< Largest distance from its head that was looked at.
};
/// The advice as words, for a head in the survey frame, whose y points north: "move it 0.42 m to the north-east, to
/// 3.120,4.500,1.850" (the head's x,y,z), or "no place within 5 m is free".
std::string move_text(const Vec3& head, const StationMove& move);

/// A station placed by its head.
struct PlacedHead {
  PlacedStation station;  ///< (u, v) as given, or of the search area above or below the ground.
  bool has_uv = false;    ///< True if (u, v) exists.
};

}  // namespace vantage
