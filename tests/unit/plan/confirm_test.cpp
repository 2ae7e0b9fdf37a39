// SPDX-License-Identifier: Apache-2.0
#include "plan/confirm.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "unit/plan/toy_survey.hpp"

namespace vantage {
namespace {

struct Confirmed {
  SearchOutcome found;
  std::vector<PlanEntry> entries;
};

Confirmed confirmed(const PlanConfig& config, test::ToyEvaluator& evaluator, std::stop_token abort = {},
                    const std::function<void(const PlanProgress&)>& watch = {}) {
  const Site site = test::toy_site();
  const DecisionSpace space(site, config);
  Confirmed result{.found = test::toy_search(config, evaluator), .entries = {}};
  result.entries = confirm_front(result.found, space, config, evaluator, watch, abort);
  return result;
}

TEST(ConfirmFront, ReportsExactBesideSampled) {
  PlanConfig config = test::toy_config(Problem::coverage_overlap_fix);
  config.sample_voxels = 1000;
  test::ToyEvaluator evaluator;
  const auto [found, entries] = confirmed(config, evaluator);
  ASSERT_EQ(entries.size(), found.front.size());
  EXPECT_EQ(evaluator.confirmed, entries.size());
  EXPECT_EQ(evaluator.estimated, entries.size());
  for (const PlanEntry& e : entries) {
    EXPECT_TRUE(e.confirmed);
    EXPECT_EQ(e.coverage_se, 0.01);
    EXPECT_EQ(e.overlap_se, 0.02);
    EXPECT_NEAR(e.exact_coverage, e.coverage - 0.001, 1e-12);
    EXPECT_EQ(e.points_on_surveyed, std::vector<std::uint64_t>(4, 7));
    EXPECT_EQ(e.exact_overlap_matrix.size(), 4u);
  }
  for (std::size_t k = 1; k < entries.size(); ++k) EXPECT_LE(entries[k].coverage, entries[k - 1].coverage);
}

TEST(ConfirmFront, AnExactSearchHasOneValue) {
  test::ToyEvaluator evaluator;
  const auto [found, entries] = confirmed(test::toy_config(Problem::coverage_min), evaluator);
  EXPECT_EQ(evaluator.estimated, 0u);
  for (const PlanEntry& e : entries) {
    EXPECT_EQ(e.coverage, e.exact_coverage);
    EXPECT_EQ(e.overlap, e.exact_overlap);
    EXPECT_EQ(e.coverage_se, 0);
  }
}

TEST(ConfirmFront, AbortLeavesWhatTheSearchSaw) {
  for (const std::uint64_t voxels : {0, 1000}) {
    PlanConfig config = test::toy_config(Problem::coverage_overlap_min);
    config.sample_voxels = voxels;
    test::ToyEvaluator evaluator;
    std::stop_source abort;
    const auto [found, entries] = confirmed(config, evaluator, abort.get_token(), [&](const PlanProgress& p) {
      EXPECT_EQ(p.phase, "confirm");
      if (p.iteration == 2) abort.request_stop();
    });
    ASSERT_GT(entries.size(), 3u);
    const auto done = std::count_if(entries.begin(), entries.end(), [](const PlanEntry& e) { return e.confirmed; });
    EXPECT_EQ(done, 2);
    for (const PlanEntry& e : entries) {
      EXPECT_GT(e.coverage, 0);
      if (!e.confirmed) {
        EXPECT_EQ(e.exact_coverage, 0);
        EXPECT_DOUBLE_EQ(e.coverage, test::ToyEvaluator::value_of(to_network(e.stations)).coverage);
      }
    }
  }
}

TEST(JudgeByEveryRay, MarksWhatIsDominatedAndMeasuresTheRest) {
  const Site site = test::toy_site();
  const PlanConfig config = test::toy_config(Problem::coverage_overlap_fix);
  const DecisionSpace space(site, config);
  const auto entry = [&](double coverage, double overlap) {
    PlanEntry e;
    e.x.assign(space.dimension(), 0.5);
    e.confirmed = true;
    e.exact_coverage = coverage, e.exact_overlap = overlap;
    e.coverage = 1 - coverage;  // what the search saw does not count
    return e;
  };
  std::vector<PlanEntry> entries{entry(0.9, 0.2), entry(0.5, 0.6), entry(0.4, 0.6), entry(0.5, 0.5)};
  EXPECT_DOUBLE_EQ(judge_by_every_ray(entries, space, config), 0.9 * 0.2 + 0.5 * 0.4);
  EXPECT_FALSE(entries[0].dominated);
  EXPECT_FALSE(entries[1].dominated);
  EXPECT_TRUE(entries[2].dominated);
  EXPECT_TRUE(entries[3].dominated);
  entries[1].confirmed = false;
  EXPECT_TRUE(std::isnan(judge_by_every_ray(entries, space, config)));
  EXPECT_FALSE(entries[2].dominated) << "only confirmed entries are compared";
}

TEST(ConfirmFront, NetworksInHolesNeedNoSimulation) {
  const Site site = test::toy_site();
  const PlanConfig config = test::toy_config(Problem::coverage_fix);
  const DecisionSpace space(site, config);
  SearchOutcome found;
  found.front = {{.x = std::vector<double>(8, 0.5), .f = {1}}};
  test::ToyEvaluator evaluator;
  const auto entries = confirm_front(found, space, config, evaluator, {}, {});
  ASSERT_EQ(entries.size(), 1u);
  EXPECT_EQ(evaluator.confirmed, 0u);
  EXPECT_TRUE(entries[0].confirmed);
  EXPECT_EQ(entries[0].exact_coverage, 0);
  EXPECT_EQ(entries[0].stations[0].status, StationStatus::hole);
}

}  // namespace
}  // namespace vantage
