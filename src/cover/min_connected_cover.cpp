// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <limits>
#include <utility>

#include "cover/connected_growth.hpp"
#include "cover/network.hpp"
#include "cover/partial_cover.hpp"
#include "cover/tabu_search.hpp"

namespace vantage {
namespace {

// Networks of one candidate fewer from which a search starts: those that lose least.
constexpr std::size_t kStarts = 3;
// Swaps tried without less violation before a search gives up.
constexpr std::size_t kPatience = 100;
// Elements of the first choice, and how often it is made with a larger margin.
constexpr std::size_t kFirstElements = 5000, kMargins = 3;
// Accuracy of the weakest link.
constexpr double kLinkStep = 0.02;

// Places of the chosen candidates that may leave; the one with the least violation first.
std::vector<std::size_t> places_by_loss(const CoverProblem& problem, const std::vector<std::size_t>& chosen) {
  struct Loss {
    double violation, coverage;
    std::size_t at;
  };
  const PartialCover cover(problem.matrix, chosen);
  const double whole = cover.value();
  const std::vector<std::size_t> components = NetworkLinks(problem, chosen, problem.link).counts_without();
  std::vector<Loss> losses;
  for (std::size_t at = problem.existing.size(); at < chosen.size(); ++at) {
    const double coverage = whole - cover.loss(chosen[at]);
    losses.push_back({violation(problem, coverage, components[at]), coverage, at});
  }
  std::ranges::stable_sort(losses, [](const Loss& a, const Loss& b) {
    return a.violation != b.violation ? a.violation < b.violation : a.coverage > b.coverage;
  });
  std::vector<std::size_t> places;
  for (const Loss& loss : losses) places.push_back(loss.at);
  return places;
}

// A choice, and the candidates that its search tried.
struct Choice {
  ConnectedCover cover;
  std::vector<std::size_t> tried = {};
};

// `fewer`: a network of few candidates from which the search for one candidate fewer starts, where it has that number.
Choice choose(const CoverProblem& problem, std::optional<CoverSolution> start, const std::vector<std::size_t>& fewer,
              const std::stop_token& stop) {
  const TabuSearch tabu(problem, kPatience, stop);
  Choice choice{
      {.best = start ? std::move(*start) : evaluate_cover(problem, grow_connected(problem, problem.existing))}};
  CoverSolution& best = choice.cover.best;
  std::optional<CoverSolution>& nearest = choice.cover.one_fewer;
  const auto take_in = [&](const std::vector<std::size_t>& candidates) {
    choice.tried.insert(choice.tried.end(), candidates.begin(), candidates.end());
  };
  const auto placed = [&] { return best.chosen.size() - problem.existing.size(); };
  const auto swap = [&] {
    TabuSearch::Found found = tabu.run(best.chosen, problem.link);
    take_in(found.joined);
    best = evaluate_cover(problem, std::move(found.network));
  };
  take_in(best.chosen);
  // Growth alone can shut itself in: where candidates keep a distance from each other, a chosen one may block the only
  // way to the rest. Swaps open it.
  for (double before = best.violation + 1; best.violation > 0 && best.violation < before && !stop.stop_requested();) {
    before = best.violation;
    swap();
    if (best.violation == 0 || placed() >= problem.most) break;
    CoverSolution more = evaluate_cover(problem, grow_connected(problem, best.chosen));
    take_in(more.chosen);
    if (more.violation < best.violation) best = std::move(more);
  }
  // One fewer while that is no worse, even if the network is not feasible.
  while (placed() > std::max<std::size_t>(problem.fewest, 1) && !stop.stop_requested()) {
    const std::vector<std::size_t> places = places_by_loss(problem, best.chosen);
    std::vector<std::vector<std::size_t>> starts;
    if (fewer.size() + 1 == best.chosen.size()) starts.push_back(fewer);
    for (std::size_t k = 0; k < places.size() && starts.size() < kStarts; ++k)
      starts.push_back(without(best.chosen, places[k]));
    // Most often the first one will do, while there are many.
    bool found = false;
    for (std::size_t from = 0, to = 1; from < starts.size() && !found; from = std::exchange(to, starts.size()))
      for (TabuSearch::Found& one :
           tabu.run(std::span(starts).subspan(from, to - from), problem.link, best.violation)) {
        take_in(one.joined);
        CoverSolution now = evaluate_cover(problem, std::move(one.network));
        if (now.violation <= best.violation)
          best = std::move(now), found = true;
        else if (!nearest || nearest->chosen.size() > now.chosen.size() || nearest->violation > now.violation)
          nearest = std::move(now);
        if (found) break;
      }
    if (!found) break;
  }
  if (best.violation > 0 && !stop.stop_requested()) swap();
  return choice;
}

// The same problem on some elements.
CoverageMatrix with_elements(const CoverageMatrix& matrix, std::size_t step) {
  constexpr auto kNone = std::numeric_limits<std::uint32_t>::max();
  std::vector<std::uint32_t> weights, place(matrix.elements(), kNone);
  std::vector<double> goals;
  std::size_t counted = 0;
  for (std::size_t e = 0; e < matrix.elements(); ++e) {
    if (matrix.weight(e) <= 0 || counted++ % step != 0) continue;
    place[e] = static_cast<std::uint32_t>(weights.size());
    weights.push_back(matrix.weights()[e]);
    goals.push_back(matrix.goal(e));
  }
  CoverageMatrix some(std::move(weights), matrix.goal());
  some.set_goals(goals);
  std::vector<CoverageMatrix::Entry> column;
  for (std::size_t k = 0; k < matrix.candidates(); ++k) {
    column.clear();
    for (const CoverageMatrix::Entry& one : matrix.column(k))
      if (place[one.element] != kNone) column.push_back({place[one.element], one.amount});
    some.add(std::span<const CoverageMatrix::Entry>(column));
  }
  return some;
}

// The same problem with some candidates, the existing ones among them.
class SomeCandidates {
 public:
  SomeCandidates(const CoverProblem& whole, std::vector<std::size_t> candidates)
      : candidates_(std::move(candidates)), matrix_(whole.matrix.weights(), whole.matrix.goal()) {
    candidates_.insert(candidates_.end(), whole.existing.begin(), whole.existing.end());
    std::ranges::sort(candidates_);
    candidates_.erase(std::unique(candidates_.begin(), candidates_.end()), candidates_.end());
    std::vector<double> goals(whole.matrix.elements());
    for (std::size_t e = 0; e < goals.size(); ++e) goals[e] = whole.matrix.weight(e) > 0 ? whole.matrix.goal(e) : 0;
    matrix_.set_goals(goals);
    for (const std::size_t k : candidates_) matrix_.add(whole.matrix.column(k));
    if (whole.graph) {
      graph_ = StationGraph(candidates_.size());
      for (std::size_t i = 0; i < candidates_.size(); ++i) {
        for (const StationGraph::Overlap& other : whole.graph->overlaps(candidates_[i]))
          if (const auto j = place_of(other.candidate); j && *j < i) graph_.set_overlap(i, *j, other.share);
        for (const std::uint32_t other : whole.graph->excluded(candidates_[i]))
          if (const auto j = place_of(other); j && *j < i) graph_.exclude(i, *j);
      }
    }
    problem_.graph = whole.graph ? &graph_ : nullptr;
    problem_.existing = here(whole.existing);
    problem_.fewest = whole.fewest, problem_.most = whole.most;
    problem_.coverage = whole.coverage, problem_.link = whole.link;
  }
  SomeCandidates(const SomeCandidates&) = delete;
  SomeCandidates& operator=(const SomeCandidates&) = delete;

