// SPDX-License-Identifier: Apache-2.0
#include "support/random_sites.hpp"

#include <gtest/gtest.h>

#include "trace/embree/embree_tracer.hpp"

namespace vantage {
namespace {

TEST(RandomSites, EveryWayOfCountingAgrees) {
  const test::RaysTraced rays =
      test::expect_every_way_agrees([](const TraceScene& scene) { return make_embree_tracer(scene); }, 1, 7);
  EXPECT_LT(rays.skipping, rays.all);
}

TEST(RandomSites, EveryWayOfCountingAgreesWhereManyRaysCrossAVoxel) {
  test::expect_every_way_agrees([](const TraceScene& scene) { return make_embree_tracer(scene); }, 1, 2,
                                test::random_fine_site);
}

}  // namespace
}  // namespace vantage
