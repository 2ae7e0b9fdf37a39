// SPDX-License-Identifier: Apache-2.0
// Bounds on coverage, and reasons for missed surface.
#include <sstream>

#include "program.hpp"
#include "support/glb_builder.hpp"

namespace vantage::test {
namespace {

class Bound : public ProgramTest {};

TEST_F(Bound, HoldsForWhatItFinds) {
  const auto json =
      json_of(coarse("bound", {"--stations", "2,4", "--capture", "0.5", "--candidates", "32", "--sample", "300"}));
  ASSERT_EQ(json["stations"].size(), 2u);
  EXPECT_EQ(json["candidates"], 32);
  double before = 0;
  for (const auto& one : json["stations"]) {
    EXPECT_GE(one["bound"].get<double>(), one["reached"].get<double>() - 1e-9);
    EXPECT_GE(one["bound"].get<double>(), one["relaxation"].get<double>() - 1e-9);
    EXPECT_GT(one["reached"].get<double>(), before);
    EXPECT_EQ(one["chosen"].size(), one["stations"].get<std::size_t>());
    before = one["reached"].get<double>();
  }
  const auto& half = json["captures"][0];
  EXPECT_EQ(half["possible"], true);
  EXPECT_LE(half["at_least"].get<std::size_t>(), half["enough"].size());
}

TEST_F(Bound, KeepsNetworksTogetherWhereAsked) {
  const std::vector<std::string> asked{"--stations", "3", "--candidates", "24", "--sample", "200", "--branch", "20s"};
  auto linked = asked;
  linked.insert(linked.end(), {"--link", "0.3"});
  const auto any = json_of(coarse("bound", asked))["stations"][0];
  const auto together = json_of(coarse("bound", linked))["stations"][0];
  EXPECT_EQ(together["chosen"].size(), 3u);
  EXPECT_LE(together["reached"].get<double>(), any["reached"].get<double>() + 1e-9);
  EXPECT_LE(together["reached"].get<double>(), together["bound"].get<double>() + 1e-9);
  expect_refused(run_program(coarse("bound", {"--stations", "3", "--link", "0"})), 2, "--link");
}

TEST_F(Bound, AsksForANumberOrACapture) {
  expect_refused(run_program(coarse("bound", {})), 2, "--stations N, --capture C");
  expect_refused(run_program(coarse("bound", {"--stations", "0"})), 2, "--stations");
  expect_refused(run_program(coarse("bound", {"--capture", "1.2"})), 2, "--capture");
}

TEST_F(Bound, EvaluateTellsWhatIsMissed) {
  const Outcome outcome =
      run_program(coarse("evaluate", {"--station", "8,0,1.5", "--missed", path("missed.csv"), "--missed",
                                      path("missed.ply"), "--missed", path("missed.png")}));
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_EQ(files(), (std::vector<std::string>{"missed.csv", "missed.ply", "missed.png"}));
  std::istringstream csv(read("missed.csv"));
  std::string header, all;
  std::getline(csv, header);
  std::getline(csv, all);
  EXPECT_EQ(header, "node,voxels,captured,hidden,out_of_range,too_flat,too_dark,too_sparse,not_chosen");
  ASSERT_TRUE(all.starts_with("(all),")) << all;
  std::istringstream fields(all.substr(6));
  std::string field;
  std::getline(fields, field, ',');  // voxels
  double sum = 0;
  while (std::getline(fields, field, ',')) sum += std::stod(field);
  EXPECT_NEAR(sum, 1, 1e-3);
  expect_refused(run_program(coarse("evaluate", {"--station", "8,0,1.5", "--missed", path("missed.txt")})), 2,
                 "missed.txt");
}

TEST_F(Bound, EvaluateTellsOfElements) {
  const Outcome outcome = run_program(coarse("evaluate", {"--station", "8,0,1.5", "--station", "-8,0,1.5",
                                                          "--registration", "--elements", path("elements.csv")}));
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  const std::string table = read("elements.csv");
  EXPECT_TRUE(
      table.starts_with("name,class,global_id,area_m2,voxels,captured,incidence,point_distance_mm,deviation_mm\n"))
      << table;
  EXPECT_EQ(std::ranges::count(table, '\n'), 5) << "a line for each wall: " << table;
  expect_refused(run_program(coarse("evaluate", {"--station", "8,0,1.5", "--elements", path("elements.txt")})), 2,
                 "must end with .csv");
  expect_refused(
      run_program(coarse("evaluate", {"--station", "8,0,1.5", "--sample", "100", "--elements", path("sampled.csv")})),
      2, "needs --exact");
}

TEST_F(Bound, EvaluateTellsOfRooms) {
  expect_refused(run_program(coarse("evaluate", {"--station", "8,0,1.5", "--rooms", path("rooms.csv")})), 2,
                 "names no rooms");
  GlbBuilder glb;
  const auto quad = [&](const char* name, const std::vector<float>& corners) {
    const int points = glb.positions(corners);
    const std::vector<std::uint32_t> order{0, 1, 2, 0, 2, 3};
    glb.node({{"name", name},
              {"mesh",
               glb.mesh({{"attributes", {{"POSITION", points}}}, {"indices", glb.accessor(order, 5125, "SCALAR")}})}});
  };
  quad("floor", {-5, 0, 5, 5, 0, 5, 5, 0, -5, -5, 0, -5});
  quad("wall", {-5, 0, -5, 5, 0, -5, 5, 3, -5, -5, 3, -5});
  const nlohmann::json box = {{-5, 0, -5}, {0, 3, 5}};
  glb.node({{"name", "room"}, {"extras", {{"vantage", {{"class", "IfcSpace"}, {"name", "7"}, {"box", box}}}}}});
  glb.write_glb(path("rooms.glb"));
  const Outcome outcome = run_program({"evaluate", path("rooms.glb"), "--engine", "embree", "--station", "-2,0,1.5",
                                       "--step", "2", "--user-size", "0.5", "--rooms", path("rooms.csv")});
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  const std::string table = read("rooms.csv");
  EXPECT_TRUE(table.starts_with("storey,room,floor_m2,ground_m2,stations,why_no_station,voxels,captured,")) << table;
  EXPECT_NE(table.find("\n,7,50.00,"), std::string::npos) << table;
  EXPECT_NE(table.find(",S1,,"), std::string::npos) << table;

  // Hours of the room: one of two stations is in it.
  const auto evaluate = [&](const std::string& window) {
    return run_program({"evaluate",    path("rooms.glb"),
                        "--engine",    "embree",
                        "--station",   "-2,0,1.5",
                        "--station",   "2,0,1.5",
                        "--step",      "2",
                        "--user-size", "0.5",
                        "--day",       "8h",
                        "--day-start", "06:00",
                        "--window",    window,
                        "--sessions",  path("sessions.csv")});
  };
  const Outcome kept = evaluate("7=07:30-08:00");
  EXPECT_EQ(kept.exit_code, 0) << kept.err;
  EXPECT_NE(kept.out.find("kept at all 1 station that access windows are for"), std::string::npos) << kept.out;
  const std::string sessions = read("sessions.csv");
  EXPECT_TRUE(
      sessions.starts_with("session,day,crew,order,station,name,walk_m,arrive_min,stay_min,leave_min,wait_min,"
                           "begin,end\n"))
      << sessions;
  EXPECT_NE(sessions.find(",07:30,"), std::string::npos) << sessions;
  EXPECT_EQ(kept.out.find("\nagain "), std::string::npos) << "one session";
  const auto in_days = [&](const std::string& other) {
    return run_program({"evaluate", path("rooms.glb"), "--engine", "embree", "--station", "-2,0,1.5", "--station",
                        other, "--step", "2", "--user-size", "0.5", "--day", "5min"})
        .out;
  };
  const std::string again = in_days("-4,0,1.5");
  EXPECT_NE(again.find("\nagain      1 room is entered by more than one session: 7 (day 1, crew 1; day 2, crew 1)\n"),
            std::string::npos)
      << again;
  EXPECT_EQ(in_days("2,0,1.5").find("\nagain "), std::string::npos) << "the other one is not in the room";
  const Outcome closed = evaluate("7=04:00-05:59");
  EXPECT_EQ(closed.exit_code, 3) << closed.err;
  EXPECT_NE(closed.out.find("S1 is in no session: it takes "), std::string::npos) << closed.out;
  expect_refused(evaluate("hall=07:30-08:00"), 2, "no room is named like 'hall'; there are 7");

  // A plan's answer is the same whatever the hours; a station that they leave out is told.
  for (const bool open : {true, false}) {
    const Outcome planned = run_program({"plan",         path("rooms.glb"),
                                         "--engine",     "embree",
                                         "--problem",    "coverage-fix",
                                         "--stations",   "6",
                                         "--population", "6",
                                         "--iterations", "2",
                                         "--sample",     "200",
                                         "--step",       "2",
                                         "--user-size",  "0.5",
                                         "--day",        "8h",
                                         "--day-start",  "06:00",
                                         "--window",     open ? "7=06:30-09:00" : "7=04:00-05:59",
                                         "--no-report",  "-o",
                                         path("plan"),   "--force"});
    EXPECT_EQ(planned.exit_code, open ? 0 : 3) << planned.err;
    const auto front = nlohmann::json::parse(read("plan/front.json"));
    const auto& entry = front["front"][front["answer"].get<std::size_t>() - 1];
    std::size_t in_room = 0;
    for (const auto& station : entry["stations"]) in_room += station["position"][0] < 0;
    EXPECT_GT(in_room, 0u);
    EXPECT_EQ(entry["on_site"]["closed"].size(), open ? 0 : in_room);
    EXPECT_EQ(front["met"], open);
    EXPECT_EQ(front["what_would_help"].empty(), open);
    EXPECT_EQ(front["parameters"]["plan"]["windows"].size(), 1u);
    const std::string config = read("plan/config.json");
    EXPECT_NE(config.find(open ? "7=06:30-09:00" : "7=04:00-05:59"), std::string::npos) << config;
  }
}

}  // namespace
}  // namespace vantage::test
