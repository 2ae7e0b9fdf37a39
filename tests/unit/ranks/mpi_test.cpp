// SPDX-License-Identifier: Apache-2.0
// The program under `mpirun`: the same front from any number of ranks, whatever happens to them.
#include <gtest/gtest.h>
#include <signal.h>

#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <functional>
#include <regex>
#include <sstream>
#include <thread>

#include "core/philox.hpp"
#include "unit/cli/program.hpp"
#include "vantage/built_in_scenes.hpp"
#include "vantage/scene.hpp"

namespace vantage::test {
namespace {

using Words = std::vector<std::string>;

class Mpi : public ProgramTest {
 protected:
  // Settings for any machine, without a network and with fewer cores than ranks; also as root.
  Mpi() {
    for (const auto& [name, value] : {std::pair{"OMPI_ALLOW_RUN_AS_ROOT", "1"},
                                      {"OMPI_ALLOW_RUN_AS_ROOT_CONFIRM", "1"},
                                      {"OMPI_MCA_btl", "self,vader"},
                                      {"OMPI_MCA_btl_vader_single_copy_mechanism", "none"},
                                      {"OMPI_MCA_plm_rsh_agent", ""},
                                      {"OMPI_MCA_rmaps_base_oversubscribe", "1"},
                                      {"OMPI_MCA_hwloc_base_binding_policy", "none"},
                                      // Ranks told to end are killed at once, so nothing may rely on a delay.
                                      {"OMPI_MCA_odls_base_sigkill_timeout", "0"}})
      setenv(name, value, 1);
  }

