// SPDX-License-Identifier: Apache-2.0
// A survey made of formulas: a flat square of 10 m with a round hole in its middle, and an evaluator that needs no ray.
#pragma once

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <functional>
#include <string>
#include <thread>
#include <vector>

#include "evaluate/visibility.hpp"
#include "search/measures.hpp"
#include "search/network_evaluator.hpp"
#include "search/search.hpp"
#include "site/placement_oracle.hpp"

namespace vantage::test {

inline constexpr double kHoleRadius_m = 2.5;

inline PlacementOracle toy_site() {
  return {.uv_min = {0, 0},
          .uv_max = {1, 1},
          .locate = [](Uv uv) -> std::optional<Vec3> {
            if (std::hypot(10 * uv.u - 5, 10 * uv.v - 5) < kHoleRadius_m) return std::nullopt;
            return Vec3{10 * uv.u, 10 * uv.v, 3};
          },
          .project = [](const Vec3& p) -> std::optional<Uv> {
            if (p.x < 0 || p.x > 10 || p.y < 0 || p.y > 10) return std::nullopt;
            return Uv{p.x / 10, p.y / 10};
          },
          .clashes = [](const Vec3& ground, double) { return ground.x < 0.5; },  // a wall along one side
          .check_head = [](const Vec3& head) -> PlacedStation {
            const bool above = head.x >= 0 && head.x <= 10 && head.y >= 0 && head.y <= 10;
            return {.uv = above ? Uv{head.x / 10, head.y / 10} : Uv{},
                    .position = head,
                    .ground = head - Vec3{0, 0, 1.5},
                    .status = above ? StationStatus::ok : StationStatus::off_ground};
          },
          .sees = [](const Vec3& a, const Vec3& b) { return (a.y < 5) == (b.y < 5); },  // a wall in the middle
          .height_m = 1.5,
          .range_m = 6};
}

// Coverage: how near the closest station is to each of 8 targets on a circle. Overlap: how close the stations stand
// together. Other measures compute their values from counts that agree with these.
class ToyEvaluator final : public NetworkEvaluator {
 public:
  Measures measures = measures_of(coverage_overlap_fix(4));
  std::function<void(const PlacedNetwork&)> before_each = {};
  std::size_t at_once = 1;
  double noise = 0;  // of a sample of one voxel; falls with the root of their number
  std::uint64_t evaluated = 0, confirmed = 0, estimated = 0;
  std::uint64_t voxels = 0;  // that were counted in all
  std::size_t largest_batch = 0;

  static double coverage_of(const PlacedNetwork& network) {
    double coverage = 0;
    for (int k = 0; k < 8; ++k) {
      double nearest = 20;
      for (const PlacedStation& s : network)
        if (s.status == StationStatus::ok)
          nearest = std::min(nearest, std::hypot(s.position.x - 5 - 4 * std::cos(0.7854 * k),
                                                 s.position.y - 5 - 4 * std::sin(0.7854 * k)));
      coverage += std::exp(-nearest * nearest / 4) / 8;
    }
    return coverage;
  }
  static double overlap_of(const PlacedNetwork& network) {
    double spread = 0, pairs = 0;
    for (const PlacedStation& a : network)
      for (const PlacedStation& b : network)
        if (a.status == StationStatus::ok && b.status == StationStatus::ok && &a != &b)
          spread += std::hypot(a.position.x - b.position.x, a.position.y - b.position.y), ++pairs;
    return pairs > 0 ? std::exp(-spread / pairs / 3) : 0;
  }
  // Stations are linked within 4 m.
  static OverlapMatrix near(const PlacedNetwork& network) {
    OverlapMatrix near(network.size());
    for (std::size_t i = 0; i < network.size(); ++i)
      for (std::size_t j = i + 1; j < network.size(); ++j)
        if (std::hypot(network[i].position.x - network[j].position.x, network[i].position.y - network[j].position.y) <
            4)
          near.set(i, j, 1);
    return near;
  }
  double value_of(const Objective& measure, const PlacedNetwork& network) const {
    if (measure.name == "coverage") return coverage_of(network);
    if (measure.name == "overlap") return overlap_of(network);
    constexpr double whole = 1ull << 40;
    NetworkCounts counts;
    counts.weight = 1, counts.partial_points = static_cast<std::uint64_t>(whole * coverage_of(network));
    return measure.value({.counts = counts,
                          .stations = network,
                          .existing = 0,
                          .goal_density = whole,
                          .voxels = 1,
                          .overlap = near(network),
                          .visible_parts = visibility_parts(toy_site().sees, toy_site().range_m, to_network(network))});
  }

  // One and the same for the same network and sample.
  double luck_of(const PlacedNetwork& network, const VoxelWindow& sample, std::size_t measure) const {
    if (noise == 0 || sample.voxels == 0) return 0;
    double phase = 7 * std::log(static_cast<double>(sample.voxels)) + 0.1 * static_cast<double>(sample.from) +
                   static_cast<double>(measure);
    for (const PlacedStation& s : network) phase += 1e3 * s.position.x + 1.7e3 * s.position.y;
    return noise * std::sqrt(2 / static_cast<double>(sample.voxels)) * std::sin(phase);
  }

