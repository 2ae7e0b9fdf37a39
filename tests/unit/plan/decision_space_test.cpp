// SPDX-License-Identifier: Apache-2.0
#include "search/decision_space.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "unit/plan/toy_survey.hpp"
#include "vantage/error.hpp"

namespace vantage {
namespace {

SurveyProblem stations(std::size_t low, std::size_t high) { return {.stations_min = low, .stations_max = high}; }

TEST(DecisionSpace, HasTheDimensionsOfSection44) {
  const PlacementOracle site = test::toy_site();
  EXPECT_EQ(DecisionSpace(site, stations(4, 4)).dimension(), 8u);
  EXPECT_EQ(DecisionSpace(site, stations(8, 20)).dimension(), 41u);
  SurveyProblem heights = stations(2, 3);
  heights.heights_m = {1.2, 2.4};
  const DecisionSpace space(site, heights);
  EXPECT_EQ(space.dimension(), 10u);
  EXPECT_EQ(space.bounds().lower, (std::vector<double>{0, 0, 0, 0, 0, 0, 1.2, 1.2, 1.2, 0}));
  EXPECT_EQ(space.bounds().upper, (std::vector<double>{1, 1, 1, 1, 1, 1, 2.4, 2.4, 2.4, 1}));
}

TEST(DecisionSpace, KnowsWhichCoordinatesMakeAStation) {
  const PlacementOracle site = test::toy_site();
  SurveyProblem config = stations(2, 3);
  EXPECT_EQ(DecisionSpace(site, config).blocks(), (std::vector<std::vector<std::size_t>>{{0, 1}, {2, 3}, {4, 5}}));
  config.heights_m = {1.2, 2.4};
  EXPECT_EQ(DecisionSpace(site, config).blocks(),
            (std::vector<std::vector<std::size_t>>{{0, 1, 6}, {2, 3, 7}, {4, 5, 8}}));
}

TEST(DecisionSpace, DecodesByEquation7) {
  const PlacementOracle site = test::toy_site();
  const DecisionSpace space(site, stations(2, 4));
  std::vector<double> x{0.1, 0.1, 0.9, 0.2, 0.5, 0.5, 0.01, 0.5, 0};
  EXPECT_EQ(space.decode(x).size(), 2u);
  x.back() = 0.25;  // half up
  EXPECT_EQ(space.decode(x).size(), 3u);
  x.back() = 1;
  const auto placed = space.decode(x);
  ASSERT_EQ(placed.size(), 4u);
  EXPECT_EQ(placed[0].position, (Vec3{1, 1, 4.5}));
  EXPECT_EQ(placed[1].status, StationStatus::ok);
  EXPECT_EQ(placed[2].status, StationStatus::hole);
  EXPECT_EQ(placed[3].status, StationStatus::clash);
  const Network network = to_network(placed);
  EXPECT_TRUE(network[0].active);
  EXPECT_FALSE(network[2].active);
  EXPECT_FALSE(network[3].active);
}

TEST(DecisionSpace, KeepsStationsAndVariesHeights) {
  const PlacementOracle site = test::toy_site();
  SurveyProblem config = stations(2, 2);
  config.existing = {{5, 5, 9}};  // above the hole: it was scanned from there all the same
  config.heights_m = {1, 2};
  const DecisionSpace space(site, config);
  const std::vector<double> x{0.1, 0.1, 0.9, 0.9, 1.25, 1.75};
  const auto placed = space.decode(x);
  ASSERT_EQ(placed.size(), 3u);
  EXPECT_EQ(placed[0].position, (Vec3{5, 5, 9}));
  EXPECT_EQ(placed[0].status, StationStatus::ok);
  EXPECT_EQ(placed[1].position.z, 4.25);
  EXPECT_EQ(placed[2].position.z, 4.75);
  EXPECT_EQ(space.coordinates(2), (std::vector<std::size_t>{2, 3, 5}));
  EXPECT_TRUE(placed[0].existing && !placed[1].existing);
}

TEST(DecisionSpace, ChoosesScannersInEqualShares) {
  PlacementOracle site = test::toy_site();
  SurveyProblem config = stations(2, 3);
  config.heights_m = {1, 2};
  site.scanners = {4, 0, 7};
  const DecisionSpace space(site, config);
  EXPECT_EQ(space.dimension(), 13u);
  EXPECT_EQ(space.bounds().lower, (std::vector<double>{0, 0, 0, 0, 0, 0, 1, 1, 1, 0, 0, 0, 0}));
  EXPECT_EQ(space.bounds().upper, (std::vector<double>{1, 1, 1, 1, 1, 1, 2, 2, 2, 1, 1, 1, 1}));
  EXPECT_EQ(space.blocks()[1], (std::vector<std::size_t>{2, 3, 7, 10}));
  std::vector<double> x{0.1, 0.1, 0.9, 0.9, 0.2, 0.1, 1.5, 1.5, 1.5, 0.33, 0.34, 1, 1};
  auto placed = space.decode(x);
  ASSERT_EQ(placed.size(), 3u);
  EXPECT_EQ(placed[0].setup.scanner, 4u);
  EXPECT_EQ(placed[1].setup.scanner, 0u);
  EXPECT_EQ(placed[2].setup.scanner, 7u) << "1 is the last one too";
  EXPECT_EQ(space.decode(space.encode(placed)).at(1).setup, placed[1].setup);
  EXPECT_EQ(space.decode(space.encode(placed)).at(2).setup, placed[2].setup);
  const std::vector<Vec3> heads{{1, 2, 4.5}};
  EXPECT_EQ(space.decode(space.encode(heads)).at(0).setup.scanner, 4u) << "the first of them where nobody says";
  // A single scanner leaves no choice.
  site.scanners = {2};
  const DecisionSpace one(site, config);
  EXPECT_EQ(one.dimension(), 10u);
  x.resize(10);
  EXPECT_EQ(one.decode(x)[0].setup.scanner, 2u);
}

TEST(DecisionSpace, KeptStationsStandAsTheyStood) {
  const PlacementOracle site = test::toy_site();
  SurveyProblem config = stations(1, 1);
  config.existing = {{5, 5, 9}, {1, 1, 4}};
  config.existing_setups = {{.tilt = Angle::degrees(90)}, {.scanner = 1}};
  const auto placed = DecisionSpace(site, config).decode(std::vector<double>{0.1, 0.1});
  EXPECT_EQ(placed[0].setup, config.existing_setups[0]);
  EXPECT_EQ(placed[1].setup, config.existing_setups[1]);
  EXPECT_EQ(placed[2].setup, StationSetup());
  EXPECT_EQ(to_network(placed)[0].setup, config.existing_setups[0]);
  config.existing_setups.pop_back();
  EXPECT_THROW(DecisionSpace(site, config), Error);
}

TEST(VisibilityParts, CountsWhoSeesWhomWithinRange) {
  const PlacementOracle site = test::toy_site();  // a wall at y = 5, range 6 m
  const Network network{{{1, 1, 0}, true}, {{6, 1, 0}, true}, {{9, 4, 0}, true}, {{1, 9, 0}, true}, {{9, 9, 0}, true}};
  EXPECT_EQ(visibility_parts(site.sees, site.range_m, network), 3u);  // 1-2-3, 4, 5
  Network skipped = network;
  skipped[1].active = false;
  EXPECT_EQ(visibility_parts(site.sees, site.range_m, skipped), 5u);
  EXPECT_EQ(visibility_parts(site.sees, site.range_m, Network(1)), 1u);
}

TEST(DecisionSpace, EncodesAnInitialNetworkForEachNumber) {
  const PlacementOracle site = test::toy_site();
  const std::vector<Vec3> heads{{1, 2, 4.5}, {8, 9, 4.5}, {9, 1, 4.5}};
  const DecisionSpace space(site, stations(2, 4));
  const auto xs = space.encode_each(heads);
  ASSERT_EQ(xs.size(), 2u);
  EXPECT_EQ(space.placed_count(xs[0]), 3u);
  EXPECT_EQ(space.placed_count(xs[1]), 2u);
  EXPECT_EQ(space.decode(xs[1])[1].uv, (Uv{0.8, 0.9}));
  const DecisionSpace fixed(site, stations(3, 3));
  EXPECT_EQ(fixed.encode_each(heads).size(), 1u);
}

TEST(DecisionSpace, EncodesAnInitialNetwork) {
  const PlacementOracle site = test::toy_site();
  SurveyProblem config = stations(2, 4);
  config.heights_m = {1, 2};
  const DecisionSpace space(site, config);
  const std::vector<Vec3> heads{{1, 2, 4.7}, {8, 9, 4.5}, {9, 1, 9.0}};
  const auto x = space.encode(heads);
  EXPECT_EQ(space.placed_count(x), 3u);
  const auto placed = space.decode(x);
  EXPECT_NEAR(placed[0].position.z, 4.7, 1e-12);
  EXPECT_EQ(placed[1].uv, (Uv{0.8, 0.9}));
  EXPECT_EQ(placed[2].position.z, 5);  // no higher than the bounds
  const std::vector<Vec3> outside{{11, 2, 4.5}}, five(5, Vec3{1, 1, 4.5});
  EXPECT_THROW(space.encode(outside), Error);
  EXPECT_THROW(space.encode(five), Error);
}

TEST(DecisionSpace, RefusesWhatCannotBe) {
  const PlacementOracle site = test::toy_site();
  const auto refused = [&](const SurveyProblem& config, const std::string& part) {
    try {
      DecisionSpace space(site, config);
      ADD_FAILURE() << "not refused: " << part;
    } catch (const Error& e) {
      EXPECT_EQ(e.code(), Errc::invalid_argument);
      EXPECT_NE(std::string(e.what()).find(part), std::string::npos) << e.what();
    }
  };
  refused(stations(0, 0), "at least one");
  refused(stations(5, 4), "5 is above stations_max 4");
  refused(stations(4, 1025), "1025 were asked for");
  SurveyProblem config = stations(4, 1024);
  config.existing = {{1, 1, 1}};
  refused(config, "1025 were asked for");
  config = stations(4, 4);
  config.heights_m = {2, 1};
  refused(config, "heights_m");
}

}  // namespace
}  // namespace vantage
