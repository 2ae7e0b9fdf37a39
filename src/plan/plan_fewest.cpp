// SPDX-License-Identifier: Apache-2.0
// How many, then where. Candidates and what they capture and share come first, as rows of counts; on these the fewest
// stations are chosen, around these more candidates are tried, and from there the optimiser searches for the best
// network of that number. Whatever was traced with every ray is kept, and the best of it is the answer.
#include "plan/plan_fewest.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <functional>
#include <limits>
#include <numeric>
#include <utility>

#include "cover/partial_cover.hpp"
#include "plan/candidate_table.hpp"
#include "plan/choose_optimiser.hpp"
#include "plan/drop_networks.hpp"
#include "plan/limits.hpp"
#include "plan/spread_positions.hpp"

namespace vantage {
namespace {

using Clock = std::chrono::steady_clock;

// Standard errors of the sample by which a choice keeps away from what is required, so that most choices hold with
// every ray.
constexpr double kMarginErrors = 1;
// Rounds of further candidates around those chosen: how many for each station, and within what share of the distance
// between candidates, halved each round.
constexpr std::size_t kRounds = 3, kAround = 8;
constexpr double kAroundRadius = 0.8;
// What is good by the sample is looked at again on one so many times as large: for each station chosen so many that may
// stand there instead, and so many that may stand there too.
constexpr std::uint64_t kCloser = 5;
constexpr std::size_t kInsteadClosely = 8, kMoreClosely = 64, kLongerList = 4;
constexpr std::size_t kLateCandidates = 96;
// The search after that may trace so many stations for each candidate that was looked at.
constexpr double kSearchShare = 2;
constexpr std::size_t kLeastIterations = 10, kMostIterations = 100;
// First steps of that search: about the distance between candidates, not the size of the site.
constexpr double kRefiningSigma = 0.03;
// Choices made anew with other margins, where every ray shows that a requirement is missed after all, or that fewer
// stations may do.
constexpr std::size_t kRepairs = 3;
constexpr double kBeyond = 1.25;  // of what was missed, on top
// What all the rest will take goes by so many networks as a search evaluates them, and by every ray of so many
// stations; and by what was seen on the sites of docs/examples.md: rounds become longer, so many of the listed
// stations are not listed twice, and so many choices are made that every ray is asked about.
constexpr std::size_t kTimedNetworks = 2, kTimedStations = 4;
constexpr double kLaterRounds = 1.1, kListedShare = 0.7, kEveryRay = 4.5;

// The limit of an at-least requirement, or 0.
double least_of(const SurveyProblem& problem, Objective::Kind kind) {
  return std::max(0.0, limit_of(problem, kind, Requirement::Bound::at_least).value_or(0));
}

class FewestPlan {
 public:
  FewestPlan(PlanContext& context, Simulator& simulator, const Candidates& candidates, double candidates_seconds,
             const PlanConfig& config, const PlanWatch& watch)
      : context_(context),
        simulator_(simulator),
        candidates_(candidates),
        config_(config),
        watch_(watch),
        problem_(context.problem()),
        most_(problem_.stations_max),
        link_(least_of(problem_, Objective::Kind::link)),
        sample_(config.sample_voxels > 0 ? config.sample_voxels : simulator.voxel_count()),
        table_(make_table(sample_)) {
    coverage_ = least_of(problem_, Objective::Kind::coverage);
    coverage_margin_ = kMarginErrors * candidates.visible().standard_error;
    look_seconds_ = candidates_seconds / static_cast<double>(std::max<std::size_t>(candidates.stations().size(), 1));
    station_seconds_ = look_seconds_;
  }

  PlanResult run() {
    look_at_links();
    if (table_.stations().size() <= problem_.kept.size()) return nothing_known();
    choose();
    for (std::size_t round = 0; round < kRounds && !stopped(); ++round) {
      const std::uint64_t before = traced_;
      const double seconds = timed([&] { choose_around(round); });
      if (round == 0) tell_expected(seconds, traced_ - before);
    }
    look_closer();
    // The search begins where every ray says that it is enough.
    confirm_choice();
    for (std::size_t k = 0; k < kRepairs && best_missed() > 0 && !stopped() && repair(); ++k) {
    }
    for (std::size_t k = 0; k < kRepairs && best_missed() == 0 && !stopped() && choose_again(); ++k) {
    }
    const SearchOutcome found = search(stations_of(choice_));
    take(confirmed(found, choice_.chosen.size() - problem_.kept.size()));
    PlanResult result = context_.result(found);
    result.evaluations += traced_;
    result.front = front();
    result.exact_hypervolume = judge_by_every_ray(result.front, problem_, context_.measures());
    return result;
  }