  std::size_t chunk() const override { return at_once; }
  std::optional<std::vector<std::vector<double>>> evaluate(std::span<const PlacedNetwork> networks,
                                                           const VoxelWindow& sample,
                                                           const Progress& progress) override {
    largest_batch = std::max(largest_batch, networks.size());
    std::vector<std::vector<double>> values;
    for (const PlacedNetwork& network : networks) {
      if (before_each) before_each(network);
      if (progress.stopped()) return std::nullopt;
      auto& all = values.emplace_back();
      for (std::size_t m = 0; m < measures.searched; ++m)
        all.push_back(value_of(measures.all[m], network) + luck_of(network, sample, m));
      ++evaluated, voxels += sample.voxels;
    }
    return values;
  }
  std::optional<std::vector<std::vector<Estimate>>> estimate(std::span<const PlacedNetwork> networks,
                                                             const VoxelWindow& sample, Which which,
                                                             const Progress& progress) override {
    if (progress.stopped()) return std::nullopt;
    std::vector<std::vector<Estimate>> estimates;
    for (const PlacedNetwork& network : networks) {
      auto& all = estimates.emplace_back();
      const std::size_t wanted = which == Which::all ? measures.all.size() : measures.searched;
      for (std::size_t m = 0; m < wanted; ++m)
        all.push_back({value_of(measures.all[m], network) + luck_of(network, sample, m),
                       noise > 0                           ? noise / std::sqrt(static_cast<double>(sample.voxels))
                       : measures.all[m].name == "overlap" ? 0.02
                                                           : 0.01});
      ++estimated, voxels += sample.voxels;
    }
    return estimates;
  }
  std::vector<std::optional<Evaluation>> confirm(std::span<const PlacedNetwork> networks,
                                                 const Progress& progress) override {
    std::vector<std::optional<Evaluation>> all(networks.size());
    for (std::size_t k = 0; k < networks.size(); ++k) {
      progress(static_cast<double>(k) / static_cast<double>(networks.size()));
      if (progress.stopped()) break;
      ++confirmed;
      Evaluation& exact = all[k].emplace();
      exact.stations = networks[k], exact.exact = true;
      exact.overlap_matrix = OverlapMatrix(networks[k].size());
      exact.counts.points_on_surveyed.assign(networks[k].size(), 7);
      for (const Objective& measure : measures.all)
        exact.values[measure.name] = {value_of(measure, networks[k]) - (measure.by_alpha ? 0 : 0.001), 0};
    }
    return all;
  }
  double trace_seconds() const override { return 0.25; }
};

// Every bit of an outcome that must be reproducible.
inline std::string bits_of(const SearchOutcome& outcome) {
  std::string text;
  const auto put = [&text](double value) {
    char buffer[40];
    std::snprintf(buffer, sizeof buffer, "%a ", value);
    text += buffer;
  };
  for (const ParetoPoint& point : outcome.front) {
    for (const double x : point.x) put(x);
    for (const double f : point.f) put(f);
    text += "\n";
  }
  for (const PlanIteration& line : outcome.history) {
    text += std::to_string(line.iteration) + " " + std::to_string(line.evaluations) + " ";
    put(line.hypervolume);
    for (const auto& f : line.front)
      for (const double value : f) put(value);
    text += "\n";
  }
  put(outcome.hypervolume);
  text += std::to_string(outcome.evaluations) + " " + std::to_string(outcome.drawn) + " " +
          std::to_string(outcome.redrawn) + " " + to_string(outcome.stop_reason) + "\n";
  return text;
}

inline constexpr const char* kProblems[] = {"coverage-fix", "coverage-overlap-fix", "coverage-min",
                                            "coverage-overlap-min"};

// With 4 stations, or 4 to 8 if the number is searched.
inline SurveyProblem toy_problem(const std::string& name) {
  return survey_problem(name, 4, name.ends_with("-min") ? 8 : 4);
}

inline PlanConfig toy_config() { return {.population = 20, .iterations = 30, .seed = 7}; }

inline SearchOutcome toy_search(const SurveyProblem& problem, const PlanConfig& config, ToyEvaluator& evaluator,
                                std::stop_token stop = {}, std::size_t batch = 4,
                                std::function<void(const PlanProgress&)> watch = {}) {
  const PlacementOracle site = toy_site();
  const DecisionSpace space(site, problem);
  evaluator.measures = measures_of(problem);
  const auto searched = make_search_evaluator(evaluator, config, evaluator.measures.searched);
  return search({.space = space,
                 .problem = problem,
                 .measures = evaluator.measures,
                 .config = config,
                 .evaluator = *searched,
                 .batch = batch,
                 .identity = "toy = " + problem.name + "\nseed = " + std::to_string(config.seed.value_or(1)) + "\n",
                 .watch = std::move(watch),
                 .stop = stop});
}

}  // namespace vantage::test
