// SPDX-License-Identifier: Apache-2.0
#include "plan/search.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <chrono>
#include <memory>
#include <optional>
#include <sstream>
#include <utility>

#include "core/atomic_file.hpp"
#include "plan/checkpoint.hpp"
#include "plan/choose_optimiser.hpp"
#include "plan/scaled_objectives.hpp"
#include "vantage/error.hpp"

namespace vantage {
namespace {

class Search {
 public:
  explicit Search(const SearchSetup& setup)
      : setup_(setup),
        config_(setup.config),
        space_(setup.space),
        population_(population_of(setup.problem, config_)),
        budget_(static_cast<std::uint64_t>(config_.iterations) * population_),
        optimiser_(choose_optimiser(space_, setup.problem, config_, setup.batch, setup.start)),
        evaluator_(setup.evaluator) {}

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
        if (reason != StopReason::running) break;
        reason = iterate();
      }
    } catch (...) {
      save();  // hours of work must not go down with a lost device
      throw;
    }
    save();
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
      const auto found = evaluator_.evaluate(networks, progress);
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
    record();
    if (checkpoint_due()) {
      take_snapshot();
      save();
    }
    return StopReason::running;
  }

  // Asks for a batch and draws again what stands in holes and clashes. Fills networks_.
  std::vector<double> draw() {
    std::span<const double> asked = optimiser_->ask();
    if (!setup_.start.empty() && optimiser_->evaluations() == 0) {
      // MO-CMA-ES has it among its first points; CMA-ES only draws around it.
      optimiser_->replace(0, setup_.start);
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
        for (const auto& stations : placed) drawn_ += stations.size() - space_.kept();
      if (round == config_.redraws) break;
      std::vector<std::size_t> again;
      for (const std::size_t k : open) {
        std::vector<std::size_t> coordinates;
        for (std::size_t i = space_.kept(); i < placed[k].size(); ++i) {
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

  void record() {
    const std::uint64_t iteration = optimiser_->iterations();
    const std::uint64_t last = history_.empty() ? 0 : history_.back().iteration;
    if (iteration == last) return;
    PlanIteration& line = history_.emplace_back();
    line.iteration = iteration, line.evaluations = optimiser_->evaluations();
    line.hypervolume = optimiser_->hypervolume();
    front_ = optimiser_->front();
    for (const ParetoPoint& point : front_) line.front.push_back(point.f);
    line.seconds = seconds();
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
    snapshot_ = {.optimiser = std::move(state).str(), .history = history_, .drawn = drawn_, .redrawn = redrawn_};
    since_.clear();
  }

  void save() {
    if (config_.checkpoint.empty()) return;
    // A run that stops while it still replays must not forget what it has not come to.
    std::vector<std::vector<double>> since = since_;
    since.insert(since.end(), replay_.begin() + static_cast<std::ptrdiff_t>(replay_next_), replay_.end());
    write_checkpoint(config_.checkpoint, {.identity = setup_.identity,
                                          .snapshot = snapshot_,
                                          .since = std::move(since),
                                          .seconds = seconds(),
                                          .trace_seconds = earlier_trace_seconds_ + setup_.evaluator.trace_seconds()});
    saved_ = Clock::now();
  }

  void resume() {
    std::optional<Checkpoint> checkpoint = read_checkpoint(config_.checkpoint);
    if (!checkpoint) return;
    require_same_run(config_.checkpoint, checkpoint->identity, setup_.identity);
    std::istringstream state(checkpoint->snapshot.optimiser);
    optimiser_->load(state);
    snapshot_ = std::move(checkpoint->snapshot);
    history_ = snapshot_.history;
    drawn_ = snapshot_.drawn, redrawn_ = snapshot_.redrawn;
    replay_ = std::move(checkpoint->since);
    resumed_ = evaluated_ = optimiser_->evaluations();
    earlier_seconds_ = checkpoint->seconds, earlier_trace_seconds_ = checkpoint->trace_seconds;
  }

  SearchOutcome outcome(StopReason reason) const {
    return {.front = optimiser_->front(),
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

  const SearchSetup& setup_;
  const PlanConfig& config_;
  const DecisionSpace& space_;
  std::size_t population_;
  std::uint64_t budget_;
  std::unique_ptr<Optimiser> optimiser_;
  CachingEvaluator evaluator_;
  std::vector<PlacedNetwork> networks_;  // of the open batch

  std::vector<PlanIteration> history_;
  std::vector<ParetoPoint> front_;  // as of the last iteration
  std::uint64_t drawn_ = 0, redrawn_ = 0, evaluated_ = 0, resumed_ = 0;
  SearchSnapshot snapshot_;
  std::vector<std::vector<double>> since_, replay_;
  std::size_t replay_next_ = 0;
  double earlier_seconds_ = 0, earlier_trace_seconds_ = 0;
  Clock::time_point start_ = Clock::now(), saved_ = start_;
};

}  // namespace

SearchOutcome search(const SearchSetup& setup) { return Search(setup).run(); }

}  // namespace vantage