 private:
  bool stopped() const { return watch_.stop.stop_requested() || watch_.abort.stop_requested(); }
  CandidateTable make_table(std::uint64_t sample_voxels) {
    return {simulator_, link_ > 0 || wants_links() ? &context_.surroundings() : nullptr, sample_voxels,
            surroundings_sample(), least_of(problem_, Objective::Kind::distance)};
  }
  bool wants_links() const {
    return std::ranges::any_of(problem_.objectives, [](const Objective& o) { return o.kind == Objective::Kind::link; });
  }
  std::uint64_t surroundings_sample() {
    const std::uint64_t sample = context_.surroundings_voxels();
    return sample > 0 ? sample : std::numeric_limits<std::uint32_t>::max();  // all there are
  }
  Progress progress(const char* phase) {
    return {.report = [this, phase](double) { tell(phase, -1); }, .stop = watch_.stop};
  }
  void tell(const char* phase, double seconds_left) {
    if (watch_.report) watch_.report({.evaluations = traced_, .seconds_left = seconds_left, .phase = phase});
  }

  // Seconds that `work` took.
  template <class Work>
  static double timed(Work work) {
    const auto begun = Clock::now();
    work();
    return std::chrono::duration<double>(Clock::now() - begun).count();
  }

  // What is still to come, once the first round of further candidates was tried: the others, the short list by a larger
  // sample, the end of the search, and by every ray the choice, others with other margins, and what is found.
  void tell_expected(double round_seconds, std::size_t tried) {
    if (!watch_.report || stopped() || choice_.chosen.size() <= problem_.kept.size()) return;
    const std::vector<PlacedStation> chosen = stations_of(choice_);
    const auto count = static_cast<double>(chosen.size()), kept = static_cast<double>(problem_.kept.size());
    const Progress silent{.report = {}, .stop = watch_.stop};
    // The first call sets up what later ones use again, so that it may take longer.
    const auto sampled = [&](std::size_t copies) {
      const std::vector<PlacedNetwork> some(copies, chosen);
      const auto evaluate = [&] { context_.evaluator().evaluate(some, {.voxels = config_.sample_voxels}, silent); };
      return timed(evaluate) / static_cast<double>(copies);
    };
    const auto every_ray_of = [&](std::size_t stations) {
      const std::vector<PlacedNetwork> first(1,
                                             {chosen.begin(), chosen.begin() + static_cast<std::ptrdiff_t>(stations)});
      return timed([&] { context_.evaluator().confirm(first, silent); });
    };
    const double network = std::min(sampled(1), sampled(kTimedNetworks));
    const std::size_t few = std::min(kTimedStations, chosen.size());
    const double one = std::min(every_ray_of(1), every_ray_of(1));
    const double each = few > 1 ? (every_ray_of(few) - one) / static_cast<double>(few - 1) : one;
    if (stopped()) return;
    const SurveyProblem narrow = narrowed(chosen.size() - problem_.kept.size());
    const PlanConfig config = search_config(narrow);
    const auto networks = static_cast<double>(config.iterations * population_of(narrow, config));
    const double listed = kMoreClosely + kListedShare * kInsteadClosely * (count - kept);
    const double choosing = std::max(0.0, round_seconds - static_cast<double>(tried) * station_seconds_);
    const double closely = listed * (station_seconds_ + (kCloser - 1) * look_seconds_) + choosing;
    const double seconds = (kRounds - 1) * kLaterRounds * round_seconds + closely + networks * network +
                           kEveryRay * (one + (count - 1) * std::max(each, 0.0));
    watch_.report({.evaluations = traced_, .seconds_left = -1, .phase = "choose", .whole_seconds_left = seconds});
  }

