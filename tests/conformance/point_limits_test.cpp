// SPDX-License-Identifier: Apache-2.0
// Limits of points, which every engine must apply alike: by scan, by count, by sample, with and without skipping.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <numeric>
#include <tuple>

#include "conformance/agreement.hpp"
#include "conformance/engines_under_test.hpp"
#include "conformance/sites.hpp"
#include "support/expect_counts.hpp"
#include "support/reference_counts.hpp"

namespace vantage::test {
namespace {

constexpr double goal_density = 12.5;
// Relatively closer than this to a limit, rounding may decide differently, as at edges and faces.
constexpr double undecided_part = 1e-5;

class PointLimitsConformance : public testing::TestWithParam<EngineUnderTest> {
 protected:
  static std::unique_ptr<Tracer> make(const TraceScene& scene) {
    auto tracer = GetParam().make(scene);
    tracer->set_goal_density(goal_density);
    return tracer;
  }
  using Tracers = std::map<std::tuple<std::string, std::string, bool, bool>, std::unique_ptr<Tracer>>;
  static Tracers& tracers() {
    static Tracers made;
    return made;
  }
  static void TearDownTestSuite() { tracers().clear(); }

  static Tracer& tracer(const TestSite& site, bool noisy, bool limited = true) {
    auto& kept = tracers()[{GetParam().name, site.name, noisy, limited}];
    if (!kept) kept = make(site.trace_scene(noisy, limited));
    return *kept;
  }
  static std::uint32_t stations_of(const TestSite& site) { return static_cast<std::uint32_t>(site.stations.size()); }
};

TEST_P(PointLimitsConformance, ScansAndCountsMatchADoublePrecisionReference) {
  for (const TestSite& site : sites()) {
    for (const bool noisy : {false, true}) {
      SCOPED_TRACE(site.name + (noisy ? ", noise" : ""));
      PassField field;
      const NetworkCounts counts =
          tracer(site, noisy).count(site.stations, stations_of(site), {true, false, &field}, {});
      ASSERT_EQ(counts.dropped.size(), site.stations.size());
      PassField expected;
      expected.count.resize(site.grid->size());
      expected.stations.resize(site.grid->size());
      DroppedPoints all;
      std::size_t undecided = 0, rays = 0;
      for (std::size_t s = 0; s < site.stations.size(); ++s) {
        Tracer::RawChunk chunk;
        tracer(site, noisy).scan(site.stations[s], 0, site.rays(), Tracer::voxel, chunk);
        const std::vector<ReferenceHit>& reference = site.reference(s, noisy, true);
        DroppedPoints dropped;
        std::uint64_t counted = 0;
        for (std::size_t k = 0; k < reference.size(); ++k) {
          const ReferenceHit& hit = reference[k];
          dropped = dropped + hit.dropped;
          if (chunk.voxel[k] != hit.voxel) {
            ++undecided;
            EXPECT_TRUE(std::min(hit.edge_distance, hit.face_distance) < undecided_m ||
                        hit.limit_distance < undecided_part)
                << "ray " << k << " of station " << s << ", limit " << hit.limit_distance;
          }
          if (chunk.voxel[k] == kNoVoxel) continue;
          ++counted;
          ++expected.count[chunk.voxel[k]];
          expected.stations[chunk.voxel[k]] |= std::uint64_t{1} << s;
        }
        rays += reference.size();
        EXPECT_EQ(counts.points_on_surveyed[s], counted);
        const double slack = 3 + 1e-4 * static_cast<double>(dropped.points);
        EXPECT_NEAR(static_cast<double>(counts.dropped[s].points), static_cast<double>(dropped.points), slack);
        EXPECT_NEAR(static_cast<double>(counts.dropped[s].incidence), static_cast<double>(dropped.incidence), slack);
        EXPECT_NEAR(static_cast<double>(counts.dropped[s].footprint), static_cast<double>(dropped.footprint), slack);
        EXPECT_NEAR(static_cast<double>(counts.dropped[s].noise), static_cast<double>(dropped.noise), slack);
        EXPECT_NEAR(static_cast<double>(counts.dropped[s].echo), static_cast<double>(dropped.echo), slack);
        all = all + counts.dropped[s];
      }
      EXPECT_LE(static_cast<double>(undecided), most_undecided(rays));
      EXPECT_EQ(field.count, expected.count);
      EXPECT_EQ(field.stations, expected.stations);
      expect_equal_counts(counts, reference_counts(field, stations_of(site), goal_density, site.grid->demands()));
      // On these sites each limit drops points.
      EXPECT_GT(all.incidence, 100u);
      EXPECT_GT(all.footprint, 100u);
      EXPECT_GT(all.noise, 100u);
      EXPECT_GT(all.echo, 100u);
      EXPECT_LT(all.points, all.incidence + all.footprint + all.noise + all.echo);
    }
  }
}

TEST_P(PointLimitsConformance, WhatIsDroppedWouldHaveCounted) {
  for (const TestSite& site : sites()) {
    SCOPED_TRACE(site.name);
    const NetworkCounts limited =
                            tracer(site, true).count(site.stations, stations_of(site), {false, true, nullptr}, {}),
                        all = tracer(site, true, false)
                                  .count(site.stations, stations_of(site), {false, true, nullptr}, {});
    EXPECT_TRUE(all.dropped.empty());
    for (std::size_t s = 0; s < site.stations.size(); ++s)
      EXPECT_EQ(limited.points_on_surveyed[s] + limited.dropped[s].points, all.points_on_surveyed[s]);
  }
}

TEST_P(PointLimitsConformance, SkippingChangesNoVoxel) {
  for (const TestSite& site : sites()) {
    for (const bool noisy : {false, true}) {
      SCOPED_TRACE(site.name + (noisy ? ", noise" : ""));
      PassField all, skipped;
      const NetworkCounts expected =
                              tracer(site, noisy).count(site.stations, stations_of(site), {true, false, &all}, {}),
                          counts =
                              tracer(site, noisy).count(site.stations, stations_of(site), {true, true, &skipped}, {});
      EXPECT_EQ(skipped.count, all.count);
      EXPECT_EQ(skipped.stations, all.stations);
      EXPECT_EQ(counts.points_on_surveyed, expected.points_on_surveyed);
      EXPECT_EQ(counts.dropped, expected.dropped);
      EXPECT_LT(counts.rays, expected.rays);
      expect_equal_counts(counts, expected);
    }
  }
}

TEST_P(PointLimitsConformance, ASampleOfAllVoxelsIsTheExactEvaluation) {
  for (const TestSite& site : sites()) {
    std::vector<std::uint32_t> everything(site.grid->size());
    std::iota(everything.begin(), everything.end(), 0u);
    const std::vector<std::vector<TraceStation>> networks{site.stations};
    const std::vector<std::uint32_t> sizes{stations_of(site)};
    for (const bool noisy : {false, true}) {
      SCOPED_TRACE(site.name + (noisy ? ", noise" : ""));
      // Each voxel is its own group, so equal groups are equal voxels.
      const Tracer::SampleJob job{everything, static_cast<std::uint32_t>(everything.size()), true, 0};
      const auto sampled = tracer(site, noisy).count_sampled(networks, sizes, job, {});
      ASSERT_EQ(sampled.size(), 1u);
      EXPECT_TRUE(sampled[0].dropped.empty());
      PassField field;
      const NetworkCounts exact = tracer(site, noisy).count(site.stations, sizes[0], {true, true, &field}, {});
      expect_equal_counts(sampled[0], exact);
      std::size_t differing = 0;
      for (std::size_t v = 0; v < everything.size(); ++v) {
        const NetworkCounts& voxel = sampled[0].groups[v];
        const std::uint32_t count = field.count[v];
        const VoxelDemands& demands = site.grid->demands();
        const std::uint64_t weighted_points = std::uint64_t{count} * demands.point_weight(v);
        const bool full = static_cast<double>(weighted_points) >= goal_density * demands.least_point_weight();
        differing +=
            voxel.partial_points != (full ? 0 : weighted_points * demands.weight(v)) || (voxel.saturated > 0) != full;
      }
      EXPECT_EQ(differing, 0u);
    }
  }
}

// Limits that all points meet leave every bit as it is without them.
TEST_P(PointLimitsConformance, LimitsThatAllMeetChangeNothing) {
  const TestSite& site = sites()[2];
  LimitModel loose = *site.limits;
  for (LimitModel::Limits& limits : loose.meshes) limits = {};
  loose.lost_below = 0;
  for (const bool noisy : {false, true}) {
    TraceScene scene = site.trace_scene(noisy);
    scene.scanners[0].limits = std::make_shared<const LimitModel>(loose);
    const auto loosely = make(scene);
    PassField got, expected;
    const NetworkCounts counts = loosely->count(site.stations, stations_of(site), {true, true, &got}, {});
    tracer(site, noisy, false).count(site.stations, stations_of(site), {true, true, &expected}, {});
    EXPECT_EQ(got.count, expected.count);
    EXPECT_EQ(got.stations, expected.stations);
    EXPECT_EQ(counts.dropped, std::vector<DroppedPoints>(site.stations.size()));
  }
}

INSTANTIATE_TEST_SUITE_P(Engines, PointLimitsConformance, testing::ValuesIn(engines_under_test()),
                         [](const auto& instance) { return instance.param.name; });

}  // namespace
}  // namespace vantage::test
