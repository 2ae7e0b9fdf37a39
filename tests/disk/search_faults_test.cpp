// SPDX-License-Identifier: Apache-2.0
// Checkpoints on a disk that fails at any of its calls.
#include <gtest/gtest.h>

#include <cerrno>
#include <fstream>
#include <sstream>

#include "core/read_file.hpp"
#include "disk/disk_faults.hpp"
#include "search/checkpoint.hpp"
#include "support/temporary_folder.hpp"
#include "unit/plan/toy_survey.hpp"
#include "vantage/error.hpp"
#include "vantage/optimiser.hpp"

namespace vantage::test {
namespace {

constexpr const char* kProblem = "coverage-overlap-fix";

class SearchOnABadDisk : public testing::Test {
 protected:
  SearchOnABadDisk() {
    ToyEvaluator evaluator;
    config_.population = 8, config_.iterations = 2;
    wanted_ = run(config_);
    config_.checkpoint = file_, config_.checkpoint_seconds = 0;
  }
  ~SearchOnABadDisk() override { set_disk_fault({}); }

  std::string run(const PlanConfig& config) {
    ToyEvaluator evaluator;
    const SurveyProblem problem = toy_problem(kProblem);
    const PlacementOracle site = toy_site();
    const DecisionSpace space(site, problem);
    evaluator.measures = measures_of(problem);
    const auto searched = make_search_evaluator(evaluator, config, evaluator.measures.searched);
    return bits_of(search({.space = space,
                           .problem = problem,
                           .measures = evaluator.measures,
                           .config = config,
                           .evaluator = *searched,
                           .batch = 4,
                           .identity = "toy\n",
                           .warn = warn_}));
  }
  std::string resumed() {
    PlanConfig config = config_;
    config.resume = true;
    return run(config);
  }
  void start_anew() const {
    for (const auto& entry : std::filesystem::directory_iterator(folder_.path())) std::filesystem::remove(entry);
  }
  void expect_nothing_half() const {
    for (const auto& entry : std::filesystem::directory_iterator(folder_.path())) {
      EXPECT_TRUE(entry.path() == file_ || entry.path() == checkpoint_before(file_)) << entry.path();
      EXPECT_NO_THROW(read_checkpoint(entry.path()));
    }
  }

