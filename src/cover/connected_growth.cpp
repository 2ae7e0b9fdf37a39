// SPDX-License-Identifier: Apache-2.0
#include "cover/connected_growth.hpp"

#include <algorithm>
#include <optional>
#include <span>
#include <utility>

#include "cover/network.hpp"
#include "cover/partial_cover.hpp"
#include "cover/swaps.hpp"

namespace vantage {
namespace {

// Largest number of candidates on a path, and number of the most promising paths that are evaluated as a whole.
constexpr std::size_t kLongestPath = 4, kPathsTried = 24;
// A path is dropped for a candidate without a link if that gains this many times as much as each on the path.
constexpr double kWorthLeaving = 5;

using Path = std::vector<std::size_t>;

class Growth {
 public:
  Growth(const CoverProblem& problem, const ColumnIndex& columns, std::vector<std::size_t> network, Links links)
      : problem_(problem),
        links_(links),
        none_(problem.matrix.candidates()),
        free_(free_candidates(problem)),
        network_(std::move(network)),
        gains_(problem.matrix, columns, network_),
        joinable_(problem, network_) {
    const std::size_t existing = problem.existing.size(), most = problem.most;
    most_ = most < none_ - std::min(existing, none_) ? existing + most : none_;
    if (problem.link <= 0) return;
    linked_.resize(none_);
    for (std::size_t k = 0; k < none_; ++k)
      for (const StationGraph::Overlap& other : problem.graph->overlaps(k))
        if (static_cast<double>(other.share) >= problem.link) linked_[k].push_back(other.candidate);
  }

  std::vector<std::size_t> run() {
    if (network_.empty())
      if (const auto first = first_candidate()) add({*first});
    const std::size_t fewest = problem_.existing.size() + problem_.fewest;
    bool along_links = problem_.link > 0;
    while (network_.size() < most_) {
      const bool enough = gains_.share(gains_.value()) >= problem_.coverage;
      if (enough && network_.size() >= fewest) {
        if (components_of(problem_, network_, problem_.link).count == 1) break;
        const Path path = path_between_components();
        if (path.empty() || network_.size() + path.size() > most_) break;
        add(path);
        continue;
      }
      Path path;
      if (along_links) path = best_path();
      if (!path.empty() && links_ == Links::left_for_gain)
        if (const auto best = best_anywhere();
            best && gain(*best) * static_cast<double>(path.size()) > kWorthLeaving * gain_along(path))
          path.assign(1, *best);
      if (path.empty()) {
        // No path gains anything, so only candidates without links do; missing links are a violation.
        if (along_links && enough) break;
        along_links = false;
        const auto best = best_anywhere();
        if (!best) break;
        path.assign(1, *best);
      }
      add(path);
    }
    // Candidates that add nothing fill up to the requested number.
    for (const std::size_t k : free_)
      if (network_.size() < std::min(most_, fewest) && joinable_.may_stand(k)) add({k});
    return std::move(network_);
  }

 private:
  void add(const Path& path) {
    for (const std::size_t k : path)
      if (network_.size() < most_) network_.push_back(k), gains_.add(k), joinable_.add(k);
  }

  // True if `k` may stand with all candidates on the path back from `at`.
  bool may_follow(std::size_t k, std::size_t at, std::span<const std::size_t> from) const {
    for (; from[at] < none_; at = from[at])
      if (at == k || problem_.graph->excluded(k, at)) return false;
    return true;
  }

  // Returns the gain of a candidate that may stand, and 0 for any other.
  CoverUnits units(std::size_t k) const { return joinable_.may_stand(k) ? gains_[k] : 0; }
  double gain(std::size_t k) const { return gains_.share(units(k)); }
  double gain_along(const Path& path) const;

  std::optional<std::size_t> first_candidate() const;
  std::optional<std::size_t> best_anywhere() const;
  Path best_path() const;
  Path path_between_components() const;
  Path path_from(const Components& parts, std::size_t part) const;

