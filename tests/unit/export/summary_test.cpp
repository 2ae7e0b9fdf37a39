// SPDX-License-Identifier: Apache-2.0
#include "vantage/summary.hpp"

#include <gtest/gtest.h>

#include "unit/export/files.hpp"

namespace vantage {
namespace {

// 0–1–2 in a chain, 3–4 a pair that is near to 2, 5 by itself, 6 in a hole.
OverlapMatrix three_parts() {
  OverlapMatrix overlap(7);
  overlap.set(0, 1, 0.4), overlap.set(1, 2, 0.25), overlap.set(3, 4, 0.5), overlap.set(2, 3, 0.004),
      overlap.set(0, 4, 0.002);
  overlap.set(6, 5, 0.9);  // of a station that is not used
  return overlap;
}
const std::vector<bool> kUsed{true, true, true, true, true, true, false};

TEST(Summary, LinksTellPartsAndWhereTheyAreNearest) {
  const SummaryLinks links = summary_links(three_parts(), 0.01, kUsed);
  EXPECT_EQ(links.parts, (std::vector<std::vector<std::size_t>>{{0, 1, 2}, {3, 4}, {5}}));
  EXPECT_FALSE(links.weakest);
  ASSERT_EQ(links.gaps.size(), 2u);
  EXPECT_EQ(links.gaps[0].inside, 3u);
  EXPECT_EQ(links.gaps[0].outside, 2u);
  EXPECT_EQ(links.gaps[0].value, 0.004);
  EXPECT_EQ(links.gaps[1].inside, 5u);
  EXPECT_EQ(links.gaps[1].value, 0);

  EXPECT_EQ(summary_links(three_parts(), 0.01).parts.back(), (std::vector<std::size_t>{5, 6}))
      << "what nothing is said of is used";
  OverlapMatrix ring(3);
  ring.set(0, 1, 0.4), ring.set(1, 2, 0.25), ring.set(0, 2, 0.1);
  const SummaryLinks one = summary_links(ring, 0.01, {true, true, true});
  ASSERT_TRUE(one.weakest);
  EXPECT_EQ(*one.weakest, (std::pair<std::size_t, std::size_t>{1, 2}));
  EXPECT_EQ(one.weakest_value, 0.25);
}

TEST(Summary, SaysInWordsWhatItKnowsAndNothingElse) {
  SurveySummary summary{.names = {"S1", "S2", "S3", "S4", "S5", "S6", "S7"}, .captured = 0.7125};
  EXPECT_EQ(summary_text(summary), "captured   71.2 % of the site\n");
  summary.captured_error = 0.004;
  summary.of_visible = 0.92;
  summary.registration_mm = 1.234;
  summary.seconds_on_site = 3 * 3600 + 25 * 60 + 20;
  summary.links = summary_links(three_parts(), 0.01, kUsed);
  summary.faults = {{"S7 is in a hole", "move it"}};
  EXPECT_EQ(
      summary_text(summary),
      "captured   71.2 % ± 0.4 % of the site, 92.0 % of what can be seen\n"
      "linked     no: in 3 parts, by overlap of at least 0.01: S1, S2 and S3; S4 and S5; S6 stands alone\n"
      "registered to about 1.23 mm, as predicted\n"
      "on site    about 3 h 25 min\n"
      "to do      link S4 to S3, the nearest to it with 0.004: put a station between them, or move them closer\n"
      "           S6 shares nothing with any station of another part: put a station between it and S1, or tie it in "
      "with targets\n"
      "           S7 is in a hole: move it\n");
  OverlapMatrix pair(2);
  pair.set(0, 1, 0.3);
  SurveySummary linked{.names = {"K1", "S1"}, .captured = 1, .links = summary_links(pair, 0.01, {true, true})};
  EXPECT_EQ(summary_text(linked),
            "captured   100.0 % of the site\n"
            "linked     yes: all 2 stations, by overlap of at least 0.01; weakest link K1–S1 with 0.300\n");
  linked.links = summary_links(OverlapMatrix(1), 0.01, {true});
  EXPECT_EQ(summary_lines(linked)[1].text, "one station, nothing to link");
}

TEST(Summary, TheTableHasGroundAndHeadToTheMillimetre) {
  std::vector<PlacedStation> stations(3);
  stations[0].position = {500'000.12345, 2.5, 1.85}, stations[0].ground = {500'000.12345, 2.5, -0.0001};
  stations[0].kept = true;
  stations[1].status = StationStatus::hole;
  stations[2].position = {-1, 20.0004, 3.1}, stations[2].ground = {-1, 20.0004, 1.25};
  const std::vector<std::uint64_t> points{12, 0, 345};
  EXPECT_EQ(station_table(stations, station_names(stations), points),
            "station    ground x       y      z  head z  status    points on surveyed meshes\n"
            "K1       500000.123   2.500  0.000   1.850  ok, kept                         12\n"
            "S1                                          hole                              0\n"
            "S2           -1.000  20.000  1.250   3.100  ok                              345\n");
}

TEST(Summary, TheTableSaysHowStationsAreSetUpWhereAnyIsNotAsUsual) {
  std::vector<PlacedStation> stations(2);
  stations[1].setup = {.heading = Angle::degrees(-30), .tilt = Angle::degrees(90), .scanner = 1};
  std::vector<Scanner> scanners(2);
  scanners[0].name = "Größer", scanners[0].azimuth_step = Angle::degrees(0.2);
  scanners[1].name = "RTC", scanners[1].azimuth_step = scanners[1].zenith_step = Angle::degrees(0.0345);
  EXPECT_EQ(station_table(stations, station_names(stations), {}, scanners),
            "station  ground x      y      z  head z  status  heading °  tilt °  scanner  step °\n"
            "S1          0.000  0.000  0.000   0.000  ok            0.0     0.0  Größer\n"
            "S2          0.000  0.000  0.000   0.000  ok          -30.0    90.0  RTC      0.0345\n");
}

TEST(Summary, OfAPlanTellsWhatItMisses) {
  PlanResult result = test::sample_result("coverage-overlap-fix", 3, 3, 1);
  result.problem.requirements = {make_requirement("coverage>=0.99"), make_requirement("coverage>=0.2")};
  PlanEntry& entry = result.front[0];
  entry.stations[1].status = StationStatus::clash;
  entry.exact_overlap_matrix.set(0, 2, 0.2);
  const SurveySummary summary = summary_of(entry, result);
  EXPECT_EQ(summary.captured, entry.value("coverage"));
  ASSERT_TRUE(summary.links);
  EXPECT_EQ(summary.links->parts, (std::vector<std::vector<std::size_t>>{{0, 2}})) << "the clash is no part";
  ASSERT_EQ(summary.faults.size(), 2u);
  EXPECT_TRUE(summary.faults[0].what.starts_with("S2 clashes")) << summary.faults[0].what;
  EXPECT_EQ(summary.faults[1].what, "misses coverage >= 0.99: it has 0.948");
  entry.confirmed = false;
  EXPECT_FALSE(summary_of(entry, result).links) << "not known without every ray";
  EXPECT_EQ(summary_of(entry, result).captured_error, 0.001);
}

}  // namespace
}  // namespace vantage
