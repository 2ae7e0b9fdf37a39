// SPDX-License-Identifier: Apache-2.0
#include "stress/odd_rays.hpp"

#include "stress/engine_suite.hpp"

namespace vantage::test {
namespace {

using OddRaysSuite = EngineSuite;

TEST_P(OddRaysSuite, HitWhatADoublePrecisionReferenceHits) {
  for (const OddRays& rays : odd_rays(2)) {
    SCOPED_TRACE(rays.name);
    const auto tracer = make_tracer(GetParam(), rays.scene);
    Comparison all;
    for (const TraceStation& station : rays.stations) all.add(compare(*tracer, rays.scene, station));
    EXPECT_EQ(all.unexplained, 0u);
    EXPECT_EQ(all.broken, 0u);
    EXPECT_TRUE(all.range_m < 2e-5 || all.relative_range < 1e-6) << all.range_m;  // the latter over kilometres
    if (!rays.at_a_limit) {
      EXPECT_GT(all.hits, 0u);
    }
  }
}
VANTAGE_EVERY_ENGINE(OddRaysSuite);

}  // namespace
}  // namespace vantage::test
