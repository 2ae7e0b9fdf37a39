// SPDX-License-Identifier: Apache-2.0
#include "plan/search.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <exception>
#include <map>
#include <memory>
#include <optional>
#include <sstream>
#include <utility>

#include "core/atomic_file.hpp"
#include "optimise/hypervolume.hpp"
#include "plan/checkpoint.hpp"
#include "plan/choose_optimiser.hpp"
#include "plan/growing_sample.hpp"
#include "plan/sample_memory.hpp"
#include "plan/scaled_objectives.hpp"
#include "vantage/error.hpp"

namespace vantage {
namespace {

// By how much of what a first look is wrong a network may be better than it seems.
constexpr double kOptimism = 1;
// Where voxels are drawn anew, the last ones are so many times as many: they say how good the front is.
constexpr std::uint64_t kLastSample = 4;

class Search {
 public:
  explicit Search(const SearchSetup& setup)
      : setup_(setup),
        config_(setup.config),
        space_(setup.space),
        population_(population_of(setup.problem, config_)),
        budget_(static_cast<std::uint64_t>(config_.iterations) * population_),
        optimiser_(choose_optimiser(space_, setup.problem, config_, setup.batch, setup.start)),
        evaluator_(setup.evaluator),
        sample_(config_),
        memory_(setup.measures.searched),
        begins_with_(first_network()) {}

  SearchOutcome run() {
    if (!config_.checkpoint.empty()) {
      AtomicFile::remove_leftovers(config_.checkpoint);
      if (config_.resume) resume();
    }
    if (snapshot_.optimiser.empty()) take_snapshot();
    StopReason reason = StopReason::running;
    try {
      while (reason == StopReason::running) {
        reason = reason_to_stop();
        if (reason == StopReason::running)
          reason = iterate();
        else if (says_the_sample(reason) && !sample_.full())
          reason = grow();
      }
    } catch (...) {
      const auto lost = std::current_exception();
      try {
        save();                 // hours of work must not go down with a lost device
      } catch (const Error&) {  // what ended the search is what matters
      }
      std::rethrow_exception(lost);
    }
    save();
    if ((!sample_.full() || sample_.renews()) && reason != StopReason::cancelled) {
      const GrowingSample before = sample_;
      sample_.fill();  // not saved: a search that goes on does so by its own sample
      if (sample_.renews()) sample_.renew(history_.size());
      if (!assess(Then::end)) sample_ = before, reason = interrupted();
    }
    return outcome(reason);
  }

 private:
  using Clock = std::chrono::steady_clock;

  // One batch: ask, place, evaluate, tell. Anything but `running` means that it was left half way.
  StopReason iterate() {
    const std::vector<double> xs = draw();
    const std::size_t n = space_.dimension(), count = xs.size() / n;
    const auto x = [&](std::size_t k) { return std::span<const double>(xs).subspan(k * n, n); };

    std::vector<std::vector<double>> values;
    for (; values.size() < count && replay_next_ < replay_.size(); ++replay_next_)
      values.push_back(replay_[replay_next_]);
    since_.insert(since_.end(), values.begin(), values.end());
    resumed_ += values.size();
    evaluated_ += values.size();
    while (values.size() < count) {
      if (const StopReason reason = interruption(); reason != StopReason::running) return reason;
      const std::size_t left = count - values.size(),
                        chunk = evaluator_.chunk() == 0 ? left : std::min(left, evaluator_.chunk());
      std::vector<PlacedNetwork> networks(networks_.begin() + static_cast<std::ptrdiff_t>(values.size()),
                                          networks_.begin() + static_cast<std::ptrdiff_t>(values.size() + chunk));
      const Progress progress{.report = [&](double done) { watch(static_cast<double>(chunk) * done); },
                              .stop = setup_.stop};
      const auto found = evaluate(networks, xs, values.size(), progress);
      if (!found) return StopReason::cancelled;
      values.insert(values.end(), found->begin(), found->end());
      since_.insert(since_.end(), found->begin(), found->end());
      evaluated_ += chunk;
      watch(0);
      if (values.size() < count && checkpoint_due()) save();
    }

    const std::size_t m = setup_.problem.objectives.size();
    std::vector<double> f(count * m);
    for (std::size_t k = 0; k < count; ++k)
      scale_objectives(setup_.problem, x(k), values[k], missed_by(setup_.problem, setup_.measures, values[k]),
                       std::span(f).subspan(k * m, m));
    optimiser_->tell(f);
    if (record()) {
      const bool unknown = looks_first() ? !memory_.knows_looks() : error_ == 0 && !sample_.full();
      if (unknown && !assess(Then::go_on)) return interrupted();
      if (!sample_.full() && sample_.outgrown(history_, error_, population_)) return grow();
      if (sample_.stale(history_.size())) return renew();
    }
    if (checkpoint_due()) {
      take_snapshot();
      save();
    }
    return StopReason::running;
  }

