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
}

}  // namespace
}  // namespace vantage::test
