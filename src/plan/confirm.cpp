// SPDX-License-Identifier: Apache-2.0
#include "plan/confirm.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <optional>
#include <set>
#include <utility>

#include "core/seconds_since.hpp"
#include "evaluate/evaluator.hpp"
#include "plan/answer.hpp"
#include "plan/limits.hpp"
#include "search/scaled_objectives.hpp"

namespace vantage {
namespace {

constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();
// Standard errors of the difference by which one network must be better, so that the other need not be confirmed. The
// difference is known even better, since both were counted on the same voxels.
constexpr double kBeyondDoubt = 3;

// Takes the objectives that the optimiser kept of a network; none if it violates a requirement.
void take_objectives(PlanEntry& entry, const ParetoPoint& point, const SurveyProblem& problem) {
  for (std::size_t k = 0; k < problem.objectives.size(); ++k) {
    const Objective& objective = problem.objectives[k];
    if (point.f[k] <= 1) entry.searched.at(objective.name).value = objective.unscaled(point.f[k]);
    if (objective.by_alpha) entry.searched.at(objective.name).value = static_cast<double>(entry.stations.size());
  }
}

// Takes the values that follow from positions alone, which no stop leaves unknown.
void take_by_positions(PlanEntry& entry, const SurveyProblem& problem, const Measures& measures) {
  const NetworkCounts none;
  for (const Objective& measure : measures.all) {
    const RequiredInputs& needs = measure.needs;
    if (needs.counts || needs.pairs || needs.visibility || needs.surroundings || needs.time || needs.registration ||
        needs.surroundings_registration || needs.attainable || needs.meshes)
      continue;
    entry.searched.at(measure.name).value =
        measure.value({.counts = none, .stations = entry.stations, .existing = problem.existing.size()});
  }
}

std::vector<double> best_known(const PlanEntry& entry, const Measures& measures) {
  std::vector<double> values;
  for (const Objective& measure : measures.all) values.push_back(entry.value(measure.name));
  return values;
}

// Sorted by the objectives in order, then by x. Unknown values come last, or the order would be none.
bool comes_before(const PlanEntry& a, const PlanEntry& b, const Measures& measures) {
  for (const Objective& measure : measures.all) {
    const auto cost = [&](const PlanEntry& entry) {
      const double value = entry.searched.at(measure.name).value;
      return value == value ? (measure.maximised() ? -value : value) : std::numeric_limits<double>::infinity();
    };
    if (cost(a) != cost(b)) return cost(a) < cost(b);
  }
  return a.x < b.x;
}

// Scaled objectives of each entry from its best known values, row-major.
std::vector<double> scaled_rows(std::span<const PlanEntry> entries, const SurveyProblem& problem,
                                const Measures& measures) {
  const std::size_t m = problem.objectives.size();
  std::vector<double> scaled(entries.size() * m);
  for (std::size_t k = 0; k < entries.size(); ++k) {
    const std::vector<double> values = best_known(entries[k], measures);
    scale_objectives(problem, entries[k].x, values, missed_by(problem, measures, values),
                     std::span(scaled).subspan(k * m, m));
  }
  return scaled;
}

// Marks entries that another one beats in all objectives beyond doubt.
std::vector<bool> beaten(std::span<const PlanEntry> entries, const SurveyProblem& problem, const Measures& measures) {
  const std::size_t m = problem.objectives.size();
  const std::vector<double> scaled = scaled_rows(entries, problem, measures);
  std::vector<double> errors(entries.size() * m);
  for (std::size_t k = 0; k < entries.size(); ++k) {
    for (std::size_t j = 0; j < m; ++j) {
      const Objective& objective = problem.objectives[j];
      const double scale = objective.scale.width();
      if (!objective.by_alpha && scale > 0)
        errors[k * m + j] = entries[k].searched.at(objective.name).standard_error / scale;
    }
  }
  const auto beats = [&](std::size_t a, std::size_t b) {
    bool better = false;
    for (std::size_t j = 0; j < m; ++j) {
      const double ahead = scaled[b * m + j] - scaled[a * m + j];
      if (!(ahead >= kBeyondDoubt * std::hypot(errors[a * m + j], errors[b * m + j]))) return false;
      better |= ahead > 0;
    }
    return better;
  };
  std::vector<bool> found(entries.size());
  for (std::size_t b = 0; b < entries.size(); ++b)
    for (std::size_t a = 0; a < entries.size() && !found[b]; ++a) found[b] = beats(a, b);
  return found;
}

// Removes the marked elements.
template <class T>
void erase_said(std::vector<T>& all, const std::vector<bool>& said) {
  std::size_t k = 0;
  std::erase_if(all, [&](const T&) { return said[k++]; });
}

std::vector<PlacedNetwork> networks_of(std::span<const PlanEntry> entries) {
  std::vector<PlacedNetwork> networks;
  for (const PlanEntry& entry : entries) networks.push_back(entry.stations);
  return networks;
}

// The front as entries, with what the search kept of them.
std::vector<PlanEntry> searched_entries(const SearchOutcome& found, const DecisionSpace& space,
                                        const SurveyProblem& problem, const Measures& measures) {
  std::vector<PlanEntry> entries;
  const EvaluationOptions options = evaluation_options(problem);
  for (const ParetoPoint& point : found.front) {
    PlanEntry& entry = entries.emplace_back();
    entry.x = point.x;
    entry.stations = space.decode(point.x);
    take_options(entry, options);
    for (const Objective& measure : measures.all) entry.searched[measure.name] = {kUnknown, 0};
    take_objectives(entry, point, problem);
    take_by_positions(entry, problem, measures);
    entry.values = entry.searched;
  }
  return entries;
}

// Estimates the entries of a sampled search again, which kept no standard errors, and no measures that are no
// objectives. The same sample is drawn again. Returns false if it was stopped.
bool estimate_again(std::vector<PlanEntry>& entries, const SearchOutcome& found, std::uint64_t sample_voxels,
                    const Measures& measures, NetworkEvaluator& evaluator, const std::stop_token& stop) {
  const VoxelWindow sample = found.sample.voxels > 0 ? found.sample : VoxelWindow{sample_voxels};
  const auto estimates = evaluator.estimate(networks_of(entries), sample, NetworkEvaluator::Which::all, {.stop = stop});
  if (!estimates) return false;
  for (std::size_t k = 0; k < entries.size(); ++k) {
    for (std::size_t m = 0; m < measures.all.size(); ++m) {
      const bool pooled = k < found.estimates.size() && m < measures.searched;
      entries[k].searched.at(measures.all[m].name) = pooled ? found.estimates[k][m] : (*estimates)[k][m];
    }
    entries[k].values = entries[k].searched;
  }
  return true;
}

// Tells about the confirmation of a front's networks: `done` whole ones, and a part of the next.
class ConfirmReport {
 public:
  ConfirmReport(const PlanWatch& watch, const SearchOutcome& found, std::size_t networks)
      : watch_(watch), found_(found), networks_(networks) {}

