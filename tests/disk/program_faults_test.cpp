// SPDX-License-Identifier: Apache-2.0
// A plan on a failing disk, in vanishing folders, and killed at any moment. It leaves whole old or whole new files, and
// gives the same result when continued, or one clear error.
//
// VANTAGE_FAULTS=N tries N of each kind instead of a few; a large N tries all.
#include <signal.h>
#include <sys/file.h>
#include <sys/resource.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <cstdlib>
#include <fstream>
#include <random>
#include <thread>

#include "disk/disk_faults.hpp"
#include "search/checkpoint.hpp"
#include "unit/cli/program.hpp"

namespace vantage::test {
namespace {

std::size_t tries(std::size_t usual) {
  const char* asked = std::getenv("VANTAGE_FAULTS");
  return asked ? std::strtoul(asked, nullptr, 10) : usual;
}

// Drops the costs of a run, which a resumed run does not repeat.
void drop_costs(nlohmann::json& object) {
  for (auto it = object.begin(); it != object.end();)
    if (it.key().find("seconds") != std::string::npos || it.key().find("resumed") != std::string::npos ||
        it.key() == "command" || it.key() == "work")
      it = object.erase(it);
    else {
      if (it->is_object()) drop_costs(*it);
      ++it;
    }
}

class PlanOnABadDisk : public ProgramTest {
 protected:
  PlanOnABadDisk() {
    EXPECT_EQ(run_program(plan("wanted", {})).exit_code, 0);
    for (const std::string& file : files()) wanted_.push_back(file.substr(std::string("wanted/").size()));
    EXPECT_GT(wanted_.size(), 15u);
  }
  ~PlanOnABadDisk() override { unsetenv("LD_PRELOAD"), unsetenv(kDiskFaultVariable); }

