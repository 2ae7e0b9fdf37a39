// SPDX-License-Identifier: Apache-2.0
#include "cover/network.hpp"

#include <algorithm>
#include <bit>
#include <cstdint>
#include <string>
#include <utility>

#include "vantage/error.hpp"

namespace vantage {
namespace {

// Violation of a missing link, as a share of the wanted coverage. It is so large that no network of two components wins
// by its coverage, and so small that a search may pass through one.
constexpr double kMissingLink = 0.2;

double weakest_link(const CoverProblem& problem, std::span<const std::size_t> network) {
  double weakest = 1;
  for (const TreeEdge& edge : strongest_spanning_tree(network.size(), [&](std::size_t i, std::size_t j) {
         return problem.graph ? static_cast<double>(problem.graph->overlap(network[i], network[j])) : 0;
       }))
    weakest = std::min(weakest, edge.weight);
  return weakest;
}

}  // namespace

void check(const CoverProblem& problem) {
  const std::size_t candidates = problem.matrix.candidates();
  for (const std::size_t k : problem.existing)
    if (k >= candidates)
      throw Error(Errc::invalid_argument, "cover: candidate " + std::to_string(k) +
                                              " is listed as existing, but there are " + std::to_string(candidates) +
                                              ", counted from 0");
  if (problem.graph && problem.graph->size() != candidates)
    throw Error(Errc::invalid_argument, "cover: a graph of " + std::to_string(problem.graph->size()) +
                                            " stations for " + std::to_string(candidates) + " candidates");
  if (problem.link > 0 && !problem.graph)
    throw Error(Errc::invalid_argument, "cover: a connected network is asked for, but no graph of overlaps is given");
}

std::vector<std::size_t> free_candidates(const CoverProblem& problem) {
  std::vector<std::size_t> free;
  for (std::size_t k = 0; k < problem.matrix.candidates(); ++k)
    if (std::ranges::find(problem.existing, k) == problem.existing.end()) free.push_back(k);
  return free;
}

bool linked(const CoverProblem& problem, std::size_t a, std::size_t b) {
  return problem.link > 0 ? problem.graph->linked(a, b, problem.link) : a != b;
}

Components components_of(const CoverProblem& problem, std::span<const std::size_t> network, double link) {
  if (link <= 0) return {.of = std::vector<std::size_t>(network.size(), 0), .count = 1};
  return components(network.size(),
                    [&](std::size_t i, std::size_t j) { return problem.graph->linked(network[i], network[j], link); });
}

std::size_t components_with(const CoverProblem& problem, std::span<const std::size_t> network,
                            const Components& components, std::size_t candidate, double link) {
  if (link <= 0) return 1;
  std::size_t left = components.count + 1;
  for (std::size_t first = 0; first < components.count; first += 64) {  // a bit for each component, 64 at a time
    std::uint64_t joined = 0;
    for (std::size_t i = 0; i < network.size(); ++i)
      if (components.of[i] - first < 64 && problem.graph->linked(network[i], candidate, link))
        joined |= std::uint64_t{1} << (components.of[i] - first);
    left -= static_cast<std::size_t>(std::popcount(joined));
  }
  return left;
}

bool may_stand(const CoverProblem& problem, std::size_t candidate, std::span<const std::size_t> network) {
  return std::ranges::none_of(network, [&](std::size_t other) {
    return other == candidate || (problem.graph && problem.graph->excluded(other, candidate));
  });
}

bool may_join(const CoverProblem& problem, std::size_t candidate, std::span<const std::size_t> network) {
  if (!problem.graph) return true;
  if (!may_stand(problem, candidate, network)) return false;
  if (problem.link <= 0) return true;
  std::vector<std::size_t> with(network.begin(), network.end());
  with.push_back(candidate);
  return components_of(problem, with, problem.link).count == 1;
}

double violation(const CoverProblem& problem, double coverage, std::size_t components) {
  const double short_of = std::max(0.0, problem.coverage - coverage);
  return (problem.coverage > 0 ? short_of / problem.coverage : 0) +
         (components > 1 ? kMissingLink * static_cast<double>(components - 1) : 0);
}

std::vector<std::size_t> without(std::span<const std::size_t> network, std::size_t at) {
  std::vector<std::size_t> rest(network.begin(), network.end());
  rest.erase(rest.begin() + static_cast<std::ptrdiff_t>(at));
  return rest;
}

CoverSolution evaluate_cover(const CoverProblem& problem, std::vector<std::size_t> chosen) {
  check(problem);
  for (const std::size_t k : chosen)
    if (k >= problem.matrix.candidates())
      throw Error(Errc::invalid_argument, "cover: candidate " + std::to_string(k) + " is chosen, but there are " +
                                              std::to_string(problem.matrix.candidates()) + ", counted from 0");
  CoverSolution solution{.chosen = std::move(chosen)};
  solution.coverage = problem.matrix.coverage(solution.chosen);
  solution.link = weakest_link(problem, solution.chosen);
  solution.violation =
      violation(problem, solution.coverage, components_of(problem, solution.chosen, problem.link).count);
  return solution;
}

}  // namespace vantage
