// SPDX-License-Identifier: Apache-2.0
#include "support/random_sites.hpp"

#include <gtest/gtest.h>

#include <string>

#include "conformance/engines_under_test.hpp"
#include "vantage/error.hpp"

namespace vantage::test {
namespace {

class RandomSitesConformance : public testing::TestWithParam<EngineUnderTest> {};

TEST_P(RandomSitesConformance, EveryWayOfCountingAgrees) { expect_every_way_agrees(GetParam().make, 5, 7); }

TEST_P(RandomSitesConformance, EveryWayOfCountingAgreesWhereMeshesAreShared) {
  expect_every_way_agrees(GetParam().make, 1, 4, random_placed_site);
}

TEST_P(RandomSitesConformance, EveryWayOfCountingAgreesOnUnevenRows) {
  expect_every_way_agrees(GetParam().make, 1, 3, random_uneven_site);
}

// Lists of directions are for processors.
TEST_P(RandomSitesConformance, EveryWayOfCountingAgreesOnListsOfDirections) {
  if (GetParam().name.find("embree") != std::string::npos)
    return void(expect_every_way_agrees(GetParam().make, 1, 4, random_listed_site));
  try {
    GetParam().make(random_listed_site(1).scene);
    ADD_FAILURE() << "an engine counts lists, but no test compares it";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), Errc::invalid_argument);
    EXPECT_NE(std::string(error.what()).find("use the engine embree"), std::string::npos) << error.what();
  }
}

INSTANTIATE_TEST_SUITE_P(Engines, RandomSitesConformance, testing::ValuesIn(engines_under_test()),
                         [](const auto& engine) { return engine.param.name; });

}  // namespace
}  // namespace vantage::test
