// SPDX-License-Identifier: Apache-2.0
/// What a network is searched for and judged by: objectives and requirements, as lists that anybody can add to.
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "vantage/measure.hpp"
#include "vantage/placement.hpp"

namespace vantage {

/// What was measured of one network: all that an objective looks at. Refers to counts and stations; lives for the call.
struct MeasuredNetwork {
  const NetworkCounts& counts;              ///< Of every ray, or of a sample of the voxels.
  std::span<const PlacedStation> stations;  ///< N_stations of them, kept ones first, skipped ones included.
  std::size_t kept = 0;                     ///< How many of them were there before.
  double goal_density = 1;                  ///< Points wanted in a voxel.
  std::uint64_t voxels = 0;                 ///< N_v of the site; `counts.voxels` of them were counted.
  OverlapMatrix overlap = {};               ///< Equation 11, by `overlap_matrix()`; empty where none needs pairs.
  /// Connected parts of the graph of stations that see each other within range; 0 where no objective needs visibility.
  std::size_t visible_parts = 0;
  /// What the stations left on all surfaces, surveyed or not, by the coarser simulator of `surroundings_of()`: pairs
  /// with it. Null where no objective needs it. `surroundings_voxels`: how many voxels that has in all.
  const NetworkCounts* surroundings = nullptr;
  std::uint64_t surroundings_voxels = 0;
  double minutes_on_site = 0;  ///< By `OnSite`, without kept stations; 0 where no objective needs it.
};

/// What an objective looks at besides the stations. What nobody needs is not computed.
struct RequiredInputs {
  bool counts = true;         ///< `MeasuredNetwork::counts`. False: of places alone, so no ray is traced for it.
  bool pairs = false;         ///< `NetworkCounts::seen` and `shared`, and `MeasuredNetwork::overlap`.
  bool visibility = false;    ///< `MeasuredNetwork::visible_parts`.
  bool surroundings = false;  ///< `MeasuredNetwork::surroundings`.
  bool time = false;          ///< `MeasuredNetwork::minutes_on_site`.
  /// `NetworkCounts::registration`, and with it `pairs`. What is measured together has one model.
  std::optional<RegistrationModel> registration = std::nullopt;
  bool surroundings_registration = false;  ///< That of `MeasuredNetwork::surroundings` too, by the same model.
  bool attainable = false;                 ///< `ObjectiveSettings::visible`: a search makes it anew once that is known.
};
constexpr RequiredInputs operator|(const RequiredInputs& a, const RequiredInputs& b) {
  return {a.counts || b.counts,
          a.pairs || b.pairs,
          a.visibility || b.visibility,
          a.surroundings || b.surroundings,
          a.time || b.time,
          a.registration ? a.registration : b.registration,
          a.surroundings_registration || b.surroundings_registration,
          a.attainable || b.attainable};
}

/// The range of values that matter of an objective, in its unit, made by `minimise` or `maximise`. The search minimises
/// (best − value) / (best − worst), and the hypervolume is measured against `worst`, its reference point. Values beyond
/// either end are allowed.
struct Scale {
  double best = std::numeric_limits<double>::quiet_NaN(), worst = best;
  bool given() const { return !std::isnan(best); }
  double width() const { return std::abs(best - worst); }
};
/// Less is better. Throws Error invalid_argument unless best <= worst, both finite.
Scale minimise(double best, double worst);
/// More is better. Throws Error invalid_argument unless best >= worst, both finite.
Scale maximise(double best, double worst);

/// One measure of a network, to be searched for, required or reported. A program's own needs no change of the library:
/// give it a name, a scale and a value (examples/own_objective.cpp). `plan` refuses one that lacks any of them.
struct Objective {
  /// "coverage": its key in tables, JSON and options. Lower-case letters, digits, `_`; unique.
  std::string name = {};
  std::string label = {};  ///< For axes: "Overlap (average clustering coefficient)".
  std::string unit = {};   ///< "mm"; empty: a plain number.
  Scale scale = {};        ///< `minimise(0, 10)` of millimetres, `maximise(1, 0)` of a share.
  RequiredInputs needs = {};
  /// Of what was measured. Called from several threads at once. Must give the same for the same.
  std::function<double(const MeasuredNetwork&)> value = {};
  /// Standard error of `value` where a sample was counted; empty: as docs/method.md has it, from the sample's groups.
  std::function<double(const MeasuredNetwork&)> standard_error = {};
  /// For the number of stations alone: where it is searched, the search minimises the decision variable α of equation 7
  /// in its place, which has no steps.
  bool by_alpha = false;
  /// What a limit on it is to a choice of stations among candidates, which comes before a search for few stations. The
  /// search keeps limits of every kind; the choice knows those on coverage, links, distances and time.
  enum class Kind { other, coverage, link, distance, time };
  Kind kind = Kind::other;
  double coverage_of_one = 1;  ///< The coverage (equation 8) that a value of 1 is, for `Kind::coverage`.
  /// What helps where a limit on it is not kept, after "to keep it, ": "allow more stations".
  std::string advice = "search longer";
  /// What it was made with, as text: a run is resumed only under the same, and results tell it.
  std::string parameters = {};

