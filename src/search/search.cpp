// SPDX-License-Identifier: Apache-2.0
#include "search/search.hpp"

#include <algorithm>
#include <chrono>
#include <exception>
#include <map>
#include <memory>
#include <optional>
#include <sstream>
#include <utility>

#include "core/seconds_since.hpp"
#include "search/choose_optimiser.hpp"
#include "search/proposal.hpp"
#include "search/scaled_objectives.hpp"
#include "search/search_log.hpp"
#include "vantage/error.hpp"

namespace vantage {
namespace {

class Search {
 public:
  explicit Search(const SearchSetup& setup)
      : setup_(setup),
        population_(population_of(setup.problem, setup.config)),
        optimiser_(choose_optimiser(setup.space, setup.problem, setup.config, setup.batch, setup.start)),
        log_(setup.config, setup.identity, setup.warn),
        begins_with_(first_network()) {}

  SearchOutcome run() {
    if (const auto snapshot = log_.resume())
      go_on_from(*snapshot);
    else
      take_snapshot();
    StopReason reason = StopReason::running;
    try {
      while (reason == StopReason::running) {
        reason = reason_to_stop();
        if (reason == StopReason::running && !iterate()) reason = StopReason::cancelled;
      }
    } catch (...) {
      const auto lost = std::current_exception();
      try {
        save();                 // a lost device must not take hours of work with it
      } catch (const Error&) {  // the error that ended the search matters more
      }
      std::rethrow_exception(lost);
    }
    save();
    // Not saved: a resumed search continues from the archive before this.
    if (reason != StopReason::cancelled && !verify()) reason = StopReason::cancelled;
    return outcome(reason);
  }

 private:
  // One batch: ask, place, evaluate, tell. False if stopped.
  bool iterate() {
    const bool first = optimiser_->evaluations() == 0;
    const Proposal batch = propose(*optimiser_, setup_.space, setup_.config.redraws,
                                   first ? std::span<const double>(begins_with_) : std::span<const double>());
    drawn_ += batch.drawn, redrawn_ += batch.redrawn;
    const std::optional<SearchValues> values = evaluate(batch.networks);
    if (!values) return false;
    const std::size_t n = setup_.space.dimension();
    optimiser_->tell(scaled(*values, [&](std::size_t k) { return std::span(batch.xs).subspan(k * n, n); }));
    if (record() && !refresh_archive()) return false;
    if (log_.due()) {
      take_snapshot();
      save();
    }
    return true;
  }

  // Empty if stopped.
  std::optional<SearchValues> evaluate(std::span<const PlacedNetwork> networks) {
    SearchValues values = log_.replay(networks.size());
    resumed_ += values.size(), evaluated_ += values.size();
    while (values.size() < networks.size()) {
      if (setup_.stop.stop_requested()) return std::nullopt;
      const std::size_t left = networks.size() - values.size(), most = setup_.evaluator.chunk(),
                        chunk = most == 0 ? left : std::min(left, most);
      const auto found = setup_.evaluator.evaluate(
          networks.subspan(values.size(), chunk),
          {.report = [&](double done) { watch(static_cast<double>(chunk) * done); }, .stop = setup_.stop});
      if (!found) return std::nullopt;
      log_.add(*found);
      values.insert(values.end(), found->begin(), found->end());
      evaluated_ += chunk;
      watch(0);
      if (values.size() < networks.size() && log_.due()) save();
    }
    return values;
  }

  // Scaled objectives of networks, row-major. `x_of`: the decision vector of row k.
  template <class X>
  std::vector<double> scaled(const SearchValues& values, const X& x_of) const {
    const SurveyProblem& problem = setup_.problem;
    const std::size_t m = problem.objectives.size();
    std::vector<double> f(values.size() * m);
    for (std::size_t k = 0; k < values.size(); ++k)
      scale_objectives(problem, x_of(k), values[k], missed_by(problem, setup_.measures, values[k]),
                       std::span(f).subspan(k * m, m));
    return f;
  }

  // Records an iteration if one has ended, and returns true then.
  bool record() {
    const std::uint64_t iteration = optimiser_->iterations();
    const std::uint64_t last = history_.empty() ? 0 : history_.back().iteration;
    if (iteration == last) return false;
    PlanIteration& line = history_.emplace_back();
    line.iteration = iteration, line.evaluations = optimiser_->evaluations();
    line.hypervolume = optimiser_->hypervolume();
    front_ = optimiser_->front();
    for (const ParetoPoint& point : front_) line.front.push_back(point.f);
    line.seconds = log_.seconds();
    return true;
  }

  SearchArchive archive() const {
    SearchArchive archive{.points = optimiser_->population(), .networks = {}};
    for (const ParetoPoint& point : archive.points) archive.networks.push_back(setup_.space.decode(point.x));
    return archive;
  }

  void reassess(const SearchArchive& archive, const SearchValues& values) {
    optimiser_->reassess(scaled(values, [&](std::size_t k) -> std::span<const double> { return archive.points[k].x; }));
    front_ = optimiser_->front();
  }