  std::vector<std::string> plan(const std::string& folder, const std::vector<std::string>& more) const {
    auto all =
        coarse("plan", {"--problem", "coverage-overlap-fix", "--stations", "3", "--population", "8", "--iterations",
                        "4", "--sample", "200", "--no-report", "--save-every", "0.001", "-o", path(folder)});
    all.insert(all.end(), more.begin(), more.end());
    return all;
  }
  nlohmann::json front(const std::string& folder) const {
    auto json = nlohmann::json::parse(read(folder + "/front.json"), nullptr, false);
    EXPECT_TRUE(json.is_object());
    if (json.is_object()) drop_costs(json);
    return json;
  }
  // Every file with its final name is whole; `aborted`: temporaries may remain beside.
  void expect_whole(const std::string& folder, bool aborted) const {
    for (const auto& entry : std::filesystem::directory_iterator(path(folder))) {
      const std::string name = entry.path().filename();
      SCOPED_TRACE(name);
      if (name.front() == '.') {
        EXPECT_TRUE(aborted);
      } else if (name.starts_with("checkpoint.bin")) {
        EXPECT_NO_THROW(read_checkpoint(entry.path()));
      } else if (name == "front.json") {
        EXPECT_EQ(front(folder), front("wanted"));
      } else if (name == "history.csv") {  // contains times
        const auto lines = [](const std::string& text) { return std::count(text.begin(), text.end(), '\n'); };
        EXPECT_EQ(lines(read(folder + "/" + name)), lines(read("wanted/" + name)));
      } else {
        EXPECT_EQ(read(folder + "/" + name), read("wanted/" + name));
      }
    }
  }
  void expect_resumes(const std::string& folder) const {
    const Outcome outcome = run_program(plan(folder, {"--resume"}));
    ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
    expect_whole(folder, false);
    for (const std::string& name : wanted_) EXPECT_TRUE(std::filesystem::exists(path(folder + "/" + name))) << name;
  }
  // Returns whether the call was reached.
  bool run_with_fault(const std::string& folder, int nth, int error, bool stays, Outcome& outcome) const {
    const std::string sign = path("reached");
    std::filesystem::remove(sign);
    setenv("LD_PRELOAD", VANTAGE_DISK_FAULTS, 1);
    setenv(kDiskFaultVariable,
           (std::to_string(nth) + " " + std::to_string(error) + (stays ? " 1 " : " 0 ") + sign + " " + path(folder))
               .c_str(),
           1);
    outcome = run_program(plan(folder, {"--resume"}));
    unsetenv("LD_PRELOAD"), unsetenv(kDiskFaultVariable);
    return std::filesystem::exists(sign);
  }
  // Number of calls in a whole plan.
  int calls() const {
    Outcome outcome;
    run_with_fault("probe", 0, 0, false, outcome);
    EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
    return std::atoi(read("reached").c_str());
  }
  std::vector<std::string> wanted_;
};

TEST_F(PlanOnABadDisk, FailsClearlyOrGoesOn) {
  const int all = calls();
  EXPECT_GT(all, 80);
  struct Kind {
    int error;
    bool stays;
  };
  const std::size_t each = std::min(tries(3), static_cast<std::size_t>(all));
  std::size_t reached = 0;
  for (const Kind kind : {Kind{ENOSPC, true}, Kind{EIO, false}, Kind{EROFS, true}})
    for (std::size_t k = 0; k < each; ++k) {
      const int nth = 1 + static_cast<int>(k * static_cast<std::size_t>(all) / each);
      SCOPED_TRACE("call " + std::to_string(nth) + " of " + std::to_string(all) + ", errno " +
                   std::to_string(kind.error));
      const std::string folder = "plan";
      std::filesystem::remove_all(path(folder));
      Outcome outcome;
      reached += run_with_fault(folder, nth, kind.error, kind.stays, outcome);
      if (outcome.exit_code != 0) expect_refused(outcome, 1, path(folder));
      if (std::filesystem::exists(path(folder))) expect_whole(folder, false);
      expect_resumes(folder);
    }
  EXPECT_GE(reached, 3 * each - 3);
}

TEST_F(PlanOnABadDisk, SurvivesBeingKilledAtAnyCall) {
  const int all = calls();
  const std::size_t each = std::min(tries(5), static_cast<std::size_t>(all));
  for (std::size_t k = 0; k < each; ++k) {
    const int nth = 1 + static_cast<int>(k * static_cast<std::size_t>(all) / each);
    SCOPED_TRACE("call " + std::to_string(nth) + " of " + std::to_string(all));
    std::filesystem::remove_all(path("plan"));
    Outcome outcome;
    const bool killed = run_with_fault("plan", nth, 0, false, outcome);
    EXPECT_EQ(outcome.exit_code, killed ? 128 + SIGKILL : 0) << outcome.err;
    if (std::filesystem::exists(path("plan"))) expect_whole("plan", true);
    expect_resumes("plan");
  }
}

TEST_F(PlanOnABadDisk, SurvivesBeingKilledAtRandomMoments) {
  const auto seed = std::random_device{}();
  SCOPED_TRACE("seed " + std::to_string(seed));
  std::mt19937 random(seed);
  const auto begun = std::chrono::steady_clock::now();
  std::filesystem::remove_all(path("plan"));
  EXPECT_EQ(run_program(plan("plan", {})).exit_code, 0);
  const auto whole = std::chrono::duration_cast<std::chrono::microseconds>(std::chrono::steady_clock::now() - begun);
  const std::size_t wanted = tries(20);
  std::size_t killed = 0;
  for (std::size_t k = 0; killed < wanted && k < 10 * wanted; ++k) {
    if (k % 4 == 0) std::filesystem::remove_all(path("plan"));  // then three more that continue
    const auto moment = std::chrono::microseconds(random() % static_cast<std::uint64_t>(whole.count()));
    const Outcome outcome = run_program(plan("plan", {"--resume"}), [&](int process) {
      std::this_thread::sleep_for(moment);
      kill(process, SIGKILL);
    });
    if (outcome.exit_code == 128 + SIGKILL)
      ++killed;
    else
      EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
    if (std::filesystem::exists(path("plan"))) expect_whole("plan", true);
    if (k % 4 == 3) expect_resumes("plan");
  }
  EXPECT_EQ(killed, wanted);
}

class Faults : public ProgramTest {
 protected:
  std::vector<std::string> endless(const std::string& folder) const {
    return coarse("plan", {"--problem", "coverage-overlap-fix", "--stations", "3", "--population", "8", "--iterations",
                           "10000000", "--sample", "200", "--no-report", "--save-every", "0.02", "-o", path(folder)});
  }
  // Waits until the search has begun to save itself.
  void wait_for_checkpoint(const std::string& folder) const {
    for (int tries = 0; tries < 1200 && !std::filesystem::exists(path(folder + "/checkpoint.bin.before")); ++tries)
      std::this_thread::sleep_for(std::chrono::milliseconds(25));
    EXPECT_TRUE(std::filesystem::exists(path(folder + "/checkpoint.bin.before")));
  }
};

TEST_F(Faults, SignalsThatAskForAnEndGetResults) {
  for (const int signal : {SIGTERM, SIGHUP}) {
    const std::string folder = "plan" + std::to_string(signal);
    const Outcome outcome = run_program(endless(folder), [&](int process) {
      wait_for_checkpoint(folder);
      kill(process, signal);
    });
    EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
    EXPECT_TRUE(std::filesystem::exists(path(folder + "/stations.csv"))) << outcome.err;
    EXPECT_NE(outcome.err.find("stopping in good order"), std::string::npos) << outcome.err;
  }
}

TEST_F(Faults, TwoPlansIntoOneFolderAreOneTooMany) {
  const Outcome first = run_program(endless("plan"), [&](int process) {
    wait_for_checkpoint("plan");
    for (const char* more : {"--resume", "--force"}) {
      auto second = endless("plan");
      second.push_back(more);
      expect_refused(run_program(second), 1, "another run is writing to " + path("plan"));
    }
    kill(process, SIGTERM);
  });
  EXPECT_EQ(first.exit_code, 0) << first.err;
}

TEST_F(Faults, AFolderThatIsRemovedMeanwhileIsMadeAgain) {
  const Outcome outcome = run_program(endless("plan"), [&](int process) {
    wait_for_checkpoint("plan");
    std::filesystem::rename(path("plan"), path("gone"));
    std::this_thread::sleep_for(std::chrono::milliseconds(300));
    kill(process, SIGTERM);
  });
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_NE(outcome.err.find("the search goes on without"), std::string::npos) << outcome.err;
  for (const char* name : {"plan/config.json", "plan/front.json", "plan/stations.csv", "plan/plan.png"})
    EXPECT_TRUE(std::filesystem::exists(path(name))) << name;
}

TEST_F(Faults, FilesWhereFoldersShouldBeAndFoldersWhereFilesShould) {
  const auto small = [&](const std::string& folder) {
    auto all = endless(folder);
    *std::find(all.begin(), all.end(), "10000000") = "2";
    return all;
  };
  write("file", "x");
  expect_refused(run_program(small("file")), 1, path("file"));
  expect_refused(run_program(small("file/plan")), 1, path("file/plan"));
  EXPECT_EQ(read("file"), "x");
  for (const char* name : {"config.json", "front.json", "plan.png"}) {
    SCOPED_TRACE(name);
    std::filesystem::create_directories(path("plan/" + std::string(name)));
    auto arguments = small("plan");
    arguments.push_back("--force");
    expect_refused(run_program(arguments), 1, path("plan/" + std::string(name)));
    std::filesystem::remove_all(path("plan"));
  }
  std::filesystem::create_directories(path("plan/checkpoint.bin"));
  auto arguments = small("plan");
  const Outcome without = run_program(arguments);
  EXPECT_EQ(without.exit_code, 0) << without.err;
  EXPECT_NE(without.err.find("checkpoint.bin: it names a folder"), std::string::npos) << without.err;
  arguments.push_back("--resume");
  expect_refused(run_program(arguments), 1, path("plan/checkpoint.bin"));
  for (const auto& option : {"--config", "--stations", "--within", "--crs"}) {
    SCOPED_TRACE(option);
    const std::string name = path(std::string("folder") + (std::string(option) == "--crs" ? ".prj" : ".json"));
    std::filesystem::create_directories(name);
    expect_refused(run_program(coarse("evaluate", {option, name, "--station", "8,0,1.5"})), 1, name);
  }
  expect_refused(run_program({"evaluate", folder_.path(), "--station", "8,0,1.5"}), 1, folder_.path());
}

// As `vantage … | head` stops reading, and as a full disk behind `>`.
TEST_F(Faults, NobodyReadsTheResults) {
  const auto through = [&](const std::string& command) {
    return WEXITSTATUS(std::system(("bash -c '" + command + "'").c_str()));
  };
  const std::string program = VANTAGE_PROGRAM;
  EXPECT_EQ(through("set -o pipefail; " + program + " info --json | true"), 0);
  EXPECT_EQ(through(program + " info > /dev/full 2> " + path("err")), 1);
  EXPECT_NE(read("err").find("standard output: No space left"), std::string::npos) << read("err");
  auto words = endless("plan");
  *std::find(words.begin(), words.end(), "10000000") = "2";
  std::string command;
  for (const std::string& word : words) command += " " + word;
  EXPECT_EQ(through("set -o pipefail; " + program + command + " 2>&1 | true"), 0);
  EXPECT_TRUE(std::filesystem::exists(path("plan/stations.csv")));
}

TEST_F(Faults, AFileThatMayNotGrowIsOneError) {
  rlimit before{};
  getrlimit(RLIMIT_FSIZE, &before);
  const rlimit small{.rlim_cur = 2000, .rlim_max = before.rlim_max};
  auto arguments = coarse("evaluate", {"--station", "8,0,1.5", "--cartography", path("c.ply")});
  setrlimit(RLIMIT_FSIZE, &small);
  const Outcome outcome = run_program(arguments);
  setrlimit(RLIMIT_FSIZE, &before);
  EXPECT_EQ(outcome.exit_code, 1) << outcome.err;
  EXPECT_NE(outcome.err.find("c.ply: File too large"), std::string::npos) << outcome.err;
  EXPECT_EQ(files(), std::vector<std::string>{});
}

}  // namespace
}  // namespace vantage::test
