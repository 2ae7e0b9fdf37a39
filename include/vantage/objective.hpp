// SPDX-License-Identifier: Apache-2.0
/// Measures of a network: objectives to search for and requirements to meet, as lists that a program can extend.
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "vantage/measure.hpp"
#include "vantage/placement.hpp"

namespace vantage {

/// Everything that an objective may use of one network. Refers to counts and stations; valid during the call.
struct MeasuredNetwork {
  const NetworkCounts& counts;              ///< Exact, or on a sample of the voxels.
  std::span<const PlacedStation> stations;  ///< N_stations of them, existing ones first, skipped ones included.
  std::size_t existing = 0;                 ///< Number of existing stations.
  double goal_density = 1;                  ///< Points wanted in a voxel.
  std::uint64_t voxels = 0;                 ///< N_v of the site; `counts.voxels` of them were counted.
  OverlapMatrix overlap = {};               ///< Equation 11, by `overlap_matrix()`; empty if no objective needs pairs.
  /// Connected components of the graph of stations that see each other within range; 0 if no objective needs
  /// visibility.
  std::size_t visible_parts = 0;
  /// Counts on all surfaces, surveyed or not, by the coarser simulator of `surroundings_of()`, with pairs. Null if no
  /// objective needs them. `surroundings_voxels`: the number of its voxels.
  const NetworkCounts* surroundings = nullptr;
  std::uint64_t surroundings_voxels = 0;  ///< See `surroundings`.
  double minutes_on_site = 0;             ///< Found by `OnSite`, without existing stations; 0 if no objective needs it.
  /// Share of what is attainable that the network captures (vantage/attainable.hpp); NaN if no objective needs it.
  Estimate captured = {std::numeric_limits<double>::quiet_NaN(), 0};
  const Scene* scene = nullptr;  ///< The surveyed scene, for `captured()`.
  /// The same share of the meshes of each pattern that objectives name (`Objective::meshes`).
  std::map<std::string, Estimate> captured_of_meshes = {};
};

/// Inputs of an objective besides the stations. Inputs that no objective needs are not computed.
struct RequiredInputs {
  bool counts = true;         ///< `MeasuredNetwork::counts`. False: positions alone decide, so no ray is traced for it.
  bool pairs = false;         ///< `NetworkCounts::seen` and `shared`, and `MeasuredNetwork::overlap`.
  bool visibility = false;    ///< `MeasuredNetwork::visible_parts`.
  bool surroundings = false;  ///< `MeasuredNetwork::surroundings`.
  bool time = false;          ///< `MeasuredNetwork::minutes_on_site`.
  /// `NetworkCounts::registration`, and with it `pairs`. Measures taken together share one model.
  std::optional<RegistrationModel> registration = std::nullopt;
  bool surroundings_registration = false;  ///< That of `MeasuredNetwork::surroundings` too, by the same model.
  /// `MeasuredNetwork::captured`, and with it `ObjectiveSettings::attainable`: a search makes the objective anew once
  /// that is known.
  bool attainable = false;
  bool meshes = false;  ///< `NetworkCounts::meshes`, for `captured()`.
};
/// Inputs of both; the registration model of the first that has one.
constexpr RequiredInputs operator|(const RequiredInputs& a, const RequiredInputs& b) {
  return {a.counts || b.counts,
          a.pairs || b.pairs,
          a.visibility || b.visibility,
          a.surroundings || b.surroundings,
          a.time || b.time,
          a.registration ? a.registration : b.registration,
          a.surroundings_registration || b.surroundings_registration,
          a.attainable || b.attainable,
          a.meshes || b.meshes};
}

/// Share of voxels that reached their goal density, of surveyed meshes whose name matches a pattern: a shell glob as
/// "facade*" or "*", several with "|" between them, or with "!" before them for all other meshes.
/// Each voxel counts once, whatever its weight. 0 if a sample holds none of theirs.
/// Throws Error invalid_argument if no surveyed mesh has such a name, or unless the objective needs `meshes`.
double captured(const MeasuredNetwork& network, std::string_view meshes);
/// The same of counts in `scene`. REQUIRES: `counts.meshes`, of that scene.
double captured(const NetworkCounts& counts, const Scene& scene, std::string_view meshes);

/// The relevant range of an objective's values, in its unit, made by `minimise` or `maximise`. The search minimises
/// (best − value) / (best − worst). `worst` is the reference point of the hypervolume. Values beyond either end are
/// allowed.
struct Scale {
  double best = std::numeric_limits<double>::quiet_NaN(), worst = best;  ///< Its ends; NaN: not given.
  bool given() const { return !std::isnan(best); }                       ///< True if it has ends.
  double width() const { return std::abs(best - worst); }                ///< Distance of its ends, at least 0.
};
/// A scale on which less is better. Throws Error invalid_argument unless best <= worst, both finite.
Scale minimise(double best, double worst);
/// A scale on which more is better. Throws Error invalid_argument unless best >= worst, both finite.
Scale maximise(double best, double worst);

/// One measure of a network, to be searched for, required or reported. A program's own objective needs no change of the
/// library, only a name, a scale and a value (examples/own_objective.cpp). `plan` refuses one that lacks any of them.
struct Objective {
  /// "coverage": its key in tables, JSON and options. Lower-case letters, digits, `_`; unique.
  std::string name = {};
  std::string label = {};     ///< Text for axes: "Overlap (average clustering coefficient)".
  std::string unit = {};      ///< "mm"; empty: a plain number.
  std::string noun = {};      ///< In sentences: "registration error"; empty: the name.
  bool percent = false;       ///< Sentences show a value of 1 as 100 %.
  Scale scale = {};           ///< E.g. `minimise(0, 10)` for millimetres, `maximise(1, 0)` for a share.
  RequiredInputs needs = {};  ///< Inputs that `value` reads.
  /// Computes the value. Called from several threads at once. Must be a pure function.
  std::function<double(const MeasuredNetwork&)> value = {};
  /// Standard error of `value` on a sample; empty: computed from the sample's groups (docs/method.md).
  std::function<double(const MeasuredNetwork&)> standard_error = {};
  /// For the number of stations alone. If the number is searched, the search minimises the decision variable α of
  /// equation 7 instead, which has no steps.
  bool by_alpha = false;
  /// Kinds of limits that a choice of stations among candidates, before a search for few stations, can use. The search
  /// handles limits of every kind; the choice knows those on coverage, links, distances and time.
  enum class Kind {
    other,     ///< The choice does not know it.
    coverage,  ///< A share of the surface.
    link,      ///< The weakest link of the maximum spanning tree.
    distance,  ///< The least distance between two stations.
    time,      ///< Minutes on site.
  };
  Kind kind = Kind::other;     ///< The kind of this one.
  double coverage_of_one = 1;  ///< The coverage (equation 8) that a value of 1 has at least, for `Kind::coverage`.
  /// Pattern of the surveyed meshes, as of `captured()`, of which the value is the share of what is attainable; empty:
  /// it is no share of some meshes. REQUIRES: `needs.attainable` if not empty.
  std::string meshes = {};
  /// Advice if a requirement on it is not met: "allow more stations".
  std::string advice = "search longer";
  /// Its parameters as text. Results state them, and a run is resumed only under the same ones.
  std::string parameters = {};

