// SPDX-License-Identifier: Apache-2.0
// Mistakes that users make: each gets one clear line and a stated exit code, and leaves nothing behind.
#include <sstream>

#include "program.hpp"

namespace vantage::test {
namespace {

class Usage : public ProgramTest {};

TEST_F(Usage, HelpAndVersionSucceed) {
  for (const std::vector<std::string>& arguments : {std::vector<std::string>{"--help"},
                                                    {"info", "--help"},
                                                    {"generate", "--help"},
                                                    {"scan", "--help"},
                                                    {"panorama", "--help"},
                                                    {"evaluate", "--help"},
                                                    {"plan", "--help"},
                                                    {"--version"}}) {
    const Outcome outcome = run_program(arguments);
    EXPECT_EQ(outcome.exit_code, 0) << arguments[0];
    EXPECT_NE(outcome.out, "") << arguments[0];
    EXPECT_EQ(outcome.err, "") << arguments[0];
  }
}

// The help of a command begins with its purpose, examples and own options; special cases have a list of their own.
TEST_F(Usage, HelpBeginsWithWhatAUserLooksFor) {
  const std::string help = run_program({"plan", "--help"}).out, all = run_program({"plan", "--help-all"}).out;
  const auto at = [](const std::string& text, const std::string& what) { return text.find(what); };
  EXPECT_EQ(at(help, "Find where to stand"), 0u);
  EXPECT_LT(at(help, "vantage plan site.ifc --scanner"), at(help, "--capture SHARE"));
  EXPECT_LT(at(help, "--capture SHARE"), at(help, "--surveyed PATTERN"));
  EXPECT_EQ(at(help, "--registration-rho"), std::string::npos);
  EXPECT_NE(at(help, "vantage plan --help-all"), std::string::npos);
  EXPECT_NE(at(all, "--registration-rho"), std::string::npos);
  EXPECT_EQ(at(all, "vantage plan --help-all"), std::string::npos);
  std::istringstream lines(help);
  for (std::string line; std::getline(lines, line);)
    if (!line.starts_with("  vantage")) {
      EXPECT_LE(line.size(), 120u) << line;
    }
  EXPECT_EQ(run_program({"evaluate", scene_, "--station", "8,0,1.5", "--user-size", "0.5", "--json"}).exit_code, 0);
}

TEST_F(Usage, EveryCommandShowsAnExample) {
  for (const std::string command :
       {"plan", "evaluate", "scan", "panorama", "next", "bound", "info", "import", "generate", "edit"}) {
    const std::string help = run_program({command, "--help"}).out;
    if (help.find("not in this build") != std::string::npos) continue;
    EXPECT_NE(help.find("\nExamples:\n  vantage " + command + " "), std::string::npos) << help;
  }
}

TEST_F(Usage, CommandsAndOptionsMustExist) {
  expect_refused(run_program({}), 2, "no command given");
  expect_refused(run_program({"survey"}), 2, "survey");
  expect_refused(run_program({"evaluate", scene_, "--frobnicate"}), 2, "--frobnicate");
  expect_refused(run_program({"evaluate", scene_, "--height"}), 2, "--height");
  expect_refused(run_program({"evaluate"}), 2, "which scene?");
  expect_refused(run_program({"generate", "four-walls"}), 2, "-o");
  expect_refused(run_program({"generate", "five-walls", "-o", path("x.glb")}), 2, "five-walls");
}

TEST_F(Usage, MistypedNamesGetASuggestion) {
  expect_refused(run_program({"paln", scene_, "--stations", "4"}), 2,
                 "there is no command paln; did you mean plan? See vantage --help");
  expect_refused(run_program(coarse("plan", {"--statoins", "4", "-o", path("plan")})), 2,
                 "there is no option --statoins; did you mean --stations?");
  expect_refused(run_program(coarse("plan", {"--min_overlp=0.3"})), 2, "did you mean --min-overlap?");
  expect_refused(run_program({"evaluate", scene_, "second.glb"}), 2, "several files are one site if they are IFC");
  expect_refused(run_program(coarse("plan", {"--problem", "coverge-fix", "--stations", "4", "-o", path("plan")})), 2,
                 "did you mean coverage-fix?");
  expect_refused(run_program(coarse("plan", {"--objectives", "coverage,overlop", "--stations", "4", "-o", path("p")})),
                 2, "did you mean overlap?");
  expect_refused(run_program({"evaluate", scene_, "--engine", "embre"}), 2, "did you mean embree?");
  expect_refused(run_program({"evaluate", scene_, "--station", "8,0,1.5", "--scanner", "rtc36"}), 2,
                 "did you mean rtc360?");
  expect_refused(run_program({"generate", "four_wals", "-o", path("x.glb")}), 2, "did you mean four-walls?");
  write("config.json", R"({"user-sise": 0.2})");
  expect_refused(run_program({"evaluate", scene_, "--station", "8,0,1.5", "--config", path("config.json")}), 2,
                 "there is no option 'user-sise'; did you mean --user-size?");
}

TEST_F(Usage, TwoNumbersThatMayBeTwoThingsAreAskedFor) {
  expect_refused(run_program(coarse("evaluate", {"--station", "5,3.6"})), 2, "give x=5,y=3.6;");
  expect_refused(run_program(coarse("evaluate", {"--station", "5,3.6"})), 2, "give u=5,v=3.6");
  expect_refused(run_program(coarse("evaluate", {"--station", "x=500,y=0"})), 2, "no ground to stand on");
  const auto there = json_of(coarse("evaluate", {"--station", "x=8,y=0"}));
  EXPECT_EQ(there["stations"][0]["status"], "ok");
  EXPECT_NEAR(there["stations"][0]["position"][0].get<double>(), 8, 1e-9);
  EXPECT_NEAR(there["stations"][0]["position"][1].get<double>(), 0, 1e-9);
  expect_refused(run_program(coarse("evaluate", {"--stations", path("front.json"), "--entry", "0"})), 2,
                 "counted from 1");
}

TEST_F(Usage, OutputsThatAFormatCannotHoldAreRefused) {
  const std::vector<std::string> station{"--station", "8,0,1.5"};
  const auto refused = [&](const char* command, std::vector<std::string> more, const std::string& words) {
    more.insert(more.end(), station.begin(), station.end());
    expect_refused(run_program(coarse(command, more)), 2, words);
  };
  refused("evaluate", {"--cartography", path("c.las")}, "--cartography");
  refused("evaluate", {"--picture", path("p.pdf")}, "must end with .png .svg");
  refused("evaluate", {"--write-stations", path("s.shp")}, "must end with .dxf .geojson .kml");
  refused("evaluate", {"--write-stations", path("s.kml")}, "need the coordinate system of the site");
  refused("scan", {"-o", path("c.e57"), "--outputs", "ids"}, "but no range, ids");
  refused("scan", {"-o", path("c.las"), "--outputs", "range,colour"}, "but no range");
  refused("scan", {"-o", path("c.las"), "--crs", "EPSG:4326"}, "EPSG:4326");
  EXPECT_EQ(files(), std::vector<std::string>{});
}

TEST_F(Usage, NumbersMustMakeSense) {
  const std::vector<std::pair<std::string, std::string>> cases{
      {"--height", "nan"},        {"--height", "-1"},     {"--height", "tall"},  {"--step", "0"},
      {"--step", "0.1,0.1,0.1"},  {"--range", "5"},       {"--range", "10,5"},   {"--user-size", "inf"},
      {"--user-size", "0"},       {"--spacing", "-0.01"}, {"--security", "1,2"}, {"--security", "1,2,nan"},
      {"--horizontal", "0"},      {"--vertical", "400"},  {"--seed", "-3"},      {"--seed", "1.5"},
      {"--engine", "cuda"},       {"--diffuse", "2"},     {"--station", "1"},    {"--station", "1,2,x"},
      {"--scanner", "nokia3310"}, {"--noise", "loud"},    {"--sample", "0"},     {"--error", "0"},
      {"--device", "99"},         {"--device", "0,0"},    {"--device", "0,gpu"}, {"--device", "all,1"},
      {"--weight", "wall"},       {"--weight", "*=0"},    {"--weight", "*=256"}, {"--detail", "wall"},
      {"--detail", "*=0"},        {"--accuracy", "*=x"},  {"--incidence", "0"},  {"--incidence", "91"},
      {"--beam", "0.5"}};
  for (const auto& [option, value] : cases) {
    SCOPED_TRACE(option + " " + value);
    auto arguments = coarse("evaluate", {});
    const auto same = std::find(arguments.begin(), arguments.end(), option);
    if (same != arguments.end()) arguments.erase(same, same + 2);
    if (option != "--station") arguments.insert(arguments.end(), {"--station", "8,0,1.5"});
    arguments.insert(arguments.end(), {option, value});
    const Outcome outcome = run_program(arguments);
    EXPECT_TRUE(outcome.exit_code == 2 || outcome.exit_code == 1) << outcome.err;
    // The offending number itself is named, not only the list that it stands in.
    expect_refused(outcome, outcome.exit_code, value.substr(value.find_last_of(",=") + 1));
  }
  EXPECT_EQ(files(), std::vector<std::string>{});
}

TEST_F(Usage, SeveralDevicesShareTheWork) {
  const auto on = [&](const std::string& devices) {
    return run_program({"evaluate", scene_, "--station", "8,0,1.5", "--station", "0,-8,1.5", "--step", "1",
                        "--user-size", "0.5", "--spacing", "0.1", "--engine", "compute_bvh", "--device", devices,
                        "--json"});
  };
  for (const std::string devices : {"cpu", "0,cpu", "all", "all,cpu"}) {
    SCOPED_TRACE(devices);
    const Outcome outcome = on(devices);
    ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
    const auto json = nlohmann::json::parse(outcome.out);
    EXPECT_EQ(json["device"].get<std::string>().find("threads)") != std::string::npos, devices.ends_with("cpu"));
    EXPECT_EQ(json["engine"], devices == "cpu" ? "embree" : "compute_bvh");
    EXPECT_GT(json["coverage"].get<double>(), 0);
  }
}

TEST_F(Usage, WeightsNameWhatTheFileHas) {
  expect_refused(run_program({"evaluate", scene_, "--station", "8,0,1.5", "--weight", "roof=2"}), 2,
                 "\"roof\" matches no node");
}

TEST_F(Usage, LimitsOfPointsNeedAScannerThatIsKnown) {
  const std::vector<std::string> base{"evaluate", scene_, "--station", "8,0,1.5", "--engine", "embree"};
  const auto with = [&](const std::vector<std::string>& more) {
    auto all = base;
    all.insert(all.end(), more.begin(), more.end());
    return run_program(all);
  };
  expect_refused(with({"--noise", "off", "--detail", "*=10"}), 2, "the beam of the scanner");
  expect_refused(with({"--noise", "off", "--accuracy", "*=1"}), 2, "no noise table");
}

TEST_F(Usage, VoxelsSmallerThanTheSpacingNameTheSmallestSize) {
  expect_refused(run_program({"evaluate", scene_, "--station", "8,0,1.5", "--user-size", "0.01", "--spacing", "0.05",
                              "--engine", "embree"}),
                 2, "user size");
}

TEST_F(Usage, NumbersOfStations) {
  expect_refused(run_program(coarse("evaluate", {})), 2, "no station given");
  std::vector<std::string> many;
  for (int k = 0; k < 1025; ++k) many.insert(many.end(), {"--station", "8,0,1.5"});
  expect_refused(run_program(coarse("evaluate", many)), 2, "1025 stations");
  for (const char* stations : {"0", "1025", "8..4", "0..4", "4..1025", "four", "4..", "-4"})
    expect_refused(run_program(coarse("plan", {"--stations", stations, "-o", path("plan")})), 2, "--stations");
  expect_refused(run_program(coarse("plan", {"--problem", "coverage-fix", "-o", path("plan")})), 2, "--stations");
  expect_refused(run_program(coarse("plan", {"--problem", "coverage-min", "--stations", "4", "-o", path("plan")})), 2,
                 "range");
  expect_refused(run_program(coarse("plan", {"--problem", "coverage-fix", "--stations", "4..6", "-o", path("plan")})),
                 2, "one number");
  expect_refused(run_program(coarse("plan", {"--problem", "best", "--stations", "4", "-o", path("plan")})), 2, "best");
  EXPECT_EQ(files(), std::vector<std::string>{});
}

TEST_F(Usage, FilesMustBeReadable) {
  expect_refused(run_program({"evaluate", path("no_such.glb"), "--station", "8,0,1.5"}), 1, "no_such.glb");
  expect_refused(run_program(coarse("evaluate", {"--stations", path("no_such.csv")})), 1, "no_such.csv");
  expect_refused(run_program(coarse("evaluate", {"--stations", path("no_such.json")})), 1, "no_such.json");
  expect_refused(run_program(coarse("evaluate", {"--station", "8,0,1.5", "--config", path("no_such.json")})), 1,
                 "no_such.json");
  write("text.glb", "this is no model");
  expect_refused(run_program({"evaluate", path("text.glb"), "--station", "8,0,1.5"}), 1, "text.glb");
  write("list.json", "[1, 2]");
  expect_refused(run_program(coarse("evaluate", {"--station", "8,0,1.5", "--config", path("list.json")})), 1,
                 "list.json");
  write("broken.json", "{\"step\": ");
  expect_refused(run_program(coarse("evaluate", {"--station", "8,0,1.5", "--config", path("broken.json")})), 1,
                 "broken.json");
  write("heads.csv", "x,y,z\n1,2,here\n");
  expect_refused(run_program(coarse("evaluate", {"--stations", path("heads.csv")})), 1, "heads.csv");
}

TEST_F(Usage, ResultsMustBeWritable) {
  expect_refused(run_program({"generate", "four-walls", "-o", path("no/such/folder/x.glb")}), 1, "no/such/folder");
  expect_refused(run_program(coarse("scan", {"--station", "8,0,1.5", "-o", path("no/such/folder/x.ply")})), 1,
                 "no/such/folder");
  expect_refused(run_program(coarse("scan", {"--station", "8,0,1.5", "-o", path("x.doc")})), 2, "x.doc");
  expect_refused(run_program(coarse("plan", {"--stations", "2", "-o", scene_ + "/plan"})), 1, "four_walls.glb/plan");
  EXPECT_EQ(files(), std::vector<std::string>{});
}

TEST_F(Usage, RolesMustMatchSomething) {
  expect_refused(run_program(coarse("evaluate", {"--surveyed", "tower*", "--station", "8,0,1.5"})), 2, "tower*");
}

}  // namespace
}  // namespace vantage::test