  /// 0 at the scale's best, 1 at its worst; 0 if they are equal.
  double scaled(double measured) const {
    return scale.width() == 0 ? 0 : (scale.best - measured) / (scale.best - scale.worst);
  }
  /// The value of a scaled one.
  double unscaled(double f) const;
  bool maximised() const { return scale.best > scale.worst; }
};

/// What all of them look at together.
RequiredInputs required_inputs_of(std::span<const Objective> objectives);

/// Value and standard error of an objective; the error is 0 where all voxels were counted, or none matter.
Estimate estimate(const Objective& objective, const MeasuredNetwork& measured);

/// A bound that a wanted network keeps: `coverage >= 0.9`. In a search, networks that break one rank behind all that do
/// not, by how much.
struct Requirement {
  enum class Bound { at_least, at_most };
  Objective objective;
  Bound bound = Bound::at_least;
  double limit = 0;
  /// By how much a value misses the limit, as a share of the objective's scale; 0 where it is met, infinity for NaN.
  double missed_by(double measured) const;
};
std::string to_string(const Requirement&);  ///< "coverage >= 0.9"
/// A sentence for a requirement that is not kept: "misses coverage >= 0.9: it has 0.853; to keep it, allow more
/// stations, or ask for less". `measured`: the network's value; NaN: not known.
std::string advice(const Requirement& requirement, double measured);

/// Equation 7: rounded(N_min + α (N_max − N_min)), half up, α clamped to [0, 1].
std::size_t station_count_from_alpha(double alpha, std::size_t n_min, std::size_t n_max);

/// λ1 coverage + λ2 Φ + λ3 Δ (equation 1, with section 5.1.2's Φ): Φ = 2^((N_max − N)/(N_max − N_min)) − 1, and Δ = 1 /
/// connected parts of the graph of stations that see each other within range. A baseline.
struct FitnessWeights {
  double coverage = 0.4, station_count = 0.4, visibility = 0.2;
};

/// What the built-in objectives have to be told.
struct ObjectiveSettings {
  std::size_t stations_min = 1, stations_max = max_stations;  ///< N_min and N_max, without kept stations.
  double link_overlap = default_link_overlap;                 ///< `parts`: pairs of less overlap are not linked.
  FitnessWeights fitness = {};
  RegistrationOptions registration = {};  ///< `registration`, `registration_worst`.
  double visible = 1;                     ///< `capture`: the coverage that all allowed positions together would reach.
};
/// Names of the built-in objectives, as "coverage", "overlap", "stations".
std::span<const std::string> objective_names();
/// A built-in objective by its name. Throws Error invalid_argument and lists the names.
Objective make_objective(std::string_view name, const ObjectiveSettings& settings = {});
/// "coverage>=0.9" or "stations <= 8". Throws Error invalid_argument.
Requirement make_requirement(std::string_view text, const ObjectiveSettings& settings = {});

}  // namespace vantage
