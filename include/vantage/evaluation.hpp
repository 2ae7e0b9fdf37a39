// SPDX-License-Identifier: Apache-2.0
/// One evaluated network: stations in, all figures of them out. Plans, reports, pictures and tables show it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "vantage/measure.hpp"
#include "vantage/objective.hpp"
#include "vantage/on_site.hpp"
#include "vantage/placement.hpp"
#include "vantage/progress.hpp"
#include "vantage/simulator.hpp"
#include "vantage/targets.hpp"

namespace vantage {

class AttainableCounts;  // vantage/attainable.hpp

/// Names of stations in every table and picture: "S1", "S2", … in their order, and "K1", "K2", … for existing ones,
/// each counted from 1. `given`: the user's names, one each, or none; an empty one keeps the numbered name. If two
/// names are equal, the later one gets its number among all: "P1 (3)".
std::vector<std::string> station_names(std::span<const PlacedStation> stations,
                                       std::span<const std::string> given = {});

/// The stations in the form that simulators take.
Network to_network(std::span<const PlacedStation> stations);

/// Measure that links two stations.
enum class LinkMeasure {
  overlap,       ///< Equation 11, on surveyed voxels.
  scan_overlap,  ///< The share of the smaller scan, on all surfaces.
};
std::string to_string(LinkMeasure);  ///< "overlap", "scan overlap"

/// Links between the active stations of a network. Stations are numbered by their place in it, from 0.
struct StationLinks {
  LinkMeasure measure = LinkMeasure::overlap;        ///< Measure that `least` and `values` are of.
  double least = 0;                                  ///< Least value of a link; a value of 0 never links.
  PairMatrix values = {};                            ///< One for each pair of all stations.
  std::vector<std::vector<std::size_t>> parts = {};  ///< Connected components, the largest first.
  /// The weakest link of the maximum spanning tree, if there is one component of several stations.
  std::optional<std::pair<std::size_t, std::size_t>> weakest = std::nullopt;
  double weakest_value = 0;  ///< Value of that link.
  /// Best pair of each component, except the first, with a station outside of it.
  struct Gap {
    std::size_t inside = 0, outside = 0;  ///< Stations, by their places in the network.
    double value = 0;                     ///< Value of the pair.
  };
  std::vector<Gap> gaps = {};  ///< One for each component except the first.
  /// Pairs that would link a component, except the first, to another if glass did not stop links: the best of each.
  std::vector<Gap> through_glass = {};
};
/// Links of at least `least` between stations that are active, by overlap. REQUIRES: a row for each station.
StationLinks station_links(const OverlapMatrix& overlap, double least, std::span<const PlacedStation> stations);
/// The same by scan overlap.
StationLinks station_links(const ScanOverlapMatrix& overlap, double least, std::span<const PlacedStation> stations);

/// A link that alone ties ground at two heights together, although the path on foot between its stations is long. It
/// goes through a window or across a void, and not up the stair.
struct StoreyTie {
  std::size_t a = 0, b = 0;  ///< Stations, by their places in the network.
  double value = 0;          ///< Strength of the link.
  double apart_m = 0;        ///< Between their heads.
  double way_m = 0;          ///< On foot.
};

/// Amount of data in the scans of stations, without existing ones.
struct ScanData {
  /// Points on all surfaces: counted, or estimated from the coarser scans of `EvaluationSite::surroundings`.
  double points = 0;
  double e57_bytes = 0;  ///< As files of `PointCloudWriter` with reflectivity and without colours.
  double las_bytes = 0;  ///< The same as LAS.
};

/// A network and its figures: by every ray, or estimated from a sample of the voxels.
struct Evaluation {
  std::vector<PlacedStation> stations = {};  ///< Existing ones first, skipped ones included.
  /// The user's names, one each, or none. `station_names()` of both are those to show.
  std::vector<std::string> names = {};
  bool exact = false;        ///< Measured with every ray. False: estimated from a sample, or not known yet.
  std::uint64_t voxels = 0;  ///< N_v of the site; `counts.voxels` of them were counted.
  double goal_density = 1;   ///< Points wanted in a voxel.
  /// Counts. `groups` and `registration` are left out: the figures below are made of them.
  NetworkCounts counts = {};
  Work work = {};         ///< Work of the call that made it, including the other networks of that call.
  VoxelField field = {};  ///< Points of every voxel, if they were asked for.
  /// Figures by the names of their measures, e.g. "coverage", in the measures' units. NaN: not known.
  std::map<std::string, Estimate> values = {};
  /// Attainable coverage, if it is known; `capture` is a share of it.
  std::optional<Estimate> attainable = std::nullopt;
  /// Share by which it grew with the last doubling of the positions that were looked at: its error from the rest. 1:
  /// there was no doubling, 0: every allowed position was looked at.
  std::optional<double> attainable_growth = std::nullopt;
  OverlapMatrix overlap_matrix = {};           ///< Equation 11; empty: pairs were not counted.
  PairMatrix overlap_errors = {};              ///< Their standard errors; empty for exact ones.
  ScanOverlapMatrix scan_overlap_matrix = {};  ///< On all surfaces, surveyed or not; empty: not computed.
  /// The same with all that is seen through glass, of a sample; it links nothing. Empty unless the scans have several
  /// components in a scene with glass.
  ScanOverlapMatrix through_glass = {};
  double link_overlap = default_link_overlap;                    ///< Least overlap of a link,
  double link = default_link;                                    ///< or least scan overlap, if that is known.
  std::optional<RegistrationError> registration = std::nullopt;  ///< Predicted, if it was asked for; by `targets` too.
  /// Text on what a calibration leaves, as the stations' scanners state it: "18″, 1 mm and 10 ppm". Empty: none
  /// states it, or the registration error was not asked for.
  std::string calibration = {};
  std::vector<Target> targets = {};  ///< Given and proposed, with the stations that measure each; places of checks.
  /// Instruments whose errors are most of the registration error, and that no place would check (`Target::check`).
  std::vector<std::string> no_steep_check = {};
  /// Root mean square registration error by surfaces alone, metres; known if there are targets, or were looked for.
  std::optional<double> without_targets_m = std::nullopt;
  std::optional<ScanData> data = std::nullopt;          ///< Empty: not known, without the surroundings or every ray.
  AccuracyClass accuracy_class = AccuracyClass::loa30;  ///< Judges the registration error.
  std::optional<Visit> visit = std::nullopt;            ///< The round on site without existing stations.
  std::vector<StoreyTie> storey_ties = {};  ///< `storey_ties_of()` this network; empty: none, or not looked for.
  /// For stations that do not stand well, in their order: the nearest places that may hold them, if these were looked
  /// for (`EvaluationSite::area`). Existing stations and those without ground have none.
  std::vector<StationMove> moves = {};
  /// Sum of the violations of requirements, as shares of their objectives' scales; 0: all are met.
  double violation = 0;

