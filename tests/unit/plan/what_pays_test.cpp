// SPDX-License-Identifier: Apache-2.0
#include "plan/what_pays.hpp"

#include <gtest/gtest.h>

#include <vector>

#include "vantage/error.hpp"
#include "vantage/question.hpp"
#include "vantage/summary.hpp"

namespace vantage {
namespace {

// Candidates that share nothing, one for each number of elements.
CoverageMatrix apart(const std::vector<std::uint32_t>& sizes, std::uint32_t weight = 1) {
  std::uint32_t all = 0;
  for (const std::uint32_t size : sizes) all += size;
  CoverageMatrix matrix(std::vector<std::uint32_t>(all, weight), 1);
  std::uint32_t next = 0;
  for (const std::uint32_t size : sizes) {
    std::vector<CoverageMatrix::Entry> column;
    for (std::uint32_t k = 0; k < size; ++k) column.push_back({next++, 1});
    matrix.add(column);
  }
  return matrix;
}

TEST(WhatPays, EndsWhereAFurtherStationCapturesLess) {
  const CoverageMatrix matrix = apart({10, 40, 20, 30});
  const StationsThatPay pays = stations_that_pay({.matrix = matrix, .most = 9}, 2, {.m2 = 50});
  EXPECT_EQ(pays.stations, 2u);
  EXPECT_DOUBLE_EQ(pays.capture, 0.7);
  EXPECT_DOUBLE_EQ(pays.next_m2, 40);
  const StationsThatPay all = stations_that_pay({.matrix = matrix, .most = 9}, 2, {.m2 = 1});
  EXPECT_EQ(all.stations, 4u);
  EXPECT_DOUBLE_EQ(all.capture, 1);
  EXPECT_DOUBLE_EQ(all.next_m2, 0);
}

TEST(WhatPays, AsksForAShareOfTheAverageWhereThatIsMore) {
  std::vector<std::uint32_t> sizes(12, 100);
  sizes.insert(sizes.end(), {9, 9, 9, 4, 4, 4, 4});
  const CoverageMatrix matrix = apart(sizes);
  const auto pays = [&](const LeastGain& least) { return stations_that_pay({.matrix = matrix, .most = 40}, 1, least); };
  EXPECT_EQ(pays({.m2 = 5}).stations, 15u);
  EXPECT_EQ(pays({.m2 = 5, .share = 0.1}).stations, 12u) << "9 is less than a tenth of 100";
  EXPECT_DOUBLE_EQ(pays({.m2 = 5, .share = 0.1}).least_m2, 10);
  EXPECT_EQ(pays({.m2 = 5, .share = 0.05}).stations, 15u);
  EXPECT_EQ(pays({.m2 = 1, .share = 0.01}).stations, 19u);
  // Two stations count as ten: 9 of 200.
  const CoverageMatrix few = apart({100, 100, 9});
  EXPECT_EQ(stations_that_pay({.matrix = few, .most = 9}, 1, {.m2 = 1, .share = 0.1}).stations, 3u);
  EXPECT_EQ(stations_that_pay({.matrix = few, .most = 9}, 1, {.m2 = 1, .share = 0.5}).stations, 2u);
}

TEST(WhatPays, TakesOneStationWhereNoneDoes) {
  const CoverageMatrix matrix = apart({3, 2});
  EXPECT_EQ(stations_that_pay({.matrix = matrix, .most = 9}, 1, {.m2 = 100}).stations, 1u);
  EXPECT_EQ(stations_that_pay({.matrix = matrix, .existing = {1}, .most = 9}, 1, {.m2 = 100}).stations, 0u);
}

TEST(WhatPays, CountsWhatExistingStationsCapture) {
  const CoverageMatrix matrix = apart({40, 30, 20, 10});
  const StationsThatPay pays = stations_that_pay({.matrix = matrix, .existing = {0}, .most = 9}, 1, {.m2 = 25});
  EXPECT_EQ(pays.stations, 1u);
  EXPECT_DOUBLE_EQ(pays.capture, 0.7);
}

// A fifth as many stations as there are count together, so one poor step ends nothing.
TEST(WhatPays, LooksAtAFifthMoreStationsTogether) {
  std::vector<std::uint32_t> sizes(300, 20);
  sizes.insert(sizes.end(), 200, 2);
  const CoverageMatrix matrix = apart(sizes);
  const StationsThatPay pays = stations_that_pay({.matrix = matrix, .most = 450}, 1, {.m2 = 10});
  EXPECT_GT(pays.stations, 240u);
  EXPECT_LT(pays.stations, 300u);
  EXPECT_LT(pays.next_m2, 10);
  EXPECT_EQ(stations_that_pay({.matrix = matrix, .most = 100}, 1, {.m2 = 10}).stations, 100u);
}

TEST(WhatPays, TakesAsManyStationsAsAreAskedForAtLeast) {
  const CoverageMatrix matrix = apart({40, 30, 20, 10});
  EXPECT_EQ(stations_that_pay({.matrix = matrix, .fewest = 3, .most = 9}, 1, {.m2 = 100}).stations, 3u);
  EXPECT_EQ(stations_that_pay({.matrix = matrix, .fewest = 2, .most = 3}, 1, {.m2 = 1}).stations, 3u);
}

TEST(WhatPays, SurfaceCountsAlikeWhateverItsWeight) {
  const CoverageMatrix matrix = apart({40, 30, 20, 10}, 7);
  EXPECT_EQ(stations_that_pay({.matrix = matrix, .most = 9}, 1, {.m2 = 25}).stations, 2u);
}

// Candidates 2 and 3 stand in parts of the floor where a further station adds little, 4 in one where it adds nothing.
TEST(WhatPays, EachPartOfTheFloorHasAStation) {
  const CoverageMatrix matrix = apart({50, 30, 8, 6, 1});
  const std::vector<std::vector<std::size_t>> units{{0, 1}, {2}, {3}, {4}, {}};
  const StationsThatPay pays = stations_that_pay({.matrix = matrix, .most = 9}, 1, {.m2 = 25}, units);
  EXPECT_EQ(pays.stations, 4u);
  EXPECT_EQ(pays.parts, 2u);
  EXPECT_DOUBLE_EQ(pays.capture, 94.0 / 95);
  EXPECT_EQ(stations_that_pay({.matrix = matrix, .most = 3}, 1, {.m2 = 25}, units).stations, 3u);
}

TEST(WhatPays, APartTakesItsBestStationThatMayStand) {
  const CoverageMatrix matrix = apart({50, 8, 9, 10});
  StationGraph graph(4);
  graph.exclude(0, 3);
  const std::vector<std::vector<std::size_t>> units{{0}, {1, 2, 3}};
  const std::vector<std::size_t> chosen{0};
  EXPECT_EQ(for_empty_units(matrix, &graph, chosen, units, 1, 5), (std::vector<std::size_t>{2}));
  EXPECT_EQ(for_empty_units(matrix, nullptr, chosen, units, 1, 5), (std::vector<std::size_t>{3}));
  EXPECT_TRUE(for_empty_units(matrix, &graph, chosen, units, 1, 9.5).empty());
}

TEST(WhatPays, FurtherStationsAddTheirMean) {
  const CoverageMatrix matrix = apart({40, 30, 20, 10});
  const FurtherStations one = further_stations({.matrix = matrix, .existing = {0}}, 1, 2),
                        two = further_stations({.matrix = matrix, .existing = {0}}, 10, 2);
  EXPECT_EQ(one.candidates, (std::vector<std::size_t>{1}));
  EXPECT_DOUBLE_EQ(one.each_m2, 60);
  EXPECT_DOUBLE_EQ(two.each_m2, 50);
  EXPECT_EQ(further_stations({.matrix = matrix, .existing = {0, 1, 2, 3}}, 4, 2).each_m2, 0);
}

// A floor of 12 m by 12 m.
Site floor_site() {
  const std::vector<Vec3> corners{{0, 0, 0}, {12, 0, 0}, {12, 12, 0}, {0, 12, 0}};
  const std::vector<std::array<std::uint32_t, 3>> triangles{{0, 1, 2}, {0, 2, 3}};
  SiteOptions options;
  options.engine = Engine::embree;
  options.user_size_m = 0.5, options.spacing_m = 0.05;
  return Site(Scene::from_triangles(corners, triangles), options);
}

TEST(WhatPays, TheNumberOfStationsFollowsIt) {
  const auto placed = [](double pays_m2) {
    Site site = floor_site();
    SurveyQuestion question;
    question.pays_m2 = pays_m2;
    question.link = 0;
    return plan(site, question, {.iterations = 1, .sample_voxels = 500});
  };
  const PlanResult few = placed(1000), more = placed(0.5);
  ASSERT_TRUE(few.pays && more.pays);
  EXPECT_EQ(few.pays->stations, 1u);
  EXPECT_GT(more.pays->stations, 1u);
  EXPECT_GE(more.front.front().stations.size(), few.front.front().stations.size());
  EXPECT_LT(few.pays->next_m2, 1000);
  for (const PlanResult* result : {&few, &more})
    for (const Requirement& requirement : result->problem.requirements)
      if (requirement.objective.name == "capture") {
        EXPECT_DOUBLE_EQ(requirement.limit, result->pays->capture);
      }
}

TEST(WhatPays, ALimitOnTheStationsEndsItAndIsMet) {
  Site site = floor_site();
  SurveyQuestion question;
  question.pays_m2 = 0.5, question.link = 0, question.stations = {1, 1};
  const PlanConfig config{.iterations = 1, .sample_voxels = 500};
  const PlanResult one = plan(site, question, config);
  EXPECT_EQ(one.front.front().stations.size(), 1u);
  EXPECT_TRUE(met(one));
  EXPECT_NE(planned_text(one).find(", with as many stations as are allowed; a further one would add some "),
            std::string::npos)
      << planned_text(one);
  ASSERT_TRUE(one.further);
  EXPECT_GT(one.further->m2, 0.5);
  EXPECT_GT(one.further->minutes, 3) << "setting up alone takes as long";
  question.stations = {2, 9};
  const PlanResult two = plan(site, question, config);
  EXPECT_EQ(two.front.front().stations.size(), 2u) << "a third would add nothing";
  EXPECT_TRUE(met(two));
  question.stations = {1, 1}, question.requirements = {"capture>=0.999"};
  EXPECT_FALSE(met(plan(site, question, config))) << "a share that is asked for stays";
}

TEST(WhatPays, ALimitOnTheTimeEndsItAndIsMet) {
  Site site = floor_site();
  SurveyQuestion question;
  question.pays_m2 = 0.5, question.link = 0, question.requirements = {"time<=5"};
  const PlanResult one = plan(site, question, {.iterations = 1, .sample_voxels = 500});
  EXPECT_EQ(one.front.front().stations.size(), 1u);
  EXPECT_TRUE(met(one));
  EXPECT_GT(one.exact_hypervolume, 0) << "judged by the capture that is required in the end";
}

TEST(WhatPays, EitherItOrAShareDecides) {
  Site site = floor_site();
  const auto code_of = [&](const SurveyQuestion& asked) {
    try {
      survey_problem(site, asked);
    } catch (const Error& error) {
      return error.code();
    }
    return Errc{};
  };
  SurveyQuestion question;
  question.pays_m2 = 25, question.capture = 0.8;
  EXPECT_EQ(code_of(question), Errc::invalid_argument);
  question.capture.reset();
  EXPECT_EQ(survey_problem(site, question).pays_m2, 25);
  question.problem = "coverage-fix";
  EXPECT_EQ(code_of(question), Errc::invalid_argument);
  question.problem.reset(), question.pays_m2 = 0;
  EXPECT_EQ(code_of(question), Errc::invalid_argument);
}

}  // namespace
}  // namespace vantage