  bool looks_first() const { return setup_.problem.objectives.size() > 1 && !sample_.first_looks().empty(); }

  // Of networks whose vectors are rows of xs from `first` on. What is not on the front is not worth the whole sample:
  // of a network that is dominated even at its best, few voxels say enough.
  std::optional<std::vector<std::vector<double>>> evaluate(const std::vector<PlacedNetwork>& networks,
                                                           std::span<const double> xs, std::size_t first,
                                                           const Progress& progress) {
    std::vector<std::vector<double>> values(networks.size());
    std::vector<std::size_t> open(networks.size());
    for (std::size_t k = 0; k < open.size(); ++k) open[k] = k;
    const auto still_open = [&] {
      std::vector<PlacedNetwork> left;
      for (const std::size_t k : open) left.push_back(networks[k]);
      return left;
    };
    if (memory_.knows_looks()) {
      const std::vector<VoxelWindow> looks = sample_.first_looks();
      const std::vector<ParetoPoint> front = optimiser_->front();
      for (std::size_t l = 0; l < looks.size(); ++l) {
        auto seen = setup_.evaluator.evaluate(still_open(), looks[l], progress);
        if (!seen) return std::nullopt;
        std::vector<std::size_t> promising;
        for (std::size_t i = 0; i < open.size(); ++i) {
          const std::size_t k = open[i], n = space_.dimension();
          values[k] = std::move((*seen)[i]);
          memory_.correct(values[k], l);
          const std::vector<double> best = at_best(xs.subspan((first + k) * n, n), values[k], memory_.look(l));
          if (std::ranges::none_of(front, [&](const ParetoPoint& kept) { return optimise::dominates(kept.f, best); }))
            promising.push_back(k);
        }
        open = std::move(promising);
        if (open.empty()) return values;
      }
    }
    auto found = evaluator_.evaluate(still_open(), sample_.window(), progress);
    if (!found) return std::nullopt;
    for (std::size_t i = 0; i < open.size(); ++i) {
      values[open[i]] = std::move((*found)[i]);
      memory_.correct(values[open[i]]);
    }
    return values;
  }

  // What the optimiser would be told if every measure, of which a first look saw this, came out well by all voxels.
  std::vector<double> at_best(std::span<const double> x, std::span<const double> seen,
                              std::span<const LookError> errors) const {
    const SurveyProblem& problem = setup_.problem;
    const auto best = [&](std::size_t m, bool more) {
      return seen[m] + (more ? kOptimism : -kOptimism) * errors[m].deviation;
    };
    std::vector<double> values;
    for (std::size_t m = 0; m < seen.size(); ++m) values.push_back(best(m, setup_.measures.all[m].maximised()));
    double missed = 0;
    for (std::size_t r = 0; r < problem.requirements.size(); ++r) {
      const Requirement& requirement = problem.requirements[r];
      missed +=
          requirement.missed_by(best(setup_.measures.required[r], requirement.bound == Requirement::Bound::at_least));
    }
    std::vector<double> f(problem.objectives.size());
    scale_objectives(problem, x, values, missed, f);
    return f;
  }

  // What a larger sample may see otherwise.
  static bool says_the_sample(StopReason reason) {
    return reason == StopReason::target_reached || reason == StopReason::stagnated || reason == StopReason::converged ||
           reason == StopReason::flat;
  }
  StopReason interrupted() const {
    const StopReason reason = interruption();
    return reason == StopReason::running ? StopReason::cancelled : reason;
  }

