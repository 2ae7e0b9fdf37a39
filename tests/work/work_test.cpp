// SPDX-License-Identifier: Apache-2.0
// A plan that costs more than it did fails here, until somebody writes the new numbers into kept.csv and the reason
// into the changelog. Numbers within 3 % pass: a change of rounding moves some.
#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <cmath>
#include <fstream>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include "support/temporary_folder.hpp"
#include "vantage/built_in_scenes.hpp"
#include "vantage/planner.hpp"
#include "vantage/question.hpp"
#include "vantage/site.hpp"

namespace vantage {
namespace {

constexpr double kNear = 0.03;

// Numbers by site and name.
using Kept = std::map<std::string, std::map<std::string, double>>;
Kept kept() {
  std::ifstream file(VANTAGE_KEPT_WORK);
  std::string line, cell;
  std::vector<std::string> names;
  Kept found;
  while (std::getline(file, line)) {
    std::istringstream cells(line);
    std::string site;
    std::getline(cells, site, ',');
    for (std::size_t k = 0; std::getline(cells, cell, ','); ++k) {
      if (site == "site")
        names.push_back(cell);
      else
        found[site][names.at(k)] = std::stod(cell);
    }
  }
  return found;
}

Work planned(const std::string& name) {
  const test::TemporaryFolder folder;
  const auto file = folder.path() / (name + ".glb");
  write_built_in_scene(name, 20'000, file);
  // Coarse, so that four plans take seconds.
  SiteOptions options;
  options.steps = {Angle::degrees(0.4), Angle::degrees(0.4)};
  options.user_size_m = 0.2, options.spacing_m = 0.1;
  options.engine = Engine::embree;
  Site site = Site::open(file, options);
  PlanConfig config;
  config.sample_voxels = 1000;
  SurveyQuestion question;
  question.capture = 0.9;
  return plan(site, question, config).work;
}

class Plans : public testing::TestWithParam<const char*> {};

TEST_P(Plans, CostWhatTheyDid) {
  const std::string site = GetParam();
  const Kept known = kept();
  ASSERT_TRUE(known.contains(site)) << "kept.csv has no line of " << site;
  const Work work = planned(site);
  std::string line = site;
  bool same = true;
  Work::for_each([&](const char* name, auto member) {
    const auto now = static_cast<double>(work.*member);
    line += "," + std::to_string(work.*member);
    const double before = known.at(site).at(name);
    same = same && std::abs(now - before) <= kNear * before;
    EXPECT_NEAR(now, before, kNear * before) << name;
  });
  EXPECT_TRUE(same) << "the line of kept.csv would be: " << line;
}

INSTANTIATE_TEST_SUITE_P(Sites, Plans, testing::Values("office", "house", "street", "industrial"),
                         [](const auto& site) { return std::string(site.param); });

TEST(Work, DoesNotDependOnTheNumberOfThreads) {
  const Work all = planned("office");
  const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
  EXPECT_EQ(planned("office"), all);
}

}  // namespace
}  // namespace vantage