  // Re-evaluates the archive if that is due. False if stopped.
  bool refresh_archive() {
    ArchiveEvaluator* const evaluator = setup_.evaluator.archive();
    if (!evaluator || !evaluator->due(optimiser_->population(), history_.size())) return true;
    const SearchArchive members = archive();
    const auto values = evaluator->re_evaluate(members, history_.size(), {.stop = setup_.stop});
    if (!values) return false;
    reassess(members, *values);
    // From here on the replayed values belong to an archive with these values.
    if (log_.has_file()) take_snapshot();
    return true;
  }

  // Evaluates the archive for the last time. False if stopped.
  bool verify() {
    ArchiveEvaluator* const evaluator = setup_.evaluator.archive();
    if (!evaluator) return true;
    const SearchArchive members = archive();
    const auto estimates = evaluator->verify(members, history_.size(), {.stop = setup_.stop});
    if (!estimates) return false;
    SearchValues values(estimates->size());
    for (std::size_t k = 0; k < values.size(); ++k) {
      for (const Estimate& estimate : (*estimates)[k]) values[k].push_back(estimate.value);
      verified_[members.points[k].x] = (*estimates)[k];
    }
    reassess(members, values);
    return true;
  }

  // Values of a checkpoint are replayed before anything else can stop the search, so that it continues where it ended.
  StopReason reason_to_stop() const {
    if (optimiser_->stop_reason() != StopReason::running) return optimiser_->stop_reason();
    return setup_.stop.stop_requested() && !log_.replaying() ? StopReason::cancelled : StopReason::running;
  }

  void watch(double under_way) const {
    if (!setup_.watch) return;
    const double here = seconds_since(start_), fresh = static_cast<double>(evaluated_ - resumed_) + under_way,
                 rate = here > 0 ? fresh / here : 0,
                 left = static_cast<double>(setup_.config.iterations) * static_cast<double>(population_) -
                        static_cast<double>(evaluated_) - under_way;
    setup_.watch({.iteration = evaluated_ / population_,
                  .iterations = setup_.config.iterations,
                  .evaluations = evaluated_,
                  .hypervolume = history_.empty() ? 0 : history_.back().hypervolume,
                  .evaluations_per_second = rate,
                  .seconds_left = rate > 0 ? std::max(0.0, left) / rate : 0,
                  .phase = "search",
                  .front = front_});
  }

  // REQUIRES: no batch is open.
  void take_snapshot() {
    std::ostringstream state;
    state.exceptions(std::ios::badbit);  // fails for lack of memory, never of disk space
    optimiser_->save(state);
    log_.take({.optimiser = std::move(state).str(),
               .evaluator = setup_.evaluator.state(),
               .history = history_,
               .drawn = drawn_,
               .redrawn = redrawn_});
  }

  void save() { log_.save(setup_.evaluator.trace_seconds()); }

  void go_on_from(const SearchSnapshot& snapshot) {
    std::istringstream state(snapshot.optimiser);
    optimiser_->load(state);
    setup_.evaluator.restore(snapshot.evaluator);
    history_ = snapshot.history;
    drawn_ = snapshot.drawn, redrawn_ = snapshot.redrawn;
    resumed_ = evaluated_ = optimiser_->evaluations();
  }

  SearchOutcome outcome(StopReason reason) const {
    SearchEstimates estimates;
    std::vector<ParetoPoint> front = setup_.evaluator.archive() ? optimiser_->population() : optimiser_->front();
    if (!verified_.empty())
      for (const ParetoPoint& point : front) estimates.push_back(verified_.at(point.x));
    return {.front = std::move(front),
            .estimates = std::move(estimates),
            .sample = setup_.evaluator.reported_by(),
            .history = history_,
            .hypervolume = optimiser_->hypervolume(),
            .evaluations = optimiser_->evaluations(),
            .resumed_evaluations = resumed_,
            .drawn = drawn_,
            .redrawn = redrawn_,
            .stop_reason = reason,
            .seconds = log_.seconds(),
            .trace_seconds = log_.trace_seconds(setup_.evaluator.trace_seconds())};
  }

  // MO-CMA-ES has a start among its first points; CMA-ES only draws around it, and might never return to it.
  std::vector<double> first_network() const {
    if (!setup_.start.empty() || setup_.config.start.empty() || setup_.problem.objectives.size() > 1)
      return setup_.start;
    return setup_.space.encode(setup_.config.start);
  }

  const SearchSetup& setup_;
  std::size_t population_;
  std::unique_ptr<Optimiser> optimiser_;
  SearchLog log_;
  const std::vector<double> begins_with_;  // one of the first points; empty: none
  std::vector<PlanIteration> history_;
  std::vector<ParetoPoint> front_;                                 // as of the last iteration
  std::map<std::vector<double>, std::vector<Estimate>> verified_;  // of the archive, at the end
  std::uint64_t drawn_ = 0, redrawn_ = 0, evaluated_ = 0, resumed_ = 0;
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

}  // namespace

SearchOutcome search(const SearchSetup& setup) { return Search(setup).run(); }

void drop_point(SearchOutcome& found, std::size_t k) {
  const auto at = static_cast<std::ptrdiff_t>(k);
  found.front.erase(found.front.begin() + at);
  if (k < found.estimates.size()) found.estimates.erase(found.estimates.begin() + at);
}

}  // namespace vantage