  const CoverProblem& problem() const { return problem_; }
  // Candidates of the whole problem by their numbers here, and back. REQUIRES: all are here.
  std::vector<std::size_t> here(std::vector<std::size_t> network) const {
    for (std::size_t& k : network) k = *place_of(k);
    return network;
  }
  std::vector<std::size_t> there(std::vector<std::size_t> network) const {
    for (std::size_t& k : network) k = candidates_[k];
    return network;
  }

 private:
  std::optional<std::size_t> place_of(std::size_t candidate) const {
    const auto found = std::ranges::lower_bound(candidates_, candidate);
    if (found == candidates_.end() || *found != candidate) return std::nullopt;
    return static_cast<std::size_t>(found - candidates_.begin());
  }

  std::vector<std::size_t> candidates_;  // rising
  CoverageMatrix matrix_;
  StationGraph graph_;
  CoverProblem problem_{.matrix = matrix_};
};

// Lower fidelity first: among all candidates on some elements, with a margin for what these flatter; then among the
// candidates that this tried, on all elements.
ConnectedCover choose_twice(const CoverProblem& problem, std::optional<CoverSolution> start, std::size_t step,
                            const std::stop_token& stop) {
  const CoverageMatrix some = with_elements(problem.matrix, step);
  CoverProblem first{.matrix = some,
                     .graph = problem.graph,
                     .existing = problem.existing,
                     .fewest = problem.fewest,
                     .most = problem.most,
                     .coverage = problem.coverage,
                     .link = problem.link};
  std::vector<std::size_t> tried, fewer;
  if (start) tried = start->chosen;
  for (std::size_t k = 0; k < kMargins; ++k) {
    std::optional<CoverSolution> from;
    if (start) from = evaluate_cover(first, start->chosen);
    const Choice choice = choose(first, std::move(from), fewer, stop);
    tried.insert(tried.end(), choice.tried.begin(), choice.tried.end());
    if (choice.cover.one_fewer) fewer = choice.cover.one_fewer->chosen;
    start = evaluate_cover(problem, choice.cover.best.chosen);
    if (choice.cover.best.violation > 0 || start->violation == 0 || stop.stop_requested()) break;
    first.coverage = choice.cover.best.coverage + (problem.coverage - start->coverage);
  }
  tried.insert(tried.end(), fewer.begin(), fewer.end());
  const SomeCandidates candidates(problem, std::move(tried));
  start->chosen = candidates.here(std::move(start->chosen));
  ConnectedCover found = choose(candidates.problem(), std::move(start), candidates.here(std::move(fewer)), stop).cover;
  found.best.chosen = candidates.there(std::move(found.best.chosen));
  if (found.one_fewer) found.one_fewer->chosen = candidates.there(std::move(found.one_fewer->chosen));
  return found;
}

}  // namespace

ConnectedCover min_connected_cover(const CoverProblem& problem, std::stop_token stop,
                                   std::optional<CoverSolution> start) {
  check(problem);
  std::size_t counted = 0;
  for (std::size_t e = 0; e < problem.matrix.elements(); ++e) counted += problem.matrix.weight(e) > 0;
  if (const std::size_t step = counted / kFirstElements; step > 1)
    return choose_twice(problem, std::move(start), step, stop);
  return choose(problem, std::move(start), {}, stop).cover;
}

CoverSolution improve_weakest_link(const CoverProblem& problem, CoverSolution from, double enough,
                                   std::stop_token stop) {
  check(problem);
  if (from.violation == 0 && (!problem.graph || from.link >= enough || from.chosen.size() < 2)) return from;
  const TabuSearch tabu(problem, kPatience, stop);
  CoverSolution best = std::move(from);
  if (best.violation > 0) {
    CoverSolution found = evaluate_cover(problem, tabu.run(best.chosen, problem.link).network);
    if (found.violation < best.violation) best = std::move(found);
  }
  while (problem.graph && best.violation == 0 && best.chosen.size() > 1 && best.link < enough &&
         !stop.stop_requested()) {
    // The same start with other random numbers: a link that is missed for want of a search costs stations later.
    const std::vector<std::vector<std::size_t>> starts(kStarts, best.chosen);
    CoverSolution found =
        evaluate_cover(problem, tabu.run(starts, std::min(best.link + kLinkStep, enough), 0).back().network);
    if (found.violation > 0 || found.link <= best.link) break;
    best = std::move(found);
  }
  return best;
}

}  // namespace vantage