  /// Throws Error invalid_argument for a measure that was not requested, and suggests one of those that were.
  double value(const std::string& measure) const { return estimate(measure).value; }
  const Estimate& estimate(const std::string& measure) const;  ///< The same with its standard error.
  /// Links by scan overlap if known, otherwise by overlap; empty if neither is.
  std::optional<StationLinks> links() const;
};

/// The round over a network's stations besides existing ones, which come first in it, along the links if they are
/// known. `most_min` as in `OnSite::visit()`.
Visit visit_of(std::span<const PlacedStation> stations, const std::optional<StationLinks>& links, const OnSite& on_site,
               double most_min = std::numeric_limits<double>::infinity());
/// Links between heights that differ by a storey, 1.8 m or more, without which the network falls into more components,
/// as far as a way on foot exists that is longer than 15 m, and than 1.5 times the line between the heads. Links
/// along shorter ways are preferred to them, then links of larger values. Empty if links are not known.
std::vector<StoreyTie> storey_ties_of(const Evaluation& evaluation, const OnSite& on_site);
/// Splits the evaluation's round into sessions, if `OnSiteOptions` have a day. Two stations that existing ones link
/// count as linked. `Visit::not_split` tells why `OnSite::sessions()` refused; `Visit::closed` lists stations whose
/// access windows no session keeps.
void add_sessions(Evaluation& evaluation, const OnSite& on_site);
/// Stations that no session can scan within the access windows of their rooms.
std::size_t closed_stations(const Evaluation& evaluation);
/// Minutes that the requirements allow on site; infinity if they set no limit.
double most_minutes(std::span<const Requirement> requirements);
/// Sum of the requirements' violations. REQUIRES: values of their objectives.
double violation_of(const Evaluation& evaluation, std::span<const Requirement> requirements);

/// Extent of an evaluation: counts, measures, errors.
struct EvaluationOptions {
  std::optional<std::uint64_t> sample_voxels = {};  ///< Size of the sample of voxels; empty: every ray.
  bool overlap = true;  ///< Count pairs of stations; without them only coverage is measured.
  bool skip = true;     ///< Leave out rays that cannot reach a surveyed voxel; `NetworkCounts::points` is empty then.
  bool field = false;   ///< Keep the points of every voxel. Takes every ray.
  /// Gives beams a width in surveyed voxels; `surroundings` keep rays without one. Takes every ray, and no
  /// `attainable`.
  std::optional<BeamOptions> beam = std::nullopt;
  std::vector<Objective> measures = {};                            ///< Measures besides coverage and overlap.
  std::vector<Requirement> requirements = {};                      ///< Their objectives are measured too.
  std::optional<RegistrationOptions> registration = std::nullopt;  ///< Predict the error of the registered scans.
  /// Voxels that the error is predicted from if every ray is traced: `every_voxel`, or a sample. 0: a sample that grows
  /// until the error is known to 2 % or to 0.02 mm, as one standard error.
  std::uint64_t registration_voxels = 0;
  std::vector<Target> targets = {};  ///< Targets and control points that tie scans together, for `registration`.
  TargetOptions target = {};         ///< Needs of a scan that measures a target.
  /// Measures `capture` too. The evaluated stations raise these counts where one alone sees more. Null: not.
  const AttainableCounts* attainable = nullptr;
  std::optional<double> attainable_growth = std::nullopt;           ///< As in `Evaluation`, of these counts.
  double link_overlap = default_link_overlap, link = default_link;  ///< As in `Evaluation`.
  std::vector<std::string> names = {};                              ///< The stations' names, one each, or none.
};

}  // namespace vantage
