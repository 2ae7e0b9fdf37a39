// SPDX-License-Identifier: Apache-2.0
#include "search/search.hpp"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <fstream>
#include <iterator>
#include <random>
#include <stdexcept>

#include "support/temporary_folder.hpp"
#include "unit/plan/toy_survey.hpp"
#include "vantage/error.hpp"

extern char** environ;

namespace vantage {
namespace {

using test::bits_of;
using test::toy_config;
using test::toy_search;
using test::ToyEvaluator;

class EveryProblem : public testing::TestWithParam<const char*> {
 protected:
  const SurveyProblem problem_ = test::toy_problem(GetParam());
};
INSTANTIATE_TEST_SUITE_P(Search, EveryProblem, testing::ValuesIn(test::kProblems), [](const auto& problem) {
  std::string name = problem.param;
  std::replace(name.begin(), name.end(), '-', '_');
  return name;
});

TEST_P(EveryProblem, SameSeedSameBitsWhateverTheChunk) {
  const PlanConfig config = toy_config();
  ToyEvaluator one, many;
  many.at_once = 0;
  const SearchOutcome a = toy_search(problem_, config, one), b = toy_search(problem_, config, many);
  EXPECT_EQ(bits_of(a), bits_of(b));
  EXPECT_EQ(a.evaluations, 600u);
  EXPECT_EQ(a.stop_reason, StopReason::max_iterations);
  EXPECT_EQ(one.largest_batch, 1u);
  EXPECT_GT(many.largest_batch, 1u);

  PlanConfig other = config;
  other.seed = 8;
  ToyEvaluator again;
  EXPECT_NE(bits_of(toy_search(problem_, other, again)), bits_of(a));
}

TEST_P(EveryProblem, StaysOutOfHolesAndClashes) {
  PlanConfig config = toy_config();
  ToyEvaluator evaluator;
  std::uint64_t idle = 0;
  evaluator.before_each = [&](const PlacedNetwork& network) {
    for (const PlacedStation& s : network) idle += s.status == StationStatus::ok ? 0 : 1;
  };
  const SearchOutcome drawn_again = toy_search(problem_, config, evaluator);
  const std::uint64_t idle_with = idle;
  EXPECT_GT(drawn_again.redrawn, 0u);
  EXPECT_GT(drawn_again.drawn, drawn_again.redrawn);
  config.redraws = 0, idle = 0;
  ToyEvaluator plain;
  plain.before_each = evaluator.before_each;
  const SearchOutcome as_drawn = toy_search(problem_, config, plain);
  EXPECT_EQ(as_drawn.redrawn, 0u);
  EXPECT_LT(10 * idle_with, idle);
}

TEST_P(EveryProblem, FrontIsNonDominatedAndHistoryGrows) {
  ToyEvaluator evaluator;
  const SearchOutcome outcome = toy_search(problem_, toy_config(), evaluator);
  ASSERT_FALSE(outcome.front.empty());
  std::vector<double> f;
  for (const ParetoPoint& point : outcome.front) f.insert(f.end(), point.f.begin(), point.f.end());
  for (const std::size_t rank : non_dominated_ranks(f, outcome.front[0].f.size())) EXPECT_EQ(rank, 0u);
  ASSERT_GE(outcome.history.size(), 5u);
  for (std::size_t k = 1; k < outcome.history.size(); ++k) {
    EXPECT_GT(outcome.history[k].iteration, outcome.history[k - 1].iteration);
    EXPECT_GE(outcome.history[k].hypervolume, outcome.history[k - 1].hypervolume - 1e-12);
  }
  EXPECT_EQ(outcome.history.back().evaluations, outcome.evaluations);
  EXPECT_EQ(outcome.history.back().hypervolume, outcome.hypervolume);
}

// Cut after every so many evaluations, also in the middle of a batch, and gone on with.
void expect_resumed(const SurveyProblem& problem, PlanConfig config, double noise) {
  const test::TemporaryFolder folder;
  ToyEvaluator whole;
  whole.noise = noise;
  const std::string wanted = bits_of(toy_search(problem, config, whole));

  config.checkpoint = folder / "run.checkpoint";
  config.resume = true;
  std::mt19937 random(3);
  std::uint64_t calls = 0;
  for (int cut = 0;; ++cut) {
    ASSERT_LT(cut, 200);
    std::stop_source stop;
    ToyEvaluator evaluator;
    evaluator.noise = noise;
    // Re-evaluating the archive begins anew where it was cut short, so it must fit in.
    std::uint64_t left = 1 + random() % (config.renew_iterations ? 120 : 60);
    evaluator.before_each = [&](const PlacedNetwork&) {
      if (--left == 0) stop.request_stop();
    };
    const SearchOutcome outcome = toy_search(problem, config, evaluator, stop.get_token());
    calls += evaluator.evaluated;
    if (outcome.stop_reason != StopReason::max_iterations) {
      EXPECT_EQ(outcome.stop_reason, StopReason::cancelled);
      continue;
    }
    EXPECT_GT(cut, 4);
    EXPECT_EQ(bits_of(outcome), wanted);
    break;
  }
  // Nothing that was known was evaluated again; fewer where a network came up twice. An archive that is evaluated again
  // comes on top.
  if (!config.renew_iterations) {
    EXPECT_LE(calls, 600u);
  }
}

TEST_P(EveryProblem, ResumesToTheSameBits) { expect_resumed(problem_, toy_config(), 0); }

PlanConfig renewing_config() {
  PlanConfig config = toy_config();
  config.sample_voxels = 400, config.renew_iterations = 3;
  return config;
}

TEST_P(EveryProblem, ResumesToTheSameBitsWithASampleDrawnAnew) { expect_resumed(problem_, renewing_config(), 0.5); }

TEST_P(EveryProblem, EndsWithVoxelsThatNothingWasChosenBy) {
  ToyEvaluator evaluator;
  evaluator.noise = 0.5;
  evaluator.at_once = 0;
  const PlanConfig config = renewing_config();
  const SearchOutcome found = toy_search(problem_, config, evaluator);
  const auto drawn = static_cast<std::uint64_t>(found.history.size()) / *config.renew_iterations;
  EXPECT_EQ(found.sample.from, (drawn + 1) * config.sample_voxels);
  EXPECT_EQ(found.sample.voxels, 4 * config.sample_voxels);
  ASSERT_EQ(found.estimates.size(), found.front.size());
  const PlacementOracle site = test::toy_site();
  const DecisionSpace space(site, problem_);
  for (std::size_t k = 0; k < found.front.size(); ++k) {
    const ParetoPoint& point = found.front[k];
    std::vector<double> values;
    for (const Estimate& estimate : found.estimates[k]) values.push_back(estimate.value);
    EXPECT_EQ(point.f, scaled_objectives(problem_, point.x, values));
  }
}

// A network that stays over many draws is as good by every ray as in the search; a single draw favours the networks
// that it chose.
TEST(Search, SamplesDrawnAnewDoNotFlatter) {
  const SurveyProblem problem = test::toy_problem("coverage-overlap-fix");
  double flattered = 0, left = 0;
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    for (const bool renewed : {false, true}) {
      ToyEvaluator evaluator;
      evaluator.noise = 0.5;
      evaluator.at_once = 0;
      PlanConfig config = renewing_config();
      config.seed = seed, config.iterations = 30;
      if (!renewed) config.renew_iterations = 0;
      const SearchOutcome found = toy_search(problem, config, evaluator);
      const PlacementOracle site = test::toy_site();
      const DecisionSpace space(site, problem);
      std::vector<double> exact;
      for (const ParetoPoint& point : found.front) {
        const std::vector<PlacedNetwork> one{space.decode(point.x)};
        const std::vector<double> f = scaled_objectives(problem, point.x, evaluator.evaluate(one, {}, {})->front());
        exact.insert(exact.end(), f.begin(), f.end());
      }
      (renewed ? left : flattered) += found.hypervolume - hypervolume(exact, 2, std::vector<double>{1, 1});
    }
  }
  EXPECT_LT(std::abs(left), flattered / 2);
}

TEST_P(EveryProblem, ResumesToTheSameBitsAfterKill9) {
  const test::TemporaryFolder folder;
  const std::string problem = std::string(GetParam());
  ToyEvaluator evaluator;
  const std::string wanted = bits_of(toy_search(problem_, toy_config(), evaluator));
  const std::string checkpoint = folder / "run.checkpoint", output = folder / "out.txt";
  std::string runner = VANTAGE_SEARCH_RUNNER;
  char* const arguments[] = {runner.data(), const_cast<char*>(problem.c_str()), const_cast<char*>(checkpoint.c_str()),
                             const_cast<char*>(output.c_str()), nullptr};
  const auto seed = std::random_device{}();
  SCOPED_TRACE("seed " + std::to_string(seed));
  std::mt19937 random(seed);
  constexpr int wanted_kills = 25;  // a hundred over the four problems
  int kills = 0;
  while (kills < wanted_kills) {
    std::filesystem::remove(checkpoint);
    for (bool finished = false; !finished;) {
      ASSERT_LT(kills, 400);
      pid_t child = 0;
      ASSERT_EQ(posix_spawn(&child, runner.c_str(), nullptr, nullptr, arguments, environ), 0);
      // Later each time, so that a slow machine gets on too.
      usleep(static_cast<useconds_t>(random() % static_cast<unsigned>(20'000 + 3'000 * kills)));
      kill(child, SIGKILL);
      int status = 0;
      ASSERT_EQ(waitpid(child, &status, 0), child);
      finished = WIFEXITED(status);
      if (finished) {
        ASSERT_EQ(WEXITSTATUS(status), 0);
      } else {
        ++kills;
      }
    }
    std::ifstream in(output);
    EXPECT_EQ(std::string(std::istreambuf_iterator<char>(in), {}), wanted) << "after " << kills << " kills";
  }
}

TEST(Search, GoesOnWithMoreIterationsAsIfTheyHadBeenAskedForAtOnce) {
  const test::TemporaryFolder folder;
  const SurveyProblem problem = test::toy_problem("coverage-overlap-fix");
  PlanConfig config = toy_config();
  ToyEvaluator whole;
  const std::string wanted = bits_of(toy_search(problem, config, whole));
  config.checkpoint = folder / "run.checkpoint";
  config.iterations = 10;
  ToyEvaluator first, second;
  EXPECT_EQ(toy_search(problem, config, first).resumed_evaluations, 0u);
  config.iterations = 30, config.resume = true;
  const SearchOutcome outcome = toy_search(problem, config, second);
  EXPECT_EQ(bits_of(outcome), wanted);
  EXPECT_EQ(outcome.resumed_evaluations, 200u);
  EXPECT_LE(second.evaluated, 400u);
  EXPECT_GE(second.evaluated + first.evaluated, whole.evaluated);
}

TEST(Search, GoesOnWithMoreIterationsFromTheSampleItHadDrawn) {
  const test::TemporaryFolder folder;
  const SurveyProblem problem = test::toy_problem("coverage-overlap-fix");
  PlanConfig config = renewing_config();
  ToyEvaluator whole, first, second;
  whole.noise = first.noise = second.noise = 0.5;
  const std::string wanted = bits_of(toy_search(problem, config, whole));
  config.checkpoint = folder / "run.checkpoint";
  config.iterations = 13;
  toy_search(problem, config, first);
  config.iterations = 30, config.resume = true;
  EXPECT_EQ(bits_of(toy_search(problem, config, second)), wanted);
}

TEST(Search, RefusesTheCheckpointOfAnotherRun) {
  const test::TemporaryFolder folder;
  const SurveyProblem problem = test::toy_problem("coverage-fix");
  PlanConfig config = toy_config();
  config.checkpoint = folder / "run.checkpoint";
  config.iterations = 2;
  ToyEvaluator evaluator;
  toy_search(problem, config, evaluator);
  config.seed = 99, config.resume = true;
  try {
    toy_search(problem, config, evaluator);
    FAIL();
  } catch (const Error& e) {
    EXPECT_EQ(e.code(), Errc::invalid_argument);
    EXPECT_NE(std::string(e.what()).find("seed = 7"), std::string::npos) << e.what();
    EXPECT_NE(std::string(e.what()).find("seed = 99"), std::string::npos) << e.what();
  }
}

TEST(Search, KeepsTheCheckpointWhenAnEvaluationFails) {
  const test::TemporaryFolder folder;
  const SurveyProblem problem = test::toy_problem("coverage-overlap-min");
  PlanConfig config = toy_config();
  ToyEvaluator whole;
  const std::string wanted = bits_of(toy_search(problem, config, whole));
  config.checkpoint = folder / "run.checkpoint", config.resume = true;
  ToyEvaluator failing;
  failing.before_each = [&](const PlacedNetwork&) {
    if (failing.evaluated == 333) throw Error(Errc::device_failure, "the device is gone");
  };
  EXPECT_THROW(toy_search(problem, config, failing), Error);
  ToyEvaluator rest;
  EXPECT_EQ(bits_of(toy_search(problem, config, rest)), wanted);
  // A network that came up twice, once before the failure and once after, is evaluated twice.
  EXPECT_GE(rest.evaluated, whole.evaluated - 333);
  EXPECT_LE(rest.evaluated, 600u - 333);
}

TEST(Search, StopsAtItsLimits) {
  const SurveyProblem problem = test::toy_problem("coverage-overlap-fix");
  PlanConfig config = toy_config();
  ToyEvaluator evaluator;
  config.target_hypervolume = 0.2;
  const SearchOutcome reached = toy_search(problem, config, evaluator);
  EXPECT_EQ(reached.stop_reason, StopReason::target_reached);
  EXPECT_GE(reached.hypervolume, 0.2);
  EXPECT_LT(reached.evaluations, 600u);

  config.target_hypervolume.reset();
  config.stagnation_iterations = 3;
  config.iterations = 5000;
  ToyEvaluator slow;
  const SearchOutcome stale = toy_search(problem, config, slow);
  EXPECT_EQ(stale.stop_reason, StopReason::stagnated);
  EXPECT_LT(stale.evaluations, 100'000u);
}

TEST(Search, TellsHowFarItIs) {
  const SurveyProblem problem = test::toy_problem("coverage-min");
  PlanConfig config = toy_config();
  ToyEvaluator evaluator;
  std::uint64_t last = 0, calls = 0;
  const SearchOutcome outcome = toy_search(problem, config, evaluator, {}, 4, [&](const PlanProgress& p) {
    EXPECT_GE(p.evaluations, last);
    EXPECT_EQ(p.iterations, 30u);
    EXPECT_EQ(p.phase, "search");
    EXPECT_GE(p.seconds_left, 0);
    last = p.evaluations;
    ++calls;
  });
  EXPECT_EQ(last, outcome.evaluations);
  EXPECT_GT(calls, 30u);
}

TEST(Search, StartsWhereItIsTold) {
  const SurveyProblem problem = test::toy_problem("coverage-fix");
  PlanConfig config = toy_config();
  config.start = {{1, 1, 4.5}, {9, 1, 4.5}, {9, 9, 4.5}, {1, 9, 4.5}};
  config.sigma0 = 1e-3;
  config.iterations = 1;
  ToyEvaluator evaluator;
  std::size_t swapped = 0;  // networks with one station from anywhere
  evaluator.before_each = [&](const PlacedNetwork& network) {
    ASSERT_EQ(network.size(), 4u);
    std::size_t elsewhere = 0;
    for (std::size_t i = 0; i < 4; ++i) {
      const Vec3 off = network[i].position - config.start[i];
      elsewhere += dot(off, off) > 0.2 * 0.2;
      EXPECT_EQ(network[i].position.z, 4.5);
    }
    EXPECT_LE(elsewhere, 1u);
    swapped += elsewhere;
  };
  toy_search(problem, config, evaluator);
  EXPECT_LE(swapped, config.population / 10);
}

TEST(Search, MaximisesTheFitness) {
  PlanConfig config = toy_config();
  config.iterations = 100;
  ToyEvaluator evaluator;
  const SearchOutcome outcome = toy_search(fitness_min(1, 8), config, evaluator);
  ASSERT_EQ(outcome.front.size(), 1u);
  EXPECT_GT(outcome.hypervolume, 0.6);  // one station alone: .4 for its number, .2 for seeing itself, and its coverage
  EXPECT_LE(outcome.hypervolume, 1);
  EXPECT_NEAR(outcome.hypervolume, 1 - outcome.front[0].f[0], 1e-15);
}

TEST(Search, WantsNetworksThatKeepTheRequirements) {
  // Stations are linked within 4 m; the targets, 8 m apart, pull them away from each other.
  SurveyProblem problem = test::toy_problem("coverage-overlap-fix");
  PlanConfig config = toy_config();
  config.iterations = 60;
  const PlacementOracle site = test::toy_site();
  const auto parted = [&] {
    ToyEvaluator evaluator;
    const SearchOutcome outcome = toy_search(problem, config, evaluator);
    const DecisionSpace space(site, problem);
    std::size_t n = 0;
    for (const ParetoPoint& point : outcome.front)
      n += connectivity(ToyEvaluator::near(space.decode(point.x)), 1).parts > 1 ? 1 : 0;
    return n;
  };
  EXPECT_GT(parted(), 0u);
  problem.requirements = {make_requirement("parts<=1", problem.settings())};
  EXPECT_EQ(parted(), 0u);
}

TEST(Search, FindsTheFewestStationsThatKeepARequirement) {
  // 0.4 of the toy's coverage takes some stations; the search for few must not end with networks that fall short.
  SurveyProblem problem = survey_problem(std::vector<std::string>{"stations", "overlap"}, 1, 8);
  problem.requirements = {make_requirement("coverage >= 0.4")};
  PlanConfig config = toy_config();
  config.iterations = 100;
  ToyEvaluator evaluator;
  const SearchOutcome outcome = toy_search(problem, config, evaluator);
  const PlacementOracle site = test::toy_site();
  const DecisionSpace space(site, problem);
  ASSERT_FALSE(outcome.front.empty());
  for (const ParetoPoint& point : outcome.front) {
    EXPECT_GE(ToyEvaluator::coverage_of(space.decode(point.x)), 0.4);
    EXPECT_LT(point.f[0], 1);
  }
}

TEST(Search, FindsTheBestNetworkOfAKnownSite) {
  // Eight targets and eight stations: each can stand on its own target.
  const PlanConfig config{.population = 20, .iterations = 400, .seed = 5};
  ToyEvaluator evaluator;
  EXPECT_GT(toy_search(coverage_fix(8), config, evaluator).hypervolume, 0.97);
}

}  // namespace
}  // namespace vantage
