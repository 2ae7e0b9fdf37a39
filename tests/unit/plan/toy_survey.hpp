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

#include "plan/network_evaluator.hpp"
#include "plan/search.hpp"
#include "plan/site.hpp"

namespace vantage::test {

inline constexpr double kHoleRadius_m = 2.5;

inline Site toy_site() {
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
          .clashes = [](const Vec3& ground) { return ground.x < 0.5; },                 // a wall along one side
          .sees = [](const Vec3& a, const Vec3& b) { return (a.y < 5) == (b.y < 5); },  // a wall in the middle
          .height_m = 1.5,
          .range_m = 6};
}

// Coverage: how near the closest station is to each of 8 targets on a circle. Overlap: how close the stations stand
// together.
class ToyEvaluator final : public NetworkEvaluator {
 public:
  std::function<void(const Network&)> before_each = {};
  std::size_t at_once = 1;
  std::uint64_t evaluated = 0, confirmed = 0, estimated = 0;
  std::size_t largest_batch = 0;

  static NetworkValue value_of(const Network& network) {
    double coverage = 0, spread = 0, pairs = 0;
    for (int k = 0; k < 8; ++k) {
      double nearest = 20;
      for (const Station& s : network)
        if (s.active)
          nearest = std::min(nearest, std::hypot(s.position.x - 5 - 4 * std::cos(0.7854 * k),
                                                 s.position.y - 5 - 4 * std::sin(0.7854 * k)));
      coverage += std::exp(-nearest * nearest / 4) / 8;
    }
    for (const Station& a : network)
      for (const Station& b : network)
        if (a.active && b.active && &a != &b)
          spread += std::hypot(a.position.x - b.position.x, a.position.y - b.position.y), ++pairs;
    return {.coverage = coverage, .overlap = pairs > 0 ? std::exp(-spread / pairs / 3) : 0, .parts = 1};
  }

  std::size_t chunk() const override { return at_once; }
  std::optional<std::vector<NetworkValue>> evaluate(std::span<const Network> networks,
                                                    const Progress& progress) override {
    largest_batch = std::max(largest_batch, networks.size());
    std::vector<NetworkValue> values;
    for (const Network& network : networks) {
      if (before_each) before_each(network);
      if (progress.stopped()) return std::nullopt;
      values.push_back(value_of(network));
      ++evaluated;
    }
    return values;
  }
  std::optional<std::vector<NetworkEstimate>> estimate(std::span<const Network> networks,
                                                       const Progress& progress) override {
    if (progress.stopped()) return std::nullopt;
    std::vector<NetworkEstimate> estimates;
    for (const Network& network : networks) {
      const NetworkValue v = value_of(network);
      estimates.push_back({.coverage = {v.coverage, 0.01}, .overlap = {v.overlap, 0.02}});
      ++estimated;
    }
    return estimates;
  }
  std::optional<ConfirmedNetwork> confirm(const Network& network, const Progress& progress) override {
    if (progress.stopped()) return std::nullopt;
    ++confirmed;
    const NetworkValue v = value_of(network);
    return ConfirmedNetwork{.coverage = v.coverage - 0.001,
                            .overlap = v.overlap - 0.001,
                            .overlaps = OverlapMatrix(network.size()),
                            .points_on_surveyed = std::vector<std::uint64_t>(network.size(), 7)};
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

inline PlanConfig toy_config(Problem problem) {
  PlanConfig config{
      .problem = problem, .stations_min = 4, .stations_max = 4, .population = 20, .iterations = 30, .seed = 7};
  if (problem == Problem::coverage_min || problem == Problem::coverage_overlap_min) config.stations_max = 8;
  return config;
}

inline SearchOutcome toy_search(const PlanConfig& config, ToyEvaluator& evaluator, std::stop_token stop = {},
                                std::size_t batch = 4, std::function<void(const PlanProgress&)> watch = {}) {
  const Site site = toy_site();
  const DecisionSpace space(site, config);
  return search({.space = space,
                 .config = config,
                 .evaluator = evaluator,
                 .batch = batch,
                 .identity = "toy = " + to_string(config.problem) + "\nseed = " + std::to_string(config.seed) + "\n",
                 .watch = std::move(watch),
                 .stop = stop});
}

}  // namespace vantage::test
