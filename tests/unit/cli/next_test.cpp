// SPDX-License-Identifier: Apache-2.0
// The next stations, based on scans that were taken.
#include <filesystem>

#include "program.hpp"

namespace vantage::test {
namespace {

class Next : public ProgramTest {
 protected:
  // A scan of one station, and a plan of that one and two more.
  void take_one() {
    const Outcome scanned = run_program(coarse("scan", {"--station", "8,0,1.5", "-o", path("day.e57")}));
    ASSERT_EQ(scanned.exit_code, 0) << scanned.err;
    write("plan.csv", "name,x,y,z\nA,8,0,1.5\nB,0,-8,1.5\nC,0,8,1.5\n");
  }
  std::vector<std::string> next(const std::vector<std::string>& more) const {
    std::vector<std::string> all{"--scans", path("day.e57"), "--link", "0", "-o", path("next")};
    all.insert(all.end(), more.begin(), more.end());
    return coarse("next", all);
  }
};

TEST_F(Next, TellsWhatIsThereAndWhatComesNext) {
  take_one();
  const auto json = json_of(next({"--stations", path("plan.csv"), "--capture", "0.8"}));
  EXPECT_EQ(json["taken"].size(), 1u);
  EXPECT_EQ(json["taken"][0]["name"], "A");
  EXPECT_EQ(json["taken"][0]["fitted"], true);
  EXPECT_LT(json["taken"][0]["shift"].get<double>(), 0.005);
  EXPECT_TRUE(json["not_in_model"].empty());
  EXPECT_TRUE(json["seen_through"].empty());
  const double captured = json["captured"];
  EXPECT_GT(captured, 0.05);
  EXPECT_LT(captured, 0.8);
  EXPECT_EQ(json["enough"], true);
  EXPECT_GE(json["captured_then"].get<double>(), 0.8);
  ASSERT_EQ(json["planned"].size(), 3u);
  EXPECT_EQ(json["planned"][0]["taken"], "A");
  EXPECT_GT(json["planned"][1]["adds"].get<double>(), 0);
  EXPECT_FALSE(json["next"].empty());
  EXPECT_GT(json["minutes_on_site"].get<double>(), 0);
  EXPECT_EQ(nlohmann::json::parse(read("next/next.json")), json);
  EXPECT_TRUE(read("next/stations.csv").starts_with("station,name,"));
  EXPECT_TRUE(read("next/plan.png").starts_with("\x89PNG"));
  EXPECT_FALSE(read("next/stations.dxf").empty());
}

TEST_F(Next, SpeaksInWords) {
  take_one();
  const Outcome told = run_program(next({"--stations", path("plan.csv"), "--capture", "0.8"}));
  EXPECT_EQ(told.exit_code, 0) << told.err;
  for (const char* words : {"taken      A at 8.00,0.00,1.50: ", "captured   ", "of what is attainable", "A is taken\n",
                            "next       1. ", "on site    about ", "results in "})
    EXPECT_NE(told.out.find(words), std::string::npos) << words << " is not in\n" << told.out;
}

// A room of 6 x 4 x 2.5 m, Y up, with a screen from its south wall that leaves 1.2 m at its end.
constexpr const char* kScreenedRoom =
    "v 0 0 0\nv 6 0 0\nv 6 0 -4\nv 0 0 -4\nv 0 2.5 0\nv 6 2.5 0\nv 6 2.5 -4\nv 0 2.5 -4\n"
    "v 3 0 0\nv 3.2 0 0\nv 3.2 0 -2.8\nv 3 0 -2.8\nv 3 2.5 0\nv 3.2 2.5 0\nv 3.2 2.5 -2.8\nv 3 2.5 -2.8\n"
    "o floor\nf 1 2 3 4\no ceiling\nf 5 8 7 6\no walls\nf 1 5 6 2\nf 2 6 7 3\nf 3 7 8 4\nf 4 8 5 1\n"
    "o screen\nf 9 10 14 13\nf 10 11 15 14\nf 11 12 16 15\nf 12 9 13 16\n";

TEST_F(Next, WithoutAModelTheScansAreTheSite) {
  write("room.obj", kScreenedRoom);
  std::filesystem::create_directory(path("day"));
  const Outcome scanned = run_program({"scan", path("room.obj"), "--unit", "m", "--up", "y", "--station", "1.5,1.5,1.6",
                                       "--step", "0.4", "--engine", "embree", "-o", path("day/one.e57")});
  ASSERT_EQ(scanned.exit_code, 0) << scanned.err;
  const auto json = json_of({"next", "--scans", path("day"), "--engine", "embree", "--step", "0.8", "--user-size",
                             "0.3", "--link", "0", "-o", path("next")});
  EXPECT_EQ(json["options"]["unknown"], true);
  EXPECT_EQ(json["taken"][0]["fitted"], false);
  EXPECT_TRUE(json["not_in_model"].empty());
  EXPECT_GT(json["unknown"].get<double>(), 0.1);
  EXPECT_NEAR(json["captured"].get<double>() + json["not_seen"].get<double>() + json["unknown"].get<double>(), 1, 1e-6);
  // One station looks behind the screen, past its end.
  ASSERT_EQ(json["next"].size(), 1u);
  EXPECT_GT(json["next"][0]["position"][1].get<double>(), 2.2);
  EXPECT_GT(json["captured_then"].get<double>(), 0.95);
}

TEST_F(Next, ExitsWithThreeWhereItIsNotEnough) {
  take_one();
  const Outcome told = run_program(next({"--capture", "1", "--most", "1"}));
  EXPECT_EQ(told.exit_code, 3) << told.out << told.err;
  EXPECT_NE(told.out.find("to do      no 1 further station"), std::string::npos) << told.out;
}

TEST_F(Next, NeedsScans) {
  expect_refused(run_program(coarse("next", {})), 2, "--scans FILE_OR_DIR");
  expect_refused(run_program(coarse("next", {"--scans", path("none.e57")})), 1, "none.e57");
  std::filesystem::create_directory(path("empty"));
  expect_refused(run_program(coarse("next", {"--scans", path("empty")})), 1, "has no scan");
  expect_refused(run_program(coarse("next", {"--scans", scene_})), 1, "E57 and PTX");
}

}  // namespace
}  // namespace vantage::test