  void look_at_links() {
    std::vector<PlacedStation> kept = existing_stations(context_.oracle(), problem_.kept, problem_.kept_setups);
    for (PlacedStation& station : kept)
      if (active(station)) station.status = StationStatus::ok;  // rows of others are empty
    // Kept stations come first in every network, so they are traced even where time is short.
    if (!kept.empty()) table_.add(kept, {.report = {}, .stop = watch_.abort});
    // Where the time is over before links were looked at, those of a few: a network that hangs together is worth more
    // than one chosen from many.
    const std::span<const PlacedStation> all = candidates_.stations();
    if (stopped())
      table_.add(all.first(std::min(all.size(), kLateCandidates)), candidates_.coverage(),
                 {.report = {}, .stop = watch_.abort});
    else
      station_seconds_ += timed([&] { table_.add(all, candidates_.coverage(), progress("look")); }) /
                          static_cast<double>(std::max<std::size_t>(all.size(), 1));
    traced_ += table_.stations().size();
  }

  CoverProblem question(const CandidateTable& table, double coverage_margin) const {
    std::vector<std::size_t> existing(problem_.kept.size());
    std::iota(existing.begin(), existing.end(), std::size_t{0});
    return {.matrix = table.matrix(),
            .graph = &table.graph(),
            .existing = std::move(existing),
            .fewest = problem_.stations_min,
            .most = most_,
            .coverage = coverage_ + (coverage_ > 0 ? coverage_margin : 0),
            .link = link_ > 0 ? link_ + link_margin_ : 0};
  }
  CoverProblem question() const { return question(table_, coverage_margin_); }
  std::vector<PlacedStation> stations_of(const CoverSolution& answer) const {
    std::vector<PlacedStation> stations;
    for (const std::size_t row : answer.chosen) stations.push_back(table_.stations()[row]);
    return stations;
  }

  void choose_from(std::optional<CoverSolution> start) {
    ConnectedCover found = min_connected_cover(question(), watch_.stop, std::move(start));
    choice_ = std::move(found.best), nearly_ = std::move(found.one_fewer);
  }

  void choose() {
    tell("choose", -1);
    choose_from({});
    fit_time();
    choice_ = improve_weakest_link(question(), std::move(choice_), watch_.stop);
  }

  double minutes(const CoverSolution& answer) {
    const std::vector<PlacedStation> stations = stations_of(answer);
    return context_.on_site().visit(std::span(stations).subspan(problem_.kept.size())).minutes;
  }

  // Where a round of as many as it takes lasts too long: the most that can be captured by as many as there is time for.
  void fit_time() {
    const std::optional<double> most = limit_of(problem_, Objective::Kind::time, Requirement::Bound::at_most);
    if (!most) return;
    const double limit = *most;
    const std::size_t kept = problem_.kept.size();
    const double each = context_.on_site().minutes_per_scan() + context_.on_site().options().set_up_min;
    std::size_t placed = choice_.chosen.size() - kept;
    if (each > 0) placed = std::min(placed, static_cast<std::size_t>(std::max(1.0, limit / each)));
    for (; minutes(choice_) > limit && placed >= std::max<std::size_t>(problem_.stations_min, 1); --placed) {
      most_ = placed;
      nearly_.reset();
      choice_ = min_connected_cover(question(), watch_.stop).best;
    }
  }

  // More candidates around what was chosen, and around the best network of one station fewer.
  void choose_around(std::size_t round) {
    const double radius = kAroundRadius * std::ldexp(std::max(candidates_.spacing_m(), 0.1), -static_cast<int>(round));
    std::vector<PlacedStation> around;
    const auto add = [&](const CoverSolution& answer) {
      std::vector<PlacedStation> stations = stations_of(answer);
      stations.erase(stations.begin(), stations.begin() + static_cast<std::ptrdiff_t>(problem_.kept.size()));
      const auto more = positions_around(context_.oracle(), stations, kAround, radius);
      around.insert(around.end(), more.begin(), more.end());
    };
    add(choice_);
    if (nearly_) add(*nearly_);
    const std::size_t before = table_.stations().size();
    table_.add(around, progress("choose"));
    traced_ += table_.stations().size() - before;
    if (nearly_) {
      CoverProblem fewer = question();
      fewer.most = std::min(fewer.most, nearly_->chosen.size() - problem_.kept.size());
      CoverSolution better = improve_weakest_link(fewer, std::move(*nearly_), watch_.stop);
      nearly_ = better;
      if (better.violation <= choice_.violation) {
        choose_from(std::move(better));
      }
    }
    choice_ = improve_weakest_link(question(), std::move(choice_), watch_.stop);
  }

