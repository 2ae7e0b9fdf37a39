// SPDX-License-Identifier: Apache-2.0
#include "vantage/summary.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "unit/formats/files.hpp"
#include "vantage/question.hpp"

namespace vantage {
namespace {

// 0–1–2 in a chain, 3–4 a pair that is near to 2, 5 by itself, 6 in a hole.
Evaluation seven_stations() {
  Evaluation network{.stations = std::vector<PlacedStation>(7), .exact = true};
  network.stations[6].status = StationStatus::hole;
  network.overlap_matrix = OverlapMatrix(7);
  OverlapMatrix& overlap = network.overlap_matrix;
  overlap.set(0, 1, 0.4), overlap.set(1, 2, 0.25), overlap.set(3, 4, 0.5), overlap.set(2, 3, 0.004);
  overlap.set(0, 4, 0.002);
  overlap.set(6, 5, 0.9);  // of a station that is not used
  network.values["coverage"] = {0.7125, 0};
  return network;
}

TEST(Summary, TellsTheErrorOfWhatIsAttainable) {
  Evaluation network{.stations = std::vector<PlacedStation>(1), .exact = true, .values = {{"coverage", {0.5, 0}}}};
  network.values["capture"] = {0.9, 0};
  const auto captured = [&](double growth) {
    network.attainable_growth = growth;
    return summary_lines(network).front().text;
  };
  EXPECT_EQ(captured(0), "90.0 % of what is attainable; 50.0 % of the site");
  EXPECT_EQ(captured(0.007), "90.0 % of what is attainable, which is known to 0.7 %; 50.0 % of the site");
  EXPECT_TRUE(captured(0.0001).ends_with("which is known to less than 0.1 %; 50.0 % of the site"));
  EXPECT_EQ(captured(1), "90.0 % of what is attainable from the few places that were looked at; 50.0 % of the site");
}

TEST(Summary, SaysWhyMoreStationsRegisterWorse) {
  std::vector<TradeOffPoint> points;
  const auto add = [&](std::size_t stations, double registered_mm, double link) {
    points.push_back({.stations = std::vector<PlacedStation>(stations)});
    points.back().values = {{"registration", {registered_mm, 0}}, {"link", {link, 0}}};
  };
  add(7, 9.5, 0.31), add(8, 0.99, 0.45);
  EXPECT_EQ(registration_jump_text(points), "") << "more stations register better";
  add(10, 8.81, 0.32), add(12, 1.5, 0.4);
  EXPECT_EQ(registration_jump_text(points),
            "10 stations register to 8.8 mm, 8 to 1.0 mm: each number is a network of its own, chosen by what it "
            "captures, and the scans of the 10 are held together by a link of 0.32, those of the 8 by one of 0.45");
  points[2].values["link"].value = 0.5;
  EXPECT_TRUE(registration_jump_text(points).ends_with("chosen by what it captures")) << "no link explains it";
  points[2].values["registration"].value = 1.2;
  EXPECT_EQ(registration_jump_text(points), "") << "no jump";
}

TEST(Summary, JudgesTheRegistrationAndSaysWhereItMisses) {
  Evaluation network{.stations = std::vector<PlacedStation>(5), .exact = true, .values = {{"coverage", {1, 0}}}};
  const auto told = [&](double rms_mm) {
    network.values["registration"] = {rms_mm, 0};
    std::string text;
    for (const SummaryLine& line : summary_lines(network))
      if (line.heading == "registered") text = line.text;
    return text;
  };
  network.registration.emplace().stations.resize(5);
  EXPECT_EQ(told(5),
            "to about 5.0 mm, as predicted by random errors alone (the scanner states no calibration); LOA30 (15 mm at "
            "95 %) is met with 5.2 mm to spare");
  network.registration->stations[3].rms_m = 0.01;
  EXPECT_EQ(told(5),
            "to about 5.0 mm, as predicted by random errors alone (the scanner states no calibration); LOA30 (15 mm at "
            "95 %) is met with 5.2 mm to spare, but not at S4 (19.6 mm)");
  for (const std::size_t k : {0, 1, 2}) network.registration->stations[k].rms_m = 0.02 + 0.01 * static_cast<double>(k);
  EXPECT_EQ(told(20),
            "to about 20.0 mm, as predicted by random errors alone (the scanner states no calibration); LOA30 (15 mm "
            "at 95 %) is missed by 24.2 mm, most at S3 (78.4 mm), S2 "
            "(58.8 mm), S1 (39.2 mm) and 1 more");
  const auto advice = [&] { return summary_lines(network).back().text; };
  EXPECT_NE(advice().find("let targets be proposed"), std::string::npos);
  network.without_targets_m = 0.02;
  EXPECT_NE(advice().find("no place for a target is near enough to two stations"), std::string::npos);
  network.targets = {{.name = "T1", .proposed = true, .stations = {0, 1}}};
  EXPECT_NE(advice().find("nor do the proposed targets"), std::string::npos);
  network.registration->stations.assign(5, {});
  EXPECT_EQ(
      told(2),
      "to about 2.0 mm, as predicted by random errors alone (the scanner states no calibration), with 1 target that "
      "ties scans together (20.0 mm without); LOA30 (15 mm at 95 %) is met with 11.1 mm to spare");
  network.registration->rms_m = 0.002, network.registration->random_m = 0.0004;
  EXPECT_EQ(told(2),
            "to about 2.0 mm, as predicted (random 0.4 mm, the rest by what a calibration leaves), with 1 target that "
            "ties scans together (20.0 mm without); LOA30 (15 mm at 95 %) is met with 11.1 mm to spare");
  network.calibration = "18″, 1 mm and 10 ppm";
  EXPECT_TRUE(
      told(2).starts_with("to about 2.0 mm, as predicted (random 0.4 mm, the rest by what a calibration leaves: "
                          "18″, 1 mm and 10 ppm), with "))
      << told(2);
  EXPECT_EQ(std::ranges::count(summary_lines(network), "to check", &SummaryLine::heading), 1);
  network.targets.clear(), network.without_targets_m.reset();
  network.registration->rms_m = network.registration->random_m = 0.00004;
  network.accuracy_class = AccuracyClass::loa50;
  EXPECT_EQ(told(0.04),
            "to less than 0.1 mm, as predicted by random errors alone (the scanner states no calibration); LOA50 "
            "(1 mm at 95 %) is within reach, and no prediction promises it: check it on site");
  EXPECT_EQ(std::ranges::count(summary_lines(network), "to check", &SummaryLine::heading), 0);
}

TEST(Summary, TellsWhatTheScansHoldInAFewDigits) {
  Evaluation network = seven_stations();
  for (const auto& [data, text] :
       {std::pair{ScanData{45'053, 904'000, 1.62e6}, "45\u2009053 points: 0.9 MB as E57, 1.6 MB"},
        {ScanData{4.71e6, 94.1e6, 169e6}, "4.7 million points: 94 MB as E57, 169 MB"},
        {ScanData{542.9e6, 10.9e9, 19.54e9}, "543 million points: 11 GB as E57, 20 GB"},
        {ScanData{1.21e9, 24.2e9, 43.4e9}, "1.2 billion points: 24 GB as E57, 43 GB"}}) {
    network.data = data;
    const std::string told = summary_text(network);
    EXPECT_NE(told.find(std::string("\ndata       about ") + text + " as LAS\n"), std::string::npos) << told;
  }
}

TEST(Summary, TellsBatteriesIfItIsKnownHowLongTheyLast) {
  Evaluation network = seven_stations();
  Visit& visit = network.visit.emplace();
  EXPECT_EQ(summary_text(network).find("batteries"), std::string::npos);
  const BatteryUse use{
      .instrument = "Mine", .battery_min = 120, .on_min = 390, .scans = 63, .batteries = 4, .in_a_day = 4};
  const auto told = [&](const std::string& text) {
    const std::string summary = summary_text(network);
    EXPECT_NE(summary.find("batteries  " + text + "\n"), std::string::npos) << summary;
  };
  visit.batteries = {use};
  told("4 of 2 h each, for 6 h 30 min with the scanner on");
  visit.batteries[0].battery_min = 0, visit.batteries[0].battery_scans = 40;
  told("4 of 40 scans each, for 63 scans");
  visit.batteries[0].battery_min = 90;
  told("4 of 1 h 30 min or 40 scans each, for 6 h 30 min with the scanner on and 63 scans");
  visit.batteries = {use, use};
  visit.batteries[1].instrument = "Yours";
  told(
      "Mine: 4 of 2 h each, for 6 h 30 min with the scanner on\n           Yours: 4 of 2 h each, for 6 h 30 min with "
      "the scanner on");

  visit.day_min = 480;
  for (const std::size_t k : {0, 1, 2}) {
    Session one;
    one.day = k / 2 + 1, one.crew = k % 2 + 1, one.order = {2 * k, 2 * k + 1}, one.batteries = {use};
    one.batteries[0].batteries = k + 1;
    visit.sessions.push_back(one);
  }
  told("at most 3 a session and 3 a day, 6 in all, of 2 h each, for 19 h 30 min with the scanner on");
}

TEST(Summary, TellsSessionsAndWhereNoLinkHoldsThem) {
  Evaluation network = seven_stations();
  Visit& visit = network.visit.emplace();
  visit.day_min = 480;
  for (const std::size_t k : {0, 1, 2}) {
    Session one;
    one.day = k / 2 + 1, one.crew = k % 2 + 1, one.order = {2 * k, 2 * k + 1}, one.minutes = 400 + 30.0 * k;
    visit.sessions.push_back(one);
  }
  visit.sessions[1].parts = 2, visit.sessions[2].linked = false;
  const std::string text = summary_text(network);
  EXPECT_NE(text.find("on site    3 sessions of at most 8 h: 2 days with 2 crews; the longest takes 7 h 40 min, all "
                      "together 21 h 30 min\n"),
            std::string::npos)
      << text;
  EXPECT_NE(text.find("the session of day 1, crew 2 (S3 to S4) has its scans in 2 groups"), std::string::npos) << text;
  EXPECT_NE(text.find("the session of day 2, crew 1 (S5 to S6) is linked to no other session"), std::string::npos);
  visit.sessions.resize(1);
  EXPECT_NE(summary_text(network).find("1 session of at most 8 h: 1 day; it takes 6 h 40 min\n"), std::string::npos);
}

TEST(Summary, SaysInWordsWhatItKnowsAndNothingElse) {
  Evaluation network{.stations = std::vector<PlacedStation>(7), .exact = true, .values = {{"coverage", {0.7125, 0}}}};
  EXPECT_EQ(summary_text(network), "captured   71.2 % of the site\n");
  network = seven_stations();
  network.exact = false;
  network.values["coverage"].standard_error = 0.004;
  network.values["capture"] = {0.92, 0.01};
  network.values["registration"] = {1.234, 0};
  network.visit.emplace().minutes = 3 * 60 + 25 + 20 / 60.0;
  EXPECT_EQ(
      summary_text(network),
      "captured   92.0 % ± 1.0 % of what is attainable; 71.2 % ± 0.4 % of the site\n"
      "linked     no: in 3 parts, by overlap of at least 0.01: S1, S2 and S3; S4 and S5; S6 stands alone\n"
      "registered to about 1.2 mm, as predicted; LOA30 (15 mm at 95 %) is met with 12.6 mm to spare\n"
      "on site    about 3 h 25 min\n"
      "to do      link S4 to S3, the nearest to it with 0.004: put a station on the way between "
      "them, in a doorway if there is one, or move them closer\n"
      "           S6 shares nothing with any station of another part: put a station on the way to S1, in a doorway "
      "if there is one, or tie it in "
      "with targets\n"
      "           S7 " +
          explain(StationStatus::hole) + ", and is left out: move it\n");
  network.stations[6] = {.uv = {}, .position = {10, 20, 1.85}, .status = StationStatus::clash};
  const auto advice = [&] { return summary_lines(network).back().text; };
  const std::string clash = "S7 " + explain(StationStatus::clash) + ", and is left out: ";
  network.moves = {{.station = 6, .to = PlacedStation{.uv = {}, .position = {10.3, 20.3, 1.85}}}};
  EXPECT_EQ(advice(), clash + "move it 0.42 m to the north-east, to 10.300,20.300,1.850");
  network.moves[0].to->position = {10, 18, 0.6};
  EXPECT_EQ(advice(), clash + "move it 2.00 m to the south and 1.25 m down, to 10.000,18.000,0.600");
  network.moves[0].to->position = {10, 20, 2};
  EXPECT_EQ(advice(), clash + "move it 0.15 m up, to 10.000,20.000,2.000");
  network.moves[0].to.reset();
  EXPECT_EQ(advice(), clash + "no place within 5 m is free");
  Evaluation pair{.stations = std::vector<PlacedStation>(2), .exact = true, .values = {{"coverage", {1, 0}}}};
  pair.stations[0].existing = true;
  pair.overlap_matrix = OverlapMatrix(2);
  pair.overlap_matrix.set(0, 1, 0.3);
  EXPECT_EQ(summary_text(pair),
            "captured   100.0 % of the site\n"
            "linked     yes: all 2 stations, by overlap of at least 0.01; weakest link K1–S1 with 0.300\n");
  pair.scan_overlap_matrix = ScanOverlapMatrix(2);
  pair.scan_overlap_matrix.set(0, 1, 0.5);
  EXPECT_EQ(summary_lines(pair)[1].text,
            "yes: all 2 stations, by scan overlap of at least 0.3; weakest link K1–S1 with 0.500");
  pair.stations.resize(1), pair.scan_overlap_matrix = {}, pair.overlap_matrix = OverlapMatrix(1);
  EXPECT_EQ(summary_lines(pair)[1].text, "one station, nothing to link");
}

TEST(Summary, TellsWhichStationsOfPartsAreNearest) {
  Evaluation network{.stations = std::vector<PlacedStation>(6), .exact = true, .values = {{"coverage", {1, 0}}}};
  network.overlap_matrix = OverlapMatrix(6);
  for (std::size_t storey = 0; storey < 3; ++storey) {
    const double z = 4 * static_cast<double>(storey);
    network.stations[2 * storey].position = {0, 0, z}, network.stations[2 * storey + 1].position = {9, 0, z};
    network.overlap_matrix.set(2 * storey, 2 * storey + 1, 0.5);
  }
  const auto told = [&] {
    std::vector<std::string> sentences;
    for (const SummaryLine& line : summary_lines(network))
      if (line.heading == "to do") sentences.push_back(line.text);
    return sentences;
  };
  ASSERT_EQ(told().size(), 2u);
  EXPECT_TRUE(told()[0].starts_with("S3 shares nothing") && told()[0].find("way to S1,") != std::string::npos);
  EXPECT_TRUE(told()[1].starts_with("S5 shares nothing") && told()[1].find("way to S3,") != std::string::npos);
  network.overlap_matrix.set(2, 5, 0.002);
  ASSERT_EQ(told().size(), 1u) << "the pair is the best one of both";
  EXPECT_TRUE(told()[0].starts_with("link S3 to S6")) << told()[0];
}

TEST(Summary, OfManyPartsCanBeRead) {
  Evaluation network{.stations = std::vector<PlacedStation>(400), .exact = true, .values = {{"coverage", {1, 0}}}};
  network.overlap_matrix = OverlapMatrix(400);
  for (std::size_t k = 0; k < 99; ++k) network.overlap_matrix.set(k, k + 1, 0.5);        // a part of a hundred
  for (std::size_t k = 100; k < 200; k += 2) network.overlap_matrix.set(k, k + 1, 0.5);  // fifty pairs
  const std::string text = summary_lines(network)[1].text;
  EXPECT_LT(text.size(), 600u);
  EXPECT_EQ(text.find("no: in 251 parts, "), 0u) << text;
  for (const char* told :
       {"S29 and 71 more; S101 and S102; ", "; 45 more of several stations; ", "and 171 more stand alone"})
    EXPECT_NE(text.find(told), std::string::npos) << told << " in: " << text;
}

TEST(Summary, TheTableHasGroundAndHeadToTheMillimetre) {
  std::vector<PlacedStation> stations(3);
  stations[0].position = {500'000.12345, 2.5, 1.85}, stations[0].ground = {500'000.12345, 2.5, -0.0001};
  stations[0].existing = true;
  stations[1].status = StationStatus::hole;
  stations[2].position = {-1, 20.0004, 3.1}, stations[2].ground = {-1, 20.0004, 1.25};
  const std::vector<std::uint64_t> points{12, 0, 345};
  EXPECT_EQ(station_table(stations, station_names(stations), points),
            "station    ground x       y      z  head z  status        points on surveyed meshes\n"
            "K1       500000.123   2.500  0.000   1.850  ok, existing                         12\n"
            "S1                                          hole                                  0\n"
            "S2           -1.000  20.000  1.250   3.100  ok                                  345\n");
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
  const PlanResult result = test::sample_result("coverage-overlap-fix", 3, 3, 1);
  const std::vector<Requirement> requirements{make_requirement("coverage>=0.99"), make_requirement("coverage>=0.2")};
  PlanEntry entry = result.front[0];
  entry.stations[1].status = StationStatus::clash;
  entry.overlap_matrix.set(0, 2, 0.2);
  ASSERT_TRUE(entry.links());
  EXPECT_EQ(entry.links()->parts, (std::vector<std::vector<std::size_t>>{{0, 2}})) << "the clash is no part";
  const std::vector<SummaryLine> lines = summary_lines(entry, requirements);
  ASSERT_EQ(lines.size(), 4u);
  EXPECT_EQ(lines[0].text, "94.8 % of the site");
  EXPECT_TRUE(lines[2].text.starts_with("S2 clashes")) << lines[2].text;
  EXPECT_TRUE(lines[3].text.starts_with("not met: share captured of the site at least 99 %, it has 94.8 %; allow"))
      << lines[3].text;
  EXPECT_EQ(summary_lines(entry).size(), 3u) << "nothing is required";
}

// A plan of so many stations that capture a share, by an error.
PlanResult fewest_result(std::size_t stations, Estimate captured, double asked) {
  PlanResult result;
  result.problem = fewest_stations(asked);
  std::erase_if(result.problem.requirements, [](const Requirement& r) { return r.objective.name != "capture"; });
  PlanEntry entry;
  entry.exact = true;
  entry.stations.resize(stations);
  entry.values = {{"coverage", {0.7, 0}}, {"capture", captured}, {"registration", {1, 0}}};
  entry.violation = violation_of(entry, result.problem.requirements);
  result.front.push_back(entry);
  return result;
}

TEST(Summary, BeginsWithWhatEndedAPlanAndWhatTheNextStationAdds) {
  PlanResult result = fewest_result(16, {0.862, 0}, 0.86);
  result.pays = {.least_m2 = 25, .stations = 15, .capture = 0.86, .next_m2 = 21};
  result.further = {.m2 = 22.3, .minutes = 3.7};
  EXPECT_EQ(summary_lines(result).front().heading, "planned");
  EXPECT_EQ(planned_text(result),
            "16 stations capture 86.2 % of what is attainable; a further one would add some 22 m² in 4 min, and has to "
            "add 25 m²");
  result.problem.pays_m2 = 20, result.problem.pays_share = 0.1;
  EXPECT_TRUE(planned_text(result).ends_with(", and has to add 25 m², 0.6 % of what all of these capture"));
  result.further = {.m2 = 27, .minutes = 3.7};
  EXPECT_TRUE(planned_text(result).ends_with("; a further one would add some 27 m² in 4 min"));
  result.further = {.m2 = 24.6, .minutes = 3.7};
  EXPECT_NE(planned_text(result).find("; a further one would add just under 25 m² in 4 min, and has to add 25 m²"),
            std::string::npos);
  result.further = {.m2 = 0, .minutes = 3.7};
  EXPECT_TRUE(planned_text(result).ends_with("; a further one would add nothing"));
  result.problem.stations_max = 16, result.pays->capture = 0.95;
  EXPECT_TRUE(planned_text(result).starts_with(
      "16 stations capture 86.2 % of what is attainable, with as many stations as are allowed;"));
  result.problem.stations_max = 20;
  EXPECT_TRUE(
      planned_text(result).starts_with("16 stations capture 86.2 % of what is attainable, as far as links reach;"));
  result.pays->capture = 0.863, result.front.front().values["capture"].standard_error = 0.002;
  EXPECT_TRUE(planned_text(result).starts_with("16 stations capture 86.2 % of what is attainable; a further"))
      << "it has it";
}

// Nobody asked for that share, so no line mentions a requested one.
TEST(Summary, SaysWhatLinksLeaveOutOfWhatPays) {
  PlanResult result = fewest_result(21, {0.86, 0.002}, 0.96);
  result.pays = {.least_m2 = 25, .stations = 19, .capture = 0.96};
  const std::string all = summary_text(result) + unmet_text(result);
  EXPECT_NE(all.find("not met: what pays is 96.0 % of what is attainable, and stations with such links capture 86.0 %; "
                     "allow weaker links"),
            std::string::npos)
      << all;
  EXPECT_NE(all.find("what pays is 96.0 % of what is attainable; the best network has 86.0 %"), std::string::npos)
      << all;
  EXPECT_EQ(all.find("asked for"), std::string::npos) << all;
  EXPECT_EQ(all.find("at least"), std::string::npos) << all;
}

TEST(Summary, OfAPlanForAShareSaysWhetherItIsMet) {
  const auto text = [](double captured, double error) {
    return planned_text(fewest_result(9, {captured, error}, 0.9));
  };
  EXPECT_EQ(text(0.913, 0.002), "9 stations capture 91.3 % of what is attainable, and 90 % were asked for");
  EXPECT_EQ(text(0.89998, 0.002),
            "9 stations capture 90.0 % of what is attainable, which meets 90 % within the error of 0.2 %");
  EXPECT_EQ(text(0.89998, 0), "9 stations capture 90.0 % of what is attainable, which meets 90 % within the error");
  EXPECT_EQ(text(0.85, 0.002), "9 stations capture 85.0 % of what is attainable, but 90 % were asked for");
  for (const double captured : {0.913, 0.8985, 0.85}) {
    const PlanResult result = fewest_result(9, {captured, 0.002}, 0.9);
    const std::string all = summary_text(result) + unmet_text(result);
    EXPECT_EQ(met(result), all.find("not met") == std::string::npos) << all;
    EXPECT_EQ(met(result), captured > 0.89) << all;
  }
}

}  // namespace
}  // namespace vantage
