// SPDX-License-Identifier: Apache-2.0
#include "stress/engine_suite.hpp"
#include "stress/reference_differences.hpp"

namespace vantage::test {
namespace {

using Reference = EngineSuite;

TEST_P(Reference, HitsNoiseAndObjectivesMatchDoublePrecision) {
  for (const TestSite& site : sites()) {
    SCOPED_TRACE(site.name);
    const ReferenceDifferences d = compare_with_reference(GetParam(), site);
    EXPECT_LE(static_cast<double>(d.rays.differing), 1e-5 * static_cast<double>(d.rays.rays) + 1);
    EXPECT_EQ(d.rays.unexplained, 0u);
    EXPECT_EQ(d.rays.broken, 0u);
    EXPECT_LT(d.rays.range_m, 2e-5);
    EXPECT_LT(d.rays.sigma_m, 5e-6);
    EXPECT_LT(d.coverage, 1e-5);
    EXPECT_LT(d.overlap, 1e-4);
    EXPECT_LT(d.clustering, 1e-4);
  }
}
VANTAGE_EVERY_ENGINE(Reference);

}  // namespace
}  // namespace vantage::test
