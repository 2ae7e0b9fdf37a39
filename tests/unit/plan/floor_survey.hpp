// SPDX-License-Identifier: Apache-2.0
// A survey made of formulas for the question of the fewest stations: the floor of toy_site(), each station covering the
// cells within 3 m, and scans that overlap by how near their stations are.
#pragma once

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <vector>

#include "plan/fewest_verify.hpp"
#include "unit/plan/toy_survey.hpp"
#include "vantage/question.hpp"

namespace vantage::test {

inline constexpr double kReach_m = 3;

inline double apart_m(const Vec3& a, const Vec3& b) { return std::sqrt(dot(a - b, a - b)); }

// Cells of a quarter of a metre, each `step`-th of them; the whole cell has to be reached once.
inline TraceColumns floor_columns(std::size_t step = 1, double reach_m = kReach_m) {
  return [=](std::span<const PlacedStation> stations, const Progress& progress) {
    constexpr std::size_t side = 40;
    CoverageMatrix matrix(std::vector<std::uint32_t>((side * side + step - 1) / step, 1), 1);
    for (const PlacedStation& station : stations) {
      if (progress.stopped()) break;
      std::vector<std::uint32_t> amounts(matrix.elements(), 0);
      for (std::size_t e = 0; e < amounts.size(); ++e) {
        const std::size_t cell = e * step;
        const double x = (static_cast<double>(cell % side) + 0.5) / 4, y = (static_cast<double>(cell / side) + 0.5) / 4;
        amounts[e] = std::hypot(x - station.position.x, y - station.position.y) < reach_m;
      }
      matrix.add(std::span<const std::uint32_t>(amounts));
    }
    return matrix;
  };
}

// Allowed positions on a lattice of the floor.
inline std::vector<PlacedStation> floor_candidates(int side) {
  const PlacementOracle oracle = toy_site();
  std::vector<PlacedStation> found;
  for (int i = 0; i < side; ++i)
    for (int j = 0; j < side; ++j) {
      const PlacedStation one = place_station(oracle, {(i + 0.5) / side, (j + 0.5) / side}, oracle.height_m);
      if (one.status == StationStatus::ok) found.push_back(one);
    }
  return found;
}

// At least that coverage, linked by at least 0.1, at least a metre apart; then the most coverage.
inline SurveyProblem floor_problem(double coverage) {
  SurveyProblem problem = fewest_stations(coverage, 0.1, 1, 12, 1);
  problem.attainable = 1;
  for (Requirement& requirement : problem.requirements)
    if (requirement.objective.name == "capture") requirement.objective = make_objective("capture", problem.settings());
  problem.objectives = {make_objective("coverage", problem.settings())};
  return problem;
}

inline FewestChoice floor_choice(const SurveyProblem& problem, std::size_t step = 1) {
  return {.asked = fewest_asked(problem),
          .table = CandidateTable(floor_columns(step), floor_columns(1, 4), {.nearest_m = 1})};
}

// Evaluates networks by the columns of all cells. A sample overstates coverage by `overstated`.
class FloorEvaluator final : public NetworkEvaluator {
 public:
  explicit FloorEvaluator(const Measures& measures) : measures_(measures) {}

  double overstated = 0;
  // Returns the overlap of two stations by every ray, given the sampled one.
  std::function<float(const PlacedStation&, const PlacedStation&, float)> exact_overlap = {};
  std::function<double(const PlacedNetwork&)> penalty = {};  // that only every ray shows, of coverage

  static double coverage_of(const PlacedNetwork& network) {
    const CoverageMatrix matrix = floor_columns()(network, {});
    std::vector<std::size_t> all(network.size());
    for (std::size_t k = 0; k < all.size(); ++k) all[k] = k;
    return matrix.coverage(all);
  }
  std::size_t chunk() const override { return 0; }
  std::optional<std::vector<std::vector<double>>> evaluate(std::span<const PlacedNetwork> networks, const VoxelWindow&,
                                                           const Progress&) override {
    std::vector<std::vector<double>> all;
    for (const PlacedNetwork& network : networks) all.push_back(values_of(network, measures_.searched, overstated));
    return all;
  }
  std::optional<std::vector<std::vector<Estimate>>> estimate(std::span<const PlacedNetwork> networks,
                                                             const VoxelWindow&, Which, const Progress&) override {
    std::vector<std::vector<Estimate>> all;
    for (const PlacedNetwork& network : networks) {
      auto& of = all.emplace_back();
      for (const double value : values_of(network, measures_.all.size(), overstated)) of.push_back({value, 0.01});
    }
    return all;
  }
  std::vector<std::optional<Evaluation>> confirm(std::span<const PlacedNetwork> networks,
                                                 const Progress& progress) override {
    std::vector<std::optional<Evaluation>> all(networks.size());
    for (std::size_t k = 0; k < networks.size() && !progress.stopped(); ++k) {
      Evaluation& exact = all[k].emplace();
      exact.stations = networks[k], exact.exact = true;
      exact.overlap_matrix = OverlapMatrix(networks[k].size());
      const StationGraph links = links_of(networks[k], true);
      exact.scan_overlap_matrix = ScanOverlapMatrix(networks[k].size());
      for (std::size_t i = 0; i < networks[k].size(); ++i)
        for (std::size_t j = 0; j < i; ++j)
          exact.scan_overlap_matrix.set(i, j, static_cast<double>(links.overlap(i, j)));
      const std::vector<double> values =
          values_of(networks[k], measures_.all.size(), penalty ? -penalty(networks[k]) : 0, true);
      for (std::size_t m = 0; m < values.size(); ++m) exact.values[measures_.all[m].name] = {values[m], 0};
    }
    return all;
  }
  double trace_seconds() const override { return 0; }

 private:
  StationGraph links_of(const PlacedNetwork& network, bool exact) const {
    StationGraph graph(floor_columns(1, 4)(network, {}), network.size());
    for (std::size_t i = 0; i < network.size() && exact && exact_overlap; ++i)
      for (std::size_t j = 0; j < i; ++j)
        graph.set_overlap(i, j, exact_overlap(network[i], network[j], graph.overlap(i, j)));
    return graph;
  }
  std::vector<double> values_of(const PlacedNetwork& network, std::size_t count, double off, bool exact = false) const {
    std::vector<std::size_t> all(network.size());
    for (std::size_t k = 0; k < all.size(); ++k) all[k] = k;
    const CoverageMatrix around = floor_columns(1, 4)(network, {});
    const StationGraph graph = links_of(network, exact);
    const double link = evaluate_cover({.matrix = around, .graph = &graph}, all).link;
    double nearest = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < network.size(); ++i)
      for (std::size_t j = 0; j < i; ++j)
        nearest = std::min(nearest, apart_m(network[i].position, network[j].position));
    std::vector<double> values;
    for (std::size_t m = 0; m < count; ++m) {
      const std::string& name = measures_.all[m].name;
      values.push_back(name == "coverage" || name == "capture" ? coverage_of(network) + off
                       : name == "link"                        ? link
                       : name == "apart"                       ? nearest
                                                               : 0);
    }
    return values;
  }
  const Measures& measures_;
};

}  // namespace vantage::test