  // Rows that may be worth having in a network like the one chosen: it, the best one of a station fewer, for each of
  // its stations those that would replace it best, and those that would add most to it; `times` as many of the latter
  // two.
  std::vector<std::size_t> short_list(std::size_t times) const {
    const CoverageMatrix& rows = table_.matrix();
    const ColumnIndex columns(rows);
    const PartialCover cover(rows, choice_.chosen);
    std::vector<double> gains(rows.candidates());
    std::vector<char> listed(rows.candidates(), 0);
    std::vector<std::size_t> order(rows.candidates());
    std::iota(order.begin(), order.end(), std::size_t{0});
    const auto list_best = [&](std::span<const double> by, std::size_t count) {
      std::ranges::stable_sort(order, std::ranges::greater(), [&](std::size_t row) { return by[row]; });
      for (std::size_t k = 0; k < std::min(count, order.size()); ++k) listed[order[k]] = 1;
    };
    // One after the other: those that add most at first are near each other.
    const CoverProblem more{
        .matrix = rows, .graph = &table_.graph(), .existing = choice_.chosen, .most = times * kMoreClosely};
    for (const std::size_t row : greedy(more)) listed[row] = 1;
    for (std::size_t row = 0; row < rows.candidates(); ++row) gains[row] = cover.gain(row);
    for (std::size_t at = problem_.kept.size(); at < choice_.chosen.size(); ++at) {
      std::vector<double> without = gains;
      columns.add_gains_without(choice_.chosen[at], cover, without);
      list_best(without, times * kInsteadClosely);
    }
    if (nearly_)
      for (const std::size_t row : nearly_->chosen) listed[row] = 1;
    std::vector<std::size_t> list;
    for (std::size_t row = problem_.kept.size(); row < rows.candidates(); ++row)
      if (listed[row]) list.push_back(row);
    return list;
  }

  // What was chosen among thousands by a sample is what the sample flatters. So what is good by it is looked at with
  // more voxels, and chosen from anew; where it does not reach what it did by the sample, what is less good too.
  void look_closer() {
    const std::uint64_t closer = std::min(kCloser * sample_, simulator_.voxel_count());
    if (closer <= sample_) return;
    const double margin = coverage_margin_ * std::sqrt(static_cast<double>(sample_) / static_cast<double>(closer));
    const std::size_t kept = problem_.kept.size(), all = table_.stations().size();
    CandidateTable table = make_table(closer);
    if (kept > 0 && !table.add(std::span(table_.stations()).first(kept), {.report = {}, .stop = watch_.abort})) return;
    std::vector<std::size_t> row_of(all, all);
    std::iota(row_of.begin(), row_of.begin() + static_cast<std::ptrdiff_t>(kept), std::size_t{0});
    for (const std::size_t times : {std::size_t{1}, kLongerList}) {
      if (stopped()) return;
      std::vector<PlacedStation> listed;
      for (const std::size_t row : short_list(times)) {
        if (row_of[row] < all) continue;
        row_of[row] = table.stations().size() + listed.size();
        listed.push_back(table_.stations()[row]);
      }
      if (!table.add(listed, progress("choose"))) return;
      traced_ += listed.size();
      std::vector<std::size_t> rows;
      for (const std::size_t row : choice_.chosen) rows.push_back(row_of[row]);
      const CoverProblem asked = question(table, margin);
      ConnectedCover found = min_connected_cover(asked, watch_.stop, evaluate_cover(asked, std::move(rows)));
      if (found.best.violation > choice_.violation && times < kLongerList && !stopped()) continue;
      table_ = std::move(table);
      coverage_margin_ = margin;
      nearly_ = std::move(found.one_fewer);
      choice_ = improve_weakest_link(question(), std::move(found.best), watch_.stop);
      return;
    }
  }

  SurveyProblem narrowed(std::size_t stations) const {
    SurveyProblem narrowed = problem_;
    narrowed.stations_min = narrowed.stations_max = stations;
    const auto all = static_cast<double>(problem_.kept.size() + stations);
    for (Objective& objective : narrowed.objectives)
      if (objective.by_alpha) objective.scale = minimise(all, all);
    return narrowed;
  }

  // Further from the limits, by what the sample that it searches with is known to flatter.
  SurveyProblem with_margins(SurveyProblem narrowed) const {
    for (Requirement& requirement : narrowed.requirements) {
      if (requirement.bound != Requirement::Bound::at_least) continue;
      const Objective& objective = requirement.objective;
      if (objective.kind == Objective::Kind::coverage)
        requirement.limit = std::min(1.0, requirement.limit + sample_off_ / objective.coverage_of_one);
      if (objective.kind == Objective::Kind::link) requirement.limit += link_margin_;
    }
    return narrowed;
  }