  static Words on(int ranks, const Words& arguments, const std::string& program = VANTAGE_MPI_PROGRAM) {
    Words all{"-n", std::to_string(ranks), program};
    all.insert(all.end(), arguments.begin(), arguments.end());
    return all;
  }
  Words plan(const std::string& folder, Words more) const {
    more.insert(more.end(), {"--no-report", "-o", path(folder)});
    return coarse("plan", more);
  }
  // A result without its times.
  std::string front(const std::string& folder) const {
    static const std::regex costs("\"(seconds|work)\": (\\{[^}]*\\}|[-+0-9.e]+)");
    return std::regex_replace(read(folder + "/front.json"), costs, "\"$1\": 0") + read(folder + "/front.csv");
  }
  void expect_equal_fronts(const Words& question) const {
    std::string first;
    for (const int ranks : {1, 2, 4}) {
      const std::string folder = "on" + std::to_string(ranks);
      const Outcome outcome = run_program(on(ranks, plan(folder, question)));
      ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
      if (ranks > 1) {
        EXPECT_NE(outcome.err.find(std::to_string(ranks) + " ranks share the work"), std::string::npos) << outcome.err;
      }
      // Only rank 0 prints.
      EXPECT_EQ(outcome.out.find("results in "), outcome.out.rfind("results in ")) << outcome.out;
      if (ranks == 1) first = front(folder);
      EXPECT_EQ(front(folder), first) << ranks << " ranks";
    }
    EXPECT_NE(first.find("\"stations\""), std::string::npos);
    // The program without MPI finds the same.
    const Outcome outcome = run_program(on(1, plan("plain", question), VANTAGE_PLAIN_PROGRAM));
    ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
    EXPECT_EQ(front("plain"), first);
  }
};

const Words kSampled{"--problem", "coverage-overlap-fix", "--stations",   "3",  "--sample",     "300",
                     "--scheme",  "generational",         "--population", "24", "--iterations", "6"};

TEST_F(Mpi, AnyNumberOfRanksFindsTheSameFront) { expect_equal_fronts(kSampled); }

TEST_F(Mpi, AnyNumberOfRanksFindsTheSameFrontByEveryRay) {
  expect_equal_fronts({"--problem", "coverage-overlap-fix", "--stations", "3", "--exact", "--scheme", "generational",
                       "--population", "6", "--iterations", "2"});
}

// Examines candidates, chooses among them, and uses overlaps of whole scans.
TEST_F(Mpi, AnyNumberOfRanksFindsTheSameFewest) { expect_equal_fronts({"--link", "0.1", "--iterations", "3"}); }

TEST_F(Mpi, AnotherSceneIsRefused) {
  std::filesystem::create_directory(path("other"));
  write_built_in_scene("three-walls", 0, path("other/four_walls.glb"));
  Words words = on(1, plan("plan", kSampled)), other = on(1, plan("plan", kSampled));
  std::ranges::replace(other, scene_, path("other/four_walls.glb"));
  words.push_back(":");
  words.insert(words.end(), other.begin(), other.end());
  expect_refused(run_program(words), 2, "its scene is not rank 0's");
  EXPECT_FALSE(std::filesystem::exists(path("plan")));
}

TEST_F(Mpi, OtherSettingsAreRefused) {
  Words words = on(1, plan("plan", kSampled)), other = on(1, plan("plan", kSampled));
  *(std::ranges::find(other, "--step") + 1) = "2";
  words.push_back(":");
  words.insert(words.end(), other.begin(), other.end());
  expect_refused(run_program(words), 2, "its scanner or noise is not rank 0's");
}

TEST_F(Mpi, WhatARankLacksIsToldByRank0) {
  Words words = on(1, plan("plan", kSampled)), other = on(1, plan("plan", kSampled));
  std::ranges::replace(other, scene_, path("nowhere.glb"));
  words.push_back(":");
  words.insert(words.end(), other.begin(), other.end());
  const Outcome outcome = run_program(words);
  expect_refused(outcome, 1, "nowhere.glb");
  EXPECT_NE(outcome.err.find("error: rank 1: on "), std::string::npos) << outcome.err;
}

TEST_F(Mpi, UsageIsToldOnce) {
  expect_refused(run_program(on(3, plan("plan", {"--stationz", "3"}))), 2, "--stationz");
  expect_refused(run_program(on(2, coarse("evaluate", {"--station", "0,-8,1.5"}))), 2, "only `vantage plan`");
  const Outcome version = run_program(on(3, {"--version"}));
  EXPECT_EQ(version.exit_code, 0) << version.err;
  EXPECT_EQ(std::ranges::count(version.out, '\n'), 1) << version.out;
}

// Each would plan everything and write the same files.
TEST_F(Mpi, TheProgramWithoutMpiRefusesAJob) {
  const Outcome outcome = run_program(on(2, plan("plan", kSampled), VANTAGE_PLAIN_PROGRAM));
  EXPECT_EQ(outcome.exit_code, 2) << outcome.err;
  EXPECT_NE(outcome.err.find("built without MPI"), std::string::npos) << outcome.err;
  EXPECT_FALSE(std::filesystem::exists(path("plan")));
}

TEST_F(Mpi, ExitCodesAreRank0s) {
  Words question = kSampled;
  question.insert(question.end(), {"--require", "coverage>=0.999"});
  const Outcome outcome = run_program(on(2, plan("plan", question)));
  EXPECT_EQ(outcome.exit_code, 3) << outcome.err;
}

// Running processes that the launcher started, by rank.
std::vector<int> ranks_of(int launcher) {
  std::vector<int> processes;
  for (const auto& entry : std::filesystem::directory_iterator("/proc")) {
    const std::string name = entry.path().filename();
    if (name.find_first_not_of("0123456789") != std::string::npos) continue;
    // "12 (vantage-mpi) S 11": the process, its name, its state, its parent
    std::ifstream stat(entry.path() / "stat");
    std::string text;
    std::getline(stat, text);
    const std::size_t named = text.find(" (vantage"), end = text.rfind(") ");
    if (named == std::string::npos || end == std::string::npos || text[end + 2] == 'Z') continue;
    if (std::atoi(text.c_str() + end + 4) == launcher) processes.push_back(std::atoi(name.c_str()));
  }
  std::ranges::sort(processes);
  return processes;
}

bool ended(int process) {
  std::ifstream stat("/proc/" + std::to_string(process) + "/stat");
  std::string text;
  std::getline(stat, text);
  return text.empty() || text.find(") Z ") != std::string::npos;
}

bool within(std::chrono::seconds limit, const std::function<bool()>& done) {
  for (const auto end = std::chrono::steady_clock::now() + limit; !done();) {
    if (std::chrono::steady_clock::now() > end) return false;
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  return true;
}

// The same search is run repeatedly on various numbers of ranks, and one rank is killed: in every fourth run at some
// moment after the start, in the others at some moment after the run has saved its state. No machine is too slow or too
// fast for that, and the last run must find what an undisturbed run finds.
TEST_F(Mpi, KilledAndResumedItFindsTheSameFront) {
  using std::chrono::milliseconds;
  Words question{"--problem", "coverage-overlap-fix", "--stations",   "4",  "--sample",     "1500",
                 "--scheme",  "generational",         "--population", "40", "--iterations", "150"};
  ASSERT_EQ(run_program(on(1, plan("undisturbed", question))).exit_code, 0);
  question.insert(question.end(), {"--resume", "--save-every", "0.05"});
  const std::filesystem::path checkpoint = path("disturbed/checkpoint.bin");
  const auto last_saved = [&] {
    std::error_code none;  // `last_write_time` then is the earliest time
    return std::filesystem::last_write_time(checkpoint, none);
  };
  RandomStream random(20);
  std::size_t killed = 0, saved = 0;
  for (int k = 0; k < 60 && saved < 10; ++k) {
    const int ranks = 2 + static_cast<int>(random.bits() % 3);
    const auto victim = static_cast<std::size_t>(random.bits() % static_cast<std::uint32_t>(ranks));
    const bool after_saving = k % 4 != 0;
    const milliseconds moment(static_cast<int>(random.uniform() * (after_saving ? 100 : 1000)));
    const auto before = last_saved();
    bool struck = false;
    const Outcome outcome = run_program(on(ranks, plan("disturbed", question)), [&](int launcher) {
      std::vector<int> processes;
      const auto all_there = [&] {
        processes = ranks_of(launcher);
        return processes.size() == static_cast<std::size_t>(ranks);
      };
      EXPECT_TRUE(within(std::chrono::seconds(60), all_there));
      if (after_saving) {
        EXPECT_TRUE(within(std::chrono::seconds(60), [&] { return last_saved() != before || ended(launcher); }));
      }
      std::this_thread::sleep_for(moment);
      if (!all_there()) return;
      struck = kill(processes[victim], SIGKILL) == 0;
      EXPECT_TRUE(within(std::chrono::seconds(60), [&] { return ranks_of(launcher).empty(); })) << "a rank goes on";
      // Open MPI 4.1's launcher may deadlock at its own end, once all its processes are gone.
      if (!within(std::chrono::seconds(5), [&] { return ended(launcher); })) kill(launcher, SIGKILL);
    });
    SCOPED_TRACE(std::to_string(k) + ": rank " + std::to_string(victim) + " of " + std::to_string(ranks) + ", " +
                 std::to_string(moment.count()) + " ms after " + (after_saving ? "it saved" : "the start"));
    if (outcome.exit_code == 0) {  // it had finished: the next begins anew
      EXPECT_EQ(front("disturbed"), front("undisturbed"));
      std::filesystem::remove_all(path("disturbed"));
      continue;
    }
    EXPECT_TRUE(struck) << outcome.err;
    EXPECT_NE(outcome.err.find("exited on signal 9"), std::string::npos) << outcome.err;
    ++killed;
    saved += std::filesystem::exists(checkpoint);
  }
  EXPECT_GE(killed, 10u) << "too quick to be killed on the way";
  EXPECT_GE(saved, 10u) << "nothing was there to go on from";
  const Outcome last = run_program(on(1, plan("disturbed", question)));
  ASSERT_EQ(last.exit_code, 0) << last.err;
  EXPECT_EQ(front("disturbed"), front("undisturbed"));
}

}  // namespace
}  // namespace vantage::test