  StopReason grow() {
    GrowingSample grown = sample_;
    grown.grow(history_.size());
    return go_by(grown);
  }
  StopReason renew() {
    GrowingSample fresh = sample_;
    fresh.renew(history_.size());
    return go_by(fresh);
  }
  StopReason go_by(const GrowingSample& sample) {
    const GrowingSample before = std::exchange(sample_, sample);
    if (!assess(Then::go_on)) {
      sample_ = before;
      return interrupted();
    }
    // What is replayed from here on was told to a population of these values.
    if (!config_.checkpoint.empty()) take_snapshot();
    if (checkpoint_due()) save();
    return StopReason::running;
  }

  enum class Then { go_on, end };

  // What the front is told by.
  VoxelWindow last_window() const {
    const VoxelWindow window = sample_.window();
    return {sample_.renews() ? kLastSample * window.voxels : window.voxels, window.from};
  }

  // Measures what the optimiser keeps by the sample as it is. Where the search goes on, as newcomers are measured, and
  // how well first looks tell; at its end as well as the sample can, without what samples are wrong by on average.
  // False when stopped half way.
  bool assess(Then then) {
    const std::vector<ParetoPoint> population = optimiser_->population();
    std::vector<PlacedNetwork> networks;
    for (const ParetoPoint& point : population) networks.push_back(space_.decode(point.x));
    const Progress progress{.report = {}, .stop = setup_.stop};
    const SurveyProblem& problem = setup_.problem;
    const std::size_t m = problem.objectives.size();
    std::vector<std::vector<double>> values(networks.size());
    double errors = 0;
    if (then == Then::end || !sample_.full()) {
      const VoxelWindow window = then == Then::end ? last_window() : sample_.window();
      auto found = setup_.evaluator.estimate(networks, window, NetworkEvaluator::Which::searched, progress);
      if (!found) return false;
      if (then == Then::end && sample_.renews()) {
        found = memory_.pooled(population, std::move(*found), kLastSample);
        for (std::size_t k = 0; k < networks.size(); ++k) pooled_[population[k].x] = (*found)[k];
      }
      for (std::size_t k = 0; k < networks.size(); ++k) {
        for (const Estimate& estimate : (*found)[k]) values[k].push_back(estimate.value);
        for (std::size_t j = 0; j < m; ++j) {
          const double scale = problem.objectives[j].scale.width();
          if (scale > 0) errors += (*found)[k][j].standard_error / scale;
        }
      }
    }
    if (then == Then::go_on) {
      auto found = setup_.evaluator.evaluate(networks, sample_.window(), progress);
      if (!found) return false;
      values = std::move(*found);
      if (looks_first() && !measure_looks(networks, values)) return false;
      if (sample_.renews()) memory_.average(population, values, sample_.window().from);
    }
    std::vector<double> f(networks.size() * m);
    for (std::size_t k = 0; k < networks.size(); ++k)
      scale_objectives(problem, population[k].x, values[k], missed_by(problem, setup_.measures, values[k]),
                       std::span(f).subspan(k * m, m));
    error_ = networks.empty() ? 0 : errors / static_cast<double>(f.size());
    optimiser_->reassess(f);
    front_ = optimiser_->front();
    return true;
  }

  // How far first looks are off, from what the optimiser keeps. As looks and sample see the same voxels, and all
  // networks do, that is less than their standard errors. False when stopped half way.
  bool measure_looks(const std::vector<PlacedNetwork>& networks, const std::vector<std::vector<double>>& measured) {
    std::vector<std::vector<LookError>> errors;
    for (const VoxelWindow& look : sample_.first_looks()) {
      const auto looked = setup_.evaluator.evaluate(networks, look, {.report = {}, .stop = setup_.stop});
      if (!looked) return false;
      errors.push_back(look_errors(*looked, measured));
    }
    memory_.learn_looks(std::move(errors));
    return true;
  }

