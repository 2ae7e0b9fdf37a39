// SPDX-License-Identifier: Apache-2.0
#include "plan/what_pays.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "scene/scene_data.hpp"

namespace vantage {
namespace {

// After this many stations the gain of one more is looked at alone, after twice as many that of two.
constexpr std::size_t kLookedAtTogether = 5;
constexpr std::size_t kFirstChoice = 64;  // stations; then twice as many

std::size_t looked_at_after(std::size_t stations) { return std::max<std::size_t>(1, stations / kLookedAtTogether); }

// Surface that the existing stations of a greedy choice capture, and all of them after each further one.
std::vector<double> captured_m2(const CoverProblem& even, std::span<const std::size_t> order, double element_m2) {
  const double whole_m2 = even.matrix.total_weight() * element_m2;
  const std::size_t kept = even.existing.size();
  PartialCover cover(even.matrix, order.first(kept));
  std::vector<double> captured{cover.value() * whole_m2};
  for (const std::size_t k : order.subspan(kept)) {
    cover.add(k);
    captured.push_back(cover.value() * whole_m2);
  }
  return captured;
}

}  // namespace

CoverageMatrix with_even_weights(const CoverageMatrix& matrix) {
  CoverageMatrix even(std::vector<std::uint32_t>(matrix.elements(), 1), matrix.goal());
  std::vector<double> goals(matrix.elements());
  for (std::size_t e = 0; e < goals.size(); ++e) goals[e] = matrix.weight(e) > 0 ? matrix.goal(e) : 0;
  even.set_goals(goals);
  for (std::size_t k = 0; k < matrix.candidates(); ++k) even.add(matrix.column(k));
  return even;
}

double new_surface_m2(const CoverageMatrix& matrix, const PartialCover& network, std::size_t candidate,
                      double element_m2) {
  double sum = 0;
  for (const auto& [element, amount] : matrix.column(candidate)) {
    if (matrix.weight(element) <= 0) continue;
    const std::uint64_t has = network.amount(element);
    sum += (network.covered(element, has + amount) - network.covered(element, has)) * matrix.weight(element) /
           matrix.weights()[element];
  }
  return sum * element_m2;
}

double surface_m2(const CoverageMatrix& matrix, std::span<const std::size_t> network, double element_m2) {
  const PartialCover cover(matrix, network);
  double sum = 0;
  for (std::size_t e = 0; e < matrix.elements(); ++e)
    if (matrix.weight(e) > 0) sum += cover.covered(e, cover.amount(e)) * matrix.weight(e) / matrix.weights()[e];
  return sum * element_m2;
}

std::vector<std::size_t> for_empty_units(const CoverageMatrix& matrix, const StationGraph* graph,
                                         std::span<const std::size_t> chosen,
                                         std::span<const std::vector<std::size_t>> units, double element_m2,
                                         double least_m2) {
  PartialCover cover(matrix, chosen);
  std::vector<std::size_t> all(chosen.begin(), chosen.end()), found;
  const auto is_chosen = [&](std::size_t k) { return std::ranges::find(all, k) != all.end(); };
  const auto may_stand = [&](std::size_t k) {
    return !graph || std::ranges::none_of(all, [&](std::size_t other) { return graph->excluded(k, other); });
  };
  for (const std::vector<std::size_t>& unit : units) {
    if (std::ranges::any_of(unit, is_chosen)) continue;
    std::optional<std::size_t> best;
    double most_m2 = 0;
    for (const std::size_t k : unit)
      if (const double m2 = new_surface_m2(matrix, cover, k, element_m2); m2 > most_m2 && may_stand(k))
        most_m2 = m2, best = k;
    if (!best || most_m2 < least_m2) continue;
    cover.add(*best), all.push_back(*best), found.push_back(*best);
  }
  return found;
}

StationsThatPay stations_that_pay(const CoverProblem& problem, double element_m2, const LeastGain& least,
                                  std::span<const std::vector<std::size_t>> units) {
  const std::size_t kept = problem.existing.size();
  const CoverageMatrix matrix = with_even_weights(problem.matrix);
  const std::size_t fewest = problem.fewest > 1 ? problem.fewest : problem.existing.empty() ? 1 : 0;
  StationsThatPay found;
  // Longer and longer, since few sites take as many stations as are allowed.
  for (std::size_t most = std::min(std::max(kFirstChoice, fewest), problem.most);;
       most = std::min(2 * most, problem.most)) {
    const CoverProblem even{.matrix = matrix, .existing = problem.existing, .most = most};
    const std::vector<std::size_t> order = greedy(even);
    const std::vector<double> captured = captured_m2(even, order, element_m2);
    const std::size_t all = captured.size() - 1;
    const bool ended = all < most || most == problem.most;
    for (std::size_t n = std::min(fewest, all); n <= all; ++n) {
      const std::size_t next = looked_at_after(n), last = std::min(n + next, all);
      if (n + next > all && !ended) break;
      found.next_m2 = last > n ? (captured[last] - captured[n]) / static_cast<double>(last - n) : 0;
      found.least_m2 =
          std::max(least.m2, least.share * captured[n] / static_cast<double>(std::max(few_for_average, kept + n)));
      if (found.next_m2 >= found.least_m2) continue;
      std::vector<std::size_t> chosen(order.begin(), order.begin() + static_cast<std::ptrdiff_t>(kept + n));
      const std::vector<std::size_t> own =
          for_empty_units(matrix, nullptr, chosen, units, element_m2, kLeastOfUnit * least.m2);
      found.parts = std::min(own.size(), problem.most - n);
      chosen.insert(chosen.end(), own.begin(), own.begin() + static_cast<std::ptrdiff_t>(found.parts));
      found.stations = n + found.parts;
      found.capture = problem.matrix.coverage(chosen);
      return found;
    }
  }
}

FurtherStations further_stations(CoverProblem even, std::size_t stations, double element_m2) {
  even.most = looked_at_after(stations);
  const std::vector<std::size_t> order = greedy(even);
  FurtherStations found{.candidates = {order.begin() + static_cast<std::ptrdiff_t>(even.existing.size()), order.end()}};
  if (found.candidates.empty()) return found;
  const std::vector<double> captured = captured_m2(even, order, element_m2);
  found.each_m2 = (captured.back() - captured.front()) / static_cast<double>(found.candidates.size());
  return found;
}

double surveyed_area_m2(const Scene& scene) {
  const SceneData& data = scene.data();
  double area = 0;
  for (std::size_t m = 0; m < data.meshes.size(); ++m) {
    if (data.meshes[m].role != Role::surveyed) continue;
    const MeshRange& range = data.ranges[m];
    for (std::uint32_t t = range.first_triangle; t < range.first_triangle + range.triangle_count; ++t) {
      const auto p = data.corners(t);
      const Vec3 a = widen(p[0]), normal = cross(widen(p[1]) - a, widen(p[2]) - a);
      area += std::sqrt(dot(normal, normal)) / 2;
    }
  }
  return area;
}

}  // namespace vantage