  double seconds() const { return seconds_since(start_); }
  void operator()(double done) const {
    if (!watch_.report) return;
    constexpr double kRounding = 1e-9;
    const auto whole = static_cast<std::size_t>(done + kRounding);
    const double rate = seconds() > 0 ? done / seconds() : 0;
    // The times of stations differ severalfold, and an engine may trace those of the first network along with others. A
    // part of it tells nothing yet about the whole.
    const bool telling = rate > 0 && (whole > 0 || networks_ == 1);
    watch_.report({.iteration = whole,
                   .iterations = networks_,
                   .evaluations = found_.evaluations,
                   .hypervolume = found_.hypervolume,
                   .evaluations_per_second = rate,
                   .seconds_left = telling ? (static_cast<double>(networks_) - done) / rate : -1,
                   .phase = "confirm",
                   .done = done / static_cast<double>(std::max<std::size_t>(networks_, 1))});
  }

 private:
  const PlanWatch& watch_;
  const SearchOutcome& found_;
  std::size_t networks_;
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

// Evaluates the entries with every ray. The answer comes first, as far as it is known: a stop leaves that measured.
void confirm_entries(std::vector<PlanEntry>& entries, const SearchOutcome& found, const SurveyProblem& problem,
                     NetworkEvaluator& evaluator, const PlanWatch& watch) {
  const ConfirmReport report(watch, found, entries.size());
  report(0);
  if (entries.empty()) return;
  const auto confirm = [&](std::size_t first, std::size_t many) {
    const std::span<PlanEntry> some = std::span(entries).subspan(first, many);
    const auto part = [&](double share) { report(static_cast<double>(first) + share * static_cast<double>(many)); };
    std::vector<std::optional<Evaluation>> confirmed =
        evaluator.confirm(networks_of(some), {.report = part, .stop = watch.abort});
    for (std::size_t k = 0; k < many; ++k)
      if (confirmed[k]) static_cast<Evaluation&>(some[k]) = std::move(*confirmed[k]);
  };
  for (PlanEntry& entry : entries) entry.violation = violation_of(entry, problem.requirements);
  const auto chosen = static_cast<std::ptrdiff_t>(answer(entries, problem));
  std::rotate(entries.begin(), entries.begin() + chosen, entries.begin() + chosen + 1);
  confirm(0, 1);
  const auto stations = entries.front().stations.size();
  if (entries.front().exact && watch.seconds_after)
    watch.seconds_after(stations, report.seconds() / static_cast<double>(std::max<std::size_t>(stations, 1)));
  if (entries.size() > 1) confirm(1, entries.size() - 1);
  report(static_cast<double>(entries.size()));
}

}  // namespace

EvaluationOptions evaluation_options(const SurveyProblem& problem) {
  return {.target = problem.target,
          .link_overlap = problem.link_overlap,
          .link = limit_of(problem, Objective::Kind::link, Requirement::Bound::at_least).value_or(0),
          .names = problem.existing_names};
}

ConfirmedFront confirm_front(const SearchOutcome& found, const DecisionSpace& space, const SurveyProblem& problem,
                             const Measures& measures, std::uint64_t sample_voxels, NetworkEvaluator& evaluator,
                             const PlanWatch& watch) {
  ConfirmedFront front{.entries = searched_entries(found, space, problem, measures)};
  std::vector<PlanEntry>& entries = front.entries;
  const bool sampled = sample_voxels > 0;
  const bool estimated =
      sampled && !entries.empty() && estimate_again(entries, found, sample_voxels, measures, evaluator, watch.abort);
  // A single voxel that only every ray sees may decide whether a requirement is violated.
  if (estimated && problem.requirements.empty()) {
    erase_said(entries, beaten(entries, problem, measures));
    front.spared = found.front.size() - entries.size();
  }
  confirm_entries(entries, found, problem, evaluator, watch);
  if (!sampled)
    for (PlanEntry& entry : entries)
      if (entry.exact) entry.searched = entry.values;
  std::sort(entries.begin(), entries.end(),
            [&](const PlanEntry& a, const PlanEntry& b) { return comes_before(a, b, measures); });
  return front;
}

void keep_undominated(std::vector<PlanEntry>& entries, const SurveyProblem& problem, const Measures& measures) {
  const std::size_t m = problem.objectives.size();
  const std::vector<double> scaled = scaled_rows(entries, problem, measures);
  const std::vector<std::size_t> ranks = non_dominated_ranks(scaled, m);
  std::vector<bool> needless;
  std::set<std::vector<double>> kept;
  for (std::size_t k = 0; k < entries.size(); ++k) {
    const auto own = std::span<const double>(scaled).subspan(k * m, m);
    needless.push_back(ranks[k] > 0 || !kept.emplace(own.begin(), own.end()).second);
  }
  erase_said(entries, needless);
}

double judge_by_every_ray(std::vector<PlanEntry>& entries, const SurveyProblem& problem, const Measures& measures) {
  const std::size_t objectives = problem.objectives.size();
  std::vector<double> scaled;
  std::vector<PlanEntry*> judged;
  for (PlanEntry& entry : entries) {
    const std::vector<double> values = best_known(entry, measures);
    entry.violation = violation_of(entry, problem.requirements);
    if (!entry.exact) continue;
    scaled.resize(scaled.size() + objectives);
    scale_objectives(problem, entry.x, values, entry.violation, std::span(scaled).last(objectives));
    judged.push_back(&entry);
  }
  const std::vector<std::size_t> ranks = non_dominated_ranks(scaled, objectives);
  for (std::size_t k = 0; k < judged.size(); ++k) judged[k]->dominated = ranks[k] > 0;
  if (judged.empty() || judged.size() < entries.size()) return kUnknown;
  return hypervolume(scaled, objectives, std::vector<double>(objectives, 1.0));
}

}  // namespace vantage
