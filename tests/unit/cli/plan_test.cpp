// SPDX-License-Identifier: Apache-2.0
// A whole plan from the command line: its files, its reproducibility, and stops on request.
#include <signal.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <regex>
#include <set>
#include <thread>

#include "program.hpp"
#include "support/glb_builder.hpp"

namespace vantage::test {
namespace {

class Plan : public ProgramTest {
 protected:
  std::vector<std::string> plan(const std::string& folder, const std::vector<std::string>& more) const {
    auto all = coarse("plan", {"--population", "6", "--sample", "200", "-o", path(folder)});
    all.insert(all.end(), more.begin(), more.end());
    if (std::find(more.begin(), more.end(), "--iterations") == more.end()) all.insert(all.end(), {"--iterations", "3"});
    return all;
  }
  static void drop_times(nlohmann::json& object) {
    for (auto it = object.begin(); it != object.end();)
      if (it.key().find("seconds") != std::string::npos)
        it = object.erase(it);
      else {
        if (it->is_object()) drop_times(*it);
        ++it;
      }
  }
};

TEST_F(Plan, WritesEverythingAndPrintsTheFront) {
  const auto front = json_of(plan("plan", {"--problem", "coverage-overlap-fix", "--stations", "4"}));
  for (const char* key : {"problem", "objectives", "hypervolume", "evaluations", "stop_reason", "front", "seconds",
                          "engine", "device", "seed"})
    EXPECT_TRUE(front.contains(key)) << key;
  EXPECT_EQ(front["problem"], "coverage-overlap-fix");
  EXPECT_GE(front["evaluations"], 18);
  ASSERT_FALSE(front["front"].empty());
  for (const auto& entry : front["front"]) {
    EXPECT_EQ(entry["station_count"], 4);
    EXPECT_EQ(entry["stations"].size(), 4u);
    EXPECT_TRUE(entry["exact"].contains("coverage"));
    EXPECT_TRUE(entry["exact"].contains("overlap"));
  }
  EXPECT_EQ(nlohmann::json::parse(read("plan/front.json")), front);
  for (const char* name :
       {"front.csv", "front.json", "history.csv", "coverage.ply", "overlap.csv", "stations.csv", "front.png",
        "front.svg", "hypervolume.png", "hypervolume.svg", "plan.png", "plan.svg", "config.json"})
    EXPECT_GT(read(std::string("plan/") + name).size(), 0u) << name;
}

TEST_F(Plan, EvaluateGivesBackTheSameNumbers) {
  const auto front = json_of(plan("plan", {"--problem", "coverage-overlap-fix", "--stations", "4"}));
  for (std::size_t k = 0; k < front["front"].size(); ++k) {
    const auto again = json_of({"evaluate", scene_, "--engine", "embree", "--config", path("plan/config.json"),
                                "--stations", path("plan/front.json"), "--entry", std::to_string(k + 1)});
    EXPECT_EQ(front["front"][k]["entry"], k + 1);
    EXPECT_EQ(again["coverage"], front["front"][k]["exact"]["coverage"]) << k;
    EXPECT_EQ(again["overlap"], front["front"][k]["exact"]["overlap"]) << k;
  }
  const auto chosen = json_of(coarse("evaluate", {"--stations", path("plan/stations.csv")}));
  bool found = false;
  for (const auto& entry : front["front"]) found |= entry["exact"]["coverage"] == chosen["coverage"];
  EXPECT_TRUE(found);
}

// Earlier versions called existing stations "kept".
TEST_F(Plan, ReadsResultsOfEarlierVersions) {
  const auto front = json_of(plan("plan", {"--problem", "coverage-fix", "--stations", "2", "--keep", "8,0,1.5"}));
  const auto renamed = [&](const std::string& name) {
    const std::string text = read("plan/" + name);
    EXPECT_NE(text.find("existing"), std::string::npos) << name;
    write(name, std::regex_replace(text, std::regex("existing"), "kept"));
    return path(name);
  };
  for (const char* name : {"front.json", "stations.csv"}) {
    const auto again = json_of(coarse("evaluate", {"--stations", renamed(name)}));
    EXPECT_EQ(again["stations"].size(), 3u) << name;
    EXPECT_EQ(again["coverage"], front["front"][0]["exact"]["coverage"]) << name;
  }
}

TEST_F(Plan, ChoosesAStepForEachStation) {
  const std::vector<std::string> what{
      "--objectives", "time,coverage",         "--stations", "3",  "--search-step", "4,2,1",
      "--keep",       "x=8,y=0,z=1.5,tilt=90", "--rate",     "100"};
  const auto front = json_of(plan("plan", what));
  std::set<double> steps;
  for (const auto& entry : front["front"]) {
    double minutes = 0;
    for (std::size_t k = 0; k < 4; ++k) {
      const auto& station = entry["stations"][k];
      const double step = station["step"];
      EXPECT_EQ(station["existing"], k == 0);
      EXPECT_EQ(station["tilt"], k == 0 ? 90 : 0);
      if (k == 0) {
        EXPECT_NEAR(step, 1, 1e-12);
        continue;
      }
      steps.insert(std::round(step));
      if (station["status"] == "ok") minutes += std::round(360 / step) * std::floor(150 / step + 1e-9) / 100 / 60;
    }
    EXPECT_NEAR(entry["on_site"]["scan_min"].get<double>(), minutes, 0.01 * minutes) << "as its steps take";
  }
  EXPECT_GT(steps.size(), 1u);
  // Front and configuration say all of it.
  for (std::size_t k = 0; k < front["front"].size(); ++k) {
    const auto again = json_of({"evaluate", scene_, "--engine", "embree", "--config", path("plan/config.json"),
                                "--stations", path("plan/front.json"), "--entry", std::to_string(k + 1)});
    EXPECT_EQ(again["coverage"], front["front"][k]["exact"]["coverage"]);
    EXPECT_EQ(again["stations"][0]["tilt"], 90);
  }
  EXPECT_NE(read("plan/stations.csv").find(",heading,tilt,scanner,step"), std::string::npos);
  const auto same = json_of({"plan", scene_, "--engine", "embree", "--config", path("plan/config.json"), "--population",
                             "6", "--iterations", "3", "--sample", "200", "-o", path("again")});
  EXPECT_EQ(same["front"], front["front"]);
  expect_refused(run_program(plan("other", {"--stations", "2", "--search-step", "1,3mm"})), 2, "a scanner's preset");
}

TEST_F(Plan, SplitsARoundThatIsLongerThanADay) {
  const std::vector<std::string> what{"--problem", "coverage-fix", "--stations", "5"};
  const auto with = [&](std::vector<std::string> more) {
    more.insert(more.begin(), what.begin(), what.end());
    return more;
  };
  const auto front = json_of(plan("plan", with({"--day", "8min", "--crews", "2"})));
  const auto& on_site = front["front"][front["answer"].get<std::size_t>() - 1]["on_site"];
  ASSERT_TRUE(on_site.contains("sessions"));
  const auto& sessions = on_site["sessions"];
  ASSERT_GE(sessions.size(), 3u) << "two stations of three minutes fit eight at most";
  nlohmann::json order = nlohmann::json::array();
  for (std::size_t s = 0; s < sessions.size(); ++s) {
    EXPECT_EQ(sessions[s]["day"], s / 2 + 1);
    EXPECT_EQ(sessions[s]["crew"], s % 2 + 1);
    EXPECT_LE(sessions[s]["minutes"].get<double>(), 8);
    for (const auto& station : sessions[s]["order"]) order.push_back(station);
  }
  EXPECT_EQ(order, on_site["order"]);
  std::string told;
  for (const auto& line : front["summary"])
    if (line["heading"] == "on site") told = line["text"];
  EXPECT_TRUE(told.starts_with(std::to_string(sessions.size()) +
                               " sessions of at most 8 min: 2 days with 2 crews; the longest takes "))
      << told;
  const std::string table = read("plan/sessions.csv");
  EXPECT_TRUE(table.starts_with(
      "session,day,crew,order,station,name,walk_m,arrive_min,stay_min,leave_min,wait_min,begin,end\n1,1,1,1,"));
  EXPECT_EQ(std::ranges::count(table, '\n'), 6);
  EXPECT_EQ(front["parameters"]["plan"]["day"], "8min");

  // Evaluating the same stations gives the same results.
  const auto again =
      json_of({"evaluate", scene_, "--engine", "embree", "--config", path("plan/config.json"), "--stations",
               path("plan/front.json"), "--day", "8min", "--crews", "2", "--sessions", path("again.csv")});
  ASSERT_EQ(again["sessions"].size(), sessions.size());
  for (std::size_t s = 0; s < sessions.size(); ++s)  // links are by scan overlaps there, which this problem has not
    for (const char* key : {"day", "crew", "order", "minutes", "arrive_min"})
      EXPECT_EQ(again["sessions"][s][key], sessions[s][key]) << s << " " << key;
  EXPECT_EQ(read("again.csv"), table);
  EXPECT_FALSE(again.contains("batteries") || again["sessions"][0].contains("batteries")) << "not known";

  // Two scans a battery: one for a session of two, as the table says in its last column.
  const auto powered = json_of({"evaluate", scene_, "--engine", "embree", "--config", path("plan/config.json"),
                                "--stations", path("plan/front.json"), "--day", "8min", "--crews", "2", "--battery",
                                "0,2", "--sessions", path("powered.csv")});
  std::size_t taken = 0;
  for (const auto& session : powered["sessions"]) {
    EXPECT_EQ(session["batteries"][0]["batteries"], (session["order"].size() + 1) / 2);
    taken += session["batteries"][0]["batteries"].get<std::size_t>();
  }
  ASSERT_EQ(powered["batteries"].size(), 1u);
  EXPECT_EQ(powered["batteries"][0]["batteries"], taken);
  EXPECT_EQ(powered["batteries"][0]["battery_scans"], 2);
  EXPECT_FALSE(powered["batteries"][0].contains("battery_min"));
  EXPECT_EQ(powered["stations"], again["stations"]);
  EXPECT_NE(read("powered.csv").find(",begin,end,batteries\n1,1,1,1,"), std::string::npos);

  // Without a day there are no sessions, and no file of an earlier plan.
  const auto whole = json_of(plan("plan", with({"--force"})));
  EXPECT_FALSE(whole["front"][0]["on_site"].contains("sessions"));
  EXPECT_FALSE(whole["parameters"]["plan"].contains("day"));
  EXPECT_EQ(whole["front"][0]["stations"], front["front"][0]["stations"]) << "the search is the same";
  EXPECT_FALSE(std::filesystem::exists(path("plan/sessions.csv")));
}

TEST_F(Plan, RefusesDaysThatCannotBe) {
  const auto refused = [&](const std::vector<std::string>& more, const std::string& words) {
    std::vector<std::string> all{"--problem", "coverage-fix", "--stations", "2"};
    all.insert(all.end(), more.begin(), more.end());
    expect_refused(run_program(plan("plan", all)), 2, words);
    EXPECT_FALSE(std::filesystem::exists(path("plan/front.json")));
  };
  refused({"--crews", "2"}, "give the length of a day too");
  refused({"--day", "8h", "--crews", "0"}, "crews");
  refused({"--day", "tomorrow"}, "is no time");
  refused({"--day", "2min"}, "day: 2.00 min are too short for one station, which takes 3.00 min");
  const auto evaluated = [&](const std::vector<std::string>& more) {
    std::vector<std::string> all{"--station", "8,0,1.5", "--station", "-8,0,1.5"};
    all.insert(all.end(), more.begin(), more.end());
    return run_program(coarse("evaluate", all));
  };
  expect_refused(evaluated({"--sessions", path("sessions.csv")}), 2, "--sessions: a round is split by --day");
  expect_refused(evaluated({"--day", "1h", "--sessions", path("sessions.txt")}), 2, "must end with .csv");
  expect_refused(evaluated({"--day", "3.1min"}), 2, "takes");
  EXPECT_FALSE(std::filesystem::exists(path("sessions.csv")));
}

TEST_F(Plan, ChoosesAStepForEachStationOfTheFewest) {
  const auto front =
      json_of(plan("plan", {"--capture", "0.5", "--link", "0.05", "--stations", "1..6", "--search-step", "1,0.5"}));
  ASSERT_FALSE(front["front"].empty());
  for (const auto& entry : front["front"]) {
    const std::size_t count = entry["stations"].size();
    EXPECT_EQ(entry["station_count"], count);
    EXPECT_EQ(entry["x"].size(), 3 * count) << "(u, v) and a step of each";
    EXPECT_GE(entry["values"]["capture"]["exact"].get<double>(), 0.5);
    for (const auto& station : entry["stations"]) {
      const double step = station["step"];
      EXPECT_TRUE(std::abs(step - 1) < 1e-9 || std::abs(step - 0.5) < 1e-9) << step;
    }
  }
  const auto again = json_of({"evaluate", scene_, "--engine", "embree", "--config", path("plan/config.json"),
                              "--stations", path("plan/front.json")});
  EXPECT_EQ(again["coverage"], front["front"][0]["exact"]["coverage"]);
}

TEST_F(Plan, TheSameSeedGivesTheSameFront) {
  for (const char* problem : {"coverage-fix", "coverage-overlap-min"}) {
    const std::string stations = std::string(problem) == "coverage-fix" ? "2" : "2..4";
    const auto folder = [&](const char* run) { return std::string(problem) + "-" + run; };
    auto first = json_of(plan(folder("first"), {"--problem", problem, "--stations", stations, "--seed", "5"}));
    auto second = json_of(plan(folder("second"), {"--problem", problem, "--stations", stations, "--seed", "5"}));
    auto other = json_of(plan(folder("other"), {"--problem", problem, "--stations", stations, "--seed", "6"}));
    drop_times(first);
    drop_times(second);
    EXPECT_EQ(first, second);
    EXPECT_NE(first["front"], other["front"]);
  }
}

// On the software device, or any other with ray queries: what the README's first command does, with coarse rays.
TEST_F(Plan, RayQueriesGiveTheSameFrontAgain) {
  const auto by_ray_query = [&](const std::string& folder) {
    auto arguments = plan(folder, {"--problem", "coverage-overlap-fix", "--stations", "3", "--seed", "5"});
    *std::find(arguments.begin(), arguments.end(), "embree") = "ray_query";
    auto front = json_of(arguments);
    drop_times(front);
    EXPECT_GT(front["work"]["sampled_rays"], 0);
    front["work"].erase("sampled_rays");  // groups of threads end their walks in any order
    return front;
  };
  const auto first = by_ray_query("first");
  EXPECT_EQ(first["engine"], "ray_query");
  EXPECT_EQ(first, by_ray_query("second"));
}

// config.json holds all that was set, by a name that --config reads.
TEST_F(Plan, ItsConfigurationGivesTheSameFrontAgain) {
  const std::vector<std::string> asked{"--objectives",   "coverage,overlap",
                                       "--stations",     "2..3",
                                       "--require",      "coverage>=0.2",
                                       "--heights",      "1.2,2",
                                       "--keep",         "8,0,1.5",
                                       "--link-overlap", "0.05",
                                       "--scheme",       "generational",
                                       "--sigma",        "0.3",
                                       "--redraws",      "3",
                                       "--seed",         "4",
                                       "--zenith-start", "10"};
  auto first = json_of(plan("first", asked));
  auto again =
      json_of({"plan", scene_, "--engine", "embree", "--config", path("first/config.json"), "-o", path("again")});
  drop_times(first);
  drop_times(again);
  EXPECT_EQ(first["parameters"], again["parameters"]);
  EXPECT_EQ(first, again);
}

TEST_F(Plan, StartsFromTheBestOfItsCandidates) {
  const auto front =
      json_of(plan("plan", {"--problem", "coverage-overlap-fix", "--stations", "3", "--seed-with", "exact"}));
  double most = 0;
  for (const auto& entry : front["front"]) most = std::max(most, entry["coverage"].get<double>());
  const auto bound =
      json_of(coarse("bound", {"--stations", "3", "--candidates", "256", "--sample", "200", "--branch", "1min"}));
  EXPECT_GE(most + 1e-9, bound["stations"][0]["reached"].get<double>()) << "the first member of the search";
  expect_refused(run_program(plan("other", {"--seed-with", "exact"})), 2, "--seed-with");
  expect_refused(run_program(plan("other", {"--stations", "3", "--problem", "coverage-fix", "--seed-with", "luck"})), 2,
                 "'luck' is neither greedy nor exact");
}

TEST_F(Plan, ShowsTheRegistrationErrorWhereItIsAskedFor) {
  const auto front = json_of(
      plan("plan", {"--objectives", "coverage,registration", "--stations", "3", "--registration-surfaces", "all"}));
  EXPECT_EQ(front["parameters"]["plan"]["registration_surfaces"], "all");
  for (const char* name : {"registration.ply", "registration.png", "registration.svg"})
    EXPECT_GT(read(std::string("plan/") + name).size(), 0u) << name;
  EXPECT_NE(read("plan/plan.svg").size(), 0u);
  // Exact, as in evaluate.
  const auto& entry = front["front"][0];
  const auto again =
      json_of({"evaluate", scene_, "--engine", "embree", "--config", path("plan/config.json"), "--registration",
               "--registration-surfaces", "all", "--stations", path("plan/front.json"), "--entry", "1"});
  EXPECT_NEAR(again["registration"]["error_mm"].get<double>(), entry["values"]["registration"]["exact"].get<double>(),
              1e-9);
  EXPECT_EQ(again["registration"]["surfaces"], "all");
}

TEST_F(Plan, SaysWhatANetworkMisses) {
  const Outcome outcome = run_program(
      plan("plan", {"--objectives", "coverage,overlap", "--stations", "2", "--require", "coverage >= 0.99"}));
  EXPECT_EQ(outcome.exit_code, 3) << outcome.err;
  EXPECT_NE(outcome.out.find("to do"), std::string::npos) << outcome.out;
  EXPECT_NE(outcome.out.find("more stations than 2"), std::string::npos) << outcome.out;
  EXPECT_NE(outcome.out.find("not met: share captured of the site at least 99 %"), std::string::npos) << outcome.out;
  const Outcome wrong = run_program(plan("wrong", {"--stations", "2", "--require", "speed>=3"}));
  EXPECT_EQ(wrong.exit_code, 2);
  EXPECT_NE(wrong.err.find("--require: unknown objective \"speed\"; known: coverage"), std::string::npos) << wrong.err;
}

// Four walls seen from outside: no two stations of a plan see the same of them, let alone all.
TEST_F(Plan, AsksTheSurveyorsQuestionWhereNoneIsNamed) {
  const auto front = json_of(plan("plan", {"--link", "0", "--capture", "0"}));
  EXPECT_EQ(front["problem"], "survey");
  ASSERT_EQ(front["front"].size(), 1u);
  EXPECT_EQ(front["front"][0]["missed"], 0);
  EXPECT_EQ(front["front"][0]["station_count"], 1) << "nothing is asked of it";

  EXPECT_EQ(run_program(plan("plan", {"--stations", "2"})).exit_code, 2) << "the folder holds another run";
  for (const char* name : {"missed.csv", "plan-level-2.png", "targets.csv", "report.pdf", "notes.txt"})
    std::ofstream(path("plan/") + name) << "of the run before";
  const Outcome few = run_program(plan("plan", {"--stations", "2", "--capture", "0.9", "--force", "--no-report"}));
  EXPECT_EQ(few.exit_code, 3) << few.err;
  EXPECT_NE(few.out.find("to do"), std::string::npos) << few.out;
  for (const char* name : {"plan-level-2.png", "targets.csv", "report.pdf"})
    EXPECT_FALSE(std::filesystem::exists(path("plan/") + name)) << name << " is of another plan";
  EXPECT_EQ(read("plan/missed.csv").find("of the run before"), std::string::npos);
  EXPECT_EQ(read("plan/notes.txt"), "of the run before") << "that is the surveyor's own";
}

// Its configuration repeats the question: no share, but so much surface of each station.
TEST_F(Plan, AsksForTheStationsThatPayByDefault) {
  const auto front = json_of(plan("plan", {"--link", "0"}));
  EXPECT_EQ(front["pays"]["least_m2"], 25);
  EXPECT_TRUE(front["met"]);
  EXPECT_EQ(front["summary"][0]["heading"], "scanner");
  EXPECT_EQ(front["summary"][1]["heading"], "planned");
  EXPECT_TRUE(front["further"]["m2"].is_number());
  const auto same = json_of(
      {"plan", scene_, "--engine", "embree", "--config", path("plan/config.json"), "-o", path("again"), "--no-report"});
  EXPECT_EQ(same["front"], front["front"]);
  EXPECT_EQ(same["pays"], front["pays"]);
}

// A plan whose time is over leaves all files of one that was finished.
TEST_F(Plan, IsDoneWithinTheTimeGiven) {
  const auto begun = std::chrono::steady_clock::now();
  const Outcome outcome =
      run_program({"plan", scene_, "--engine", "embree", "--step", "0.5", "--spacing", "0.05", "--capture", "0.9",
                   "--link", "0", "--iterations", "10000000", "--max-time", "8", "-o", path("plan")});
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begun).count();
  EXPECT_TRUE(outcome.exit_code == 0 || outcome.exit_code == 3) << outcome.err;
  EXPECT_LT(seconds, 60) << "ten million iterations take hours";
  EXPECT_EQ(nlohmann::json::parse(read("plan/front.json"))["stop_reason"], "max_time") << outcome.err;
  const Outcome whole = run_program({"plan", scene_, "--engine", "embree", "--step", "0.5", "--spacing", "0.05",
                                     "--capture", "0.9", "--link", "0", "--iterations", "2", "-o", path("whole")});
  EXPECT_TRUE(whole.exit_code == 0 || whole.exit_code == 3) << whole.err;
  const auto names = [&](const char* folder) {
    std::set<std::string> all;
    for (const auto& file : std::filesystem::directory_iterator(path(folder)))
      all.insert(file.path().filename().string());
    return all;
  };
  // Under load there may be no time for all files, and the program says which it left out. A finished search keeps its
  // state, and some answers take targets.
  const std::set<std::string> written = names("plan");
  for (const std::string& file : names("whole"))
    EXPECT_TRUE(written.contains(file) || file == "checkpoint.bin" || file == "targets.csv" ||
                outcome.err.find(file) != std::string::npos)
        << file << "\n"
        << outcome.err;
  for (const char* file : {"front.json", "stations.csv", "plan.png", "coverage.ply"})
    EXPECT_TRUE(written.contains(file)) << file << "\n" << outcome.err;
  for (const std::string& text : {outcome.out, whole.out})
    for (const char* line : {"linked", "registered", "on site", "<- the plan"})
      EXPECT_NE(text.find(line), std::string::npos) << line << "\n" << text;
}

TEST_F(Plan, KeepsBetterResultsWhenResumedWithLess) {
  const std::vector<std::string> asked{"--problem", "coverage-overlap-fix", "--stations", "3"};
  auto more = asked;
  more.insert(more.end(), {"--iterations", "6"});
  const auto first = json_of(plan("plan", more));
  auto less = asked;
  less.insert(less.end(), {"--iterations", "2", "--resume"});
  const Outcome resumed = run_program(plan("plan", less));
  EXPECT_EQ(resumed.exit_code, 0) << resumed.err;
  EXPECT_NE(resumed.err.find("resuming"), std::string::npos) << resumed.err;
  EXPECT_GE(nlohmann::json::parse(read("plan/front.json"))["evaluations"], first["evaluations"]);
  EXPECT_EQ(nlohmann::json::parse(read("plan/front.json"))["front"], first["front"]);
}

TEST_F(Plan, FirstInterruptEndsInGoodOrder) {
  const Outcome outcome = run_program(
      plan("plan", {"--problem", "coverage-overlap-fix", "--stations", "3", "--iterations", "10000000", "--json"}),
      [&](int process) {
        for (int tries = 0; tries < 600 && !std::filesystem::exists(path("plan/config.json")); ++tries)
          std::this_thread::sleep_for(std::chrono::milliseconds(50));
        std::this_thread::sleep_for(std::chrono::milliseconds(300));
        kill(process, SIGINT);
      });
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  const auto front = nlohmann::json::parse(outcome.out, nullptr, false);
  ASSERT_TRUE(front.is_object()) << outcome.err;
  EXPECT_EQ(front["stop_reason"], "cancelled");
  EXPECT_TRUE(std::filesystem::exists(path("plan/front.json")));

  const auto done = front["evaluations"].get<std::size_t>();
  const auto resumed = json_of(plan("plan", {"--problem", "coverage-overlap-fix", "--stations", "3", "--resume",
                                             "--iterations", std::to_string(done / 6 + 2)}));
  EXPECT_GT(resumed["evaluations"], done);
}

// A block in the void: the first line says that the ground is made up, and so does the exit code.
TEST_F(Plan, OnAPlaneThatWasLaidIsForTheSurveyorToDecide) {
  GlbBuilder glb;
  std::vector<float> corners;
  for (const float z : {-2.0F, 2.0F})
    for (const float y : {0.0F, 3.0F})
      for (const float x : {-3.0F, 3.0F}) corners.insert(corners.end(), {x, y, z});
  const std::vector<std::uint32_t> faces{0, 2, 3, 0, 3, 1, 4, 5, 7, 4, 7, 6, 0, 1, 5, 0, 5, 4,
                                         2, 6, 7, 2, 7, 3, 0, 4, 6, 0, 6, 2, 1, 3, 7, 1, 7, 5};
  const int positions = glb.positions(corners), indices = glb.accessor(faces, 5125, "SCALAR");
  glb.node({{"mesh", glb.mesh({{"attributes", {{"POSITION", positions}}}, {"indices", indices}})}, {"name", "block"}});
  glb.write_glb(path("block.glb"));
  const Outcome outcome = run_program({"plan",         path("block.glb"),
                                       "--engine",     "embree",
                                       "--step",       "1",
                                       "--user-size",  "0.5",
                                       "--spacing",    "0.2",
                                       "--unit",       "m",
                                       "--up",         "y",
                                       "--problem",    "coverage-fix",
                                       "--stations",   "2",
                                       "--iterations", "2",
                                       "--population", "6",
                                       "--sample",     "200",
                                       "--no-report",  "-o",
                                       path("plan")});
  EXPECT_EQ(outcome.exit_code, 3) << outcome.err;
  EXPECT_EQ(outcome.out.find("none in the model: the stations stand on a horizontal plane laid under the model"), 0u)
      << outcome.out;
}

}  // namespace
}  // namespace vantage::test