  const CoverProblem& problem_;
  Links links_;
  std::size_t none_;
  std::vector<std::size_t> free_, network_;
  CoverGains gains_;
  Joinable joinable_;
  std::size_t most_ = 0;                            // most stations, existing ones included
  std::vector<std::vector<std::uint32_t>> linked_;  // by candidate, rising; none if links are not asked for
};

// The candidate with the most coverage in the component that covers most as a whole.
std::optional<std::size_t> Growth::first_candidate() const {
  const Components parts = components_of(problem_, free_, problem_.link);
  std::optional<std::size_t> best;
  double most = 0;
  for (std::size_t part = 0; part < parts.count; ++part) {
    std::vector<std::size_t> members;
    for (std::size_t i = 0; i < free_.size(); ++i)
      if (parts.of[i] == part) members.push_back(free_[i]);
    const double together = parts.count > 1 ? problem_.matrix.coverage(members) : 1;
    if (best && together <= most) continue;
    most = together;
    best = *std::ranges::max_element(members, {}, [&](std::size_t k) { return gains_[k]; });
  }
  return best;
}

std::optional<std::size_t> Growth::best_anywhere() const {
  std::optional<std::size_t> best;
  double most = 0;
  for (const std::size_t k : free_)
    if (gain(k) > most) most = gain(k), best = k;
  return best;
}

// Gain of all candidates of a path together.
double Growth::gain_along(const Path& path) const {
  if (path.size() == 1) return gain(path.front());
  double sum = 0;
  std::vector<CoverageMatrix::Entry> added;  // by the candidates before
  for (const std::size_t k : path) {
    const std::span<const CoverageMatrix::Entry> column = problem_.matrix.column(k);
    sum += gains_.cover().gain(k, added);
    std::vector<CoverageMatrix::Entry> both;
    both.reserve(added.size() + column.size());
    std::ranges::merge(added, column, std::back_inserter(both), {}, &CoverageMatrix::Entry::element,
                       &CoverageMatrix::Entry::element);
    added.clear();
    for (const CoverageMatrix::Entry& one : both) {
      if (!added.empty() && added.back().element == one.element)
        added.back().amount += one.amount;
      else
        added.push_back(one);
    }
  }
  return sum;
}

// Path along links, from the network to a promising candidate, with the largest gain per candidate on it.
Path Growth::best_path() const {
  std::vector<std::size_t> hops(none_, none_), from(none_, none_), reached = network_, next;
  for (const std::size_t k : network_) hops[k] = 0;
  std::ranges::sort(reached);
  struct End {
    double score;  // upper bound of the path's gain for each candidate
    std::size_t candidate;
  };
  std::vector<End> ends;
  CoverUnits one_step = 0;  // the largest gain of a candidate that is linked to the network
  for (std::size_t hop = 1; hop <= kLongestPath; ++hop) {
    next.clear();
    for (const std::size_t before : reached)
      for (const std::size_t k : linked_[before]) {
        if (hops[k] < none_ || !joinable_.may_stand(k)) continue;
        if ((from[k] < none_ && units(before) <= units(from[k])) || !may_follow(k, before, from)) continue;
        if (from[k] == none_) next.push_back(k);
        from[k] = before;
      }
    std::ranges::sort(next);
    if (next.empty()) break;
    for (const std::size_t k : next) {
      hops[k] = hop;
      double sum = 0;
      for (std::size_t at = k; hops[at] > 0; at = from[at]) sum += gain(at);
      if (gain(k) > 0) ends.push_back({sum / static_cast<double>(hop), k});
      if (hop == 1) one_step = std::max(one_step, units(k));
    }
    // A longer path gains more per candidate only if one of its candidates gains more than all that are one step away.
    if (std::ranges::none_of(free_, [&](std::size_t k) { return hops[k] == none_ && units(k) > one_step; })) break;
    reached.swap(next);
  }
  const std::size_t tried = std::min(kPathsTried, ends.size());
  std::ranges::partial_sort(ends, ends.begin() + static_cast<std::ptrdiff_t>(tried), [](const End& a, const End& b) {
    return a.score != b.score ? a.score > b.score : a.candidate < b.candidate;
  });
  Path best;
  double most = 0;
  for (std::size_t i = 0; i < tried && ends[i].score > most; ++i) {
    Path path;
    for (std::size_t at = ends[i].candidate; hops[at] > 0; at = from[at]) path.push_back(at);
    std::ranges::reverse(path);
    if (const double each = gain_along(path) / static_cast<double>(path.size()); each > most)
      most = each, best = std::move(path);
  }
  return best;
}

// Candidates from the first component that has a path to another one, up to that one; empty if none has.
Path Growth::path_between_components() const {
  const Components parts = components_of(problem_, network_, problem_.link);
  for (std::size_t part = 0; part < parts.count; ++part)
    if (Path path = path_from(parts, part); !path.empty()) return path;
  return {};
}

// The shortest path from a component to another one.
Path Growth::path_from(const Components& parts, std::size_t part) const {
  std::vector<std::size_t> from(none_, none_), open;
  std::vector<char> seen(none_, 0), other(none_, 0);
  for (std::size_t i = 0; i < network_.size(); ++i) {
    if (parts.of[i] == part)
      seen[network_[i]] = 1, open.push_back(network_[i]);
    else
      other[network_[i]] = 1;
  }
  for (std::size_t i = 0; i < open.size(); ++i) {
    const std::size_t at = open[i];
    for (const std::size_t k : linked_[at]) {
      if (seen[k] || (!other[k] && !joinable_.may_stand(k))) continue;
      if (!may_follow(k, at, from)) continue;
      from[k] = at, seen[k] = 1;
      if (!other[k]) {
        open.push_back(k);
        continue;
      }
      Path path;
      for (std::size_t back = at; from[back] < none_; back = from[back]) path.push_back(back);
      return path;
    }
  }
  return {};
}

}  // namespace

std::vector<std::size_t> grow_connected(const CoverProblem& problem, const ColumnIndex& columns,
                                        std::vector<std::size_t> network, Links links) {
  return Growth(problem, columns, std::move(network), links).run();
}

CoverSolution grow_and_swap(const CoverProblem& problem, const ColumnIndex& columns, std::vector<std::size_t> network,
                            const std::stop_token& stop) {
  network = grow_connected(problem, columns, std::move(network));
  return evaluate_cover(problem, improve_by_swaps(problem, columns, std::move(network), stop));
}

}  // namespace vantage
