// SPDX-License-Identifier: Apache-2.0
#include "cover/network.hpp"

#include <algorithm>
#include <bit>
#include <cstdint>
#include <functional>
#include <string>
#include <utility>

#include "core/disjoint_sets.hpp"
#include "core/parse.hpp"
#include "vantage/error.hpp"

namespace vantage {
namespace {

std::vector<std::uint32_t> places_of(const CoverProblem& problem, std::span<const std::size_t> network) {
  std::vector<std::uint32_t> places(problem.matrix.candidates(), static_cast<std::uint32_t>(network.size()));
  for (std::size_t at = 0; at < network.size(); ++at) places[network[at]] = static_cast<std::uint32_t>(at);
  return places;
}

// The smallest overlap of the maximum spanning tree (Kruskal: On the Shortest Spanning Subtree of a Graph, 1956).
double weakest_link(const CoverProblem& problem, std::span<const std::size_t> network) {
  if (network.size() < 2) return 1;
  if (!problem.graph) return 0;
  struct Edge {
    float share;
    std::uint32_t a, b;
  };
  std::vector<Edge> edges;
  const std::vector<std::uint32_t> places = places_of(problem, network);
  for (std::uint32_t at = 0; at < network.size(); ++at)
    for (const StationGraph::Overlap& other : problem.graph->overlaps(network[at]))
      if (places[other.candidate] < at && other.share > 0) edges.push_back({other.share, at, places[other.candidate]});
  std::ranges::sort(edges, std::greater<>{}, &Edge::share);
  DisjointSets parts(network.size());
  double weakest = 1;
  std::size_t missing = network.size() - 1;
  for (const Edge& edge : edges) {
    if (!parts.join(edge.a, edge.b)) continue;
    weakest = std::min(weakest, static_cast<double>(edge.share));
    if (--missing == 0) return weakest;
  }
  return 0;
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
  check_number(problem.link, "cover: the least overlap of a link", kNotNegative);
  check_number(problem.least_help, "cover: the least help of a further candidate", kNotNegative);
  if (problem.link > 0 && !problem.graph)
    throw Error(Errc::invalid_argument, "cover: a connected network is asked for, but no graph of overlaps is given");
}

void check(const BoundConfig& config) {
  check_number(config.tolerance, "cover: the tolerance", {.low = 0, .high = 1, .low_included = false});
  check_number(config.max_seconds, "cover: the time limit", kAnySeconds);
  check_number(config.exact_seconds, "cover: the time for branch and bound", kAnySeconds);
}

std::vector<std::size_t> free_candidates(const CoverProblem& problem) {
  std::vector<std::size_t> free;
  for (std::size_t k = 0; k < problem.matrix.candidates(); ++k)
    if (std::ranges::find(problem.existing, k) == problem.existing.end()) free.push_back(k);
  return free;
}

NetworkLinks::NetworkLinks(const CoverProblem& problem, std::span<const std::size_t> network, double link)
    : all_(link <= 0), graph_(problem.graph), link_(link), network_(network.begin(), network.end()) {
  if (all_) return;
  places_.resize(problem.matrix.candidates());
  for (std::uint32_t at = 0; at < network_.size(); ++at)
    for_linked(network_[at], [&](std::uint32_t candidate) { places_[candidate].push_back(at); });
}

void NetworkLinks::replace(std::size_t at, std::size_t joining) {
  const std::size_t leaving = std::exchange(network_[at], joining);
  if (all_) return;
  const auto place = static_cast<std::uint32_t>(at);
  for_linked(leaving, [&](std::uint32_t candidate) { std::erase(places_[candidate], place); });
  for_linked(joining, [&](std::uint32_t candidate) {
    std::vector<std::uint32_t>& places = places_[candidate];
    places.insert(std::ranges::lower_bound(places, place), place);
  });
}

NetworkLinks::Trees NetworkLinks::trees() const {
  const std::size_t size = network_.size();
  if (all_) return {.order = {}, .parent = {}, .end = {}, .cut = {}, .without = std::vector<std::size_t>(size, 1)};
  Trees trees{.order = {},
              .parent = std::vector<std::size_t>(size, size),
              .end = std::vector<std::size_t>(size, 0),
              .cut = std::vector<std::uint8_t>(size, 0),
              .without = std::vector<std::size_t>(size, 0)};
  trees.order.reserve(size);
  // `low`: the earliest member that a member, or one below it, is linked to.
  std::vector<std::size_t> entered(size, 0), low(size, 0), next(size, 0), path;
  std::size_t count = 0;
  const auto enter = [&](std::size_t member) {
    trees.order.push_back(member);
    entered[member] = low[member] = trees.order.size();
    path.push_back(member);
  };
  for (std::size_t root = 0; root < size; ++root) {
    if (entered[root] > 0) continue;
    ++count;
    enter(root);
    while (!path.empty()) {
      const std::size_t at = path.back();
      if (next[at] < of(network_[at]).size()) {
        const std::size_t other = of(network_[at])[next[at]++];
        if (entered[other] == 0) {
          trees.parent[other] = at;
          enter(other);
        } else if (other != trees.parent[at]) {
          low[at] = std::min(low[at], entered[other]);
        }
        continue;
      }
      trees.end[at] = trees.order.size();
      path.pop_back();
      if (path.empty()) continue;
      const std::size_t above = path.back();
      low[above] = std::min(low[above], low[at]);
      trees.cut[at] = low[at] >= entered[above];
      trees.without[above] += trees.cut[at];
    }
  }
  // A root has no component above it: without it, only the parts below it are left.
  for (std::size_t at = 0; at < size; ++at) trees.without[at] += count - (trees.parent[at] == size ? 1 : 0);
  return trees;
}

Components NetworkLinks::components_without(std::size_t at, const Trees& trees) const {
  const std::size_t size = network_.size();
  if (all_) return {.of = std::vector<std::size_t>(size, 0), .count = 1};
  Components found{.of = std::vector<std::size_t>(size, size)};
  std::size_t rest = size, cut = size, cut_end = 0;  // components: of the tree, and of those that `at` cuts off
  for (std::size_t place = 0; place < trees.order.size(); ++place) {
    const std::size_t member = trees.order[place];
    if (trees.parent[member] == size) rest = size;
    if (member == at) continue;
    if (trees.parent[member] == at && trees.cut[member]) cut = found.count++, cut_end = trees.end[member];
    if (place >= cut_end && rest == size) rest = found.count++;
    found.of[member] = place < cut_end ? cut : rest;
  }
  return found;
}

Components components_of(const CoverProblem& problem, std::span<const std::size_t> network, double link) {
  return NetworkLinks(problem, network, link).components();
}

Joinable::Joinable(const CoverProblem& problem, std::span<const std::size_t> network)
    : problem_(problem), against_(problem.matrix.candidates(), 0) {
  for (const std::size_t k : network) add(k);
}

void Joinable::count(std::size_t candidate, int by) {
  const auto change = static_cast<std::uint32_t>(by);  // wraps around, and back
  against_[candidate] += change;
  if (!problem_.graph) return;
  for (const std::uint32_t other : problem_.graph->excluded(candidate)) against_[other] += change;
}

std::size_t NetworkLinks::joined(const Components& components, std::size_t candidate, std::size_t without) const {
  const std::span<const std::uint32_t> places = of(candidate);
  if (components.count == 1) return places.size() > 1 || (places.size() == 1 && places.front() != without) ? 1 : 0;
  constexpr std::size_t kBits = 64;
  if (components.count <= kBits) {
    std::uint64_t bits = 0;
    for (const std::uint32_t place : places)
      if (place != without) bits |= std::uint64_t{1} << components.of[place];
    return static_cast<std::size_t>(std::popcount(bits));
  }
  std::vector<std::size_t> found;
  for (const std::uint32_t place : places)
    if (place != without && std::ranges::find(found, components.of[place]) == found.end())
      found.push_back(components.of[place]);
  return found.size();
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
