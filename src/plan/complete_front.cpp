// SPDX-License-Identifier: Apache-2.0
#include "plan/complete_front.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "evaluate/evaluator.hpp"
#include "plan/answer_targets.hpp"
#include "plan/fewest_choice.hpp"
#include "plan/trade_off.hpp"
#include "vantage/candidates.hpp"

namespace vantage {
namespace {

// Largest front whose entries all have their rounds computed; on a larger one, only the answer has.
constexpr std::size_t kMostRounds = 16;

// A station of a confirmed network may see more of a voxel than any candidate did.
void take_in_confirmed(PlanResult& result, PlanContext& context, Simulator& simulator, const Progress& progress) {
  std::vector<Network> networks;
  for (const PlanEntry& entry : result.front)
    if (entry.exact) networks.push_back(to_network(entry.stations));
  if (networks.empty()) return;
  AttainableCounts raised = context.confirmed;
  for (const Network& network : networks)
    if (!raise_attainable(raised, simulator, network, progress)) return;
  const std::vector<CapturedShares> shares = captured_shares(simulator, raised, networks, progress);
  if (shares.empty()) return;
  context.confirmed = std::move(raised);
  std::size_t k = 0;
  for (PlanEntry& entry : result.front) {
    if (!entry.exact) continue;
    const CapturedShares& share = shares[k++];
    for (const Objective& measure : context.measures().all)
      if (measure.needs.attainable)
        entry.values.at(measure.name) = measure.meshes.empty() ? share.all : share.meshes.at(measure.meshes);
    entry.attainable = context.confirmed.coverage();
  }
  result.exact_hypervolume = judge_by_every_ray(result.front, result.problem, context.measures());
}

void work_out_rounds(PlanResult& result, PlanContext& context, const Progress& progress) {
  const std::size_t chosen = answer(result);
  const std::vector<Objective>& objectives = result.problem.objectives;
  const bool shortest = std::ranges::any_of(objectives, [](const Objective& one) { return one.needs.time; });
  const double most_min = shortest ? 0 : most_minutes(result.problem.requirements);
  add_round(result.front[chosen], context.on_site(), most_min);
  if (result.front.size() > kMostRounds) return;
  for (PlanEntry& entry : result.front)
    if (!entry.visit && !progress.stopped()) add_round(entry, context.on_site(), most_min);
}

// The confirmed answer takes its place in the trade-off. It is the only point if the time was over before others were
// estimated.
void put_answer_in_trade_off(PlanResult& result) {
  const PlanEntry& entry = result.front[answer(result)];
  const auto captured = entry.values.find("capture");
  const bool known = captured != entry.values.end() && std::isfinite(captured->second.value);
  if (!result.problem.fewest || !known || (result.trade_off.empty() && !fewest_asked(result.problem).captured)) return;
  TradeOffPoint point{.stations = entry.stations, .values = entry.values, .answer = true};
  if (entry.visit) point.minutes_on_site = entry.visit->minutes;
  const auto stations = [](const TradeOffPoint& p) { return p.stations.size(); };
  const auto at = std::ranges::lower_bound(result.trade_off, entry.stations.size(), {}, stations);
  if (at != result.trade_off.end() && at->stations.size() == entry.stations.size())
    *at = std::move(point);
  else
    result.trade_off.insert(at, std::move(point));
  mark_knee(result.trade_off);
}

}  // namespace

void complete_front(PlanResult& result, PlanContext& context, Site& site, const Progress& progress) {
  const SurveyProblem& problem = result.problem;
  if (needs_attainable(problem)) {
    take_in_confirmed(result, context, site.simulator(), progress);
    result.attainable = context.confirmed.coverage();
  }
  if (result.attainable && result.candidates)
    for (PlanEntry& entry : result.front) entry.attainable_growth = result.candidates->growth();
  if (result.front.empty()) return;
  work_out_rounds(result, context, progress);
  put_answer_in_trade_off(result);
  add_targets(result, site, context.measures(), progress);
  complete(result.front[answer(result)],
           {.simulator = site.simulator(), .on_site = &context.on_site(), .clash = &site.clash()}, progress);
}

}  // namespace vantage
