// SPDX-License-Identifier: Apache-2.0
/// One evaluated network: stations in, all that is known of them out. Plans, reports, pictures and tables show it.
#pragma once

#include <cstddef>
#include <cstdint>
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

namespace vantage {

/// What stations are called in every table and picture: "S1", "S2", … in their order, and "K1", "K2", … those that were
/// there before, each counted from 1. `given`: names of their owner's, an entry a station or none at all; an empty one
/// leaves the station its number's name. Where two would have one name, the later is told apart by its number among
/// all: "P1 (3)".
std::vector<std::string> station_names(std::span<const PlacedStation> stations,
                                       std::span<const std::string> given = {});

/// The stations as a simulator takes them.
Network to_network(std::span<const PlacedStation> stations);

/// What two stations are linked by.
enum class LinkMeasure {
  overlap,       ///< Equation 11, on surveyed voxels.
  scan_overlap,  ///< The share of the smaller scan, on all surfaces.
};
std::string to_string(LinkMeasure);  ///< "overlap", "scan overlap"

/// How the active stations of a network are linked. Stations by their place in it, from 0.
struct StationLinks {
  LinkMeasure measure = LinkMeasure::overlap;
  double least = 0;                                  ///< Pairs of this value or more are linked; of 0 never.
  PairMatrix values = {};                            ///< Of all stations.
  std::vector<std::vector<std::size_t>> parts = {};  ///< Connected components, the largest first.
  /// The weakest link of the strongest spanning tree, if there is one component of several stations.
  std::optional<std::pair<std::size_t, std::size_t>> weakest = std::nullopt;
  double weakest_value = 0;
  /// For each component but the first, its best pair with a station outside of it.
  struct Gap {
    std::size_t inside = 0, outside = 0;
    double value = 0;
  };
  std::vector<Gap> gaps = {};
};
StationLinks station_links(const OverlapMatrix& overlap, double least, std::span<const PlacedStation> stations);
StationLinks station_links(const ScanOverlapMatrix& overlap, double least, std::span<const PlacedStation> stations);

/// A network and what is known of it: by every ray, or estimated from a sample of the voxels.
struct Evaluation {
  std::vector<PlacedStation> stations = {};  ///< Existing ones first, skipped ones included.
  /// As their owner calls them, one each, or none. `station_names()` of both are those to show.
  std::vector<std::string> names = {};
  bool exact = false;        ///< Measured with every ray. False: estimated from a sample, or not known yet.
  std::uint64_t voxels = 0;  ///< N_v of the site; `counts.voxels` of them were counted.
  double goal_density = 1;   ///< Points wanted in a voxel.
  /// What was counted. `groups` and `registration` are left out: the figures below are made of them.
  NetworkCounts counts = {};
  VoxelField field = {};  ///< Points of every voxel, if they were asked for.
  /// Figures by the names of their measures, as "coverage", in the measures' units. NaN: not known.
  std::map<std::string, Estimate> values = {};
  /// Coverage that heads on all allowed positions together would reach, if it is known; `capture` is a share of it.
  std::optional<Estimate> attainable = std::nullopt;
  OverlapMatrix overlap_matrix = {};           ///< Equation 11; empty: pairs were not counted.
  PairMatrix overlap_errors = {};              ///< Standard errors of that; empty for exact ones.
  ScanOverlapMatrix scan_overlap_matrix = {};  ///< On all surfaces, surveyed or not; empty: not looked at.
  double link_overlap = default_link_overlap;  ///< Stations of at least this overlap are linked,
  double link = default_link;                  ///< or of at least this scan overlap, where that is known.
  std::optional<RegistrationError> registration = std::nullopt;  ///< Predicted, if it was asked for.
  std::optional<Visit> visit = std::nullopt;                     ///< The round on site without existing stations.
  /// How far requirements are violated in all, as shares of their objectives' scales; 0: all are kept.
  double violation = 0;

  /// Throws std::out_of_range for a measure that was not asked for.
  double value(const std::string& measure) const { return values.at(measure).value; }
  /// By scan overlap where it is known, otherwise by overlap; empty if neither is.
  std::optional<StationLinks> links() const;
};

/// What counts say of a network that was measured already: values of the measures with standard errors, overlaps, and
/// the registration error if `registration` is given. Links, attainable coverage and the round are left to the caller.
/// REQUIRES: counts of all that measures and registration look at.
Evaluation evaluation_of(const MeasuredNetwork& measured, std::span<const Objective> measures,
                         const std::optional<RegistrationOptions>& registration = std::nullopt);
/// Sum of the requirements' violations. REQUIRES: values of their objectives.
double violation_of(const Evaluation& evaluation, std::span<const Requirement> requirements);

/// What a network is evaluated on. Borrows all of it.
struct EvaluationSite {
  Simulator& simulator;
  Simulator* surroundings = nullptr;    ///< `surroundings_of(simulator)`: for scan overlaps. Null: none.
  const OnSite* on_site = nullptr;      ///< For rounds on site. Null: none.
  const ClashChecker* clash = nullptr;  ///< For measures of which stations see each other. Null: none of these.
};

struct EvaluationOptions {
  std::uint64_t sample_voxels = 0;  ///< 0: every ray.
  bool overlap = true;              ///< Count pairs of stations; without them coverage alone is measured.
  bool skip = true;    ///< Leave out rays that cannot reach a surveyed voxel; `NetworkCounts::points` is empty then.
  bool field = false;  ///< Keep the points of every voxel. Takes every ray.
  std::vector<Objective> measures = {};                            ///< What to measure besides coverage and overlap.
  std::vector<Requirement> requirements = {};                      ///< Their objectives are measured too.
  std::optional<RegistrationOptions> registration = std::nullopt;  ///< Predict the error of the registered scans.
  std::optional<Estimate> attainable = std::nullopt;  ///< Measures `capture` too, as a share of this coverage.
  double link_overlap = default_link_overlap, link = default_link;  ///< As in `Evaluation`.
  std::vector<std::string> names = {};                              ///< Of the stations, one each, or none.
};

/// Evaluates a network. Scan overlaps take every ray of the coarser `surroundings`, sampled or not. A cancelled
/// evaluation says so in `counts.cancelled` and has no values. Throws Error invalid_argument: a measure that takes what
/// `site` lacks, registration without overlap, the field of a sample, and what the simulator throws.
Evaluation evaluate_stations(const EvaluationSite& site, std::span<const PlacedStation> stations,
                             const EvaluationOptions& options = {}, const Progress& progress = {});
/// The same for several networks at a time, on one sample if they are sampled. Throws as above, and for a field.
std::vector<Evaluation> evaluate_networks(const EvaluationSite& site,
                                          std::span<const std::vector<PlacedStation>> networks,
                                          const EvaluationOptions& options = {}, const Progress& progress = {});

}  // namespace vantage