  PlanConfig search_config(const SurveyProblem& narrow) const {
    PlanConfig config = config_;
    config.sigma0 = std::min(config.sigma0, kRefiningSigma);
    if (config.iterations == 0) {
      const double stations = kSearchShare * static_cast<double>(candidates_.stations().size());
      const auto each = static_cast<double>(population_of(narrow, config) * narrow.stations_max);
      config.iterations = std::clamp(static_cast<std::size_t>(stations / each), kLeastIterations, kMostIterations);
    }
    return config;
  }

  SearchOutcome search(const std::vector<PlacedStation>& chosen) {
    SearchOutcome found;
    const SurveyProblem narrow = with_margins(narrowed(chosen.size() - problem_.kept.size()));
    const DecisionSpace space(context_.oracle(), narrow);
    const std::vector<double> start = space.encode(std::span(chosen).subspan(problem_.kept.size()));
    if (!stopped()) found = context_.search(narrow, search_config(narrow), start, watch_);
    if (stopped() && found.stop_reason == StopReason::running) found.stop_reason = StopReason::cancelled;
    return found;
  }

  // `count`: of the stations that were searched for.
  std::vector<PlanEntry> confirmed(const SearchOutcome& found, std::size_t count) {
    if (found.front.empty()) return {};
    return context_.confirm(found, narrowed(count), watch_).entries;
  }
  // A network of which nothing is known yet.
  std::vector<PlanEntry> confirmed(std::span<const PlacedStation> placed) {
    SearchOutcome found;
    found.front.push_back({.x = DecisionSpace(context_.oracle(), narrowed(placed.size())).encode(placed),
                           .f = std::vector<double>(problem_.objectives.size(), 2)});
    return confirmed(found, placed.size());
  }
  std::vector<PlanEntry> confirmed(const CoverSolution& answer) {
    const std::vector<PlacedStation> chosen = stations_of(answer);
    return confirmed(std::span(chosen).subspan(problem_.kept.size()));
  }

  void confirm_choice() {
    take(confirmed(choice_));
    sample_off_ = coverage_margin_;
    if (entries_.empty() || !entries_.back().exact) return;
    sample_off_ = entries_.back().searched.at("coverage").value - entries_.back().value("coverage");
  }

  // Entries of networks that stand where others do already are none.
  void take(std::vector<PlanEntry> entries) {
    for (PlanEntry& entry : entries) {
      entry.violation = violation_of(entry, problem_.requirements);
      entries_.push_back(std::move(entry));
    }
  }
  double best_missed() const {
    double least = std::numeric_limits<double>::infinity();
    for (const PlanEntry& entry : entries_)
      if (entry.exact) least = std::min(least, entry.violation);
    return least;
  }

  // Chooses anew, further from the limits by what every ray showed to be missing. False where that cannot help.
  bool repair() {
    const PlanEntry* nearest = nullptr;
    for (const PlanEntry& entry : entries_)
      if (entry.exact && (!nearest || entry.violation < nearest->violation)) nearest = &entry;
    if (!nearest || choice_.violation > 0) return false;
    double coverage = 0, link = 0;
    for (const Requirement& requirement : problem_.requirements) {
      const Objective& objective = requirement.objective;
      if (requirement.bound != Requirement::Bound::at_least || !(requirement.limit > 0)) continue;
      const double shortfall = requirement.limit - nearest->value(objective.name);
      if (objective.kind == Objective::Kind::coverage)
        coverage = std::max(coverage, shortfall * objective.coverage_of_one);
      if (objective.kind == Objective::Kind::link) link = std::max(link, shortfall);
    }
    if (coverage == 0 && link == 0) return false;
    coverage_margin_ += kBeyond * coverage, link_margin_ += kBeyond * link;
    nearly_.reset();
    // From where it is, at this number, or else by what one more allows.
    choice_ = evaluate_cover(question(), choice_.chosen);
    CoverSolution same = improve_weakest_link(question(), choice_, watch_.stop);
    if (same.violation == 0)
      choice_ = std::move(same);
    else
      choose_from(std::move(same));
    choice_ = improve_weakest_link(question(), std::move(choice_), watch_.stop);
    confirm_choice();
    return true;
  }