  // Asks for a batch and draws again what stands in holes and clashes. Fills networks_.
  std::vector<double> draw() {
    std::span<const double> asked = optimiser_->ask();
    if (!begins_with_.empty() && optimiser_->evaluations() == 0) {
      optimiser_->replace(0, begins_with_);
      asked = optimiser_->ask();
    }
    std::vector<double> xs(asked.begin(), asked.end());
    const std::size_t n = space_.dimension(), count = xs.size() / n;
    std::vector<PlacedNetwork> placed(count);
    std::vector<std::size_t> open(count);
    for (std::size_t k = 0; k < count; ++k) open[k] = k;
    for (std::size_t round = 0;; ++round) {
      tbb::parallel_for(std::size_t{0}, open.size(), [&](std::size_t i) {
        placed[open[i]] = space_.decode(std::span<const double>(xs).subspan(open[i] * n, n));
      });
      if (round == 0)
        for (const auto& stations : placed) drawn_ += stations.size() - space_.existing();
      if (round == config_.redraws) break;
      std::vector<std::size_t> again;
      for (const std::size_t k : open) {
        std::vector<std::size_t> coordinates;
        for (std::size_t i = space_.existing(); i < placed[k].size(); ++i) {
          if (placed[k][i].status == StationStatus::ok) continue;
          const auto own = space_.coordinates(i);
          coordinates.insert(coordinates.end(), own.begin(), own.end());
          ++drawn_, ++redrawn_;
        }
        if (coordinates.empty()) continue;
        const std::span<const double> x = optimiser_->resample(k, coordinates);
        std::copy(x.begin(), x.end(), xs.begin() + static_cast<std::ptrdiff_t>(k * n));
        again.push_back(k);
      }
      if (again.empty()) break;
      open = std::move(again);
    }
    networks_ = std::move(placed);
    return xs;
  }

  // Whether an iteration has ended.
  bool record() {
    const std::uint64_t iteration = optimiser_->iterations();
    const std::uint64_t last = history_.empty() ? 0 : history_.back().iteration;
    if (iteration == last) return false;
    PlanIteration& line = history_.emplace_back();
    line.iteration = iteration, line.evaluations = optimiser_->evaluations();
    line.hypervolume = optimiser_->hypervolume();
    front_ = optimiser_->front();
    if (sample_.renews()) memory_.keep_only(optimiser_->population());
    for (const ParetoPoint& point : front_) line.front.push_back(point.f);
    line.seconds = seconds();
    return true;
  }

  // What ends the search from outside, at any moment.
  StopReason interruption() const {
    if (setup_.stop.stop_requested()) return StopReason::cancelled;
    if (config_.max_seconds > 0 && std::chrono::duration<double>(Clock::now() - start_).count() >= config_.max_seconds)
      return StopReason::max_time;
    return StopReason::running;
  }

  // And what ends it between two batches. Values that a checkpoint brought are replayed first, so that a search that
  // goes on stands where it was left.
  StopReason reason_to_stop() const {
    if (optimiser_->stop_reason() != StopReason::running) return optimiser_->stop_reason();
    return replay_next_ < replay_.size() ? StopReason::running : interruption();
  }

  void watch(double under_way) const {
    if (!setup_.watch) return;
    const double here = std::chrono::duration<double>(Clock::now() - start_).count();
    const double fresh = static_cast<double>(evaluated_ - resumed_) + under_way;
    const double rate = here > 0 ? fresh / here : 0;
    double left =
        rate > 0 ? std::max(0.0, static_cast<double>(budget_) - static_cast<double>(evaluated_) - under_way) / rate : 0;
    if (config_.max_seconds > 0) left = std::min(left, std::max(0.0, config_.max_seconds - here));
    setup_.watch({.iteration = evaluated_ / population_,
                  .iterations = config_.iterations,
                  .evaluations = evaluated_,
                  .hypervolume = history_.empty() ? 0 : history_.back().hypervolume,
                  .evaluations_per_second = rate,
                  .seconds_left = left,
                  .phase = "search",
                  .front = front_});
  }

  double seconds() const { return earlier_seconds_ + std::chrono::duration<double>(Clock::now() - start_).count(); }

  bool checkpoint_due() const {
    return !config_.checkpoint.empty() &&
           std::chrono::duration<double>(Clock::now() - saved_).count() >= config_.checkpoint_seconds;
  }

  // REQUIRES: no batch is open.
  void take_snapshot() {
    std::ostringstream state;
    state.exceptions(std::ios::badbit);  // it runs out of memory, not of a disk
    optimiser_->save(state);
    snapshot_ = {.optimiser = std::move(state).str(),
                 .history = history_,
                 .drawn = drawn_,
                 .redrawn = redrawn_,
                 .sample = sample_.state(),
                 .sample_error = error_,
                 .memory = memory_.state()};
    since_.clear();
  }

