// SPDX-License-Identifier: Apache-2.0
// Problems by name and by list, and the fate of values in a search.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <utility>

#include "search/choose_optimiser.hpp"
#include "search/measures.hpp"
#include "search/scaled_objectives.hpp"
#include "unit/plan/toy_survey.hpp"
#include "vantage/error.hpp"
#include "vantage/question.hpp"

namespace vantage {
namespace {

template <class Call>
std::string refusal(Call&& call) {
  try {
    call();
  } catch (const Error& e) {
    return e.what();
  }
  return "accepted";
}

std::vector<std::string> names(const SurveyProblem& problem) {
  std::vector<std::string> all;
  for (const Objective& objective : problem.objectives) all.push_back(objective.name);
  return all;
}

TEST(SurveyProblem, AreThoseOfTable2) {
  using Names = std::vector<std::string>;
  EXPECT_EQ(names(coverage_fix(4)), (Names{"coverage"}));
  EXPECT_EQ(names(coverage_overlap_fix(4)), (Names{"coverage", "overlap"}));
  EXPECT_EQ(names(coverage_min(4, 8)), (Names{"coverage", "stations"}));
  EXPECT_EQ(names(coverage_overlap_min(4, 8)), (Names{"coverage", "overlap", "stations"}));
  EXPECT_EQ(names(fitness_min(4, 8)), (Names{"fitness"}));
  for (const std::string& name : problem_names())
    EXPECT_EQ(survey_problem(name, 4, name.ends_with("-min") ? 8 : 4).name, name);
  EXPECT_NE(refusal([] { survey_problem("coverage", 1, 1); }).find("coverage-overlap-min"), std::string::npos);
  EXPECT_NE(refusal([] { survey_problem("coverage-fix", 4, 5); }).find("4 to 5"), std::string::npos);
  EXPECT_NE(refusal([] { survey_problem("coverage-min", 4, 4); }).find("takes a range"), std::string::npos);
}

TEST(ScaledObjectives, OfTable2) {
  const std::vector<double> x{0.1, 0.1, 0.9, 0.9, 0.25}, values{0.75, 0.5, 2};
  EXPECT_EQ(scaled_objectives(coverage_fix(1), x, values), (std::vector<double>{0.25}));
  EXPECT_EQ(scaled_objectives(coverage_overlap_fix(1), x, values), (std::vector<double>{0.25, 0.5}));
  EXPECT_EQ(scaled_objectives(coverage_overlap_min(1, 2), x, values), (std::vector<double>{0.25, 0.5, 0.25}));
  const std::vector<double> two{0.75, 2};
  EXPECT_EQ(scaled_objectives(coverage_min(1, 2), x, two), (std::vector<double>{0.25, 0.25}));
}

TEST(ScaledObjectives, OfWhatBreaksARequirementLieBehind) {
  const SurveyProblem problem = coverage_overlap_fix(2);
  const std::array<double, 4> x{};
  const auto f = [&](double coverage, double overlap, double missed) {
    std::vector<double> scaled(2);
    scale_objectives(problem, x, std::array{coverage, overlap}, missed, scaled);
    return scaled;
  };
  const auto worst = f(0, 0, 0), near = f(0, 0, 0.01), far = f(1, 1, 0.2), equal = f(0.5, 0.5, 0.2);
  for (std::size_t k = 0; k < 2; ++k) {
    EXPECT_LT(worst[k], near[k]);  // any that keeps them goes before any that does not
    EXPECT_LT(near[k], far[k]);    // then a network that violates by a tenth less, whatever its other values
    EXPECT_LT(far[k], equal[k]);   // and of equals the better one
  }
}

TEST(Measures, AreToldOnceByName) {
  SurveyProblem problem = coverage_fix(4);
  problem.requirements = {make_requirement("overlap>=0.1"), make_requirement("coverage>=0.2")};
  const Measures measures = measures_of(problem);
  ASSERT_EQ(measures.all.size(), 2u);
  EXPECT_EQ(measures.searched, 2u);
  EXPECT_EQ(measures.required, (std::vector<std::size_t>{1, 0}));
  EXPECT_TRUE(measures.searched_needs().pairs);
  EXPECT_FALSE(measures_of(coverage_fix(4)).searched_needs().pairs);
  EXPECT_TRUE(measures_of(coverage_fix(4)).all_needs().pairs);

  EXPECT_NE(refusal([] { measures_of(SurveyProblem{}); }).find("at least one objective"), std::string::npos);
  problem.objectives.push_back(problem.objectives[0]);
  EXPECT_NE(refusal([&] { measures_of(problem); }).find("two objectives are named coverage"), std::string::npos);
  problem.objectives.back().name = "My own";
  EXPECT_NE(refusal([&] { measures_of(problem); }).find("not \"My own\""), std::string::npos);
  const auto value = std::exchange(problem.objectives.back().value, nullptr);
  problem.objectives.back().name = "own";
  EXPECT_NE(refusal([&] { measures_of(problem); }).find("own has no value"), std::string::npos);
  // Metres, say, must not be maximised because nobody said otherwise.
  problem.objectives.back() = {.name = "walk", .unit = "m", .value = value};
  EXPECT_NE(
      refusal([&] { measures_of(problem); }).find("the objective walk has no scale; give it minimise(best, worst)"),
      std::string::npos);
  problem.objectives.back().scale = minimise(0, 100);
  EXPECT_EQ(measures_of(problem).all.back().name, "overlap");
}

TEST(ChooseOptimiser, RefusesWhatCannotBe) {
  const PlacementOracle site = test::toy_site();
  const auto refused = [&](const SurveyProblem& problem, const PlanConfig& config) {
    const DecisionSpace space(site, problem);
    return refusal([&] { choose_optimiser(space, problem, config, 1); });
  };
  EXPECT_NE(refused(coverage_fix(4), {.iterations = 9, .sigma0 = 0}).find("sigma0"), std::string::npos);
  EXPECT_NE(refused(coverage_fix(4), {.iterations = 0}).find("iteration"), std::string::npos);
  EXPECT_NE(refused(coverage_fix(4), {.iterations = 9, .max_seconds = -1}).find("max_seconds"), std::string::npos);
  EXPECT_NE(refused(coverage_overlap_fix(4), {.population = 1, .iterations = 9}).find("population of 1"),
            std::string::npos);
  EXPECT_EQ(refused(coverage_overlap_fix(4), {.iterations = 9}), "accepted");
  EXPECT_EQ(population_of(coverage_fix(4), {}), 10u);
  EXPECT_EQ(population_of(fitness_min(4, 8), {}), 20u);
  EXPECT_EQ(population_of(coverage_min(4, 8), {}), 100u);
}

TEST(ChooseOptimiser, TakesOneOfTheCallersOwnForSeveralObjectives) {
  const PlacementOracle site = test::toy_site();
  const Optimiser* made = nullptr;
  PlanConfig config{.population = 6, .iterations = 3, .seed = 9};
  config.optimiser = [&](std::size_t dimension, std::size_t objectives, const OptimiserConfig& asked) {
    EXPECT_EQ(dimension, 8u);
    EXPECT_EQ(objectives, 2u);
    EXPECT_EQ(asked.population, 6u);
    EXPECT_EQ(asked.max_iterations, 3u);
    EXPECT_EQ(asked.seed, 9u);
    auto own = std::make_unique<MoCmaEs>(dimension, objectives, asked);
    made = own.get();
    return own;
  };
  const DecisionSpace two(site, coverage_overlap_fix(4)), one(site, coverage_fix(4));
  EXPECT_EQ(choose_optimiser(two, coverage_overlap_fix(4), config, 1).get(), made);
  EXPECT_NE(made, nullptr);
  made = nullptr;
  EXPECT_EQ(choose_optimiser(one, coverage_fix(4), config, 1)->objectives(), 1u);
  EXPECT_EQ(made, nullptr);
}

TEST(SurveyProblem, TheSurveyorsQuestionAsksForFewStations) {
  const SurveyProblem problem = fewest_stations(0.95, 0.2, 2, 9, 0);
  EXPECT_TRUE(problem.fewest);
  EXPECT_EQ(problem.stations_min, 2u);
  EXPECT_EQ(problem.stations_max, 9u);
  ASSERT_EQ(problem.requirements.size(), 2u);
  EXPECT_EQ(to_string(problem.requirements[0]), "capture >= 0.95");
  EXPECT_EQ(to_string(problem.requirements[1]), "link >= 0.2");
  ASSERT_EQ(problem.objectives.size(), 1u);
  EXPECT_EQ(problem.objectives[0].name, "registration");
  EXPECT_EQ(fewest_stations().requirements.size(), 3u);
  EXPECT_TRUE(fewest_stations(0, 0, 1, 4, 0).requirements.empty());
  for (const std::string& name : problem_names())
    EXPECT_FALSE(survey_problem(name, 4, name.ends_with("-min") ? 8 : 4).fewest);
}

}  // namespace
}  // namespace vantage
