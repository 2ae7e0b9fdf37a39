// SPDX-License-Identifier: Apache-2.0
// The tables of settings, which command line, configuration files, scenes and Python go by.
#include <gtest/gtest.h>

#include <cctype>
#include <set>

#include "vantage/error.hpp"
#include "vantage/question.hpp"
#include "vantage/site.hpp"

namespace vantage {
namespace {

template <class Options>
const SettingRow<Options>& row(const SettingTable<Options>& table, const std::string& name) {
  return *std::ranges::find(table, name, &SettingRow<Options>::name);
}

template <class Options>
void expect_described(const SettingTable<Options>& table, std::set<std::string>& names) {
  for (const SettingRow<Options>& setting : table) {
    EXPECT_TRUE(names.insert(setting.name).second) << setting.name << " is there twice";
    for (const char c : setting.name) EXPECT_TRUE(std::islower(c) || c == '-') << setting.name;
    EXPECT_FALSE(setting.help.empty() || setting.help.ends_with('.')) << setting.name;
    EXPECT_FALSE(setting.group.empty()) << setting.name;
    if (setting.given) {
      EXPECT_FALSE(setting.given(Options{})) << setting.name;
    }
    for (const std::string& other : setting.excludes)
      EXPECT_NE(std::ranges::find(table, other, &SettingRow<Options>::name), table.end()) << setting.name;
  }
}

TEST(SettingTables, DescribeEachSettingOnce) {
  std::set<std::string> names;
  expect_described(site_settings(), names);
  expect_described(question_settings(), names);
  expect_described(plan_settings(), names);
}

TEST(SettingTables, NameASettingThatCannotBeRead) {
  const auto refused = [](const auto& table, const std::string& name, const std::string& text, auto options) {
    try {
      row(table, name).set(options, text, name);
    } catch (const Error& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  EXPECT_EQ(refused(site_settings(), "height", "tall", SiteOptions()), "height: 'tall' is not a number");
  EXPECT_EQ(refused(site_settings(), "spacing", "0", SiteOptions()), "spacing: '0' must be above 0");
  EXPECT_EQ(refused(question_settings(), "capture", "2", SurveyQuestion()),
            "capture: '2' must be at least 0 and at most 1");
  EXPECT_EQ(refused(plan_settings(), "exact", "perhaps", PlanConfig()), "exact: 'perhaps' is neither true nor false");
  EXPECT_NE(refused(site_settings(), "weight", "facade", SiteOptions()).find("\"facade*=5\""), std::string::npos);
}

TEST(SettingTables, ReadWhatTheyDescribe) {
  SiteOptions site;
  row(site_settings(), "step").set(site, "0.2", "step");
  row(site_settings(), "weight").set(site, "wall*=5", "weight");
  row(site_settings(), "weight").set(site, "roof=2", "weight");
  row(site_settings(), "device").set(site, "0,cpu", "device");
  EXPECT_NEAR((*site.steps)[1].in_degrees(), 0.2, 1e-12);
  EXPECT_EQ(site.scene.weights, (std::vector<std::pair<std::string, std::uint32_t>>{{"wall*", 5}, {"roof", 2}}));
  EXPECT_TRUE(site.devices.cpu);
  EXPECT_TRUE(row(site_settings(), "weight").given(site));

  SurveyQuestion question;
  row(question_settings(), "stations").set(question, "3,8", "stations");
  row(question_settings(), "objectives").set(question, "coverage,overlap", "objectives");
  row(question_settings(), "set-up").set(question, "5", "set-up");
  row(question_settings(), "registration-surfaces").set(question, "all", "registration-surfaces");
  EXPECT_EQ(question.stations, (std::array<std::size_t, 2>{3, 8}));
  EXPECT_EQ(question.objectives, (std::vector<std::string>{"coverage", "overlap"}));
  EXPECT_EQ(question.on_site.set_up_min, 5);
  EXPECT_EQ(question.registration.surfaces, RegistrationSurfaces::all);

  PlanConfig config;
  row(plan_settings(), "sample").set(config, "5%", "sample");
  EXPECT_NEAR(*config.sample_share, 0.05, 1e-12);
  EXPECT_EQ(config.sample_voxels, 0u);
}

// What a result lists can be given again by the same name.
TEST(SettingTables, HaveTheOptionsOfResults) {
  const std::vector<Vec3> corners{{0, 0, 0}, {8, 0, 0}, {8, 8, 0}, {0, 8, 0}};
  const std::vector<std::array<std::uint32_t, 3>> triangles{{0, 1, 2}, {0, 2, 3}};
  const Site site(Scene::from_triangles(corners, triangles));
  for (const Setting& setting : site.settings()) {
    if (setting.option.empty()) continue;
    EXPECT_NE(std::ranges::find(site_settings(), setting.option, &SettingRow<SiteOptions>::name), site_settings().end())
        << setting.option;
  }
}

}  // namespace
}  // namespace vantage
