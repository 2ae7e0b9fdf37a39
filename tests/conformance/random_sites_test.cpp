// SPDX-License-Identifier: Apache-2.0
#include "support/random_sites.hpp"

#include <gtest/gtest.h>

#include "conformance/engines_under_test.hpp"

namespace vantage::test {
namespace {

class RandomSitesConformance : public testing::TestWithParam<EngineUnderTest> {};

TEST_P(RandomSitesConformance, EveryWayOfCountingAgrees) { expect_every_way_agrees(GetParam().make, 5, 6); }

TEST_P(RandomSitesConformance, EveryWayOfCountingAgreesWhereMeshesAreShared) {
  expect_every_way_agrees(GetParam().make, 1, 2, random_placed_site);
}

TEST_P(RandomSitesConformance, EveryWayOfCountingAgreesOnUnevenRows) {
  expect_every_way_agrees(GetParam().make, 1, 2, random_uneven_site);
}

TEST_P(RandomSitesConformance, EveryWayOfCountingAgreesOnListsOfDirections) {
  expect_every_way_agrees(GetParam().make, 1, 2, random_listed_site);
}

INSTANTIATE_TEST_SUITE_P(Engines, RandomSitesConformance, testing::ValuesIn(engines_under_test()),
                         [](const auto& engine) { return engine.param.name; });

}  // namespace
}  // namespace vantage::test