  /// 0 at the scale's best, 1 at its worst; 0 if they are equal.
  double scaled(double measured) const {
    return scale.width() == 0 ? 0 : (scale.best - measured) / (scale.best - scale.worst);
  }
  /// Inverse of `scaled`.
  double unscaled(double f) const;
  bool maximised() const { return scale.best > scale.worst; }  ///< True if more is better.
};

/// Union of their inputs.
RequiredInputs required_inputs_of(std::span<const Objective> objectives);

/// Value and standard error of an objective; the error is 0 if all voxels were counted, or if none matter.
Estimate estimate(const Objective& objective, const MeasuredNetwork& measured);

/// A bound on an objective: `coverage >= 0.9`. In a search, networks that violate one rank behind all that do not, by
/// their violation.
struct Requirement {
  /// Side on which the limit lies.
  enum class Bound {
    at_least,  ///< `>=`
    at_most,   ///< `<=`
  };
  Objective objective;            ///< Measure that is bounded.
  Bound bound = Bound::at_least;  ///< Its side.
  double limit = 0;               ///< In the unit of the objective.
  /// Violation as a share of the objective's scale; 0 if the bound holds, infinity for NaN. A share of what is
  /// attainable holds from half of the last digit that is printed (0.05 %), since it is not known any better.
  double missed_by(double measured) const;
  /// The same of an estimate: a share of what is attainable holds within its standard error, too.
  double missed_by(const Estimate& measured) const;
};
std::string to_string(const Requirement&);               ///< "coverage >= 0.9"
std::string value_text(const Objective&, double value);  ///< "85.3 %", "12.000 mm"; NaN: "not known".
/// The same with as many digits as it takes to differ from the limit of a requirement.
std::string value_text(const Requirement&, double value);
std::string in_words(const Requirement&);  ///< "share of the site captured at least 90 %"
/// A sentence for a violated requirement: "not met: share of the site captured at least 90 %, it has 85.3 %; allow more
/// stations, or ask for less". `measured`: the network's value; NaN: not known. `ended_early`: the time was over first.
std::string advice(const Requirement& requirement, double measured, bool ended_early = false);

/// Equation 7: rounded(N_min + α (N_max − N_min)), half up, α clamped to [0, 1].
std::size_t station_count_from_alpha(double alpha, std::size_t n_min, std::size_t n_max);

/// λ1 coverage + λ2 Φ + λ3 Δ (equation 1, with section 5.1.2's Φ). Φ = 2^((N_max − N)/(N_max − N_min)) − 1, and Δ = 1 /
/// connected components of the graph of stations that see each other within range. A baseline.
struct FitnessWeights {
  double coverage = 0.4, station_count = 0.4, visibility = 0.2;  ///< λ1, λ2 and λ3.
};

/// Parameters of the built-in objectives.
struct ObjectiveSettings {
  std::size_t stations_min = 1, stations_max = max_stations;  ///< N_min and N_max, without existing stations.
  double link_overlap = default_link_overlap;                 ///< `parts`: least overlap of a link.
  FitnessWeights fitness = {};                                ///< `fitness`: its weights.
  RegistrationOptions registration = {};                      ///< `registration`, `registration_worst`.
  double attainable = 1;  ///< `capture`: attainable coverage, which a capture of 1 has at least.
};
/// Names of the built-in objectives: "coverage", "overlap", "stations", ….
std::span<const std::string> objective_names();
/// A built-in objective by its name, or `capture(MESHES)`: the share of what is attainable that is captured of the
/// surveyed meshes of a pattern, as of `captured()`. Throws Error invalid_argument and lists the names.
Objective make_objective(std::string_view name, const ObjectiveSettings& settings = {});
/// "coverage>=0.9", "stations <= 8" or "capture(IfcWall*)>=0.95". Throws Error invalid_argument.
Requirement make_requirement(std::string_view text, const ObjectiveSettings& settings = {});

}  // namespace vantage
