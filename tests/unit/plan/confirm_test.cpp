// SPDX-License-Identifier: Apache-2.0
#include "plan/confirm.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "unit/plan/toy_survey.hpp"

namespace vantage {
namespace {

struct Confirmed {
  SearchOutcome found;
  std::vector<PlanEntry> entries;
};

Confirmed confirmed(const SurveyProblem& problem, std::uint64_t sampled, test::ToyEvaluator& evaluator,
                    const PlanWatch& watch = {}) {
  const PlacementOracle site = test::toy_site();
  const DecisionSpace space(site, problem);
  Confirmed result{.found = test::toy_search(problem, test::toy_config(), evaluator), .entries = {}};
  result.entries = confirm_front(result.found, space, problem, evaluator.measures, sampled, evaluator, watch).entries;
  return result;
}

TEST(ConfirmFront, ReportsExactBesideSampled) {
  test::ToyEvaluator evaluator;
  const auto [found, entries] = confirmed(test::toy_problem("coverage-overlap-fix"), true, evaluator);
  ASSERT_EQ(entries.size(), found.front.size());
  EXPECT_EQ(evaluator.confirmed, entries.size());
  EXPECT_EQ(evaluator.estimated, entries.size());
  for (const PlanEntry& e : entries) {
    EXPECT_TRUE(e.exact);
    EXPECT_EQ(e.searched.at("coverage").standard_error, 0.01);
    EXPECT_EQ(e.searched.at("overlap").standard_error, 0.02);
    EXPECT_NEAR(e.value("coverage"), e.searched.at("coverage").value - 0.001, 1e-12);
    EXPECT_EQ(e.counts.points_on_surveyed, std::vector<std::uint64_t>(4, 7));
    EXPECT_EQ(e.overlap_matrix.size(), 4u);
  }
  for (std::size_t k = 1; k < entries.size(); ++k)
    EXPECT_LE(entries[k].searched.at("coverage").value, entries[k - 1].searched.at("coverage").value);
}

TEST(ConfirmFront, AnExactSearchHasOneValue) {
  test::ToyEvaluator evaluator;
  const auto [found, entries] = confirmed(test::toy_problem("coverage-min"), false, evaluator);
  EXPECT_EQ(evaluator.estimated, 0u);
  ASSERT_FALSE(entries.empty());
  for (const PlanEntry& e : entries) {
    EXPECT_EQ(e.values.size(), 3u);  // overlap is told though nobody asked for it
    for (const auto& [name, value] : e.values) {
      EXPECT_EQ(e.searched.at(name).value, value.value) << name;
      EXPECT_EQ(value.standard_error, 0) << name;
    }
    EXPECT_EQ(e.value("stations"), static_cast<double>(e.stations.size()));
  }
}

TEST(ConfirmFront, AbortLeavesWhatTheSearchSaw) {
  for (const std::uint64_t sampled : {0, 100}) {
    test::ToyEvaluator evaluator;
    std::stop_source abort;
    PlanWatch watch{.report =
                        [&](const PlanProgress& p) {
                          EXPECT_EQ(p.phase, "confirm");
                          if (p.iteration == 2) abort.request_stop();
                        },
                    .abort = abort.get_token()};
    const auto [found, entries] = confirmed(test::toy_problem("coverage-overlap-min"), sampled, evaluator, watch);
    ASSERT_GT(entries.size(), 3u);
    const auto done = std::count_if(entries.begin(), entries.end(), [](const PlanEntry& e) { return e.exact; });
    EXPECT_EQ(done, 2);
    for (const PlanEntry& e : entries) {
      EXPECT_GT(e.value("coverage"), 0);
      EXPECT_EQ(e.value("stations"), static_cast<double>(e.stations.size()));
      if (!e.exact) {
        EXPECT_DOUBLE_EQ(e.value("coverage"), test::ToyEvaluator::coverage_of(e.stations));
      }
    }
  }
}

TEST(ConfirmFront, NetworksInHolesAreConfirmedToo) {
  const PlacementOracle site = test::toy_site();
  const SurveyProblem problem = test::toy_problem("coverage-fix");
  const DecisionSpace space(site, problem);
  SearchOutcome found;
  found.front = {{.x = std::vector<double>(8, 0.5), .f = {1}}};
  test::ToyEvaluator evaluator;
  const auto entries = confirm_front(found, space, problem, evaluator.measures, 0, evaluator, {}).entries;
  ASSERT_EQ(entries.size(), 1u);
  EXPECT_TRUE(entries[0].exact);
  EXPECT_EQ(entries[0].stations[0].status, StationStatus::hole);
}

TEST(ConfirmFront, SparesWhatIsBeatenBeyondDoubt) {
  const PlacementOracle site = test::toy_site();
  const SurveyProblem problem = test::toy_problem("coverage-overlap-fix");
  const DecisionSpace space(site, problem);
  test::ToyEvaluator evaluator;
  SearchOutcome found;
  found.front = test::toy_search(problem, test::toy_config(), evaluator).front;
  const std::size_t good = found.front.size();
  // A network in one place, seen by no target, among others that a plan would keep.
  ParetoPoint bad{.x = std::vector<double>(8, 0.02), .f = {1, 1}};
  for (std::size_t k = 1; k < 8; k += 2) bad.x[k] = 0.3 * static_cast<double>(k) / 8;
  found.front.push_back(bad);
  const double coverage = test::ToyEvaluator::coverage_of(space.decode(bad.x)),
               overlap = test::ToyEvaluator::overlap_of(space.decode(bad.x));
  // Standard errors are 0.01 and 0.02, of two networks each.
  const bool beyond_doubt = std::ranges::any_of(found.front, [&](const ParetoPoint& point) {
    const auto stations = space.decode(point.x);
    return test::ToyEvaluator::coverage_of(stations) > coverage + 3 * std::sqrt(2) * 0.01 &&
           test::ToyEvaluator::overlap_of(stations) > overlap + 3 * std::sqrt(2) * 0.02;
  });
  ASSERT_TRUE(beyond_doubt);
  evaluator.confirmed = 0;
  const ConfirmedFront front = confirm_front(found, space, problem, evaluator.measures, 100, evaluator, {});
  EXPECT_EQ(front.spared, 1u);
  EXPECT_EQ(front.entries.size(), good);
  EXPECT_EQ(evaluator.confirmed, good);
  for (const PlanEntry& entry : front.entries) EXPECT_NE(entry.x, bad.x);
}

// Entries of made-up exact values; what the search saw is the opposite and must not count.
std::vector<PlanEntry> made_up(const Measures& measures, std::initializer_list<std::array<double, 2>> values) {
  std::vector<PlanEntry> entries;
  for (const auto& [coverage, overlap] : values) {
    PlanEntry& e = entries.emplace_back();
    e.x.assign(8, 0.5);
    e.exact = true;
    for (const Objective& measure : measures.all) e.searched[measure.name] = e.values[measure.name] = {0.5, 0};
    e.searched["coverage"] = {1 - coverage, 0}, e.values["coverage"] = {coverage, 0};
    e.searched["overlap"] = {1 - overlap, 0}, e.values["overlap"] = {overlap, 0};
  }
  return entries;
}

TEST(KeepUndominated, LeavesOneOfEquals) {
  const SurveyProblem problem = test::toy_problem("coverage-overlap-fix");
  const Measures measures = measures_of(problem);
  auto entries = made_up(measures, {{0.9, 0.2}, {0.5, 0.6}, {0.9, 0.2}, {0.4, 0.6}, {0.1, 0.8}});
  keep_undominated(entries, problem, measures);
  ASSERT_EQ(entries.size(), 3u);
  EXPECT_EQ(entries[0].value("coverage"), 0.9);
  EXPECT_EQ(entries[1].value("coverage"), 0.5);
  EXPECT_EQ(entries[2].value("coverage"), 0.1);
}

TEST(JudgeByEveryRay, MarksWhatIsDominatedAndMeasuresTheRest) {
  const SurveyProblem problem = test::toy_problem("coverage-overlap-fix");
  const Measures measures = measures_of(problem);
  auto entries = made_up(measures, {{0.9, 0.2}, {0.5, 0.6}, {0.4, 0.6}, {0.5, 0.5}});
  EXPECT_DOUBLE_EQ(judge_by_every_ray(entries, problem, measures), 0.9 * 0.2 + 0.5 * 0.4);
  EXPECT_FALSE(entries[0].dominated);
  EXPECT_FALSE(entries[1].dominated);
  EXPECT_TRUE(entries[2].dominated);
  EXPECT_TRUE(entries[3].dominated);
  entries[1].exact = false;
  EXPECT_TRUE(std::isnan(judge_by_every_ray(entries, problem, measures)));
  EXPECT_FALSE(entries[2].dominated) << "only confirmed entries are compared";
}

TEST(JudgeByEveryRay, RanksWhatBreaksARequirementBehindAllElse) {
  SurveyProblem problem = test::toy_problem("coverage-overlap-fix");
  problem.requirements = {make_requirement("coverage>=0.5"), make_requirement("overlap >= 0.3")};
  const Measures measures = measures_of(problem);
  auto entries = made_up(measures, {{0.9, 0.2}, {0.5, 0.3}, {0.4, 0.9}, {0.3, 0.2}});
  EXPECT_DOUBLE_EQ(judge_by_every_ray(entries, problem, measures), 0.5 * 0.3);
  EXPECT_EQ(entries[1].violation, 0);
  EXPECT_NEAR(entries[0].violation, 0.1, 1e-12);
  EXPECT_NEAR(entries[2].violation, 0.1, 1e-12);
  EXPECT_NEAR(entries[3].violation, 0.3, 1e-12);
  EXPECT_FALSE(entries[1].dominated);
  for (const std::size_t k : {0, 2, 3}) EXPECT_TRUE(entries[k].dominated) << k;
}

}  // namespace
}  // namespace vantage
