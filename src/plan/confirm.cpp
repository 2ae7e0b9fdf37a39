// SPDX-License-Identifier: Apache-2.0
#include "plan/confirm.hpp"

#include <algorithm>
#include <chrono>
#include <limits>
#include <optional>
#include <tuple>
#include <utility>

namespace vantage {
namespace {

bool blind(const Network& network) {
  return std::none_of(network.begin(), network.end(), [](const Station& s) { return s.active; });
}

}  // namespace

std::vector<PlanEntry> confirm_front(const SearchOutcome& found, const DecisionSpace& space, const PlanConfig& config,
                                     NetworkEvaluator& evaluator, const std::function<void(const PlanProgress&)>& watch,
                                     std::stop_token abort) {
  using Clock = std::chrono::steady_clock;
  const auto start = Clock::now();
  std::vector<PlanEntry> entries;
  std::vector<Network> networks, seeing;
  for (const ParetoPoint& point : found.front) {
    PlanEntry& entry = entries.emplace_back();
    entry.x = point.x;
    entry.stations = space.decode(point.x);
    entry.exact_overlap_matrix = OverlapMatrix(entry.stations.size());
    entry.points_on_surveyed.assign(entry.stations.size(), 0);
    networks.push_back(to_network(entry.stations));
    if (!blind(networks.back())) seeing.push_back(networks.back());
  }
  const auto take_objectives = [&](PlanEntry& entry, const ParetoPoint& point) {
    constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
    entry.coverage = config.fitness ? unknown : 1 - point.f[0];
    entry.overlap = space.needs_overlap() ? 1 - point.f[1] : unknown;
  };
  const auto report = [&](std::size_t done, double part) {
    if (!watch) return;
    const double seconds = std::chrono::duration<double>(Clock::now() - start).count();
    const double rate = seconds > 0 ? (static_cast<double>(done) + part) / seconds : 0;
    watch({.iteration = done,
           .iterations = entries.size(),
           .evaluations = found.evaluations,
           .hypervolume = found.hypervolume,
           .evaluations_per_second = rate,
           .seconds_left = rate > 0 ? (static_cast<double>(entries.size() - done) - part) / rate : -1,
           .phase = "confirm"});
  };

  // A search that samples did not keep its standard errors, nor the overlap where it is no objective. The same sample
  // is drawn again.
  if (config.sample_voxels > 0 && !seeing.empty()) {
    const auto estimates = evaluator.estimate(seeing, {.report = {}, .stop = abort});
    std::size_t next = 0;
    for (std::size_t k = 0; k < entries.size(); ++k) {
      if (blind(networks[k])) continue;
      PlanEntry& entry = entries[k];
      if (estimates) {
        const NetworkEstimate& e = (*estimates)[next++];
        entry.coverage = e.coverage.value, entry.coverage_se = e.coverage.standard_error;
        entry.overlap = e.overlap.value, entry.overlap_se = e.overlap.standard_error;
      } else {
        take_objectives(entry, found.front[k]);
      }
    }
  }
  for (std::size_t k = 0; k < entries.size() && !abort.stop_requested(); ++k) {
    report(k, 0);
    PlanEntry& entry = entries[k];
    std::optional<ConfirmedNetwork> exact = ConfirmedNetwork{};
    if (!blind(networks[k])) {
      exact = evaluator.confirm(networks[k], {.report = [&](double done) { report(k, done); }, .stop = abort});
      if (!exact) break;
      entry.exact_overlap_matrix = std::move(exact->overlaps);
      entry.points_on_surveyed = std::move(exact->points_on_surveyed);
    }
    entry.confirmed = true;
    entry.exact_coverage = exact->coverage, entry.exact_overlap = exact->overlap;
  }
  report(entries.size(), 0);
  if (config.sample_voxels == 0) {
    for (std::size_t k = 0; k < entries.size(); ++k) {
      PlanEntry& entry = entries[k];
      if (entry.confirmed)
        entry.coverage = entry.exact_coverage, entry.overlap = entry.exact_overlap;
      else
        take_objectives(entry, found.front[k]);
    }
  }
  const auto rank = [](const PlanEntry& e) {
    // NaN last, or it would be no order
    const auto falling = [](double value) { return value == value ? -value : 1.0; };
    return std::make_tuple(falling(e.coverage), falling(e.overlap), e.stations.size(), e.x);
  };
  std::sort(entries.begin(), entries.end(), [&](const PlanEntry& a, const PlanEntry& b) { return rank(a) < rank(b); });
  return entries;
}

double judge_by_every_ray(std::vector<PlanEntry>& entries, const DecisionSpace& space, const PlanConfig& config) {
  const std::size_t objectives = space.objectives();
  std::vector<double> values;
  std::vector<PlanEntry*> judged;
  for (PlanEntry& entry : entries) {
    if (!entry.confirmed) continue;
    std::size_t parts = space.parts_of(to_network(entry.stations));
    if (config.min_link_overlap > 0) parts = connectivity(entry.exact_overlap_matrix, config.min_link_overlap).parts;
    values.resize(values.size() + objectives);
    space.objectives_of(entry.x, entry.exact_coverage, entry.exact_overlap, parts, std::span(values).last(objectives));
    judged.push_back(&entry);
  }
  const std::vector<std::size_t> ranks = non_dominated_ranks(values, objectives);
  for (std::size_t k = 0; k < judged.size(); ++k) judged[k]->dominated = ranks[k] > 0;
  if (judged.empty() || judged.size() < entries.size()) return std::numeric_limits<double>::quiet_NaN();
  return hypervolume(values, objectives, std::vector<double>(objectives, 1.0));
}

}  // namespace vantage