  TemporaryFolder folder_;
  const std::filesystem::path file_ = folder_ / "checkpoint.bin";
  PlanConfig config_ = toy_config();
  std::function<void(const std::string&)> warn_;
  std::string wanted_;
};

struct Kind {
  int error;
  bool stays;
};
constexpr Kind kKinds[] = {{ENOSPC, true}, {ENOSPC, false}, {EIO, false}, {EROFS, true}, {EACCES, false}};

TEST_F(SearchOnABadDisk, GoesOnWithoutACheckpointWhereSomebodyIsTold) {
  std::size_t warnings = 0;
  warn_ = [&](const std::string& line) {
    ++warnings;
    EXPECT_NE(line.find("checkpoint.bin"), std::string::npos) << line;
  };
  set_disk_fault({.below = folder_.path()});
  ASSERT_EQ(run(config_), wanted_);
  const int calls = disk_calls();
  EXPECT_GT(calls, 20);
  EXPECT_EQ(warnings, 0u);
  for (const auto& [error, stays] : kKinds)
    for (int nth = 1; nth <= calls; ++nth) {
      SCOPED_TRACE("call " + std::to_string(nth) + ", errno " + std::to_string(error));
      start_anew();
      warnings = 0;
      set_disk_fault({.below = folder_.path(), .nth = nth, .error = error, .stays = stays});
      ASSERT_EQ(run(config_), wanted_);
      set_disk_fault({});
      expect_nothing_half();
      ASSERT_EQ(resumed(), wanted_);
    }
}

TEST_F(SearchOnABadDisk, EndsWithOneErrorWhereNobodyIsTold) {
  set_disk_fault({.below = folder_.path()});
  run(config_);
  const int calls = disk_calls();
  std::size_t failures = 0;
  for (int nth = 1; nth <= calls; ++nth) {
    SCOPED_TRACE("call " + std::to_string(nth));
    start_anew();
    set_disk_fault({.below = folder_.path(), .nth = nth, .error = ENOSPC, .stays = true});
    try {
      run(config_);
    } catch (const Error& error) {
      ++failures;
      EXPECT_EQ(error.code(), Errc::io);
      EXPECT_NE(std::string(error.what()).find("No space left"), std::string::npos) << error.what();
    }
    set_disk_fault({});
    expect_nothing_half();
    ASSERT_EQ(resumed(), wanted_);
  }
  EXPECT_GT(failures, 20u);
}

TEST_F(SearchOnABadDisk, GoesOnFromTheCheckpointBeforeWhereTheNewestIsDamaged) {
  std::vector<std::string> told;
  warn_ = [&](const std::string& line) { told.push_back(line); };
  PlanConfig first = config_;
  first.iterations = 1;
  run(first);
  const std::string whole = read_file(file_);
  ASSERT_TRUE(std::filesystem::exists(checkpoint_before(file_)));
  const std::string before = read_file(checkpoint_before(file_));
  const auto write = [](const std::filesystem::path& file, const std::string& bytes) {
    std::ofstream(file, std::ios::binary | std::ios::trunc) << bytes;
  };
  // Also truncated, empty and missing.
  std::vector<std::string> damaged{whole.substr(0, whole.size() / 2), ""};
  for (std::size_t at = 0; at < whole.size(); at += 97) {
    damaged.push_back(whole);
    damaged.back()[at] = static_cast<char>(damaged.back()[at] ^ 0x10);
  }
  for (const std::string& bytes : damaged) {
    write(file_, bytes), write(checkpoint_before(file_), before);
    told.clear();
    ASSERT_EQ(resumed(), wanted_);
    ASSERT_EQ(told.size(), 1u);
    EXPECT_NE(told.front().find("going on from the one before"), std::string::npos) << told.front();
  }
  std::filesystem::remove(file_);
  write(checkpoint_before(file_), before);
  told.clear();
  EXPECT_EQ(resumed(), wanted_);
  EXPECT_EQ(told.size(), 1u);

  write(file_, whole.substr(0, 40)), write(checkpoint_before(file_), "x");
  EXPECT_THROW(resumed(), Error);
  // A damaged checkpoint must never replace the whole one before it.
  write(file_, whole.substr(0, 40)), write(checkpoint_before(file_), before);
  set_disk_fault({.below = folder_.path(), .nth = 1, .error = EIO, .stays = true});
  EXPECT_EQ(resumed(), wanted_);
  set_disk_fault({});
  EXPECT_EQ(read_file(checkpoint_before(file_)), before);
}

TEST(SavedOptimisers, NoticeEveryFlippedBit) {
  const OptimiserConfig config{.population = 2, .bounds = Bounds{{0, 0}, {1, 1}}};
  const auto make = [&](std::size_t objectives) -> std::unique_ptr<Optimiser> {
    if (objectives == 1) return std::make_unique<CmaEs>(2, config);
    return std::make_unique<MoCmaEs>(2, objectives, config);
  };
  for (const std::size_t objectives : {1, 2}) {
    SCOPED_TRACE(objectives);
    const auto optimiser = make(objectives);
    optimiser->tell(std::vector<double>(optimiser->ask().size() / 2 * objectives, 0.5));
    std::ostringstream out;
    optimiser->save(out);
    const std::string whole = out.str();
    const auto load = [&](const std::string& bytes) {
      std::istringstream in(bytes);
      make(objectives)->load(in);
    };
    EXPECT_NO_THROW(load(whole));
    std::size_t taken = 0;
    for (std::size_t bit = 0; bit < 8 * whole.size(); ++bit) {
      std::string flipped = whole;
      flipped[bit / 8] = static_cast<char>(flipped[bit / 8] ^ (1 << bit % 8));
      try {
        load(flipped);
        ++taken;
      } catch (const Error& error) {
        EXPECT_EQ(error.code(), Errc::malformed_file);
      }
    }
    EXPECT_EQ(taken, 0u);
  }
}

}  // namespace
}  // namespace vantage::test