  void save() {
    if (config_.checkpoint.empty()) return;
    // A run that stops while it still replays must not forget what it has not come to.
    std::vector<std::vector<double>> since = since_;
    since.insert(since.end(), replay_.begin() + static_cast<std::ptrdiff_t>(replay_next_), replay_.end());
    saved_ = Clock::now();
    try {
      write_checkpoint(config_.checkpoint,
                       {.identity = setup_.identity,
                        .snapshot = snapshot_,
                        .since = std::move(since),
                        .seconds = seconds(),
                        .trace_seconds = earlier_trace_seconds_ + setup_.evaluator.trace_seconds()},
                       newest_is_ours_);
      newest_is_ours_ = true;
    } catch (const Error& error) {
      if (!setup_.warn) throw;
      setup_.warn(std::string(error.what()) + "; the search goes on without");
    }
  }

  void resume() {
    std::optional<FoundCheckpoint> found = newest_checkpoint(config_.checkpoint);
    if (!found) return;
    const auto file = found->is_before ? checkpoint_before(config_.checkpoint) : config_.checkpoint;
    if (found->is_before && setup_.warn) setup_.warn(found->why + "; going on from the one before, " + file.string());
    newest_is_ours_ = !found->is_before;
    Checkpoint* const checkpoint = &found->checkpoint;
    require_same_run(file, checkpoint->identity, setup_.identity);
    std::istringstream state(checkpoint->snapshot.optimiser);
    optimiser_->load(state);
    snapshot_ = std::move(checkpoint->snapshot);
    history_ = snapshot_.history;
    drawn_ = snapshot_.drawn, redrawn_ = snapshot_.redrawn;
    sample_.restore(snapshot_.sample), error_ = snapshot_.sample_error;
    memory_.restore(snapshot_.memory, sample_.window().from);
    replay_ = std::move(checkpoint->since);
    resumed_ = evaluated_ = optimiser_->evaluations();
    earlier_seconds_ = checkpoint->seconds, earlier_trace_seconds_ = checkpoint->trace_seconds;
  }

  SearchOutcome outcome(StopReason reason) const {
    std::vector<ParetoPoint> kept = sample_.renews() ? optimiser_->population() : optimiser_->front();
    std::vector<std::vector<Estimate>> estimates;
    if (!pooled_.empty())
      for (const ParetoPoint& point : kept) estimates.push_back(pooled_.at(point.x));
    return {.front = std::move(kept),
            .estimates = std::move(estimates),
            .sample = last_window(),
            .history = history_,
            .hypervolume = optimiser_->hypervolume(),
            .evaluations = optimiser_->evaluations(),
            .resumed_evaluations = resumed_,
            .drawn = drawn_,
            .redrawn = redrawn_,
            .stop_reason = reason,
            .seconds = seconds(),
            .trace_seconds = earlier_trace_seconds_ + setup_.evaluator.trace_seconds()};
  }

  // MO-CMA-ES has a start among its first points; CMA-ES only draws around it, and might never come back to it.
  std::vector<double> first_network() const {
    if (!setup_.start.empty() || config_.start.empty() || setup_.problem.objectives.size() > 1) return setup_.start;
    return space_.encode(config_.start);
  }

  const SearchSetup& setup_;
  const PlanConfig& config_;
  const DecisionSpace& space_;
  std::size_t population_;
  std::uint64_t budget_;
  std::unique_ptr<Optimiser> optimiser_;
  CachingEvaluator evaluator_;
  GrowingSample sample_;
  double error_ = 0;  // standard error of a scaled objective by it; 0: not known yet
  SampleMemory memory_;
  std::map<std::vector<double>, std::vector<Estimate>> pooled_;  // of what is kept, at the end
  const std::vector<double> begins_with_;                        // one of the first points; empty: none
  std::vector<PlacedNetwork> networks_;                          // of the open batch

  std::vector<PlanIteration> history_;
  std::vector<ParetoPoint> front_;  // as of the last iteration
  std::uint64_t drawn_ = 0, redrawn_ = 0, evaluated_ = 0, resumed_ = 0;
  SearchSnapshot snapshot_;
  std::vector<std::vector<double>> since_, replay_;
  std::size_t replay_next_ = 0;
  double earlier_seconds_ = 0, earlier_trace_seconds_ = 0;
  bool newest_is_ours_ = false;  // and whole, so that it may become the one before
  Clock::time_point start_ = Clock::now(), saved_ = start_;
};

}  // namespace

SearchOutcome search(const SearchSetup& setup) { return Search(setup).run(); }

}  // namespace vantage