  // What every ray told of the choice says what the sample is off. As that is known now, a station fewer may do, or as
  // many may be linked better. False where neither is so.
  bool choose_again() {
    const auto exact = entries_.back().values.find("coverage");
    if (exact == entries_.back().values.end() || !nearly_ || choice_.violation > 0) return false;
    const double off = choice_.coverage - exact->second.value;
    if (off >= coverage_margin_) return false;
    const double margin = std::exchange(coverage_margin_, off);
    ConnectedCover next = min_connected_cover(question(), watch_.stop, *nearly_);
    CoverSolution found = std::move(next.best);
    if (found.violation == 0 && found.chosen.size() <= choice_.chosen.size()) {
      const CoverSolution before =
          std::exchange(choice_, improve_weakest_link(question(), std::move(found), watch_.stop));
      const double before_off = sample_off_;
      confirm_choice();
      if (entries_.back().exact && entries_.back().violation == 0) {
        nearly_ = std::move(next.one_fewer);
        return true;
      }
      choice_ = before, sample_off_ = before_off;
    }
    coverage_margin_ = margin;
    return false;
  }

  // Of all networks that were confirmed, or of all where none was: those of fewest stations that keep what is required,
  // else those that miss least; and of these, those that no other one dominates.
  std::vector<PlanEntry> front() {
    const bool any_confirmed = std::ranges::any_of(entries_, &PlanEntry::exact);
    std::vector<PlanEntry> left;
    for (PlanEntry& entry : entries_)
      if (entry.exact || !any_confirmed) left.push_back(std::move(entry));
    drop_unplaced(left, problem_.kept.size());
    const auto rank = [](const PlanEntry& entry) {
      return std::pair{entry.violation, entry.violation > 0 ? std::size_t{0} : entry.stations.size()};
    };
    if (left.empty()) return left;
    const auto best = rank(*std::ranges::min_element(left, {}, rank));
    std::erase_if(left, [&](const PlanEntry& entry) { return rank(entry) != best; });

    const std::size_t objectives = problem_.objectives.size();
    std::vector<double> scaled;
    for (const PlanEntry& entry : left)
      for (const Objective& objective : problem_.objectives)
        scaled.push_back(objective.scaled(entry.value(objective.name)));
    const std::vector<std::size_t> ranks = non_dominated_ranks(scaled, objectives);
    std::vector<PlanEntry> front;
    for (std::size_t k = 0; k < left.size(); ++k) {
      const bool doubled =
          std::ranges::any_of(front, [&](const PlanEntry& other) { return same_places(other, left[k]); });
      if (ranks[k] == 0 && !doubled && (objectives > 1 || front.empty())) front.push_back(std::move(left[k]));
    }
    return front;
  }

  // Time ran out before anything was traced: an allowed position, of which nothing is known.
  PlanResult nothing_known() {
    SearchOutcome none;
    none.stop_reason = StopReason::cancelled;
    PlanResult result = context_.result(none);
    std::vector<PlacedStation> one = candidates_.stations();
    if (one.empty())
      one = spread_positions(context_.oracle(), context_.area().mesh(), context_.oracle().height_m, 1).stations;
    if (one.empty()) return result;
    one.resize(1);
    result.front = confirmed(one);
    result.exact_hypervolume = judge_by_every_ray(result.front, problem_, context_.measures());
    return result;
  }

  PlanContext& context_;
  Simulator& simulator_;
  const Candidates& candidates_;
  const PlanConfig& config_;
  const PlanWatch& watch_;
  const SurveyProblem problem_;
  std::size_t most_;  // stations
  double link_, coverage_ = 0, coverage_margin_ = 0, link_margin_ = 0;
  double sample_off_ = 0;  // what the sample of the search says too much of the choice's coverage
  double look_seconds_ = 0, station_seconds_ = 0;  // that one takes by the sample: what it captures, and links and all
  std::uint64_t sample_;                           // voxels
  CandidateTable table_;
  CoverSolution choice_;
  std::optional<CoverSolution> nearly_;
  std::vector<PlanEntry> entries_;
  std::uint64_t traced_ = 0;
};

}  // namespace

PlanResult plan_fewest(PlanContext& context, Simulator& simulator, std::shared_ptr<const Candidates> candidates,
                       double candidates_seconds, const PlanConfig& config, const PlanWatch& watch) {
  return FewestPlan(context, simulator, *candidates, candidates_seconds, config, watch).run();
}

}  // namespace vantage
