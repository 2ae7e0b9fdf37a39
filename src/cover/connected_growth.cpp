// SPDX-License-Identifier: Apache-2.0
#include "cover/connected_growth.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <optional>
#include <span>
#include <utility>

#include "cover/network.hpp"
#include "cover/partial_cover.hpp"

namespace vantage {
namespace {

// Largest number of candidates on a path, and number of the most promising paths that are evaluated as a whole.
constexpr std::size_t kLongestPath = 4, kPathsTried = 24;

using Path = std::vector<std::size_t>;

class Growth {
 public:
  Growth(const CoverProblem& problem, std::vector<std::size_t> network)
      : problem_(problem),
        none_(problem.matrix.candidates()),
        free_(free_candidates(problem)),
        network_(std::move(network)),
        cover_(problem.matrix, network_) {
    const std::size_t existing = problem.existing.size(), most = problem.most;
    most_ = most < none_ - std::min(existing, none_) ? existing + most : none_;
  }

  std::vector<std::size_t> run() {
    if (network_.empty())
      if (const auto first = first_candidate()) add({*first});
    const std::size_t fewest = problem_.existing.size() + problem_.fewest;
    bool along_links = problem_.link > 0;
    while (network_.size() < most_) {
      const bool enough = cover_.value() >= problem_.coverage;
      if (enough && network_.size() >= fewest) {
        if (components_of(problem_, network_, problem_.link).count == 1) break;
        const Path path = path_between_components();
        if (path.empty() || network_.size() + path.size() > most_) break;
        add(path);
        continue;
      }
      Path path;
      if (along_links) path = best_path();
      if (path.empty()) {
        // No path adds anything. Only coverage is left to gain; missing links are a violation.
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
      if (network_.size() < std::min(most_, fewest) && may_stand(problem_, k, network_)) add({k});
    return std::move(network_);
  }

 private:
  void add(const Path& path) {
    for (const std::size_t k : path)
      if (network_.size() < most_) network_.push_back(k), cover_.add(k);
  }

  // Whether `k` may stand with all candidates on the way back from `at`.
  bool may_follow(std::size_t k, std::size_t at, std::span<const std::size_t> from) const {
    for (; from[at] < none_; at = from[at])
      if (!may_stand(problem_, k, {&at, 1})) return false;
    return true;
  }

  // Gains of all free candidates that may stand; 0 of others.
  std::vector<double> gains() const {
    std::vector<double> gains(none_, 0);
    tbb::parallel_for(std::size_t{0}, free_.size(), [&](std::size_t i) {
      const std::size_t k = free_[i];
      if (may_stand(problem_, k, network_)) gains[k] = cover_.gain(k);
    });
    return gains;
  }

  std::optional<std::size_t> first_candidate() const;
  std::optional<std::size_t> best_anywhere() const;
  Path best_path() const;
  Path path_between_components() const;

  const CoverProblem& problem_;
  std::size_t none_;
  std::vector<std::size_t> free_, network_;
  PartialCover cover_;
  std::size_t most_ = 0;  // largest number in the network
};

// The candidate with the most coverage in the component that covers most as a whole.
std::optional<std::size_t> Growth::first_candidate() const {
  const Components parts =
      components(free_.size(), [&](std::size_t i, std::size_t j) { return linked(problem_, free_[i], free_[j]); });
  const PartialCover none(problem_.matrix);
  std::optional<std::size_t> best;
  double most = 0;
  for (std::size_t part = 0; part < parts.count; ++part) {
    PartialCover all(problem_.matrix);
    std::size_t richest = 0;
    double gain = -1;
    for (std::size_t i = 0; i < free_.size(); ++i) {
      if (parts.of[i] != part) continue;
      all.add(free_[i]);
      if (const double alone = none.gain(free_[i]); alone > gain) gain = alone, richest = free_[i];
    }
    if (const double together = all.value(); !best || together > most) most = together, best = richest;
  }
  return best;
}

std::optional<std::size_t> Growth::best_anywhere() const {
  const std::vector<double> gain = gains();
  std::optional<std::size_t> best;
  double most = 0;
  for (const std::size_t k : free_)
    if (gain[k] > most) most = gain[k], best = k;
  return best;
}

// The path along links, from the network to a promising candidate, with the largest gain for each candidate on it.
Path Growth::best_path() const {
  std::vector<std::size_t> hops(none_, none_), from(none_, none_), now = network_, next;
  const std::vector<double> gain = gains();
  for (const std::size_t k : network_) hops[k] = 0;
  struct End {
    double score;  // upper bound of the path's gain for each candidate
    std::size_t candidate;
  };
  std::vector<End> ends;
  for (std::size_t hop = 1; hop <= kLongestPath && !now.empty(); ++hop) {
    next.clear();
    // Ways back from `now` lead over earlier hops, which stay as they are.
    tbb::parallel_for(std::size_t{0}, free_.size(), [&](std::size_t i) {
      const std::size_t k = free_[i];
      if (hops[k] < none_ || !may_stand(problem_, k, network_)) return;
      for (const std::size_t before : now)
        if (linked(problem_, before, k) && (from[k] == none_ || gain[before] > gain[from[k]]) &&
            may_follow(k, before, from))
          from[k] = before;
    });
    for (const std::size_t k : free_)
      if (hops[k] == none_ && from[k] < none_) next.push_back(k);
    for (const std::size_t k : next) {
      hops[k] = hop;
      double sum = 0;
      for (std::size_t at = k; hops[at] > 0; at = from[at]) sum += gain[at];
      if (gain[k] > 0) ends.push_back({sum / static_cast<double>(hop), k});
    }
    now = next;
  }
  std::ranges::sort(ends, [](const End& a, const End& b) {
    return a.score != b.score ? a.score > b.score : a.candidate < b.candidate;
  });
  Path best;
  double most = 0;
  for (std::size_t i = 0; i < ends.size() && i < kPathsTried && ends[i].score > most; ++i) {
    Path path;
    for (std::size_t at = ends[i].candidate; hops[at] > 0; at = from[at]) path.push_back(at);
    std::ranges::reverse(path);
    double sum = gain[path.front()];
    if (path.size() > 1) {
      PartialCover along = cover_;
      sum = 0;
      for (const std::size_t k : path) sum += along.gain(k), along.add(k);
    }
    if (const double each = sum / static_cast<double>(path.size()); each > most) most = each, best = std::move(path);
  }
  return best;
}

// The candidates between the first component and the one with the shortest path to it; empty if links lead to none.
Path Growth::path_between_components() const {
  const Components parts = components_of(problem_, network_, problem_.link);
  std::vector<std::size_t> from(none_, none_), open;
  std::vector<char> seen(none_, 0), other(none_, 0);
  for (std::size_t i = 0; i < network_.size(); ++i) {
    if (parts.of[i] == 0)
      seen[network_[i]] = 1, open.push_back(network_[i]);
    else
      other[network_[i]] = 1;
  }
  for (std::size_t i = 0; i < open.size(); ++i) {
    const std::size_t at = open[i];
    for (std::size_t k = 0; k < none_; ++k) {
      if (seen[k] || !linked(problem_, at, k) || (!other[k] && !may_stand(problem_, k, network_))) continue;
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

std::vector<std::size_t> grow_connected(const CoverProblem& problem, std::vector<std::size_t> network) {
  return Growth(problem, std::move(network)).run();
}

CoverSolution grow_and_swap(const CoverProblem& problem, std::vector<std::size_t> network,
                            const std::stop_token& stop) {
  return evaluate_cover(problem, improve_by_swaps(problem, grow_connected(problem, std::move(network)), stop));
}

}  // namespace vantage
