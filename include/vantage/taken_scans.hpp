// SPDX-License-Identifier: Apache-2.0
/// On site, after some scans: what they captured by their real points, what they met that is not in the model, and
/// where to stand next.
///
/// The steps, each a call: read the scans, fit them to the model, find how the site differs from its model, make the
/// site as it was found, and ask for the next stations there.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "vantage/candidates.hpp"
#include "vantage/measure.hpp"
#include "vantage/on_site.hpp"
#include "vantage/placement.hpp"
#include "vantage/progress.hpp"
#include "vantage/settings.hpp"
#include "vantage/site.hpp"
#include "vantage/types.hpp"

namespace vantage {

/// A point that stands for all points of a scan in a small cell.
struct TakenPoint {
  std::array<float, 3> offset;  ///< Their mean, from the scanner's head, along the survey's axes, metres.
  std::uint32_t points;         ///< Number of these points, at most 16 384.
};

/// Result of fitting a scan to the model.
struct ScanFit {
  bool fitted = false;    ///< False if the scan keeps the pose of its file.
  std::string why = {};   ///< Reason why not, as the end of a sentence that begins with the scan's name.
  double shift_m = 0;     ///< Distance by which its head was moved.
  Angle turn = {};        ///< Angle by which it was turned.
  double residual_m = 0;  ///< Root mean square distance of its points near the model from the model's planes.
  double near_share = 0;  ///< Share of its points that lie near the model.
};

/// A scan that was taken.
struct TakenScan {
  std::string name = {}, sensor = {};    ///< As the file has them; "": not told.
  Vec3 head = {};                        ///< Survey frame, metres.
  StationSetup setup = {};               ///< Heading and tilt.
  std::uint64_t points = 0;              ///< Before they were thinned.
  std::vector<TakenPoint> thinned = {};  ///< Its points, one for each cell.
  ScanFit fit = {};                      ///< Result of `fit_to_model()`.
};

/// Points of a site's scans lie this near to the model's surfaces, or are of something else.
inline constexpr double default_tolerance_m = 0.1;

/// Reads the scans of an E57 or PTX file, or of all such files of a folder by their names, thinned to one point for
/// each cell of `cell_m`. Empty if stopped. Throws Error: io, malformed_file (no such file, no scan with a pose),
/// out_of_memory.
std::vector<TakenScan> read_taken_scans(const std::filesystem::path& path, double cell_m = 0.02,
                                        const Progress& progress = {});

/// Moves each scan to where it fits the site's model best, as poses on site are rough: by point-to-plane iterations
/// (Chen, Medioni: Object modelling by registration of multiple range images, 1992), with weights that make little of
/// what is not in the model. Poses may be half a metre and 3° wrong. False if stopped.
bool fit_to_model(Site& site, std::span<TakenScan> scans, double tolerance_m = default_tolerance_m,
                  const Progress& progress = {});

/// Something on site that is not in the model.
struct FoundThing {
  Box box = {};              ///< Around its points, survey frame, metres.
  std::uint64_t points = 0;  ///< On it.
  std::size_t scans = 0;     ///< That saw it.
};

/// A part of the model that scans saw through, such as a door that stood open.
struct SeenThrough {
  std::string mesh;      ///< `MeshInfo::name`.
  Box box = {};          ///< Around what was seen through, survey frame, metres.
  double area_m2 = 0;    ///< Area of the surface that was seen through.
  bool removed = false;  ///< True if it is nearly all of the mesh: the site as it was found does without it.
};

/// Cells beside what scans saw, in the space of a person above the ground, that no scan saw.
struct UnknownSpace {
  double cell_m = 0;                                    ///< Edge of a cell.
  Vec3 corner = {};                                     ///< Lower corner of cell (0, 0, 0), survey frame.
  std::vector<std::array<std::int32_t, 3>> cells = {};  ///< Ascending.
};

/// Differences between a site and its model, by the scans.
struct SiteChanges {
  std::vector<FoundThing> things = {};  ///< Largest first.
  /// Things of one scan that another scan saw through: people who stood still, cars that left. They count as nothing.
  std::vector<FoundThing> passing = {};
  std::vector<SeenThrough> seen_through = {};           ///< Parts of the model that scans saw through.
  double cell_m = 0;                                    ///< Cells of things.
  Vec3 corner = {};                                     ///< Lower corner of cell (0, 0, 0), survey frame.
  std::vector<std::array<std::int32_t, 3>> cells = {};  ///< Cells of all things, ascending.
  std::vector<std::uint32_t> removed = {};              ///< Meshes of `Scene::meshes()`, ascending.
  UnknownSpace unknown = {};                            ///< If it is a goal: see `unknown_space()`.
  /// True if the site differs from its model.
  bool any() const { return !cells.empty() || !removed.empty() || !unknown.cells.empty(); }
};

/// Finds things: clusters of points farther than `tolerance_m` from every surface, larger than 0.3 m. A person who
/// stood still is one too, unless another scan saw through them. Empty if stopped.
SiteChanges changes_of(Site& site, std::span<const TakenScan> scans, double tolerance_m = default_tolerance_m,
                       const Progress& progress = {});

/// The edge of what the scans saw, for a site that was made of these scans alone: the next station is wanted where it
/// uncovers what is not known. Put it into `SiteChanges::unknown`. Throws Error invalid_argument without ground.
UnknownSpace unknown_space(Site& site, std::span<const TakenScan> scans);

/// A m² of the edge of unknown space counts as so much surface: behind a door is a room.
inline constexpr std::uint32_t unknown_weight = 5;

/// The site as it was found: things block rays and nobody stands in them; what is removed does neither. Unknown space
/// blocks as well, and the faces of its cells are surveyed, each m² as `unknown_weight` of surface. With the settings
/// and weights of `site`.
Site changed_site(Site& site, const SiteChanges& changes);

/// Goals of the next stations.
struct NextConfig {
  double capture = 0.9;        ///< Wanted share of what is attainable, above 0 and at most 1.
  double link = default_link;  ///< Least scan overlap of links that connect all stations, taken ones included; 0: none.
  double tolerance_m = default_tolerance_m;  ///< Distance from the model within which a point is of the model, metres.
  /// A taken scan this near to a planned station is that station.
  double taken_within_m = 1;
  std::uint64_t sample_voxels = 20'000;  ///< Voxels that candidates are judged on.
  std::size_t most = 32;                 ///< Most further stations.
  bool unknown = false;                  ///< True if the edge of `unknown_space()` is a goal.
};

/// Its members as named values, for results and configuration files.
Settings settings(const NextConfig& config);

/// One row for each setting that a user gives.
const SettingTable<NextConfig>& next_settings();

/// A station to take, in the order in which to take them.
struct NextStation {
  PlacedStation station;                    ///< Place and set-up.
  std::optional<std::size_t> planned = {};  ///< Index among the planned stations, if it is one.
  double gain = 0;                          ///< Share that it adds to the captured one, after those before it.
  double captured = 0;                      ///< The share with it.
  /// Its strongest link to a station before it: index among the taken scans, then the next stations; empty if alone.
  std::optional<std::size_t> linked_to = {};
  double overlap = 0;  ///< Scan overlap of that link.
  /// A station before it, numbered likewise, that no links tied to that one until now.
  std::optional<std::size_t> ties = {};
};

/// A planned station, as it is judged after the scans.
struct PlannedStation {
  std::optional<std::size_t> taken_as = {};  ///< Scan that was taken there.
  StationStatus status = StationStatus::ok;  ///< On the site as it was found.
  double gain = 0;                           ///< Share of what is attainable that it would add now.
  bool chosen = false;                       ///< True if it is among the next stations.
};

/// The answer tells what is captured, what is missing, and where to stand next. Shares are of what is attainable on the
/// site as found.
struct NextAnswer {
  Estimate captured;                    ///< Share by the real points.
  Estimate attainable;                  ///< Share of the site's surface that stations can capture.
  std::vector<double> captured_by;      ///< Share by each taken scan alone.
  std::vector<double> hidden_by;        ///< Missing share that a thing hides from all taken scans, one for each thing.
  double not_seen = 0;                  ///< Missing share that no thing hides.
  double unknown = 0;                   ///< Missing share that is the edge of unknown space.
  std::vector<NextStation> next;        ///< Empty: there is enough.
  std::vector<PlannedStation> planned;  ///< One for each planned station.
  double captured_then = 0;             ///< With all of `next`.
  bool linked = true;                   ///< True if links connect all taken scans and next stations.
  bool enough = true;                   ///< True if `captured_then` reaches the wanted share, and all are linked.
  Visit visit = {};                     ///< The round over the next stations.
  std::size_t candidates = 0;           ///< Places that were tried.
  std::vector<PlacedStation> taken;     ///< The scans as existing stations, on the site as found.
};

/// `found`: the site as it was found. Counts the scans' points near its surveyed surfaces in its voxels, and chooses
/// the fewest further stations among candidates and planned ones. The next station is always the one that adds most of
/// those linked to what is there. Empty if stopped. Throws Error invalid_argument (a setting out of range, no scan, no
/// ground).
std::optional<NextAnswer> next_stations(Site& found, std::span<const TakenScan> scans, const SiteChanges& changes,
                                        std::span<const PlacedStation> planned, const NextConfig& config = {},
                                        const Progress& progress = {});

/// Scans that were taken, what they tell, and the answer to where to stand next.
struct Day {
  std::vector<TakenScan> scans = {};            ///< Scans that were taken.
  std::vector<PlacedStation> planned = {};      ///< Stations of the plan, if there is one.
  std::vector<std::string> planned_names = {};  ///< One for each of `planned`.
  SiteChanges changes = {};                     ///< Differences of the site from its model, by `find_changes()`.
  NextConfig config = {};                       ///< Goals of the next stations.
  NextAnswer answer = {};                       ///< Result of `next_stations()`.

  /// A scan is named by the planned station that it is of, else by the name in its file, with ", taken" if a planned
  /// station has it. The names of the next stations follow.
  std::vector<std::string> names() const;
  /// The scans as existing stations, then the next ones.
  std::vector<PlacedStation> stations() const;
};

/// Fills `day.changes` by its scans and its configuration: fits the scans to the model, and finds how the site differs
/// from it. If unknown space is a goal, the site was made of the scans: they keep their poses, and only that space is
/// found. False if stopped. Throws Error invalid_argument without ground.
bool find_changes(Site& site, Day& day, const Progress& progress = {});

}  // namespace vantage
