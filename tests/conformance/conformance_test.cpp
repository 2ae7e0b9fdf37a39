// SPDX-License-Identifier: Apache-2.0
// Behaviour that all engines share, on every device of this machine.
#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <map>
#include <memory>
#include <numeric>
#include <random>
#include <stop_token>
#include <tuple>

#include "conformance/agreement.hpp"
#include "conformance/engines_under_test.hpp"
#include "conformance/sites.hpp"
#include "core/normal_table.hpp"
#include "core/philox.hpp"
#include "scan/noise_model.hpp"
#include "support/expect_counts.hpp"
#include "support/reference_counts.hpp"
#include "trace/registration_sums.hpp"

namespace vantage::test {
namespace {

constexpr double goal_density = 12.5;
float bits_apart(float a, float b) {
  return std::bit_cast<std::uint32_t>(a) == std::bit_cast<std::uint32_t>(b) ? 0.0f : 1.0f;
}

class Conformance : public testing::TestWithParam<EngineUnderTest> {
 protected:
  static std::unique_ptr<Tracer> make(const TestSite& site, bool noisy, std::uint64_t max_rays = 0) {
    TraceScene scene = site.trace_scene(noisy);
    scene.max_rays_per_dispatch = max_rays;
    auto tracer = GetParam().make(scene);
    tracer->set_goal_density(goal_density);
    return tracer;
  }

  using Tracers = std::map<std::tuple<std::string, std::string, bool>, std::unique_ptr<Tracer>>;
  static Tracers& tracers() {
    static Tracers made;
    return made;
  }
  static void TearDownTestSuite() { tracers().clear(); }  // before drivers and layers are torn down

  // Kept from test to test, since building an engine costs more than most tests.
  static Tracer& tracer(const TestSite& site, bool noisy) {
    auto& kept = tracers()[{GetParam().name, site.name, noisy}];
    if (!kept) kept = make(site, noisy);
    return *kept;
  }

  static Tracer::RawChunk scan(const TestSite& site, bool noisy, std::size_t station,
                               std::uint32_t outputs = all_outputs) {
    Tracer::RawChunk chunk;
    tracer(site, noisy).scan(site.stations[station], 0, site.rays(), outputs, chunk);
    return chunk;
  }

  static std::uint32_t stations_of(const TestSite& site) { return static_cast<std::uint32_t>(site.stations.size()); }

  static NetworkCounts count(const TestSite& site, bool noisy, const Tracer::CountOptions& options) {
    return tracer(site, noisy).count(site.stations, stations_of(site), options, {});
  }
};

// Scans.

TEST_P(Conformance, ScansMatchADoublePrecisionReference) {
  for (const TestSite& site : sites()) {
    for (const bool noisy : {false, true}) {
      std::size_t undecided = 0, rays = 0;
      for (std::size_t s = 0; s < site.stations.size(); ++s) {
        SCOPED_TRACE(site.name + ", station " + std::to_string(s) + (noisy ? ", noise" : ""));
        const std::vector<ReferenceHit>& reference = site.reference(s, noisy);
        compare_with_reference(*site.scene, reference, scan(site, noisy, s), undecided);
        rays += reference.size();
        if (HasFailure()) return;
      }
      EXPECT_LE(static_cast<double>(undecided), most_undecided(rays)) << site.name;
      RecordProperty(site.name + (noisy ? "_noisy" : ""), static_cast<int>(undecided));
    }
  }
}

// At several times the site's size, rounding is larger than anywhere on the site.
TEST_P(Conformance, StationsFarOffAreNoLessExact) {
  const TestSite& site = sites()[2];
  const std::vector<TraceStation> far{{{41, 3, 2}, 0}, {{-5, -44, 9}, 1}};
  static const std::vector<std::vector<ReferenceHit>> references = [&] {
    const ReferenceTracer reference(site.trace_scene(false));
    return std::vector{reference.scan(far[0]), reference.scan(far[1])};
  }();
  for (std::size_t s = 0; s < far.size(); ++s) {
    SCOPED_TRACE("station " + std::to_string(s));
    Tracer::RawChunk chunk;
    tracer(site, false).scan(far[s], 0, site.rays(), all_outputs, chunk);
    EXPECT_GT(std::ranges::count_if(chunk.range, [](float range) { return std::isfinite(range); }), 20);
    std::size_t undecided = 0;
    compare_with_reference(*site.scene, references[s], chunk, undecided);
    EXPECT_LE(undecided, 2u);
  }
  PassField all, skipping;
  tracer(site, false).count(far, 2, {true, false, &all}, {});
  tracer(site, false).count(far, 2, {true, true, &skipping}, {});
  EXPECT_EQ(skipping.count, all.count);
  EXPECT_EQ(skipping.stations, all.stations);
}

TEST_P(Conformance, BarycentricWeightsGiveThePoint) {
  const TestSite& site = sites()[2];
  const Tracer::RawChunk chunk = scan(site, false, 0);
  std::size_t hits = 0;
  for (std::size_t k = 0; k < chunk.primitive.size(); ++k) {
    if (chunk.primitive[k] == ReferenceHit::none) continue;
    ++hits;
    const auto p = site.scene->corners(chunk.primitive[k]);
    const double u = chunk.barycentric[k].x, v = chunk.barycentric[k].y;
    const auto mix = [&](auto member) { return (1 - u - v) * p[0].*member + u * p[1].*member + v * p[2].*member; };
    ASSERT_NEAR(mix(&Float3::x), chunk.position[k].x, 1e-4) << "ray " << k;
    ASSERT_NEAR(mix(&Float3::y), chunk.position[k].y, 1e-4) << "ray " << k;
    ASSERT_NEAR(mix(&Float3::z), chunk.position[k].z, 1e-4) << "ray " << k;
  }
  EXPECT_GT(hits, site.rays() / 16);
}

// Points are computed from range, origin and direction without contraction: equal bits on every device.
TEST_P(Conformance, PositionsAreRangeTimesDirectionToTheBit) {
  const TestSite& site = sites()[2];
  const RayPattern& pattern = *site.pattern;
  for (const bool noisy : {false, true}) {
    const Tracer::RawChunk chunk = scan(site, noisy, 1);
    float apart = 0;
    for (std::size_t k = 0; k < chunk.range.size(); ++k) {
      if (!std::isfinite(chunk.range[k])) continue;
      const std::size_t i = k / pattern.columns(), j = k % pattern.columns();
      const Float3 d{pattern.sin_zenith[i] * pattern.cos_azimuth[j], pattern.sin_zenith[i] * pattern.sin_azimuth[j],
                     pattern.cos_zenith[i]};
      const Float3& o = site.stations[1].origin;
      apart += bits_apart(chunk.position[k].x, o.x + chunk.range[k] * d.x) +
               bits_apart(chunk.position[k].y, o.y + chunk.range[k] * d.y) +
               bits_apart(chunk.position[k].z, o.z + chunk.range[k] * d.z);
      if (chunk.voxel[k] != kNoVoxel) {
        ASSERT_EQ(chunk.voxel[k], site.grid->index_of(chunk.position[k])) << "ray " << k;
      }
    }
    EXPECT_EQ(apart, 0);
  }
}

TEST_P(Conformance, NoiseIsKeyedByRayAndPlace) {
  const TestSite& site = sites()[2];
  const Tracer::RawChunk clean = scan(site, false, 0), noisy = scan(site, true, 0);
  std::size_t moved = 0;
  for (std::size_t k = 0; k < clean.range.size(); ++k) {
    ASSERT_EQ(clean.primitive[k], noisy.primitive[k]) << "noise must not change what is hit";
    if (!std::isfinite(clean.range[k])) continue;
    const std::uint32_t bits = philox4x32(site.noise->seed, {static_cast<std::uint32_t>(k), 0, 0, noise_stream})[0];
    const double expected =
        normal_from_bits(bits, normal_table()) * model_sigma(*site.noise, clean.range[k], clean.reflectivity[k]);
    ASSERT_NEAR(noisy.range[k] - clean.range[k], expected, 2e-6) << "ray " << k;
    moved += noisy.range[k] != clean.range[k];
  }
  EXPECT_GT(moved, site.rays() / 16);

  TraceStation elsewhere = site.stations[0];
  elsewhere.place = 5;
  Tracer::RawChunk other;
  tracer(site, true).scan(elsewhere, 0, site.rays(), Tracer::range, other);
  std::size_t differing = 0;
  for (std::size_t k = 0; k < other.range.size(); ++k) differing += other.range[k] != noisy.range[k];
  EXPECT_GT(differing, moved / 2);
}

// Bitwise, since a ray without a hit has NaNs, which compare unequal.
template <typename T>
bool same_bits(const T* a, const T* b, std::size_t n) {
  return std::memcmp(a, b, n * sizeof(T)) == 0;
}

// Calls visit(output, a's array, b's array, name) for every output of a scan.
template <typename Visit>
void for_each_output(const Tracer::RawChunk& a, const Tracer::RawChunk& b, const Visit& visit) {
  visit(Tracer::range, a.range, b.range, "range");
  visit(Tracer::position, a.position, b.position, "position");
  visit(Tracer::normal, a.normal, b.normal, "normal");
  visit(Tracer::reflectivity, a.reflectivity, b.reflectivity, "reflectivity");
  visit(Tracer::primitive, a.primitive, b.primitive, "primitive");
  visit(Tracer::barycentric, a.barycentric, b.barycentric, "barycentric");
  visit(Tracer::voxel, a.voxel, b.voxel, "voxel");
}

void expect_same(const Tracer::RawChunk& part, const Tracer::RawChunk& whole, std::size_t first, std::size_t n) {
  for_each_output(part, whole, [&](std::uint32_t, const auto& a, const auto& b, const char* name) {
    ASSERT_EQ(a.size(), n) << name;
    EXPECT_TRUE(same_bits(a.data(), b.data() + first, n)) << name << " from ray " << first;
  });
}

// Expects `one` to have `output` as `whole` has it, and nothing else.
void expect_only(std::uint32_t output, const Tracer::RawChunk& one, const Tracer::RawChunk& whole) {
  for_each_output(one, whole, [&](std::uint32_t bit, const auto& got, const auto& expected, const char* name) {
    if (bit == output) {
      ASSERT_EQ(got.size(), expected.size()) << name;
      EXPECT_TRUE(same_bits(got.data(), expected.data(), got.size())) << name;
    } else {
      EXPECT_TRUE(got.empty()) << name << " was made for output " << output;
    }
  });
}

TEST_P(Conformance, ChunksOfAnySizeGiveTheSameScan) {
  const TestSite& site = sites()[2];
  const Tracer::RawChunk whole = scan(site, true, 2);
  const std::uint64_t columns = site.pattern->columns(), rows = site.pattern->rows();
  Tracer::RawChunk part;
  for (const std::uint64_t row : {std::uint64_t{0}, rows / 2 + 3, rows - 1}) {
    tracer(site, true).scan(site.stations[2], row * columns, columns, all_outputs, part);
    expect_same(part, whole, row * columns, columns);
  }
  for (std::uint64_t row = 0; row < rows; row += 23) {
    const std::uint64_t n = std::min<std::uint64_t>(23, rows - row);
    tracer(site, true).scan(site.stations[2], row * columns, n * columns, all_outputs, part);
    expect_same(part, whole, row * columns, n * columns);
  }
  const std::uint64_t preferred = tracer(site, true).preferred_scan_rays(0);
  EXPECT_GT(preferred, 0u);
  EXPECT_EQ(preferred % columns, 0u);
}

TEST_P(Conformance, OnlyTheOutputsAskedForAreMade) {
  const TestSite& site = sites()[2];
  for (const bool noisy : {false, true}) {
    const Tracer::RawChunk whole = scan(site, noisy, 0);
    for (std::uint32_t output = 1; output < all_outputs; output <<= 1)
      expect_only(output, scan(site, noisy, 0, output), whole);
  }
}

TEST_P(Conformance, ANewEngineCanBeAskedForAnyOutputFirst) {
  const TestSite& site = sites()[2];
  const std::uint64_t rays = 40 * site.pattern->columns(), first = 80 * site.pattern->columns();
  Tracer::RawChunk all;
  tracer(site, false).scan(site.stations[0], first, rays, all_outputs, all);
  for (std::uint32_t output = 1; output < all_outputs; output <<= 1) {
    Tracer::RawChunk one;
    make(site, false)->scan(site.stations[0], first, rays, output, one);
    expect_only(output, one, all);
  }
}

// Exact counts.

TEST_P(Conformance, CountsAreThePointsOfTheScans) {
  for (const TestSite& site : sites()) {
    for (const bool noisy : {false, true}) {
      SCOPED_TRACE(site.name + (noisy ? ", noise" : ""));
      PassField expected;
      expected.count.resize(site.grid->size());
      expected.stations.resize(site.grid->size());
      std::vector<std::uint64_t> points, on_surveyed;
      for (std::size_t s = 0; s < site.stations.size(); ++s) {
        const Tracer::RawChunk chunk = scan(site, noisy, s, Tracer::voxel | Tracer::primitive);
        points.push_back(static_cast<std::uint64_t>(std::count_if(
            chunk.primitive.begin(), chunk.primitive.end(), [](std::uint32_t p) { return p != ReferenceHit::none; })));
        on_surveyed.push_back(0);
        for (const std::uint32_t voxel : chunk.voxel) {
          if (voxel == kNoVoxel) continue;
          ++expected.count[voxel];
          expected.stations[voxel] |= std::uint64_t{1} << s;
          ++on_surveyed.back();
        }
      }
      for (const bool masks : {true, false}) {
        PassField field;
        const NetworkCounts counts = count(site, noisy, {masks, false, &field});
        EXPECT_EQ(field.count, expected.count);
        EXPECT_EQ(field.stations, masks ? expected.stations : std::vector<std::uint64_t>{});
        EXPECT_EQ(counts.points, points);
        EXPECT_EQ(counts.points_on_surveyed, on_surveyed);
        EXPECT_EQ(counts.rays, site.rays() * site.stations.size());
        EXPECT_FALSE(counts.cancelled);
        expect_equal_counts(counts, reference_counts(field, stations_of(site), goal_density, site.grid->demands()));
      }
    }
  }
}

TEST_P(Conformance, TotalsMatchTheReference) {
  for (const TestSite& site : sites()) {
    SCOPED_TRACE(site.name);
    PassField expected;
    expected.count.resize(site.grid->size());
    double points = 0, on_surveyed = 0;
    for (std::size_t s = 0; s < site.stations.size(); ++s) {
      for (const ReferenceHit& hit : site.reference(s, true)) {
        points += hit.triangle != ReferenceHit::none;
        on_surveyed += hit.voxel != kNoVoxel;
        if (hit.voxel != kNoVoxel) ++expected.count[hit.voxel];
      }
    }
    const NetworkCounts counts = count(site, true, {false, false, nullptr});
    const auto total = [](const std::vector<std::uint64_t>& v) {
      return static_cast<double>(std::accumulate(v.begin(), v.end(), std::uint64_t{0}));
    };
    EXPECT_NEAR(total(counts.points), points, 1e-4 * points);
    EXPECT_NEAR(total(counts.points_on_surveyed), on_surveyed, 1e-4 * on_surveyed);
    const double reached =
        coverage(reference_counts(expected, stations_of(site), goal_density, site.grid->demands()), goal_density);
    EXPECT_NEAR(coverage(counts, goal_density), reached, 1e-4 * reached);
  }
}

TEST_P(Conformance, StationsKeepTheirPlaceInTheNetwork) {
  const TestSite& site = sites()[1];
  std::vector<TraceStation> stations{site.stations[0], site.stations[1]};
  stations[0].place = 63;
  stations[1].place = 2;
  PassField field;
  const NetworkCounts counts = tracer(site, false).count(stations, 64, {true, false, &field}, {});
  ASSERT_EQ(counts.points.size(), 64u);
  ASSERT_EQ(counts.seen.size(), 64u);
  ASSERT_EQ(counts.shared.size(), 64u * 63 / 2);
  for (std::uint32_t i = 0; i < 64; ++i) {
    EXPECT_EQ(counts.points[i] > 0, i == 63 || i == 2);
    EXPECT_EQ(counts.seen[i] > 0, i == 63 || i == 2);
  }
  expect_equal_counts(counts, reference_counts(field, 64, goal_density));
  const NetworkCounts none = tracer(site, false).count({}, 3, {true, true, nullptr}, {});
  EXPECT_EQ(none.seen, (std::vector<std::uint64_t>{0, 0, 0}));
  EXPECT_EQ(none.saturated + none.partial_points, 0u);
  EXPECT_EQ(none.voxels, site.grid->size());
}

TEST_P(Conformance, DispatchesOfAnySizeGiveTheSameCounts) {
  const TestSite& site = sites()[2];
  PassField whole, part;
  const NetworkCounts expected = count(site, true, {true, false, &whole});
  for (const std::uint64_t max_rays : {std::uint64_t{1}, std::uint64_t{7777}, site.rays() * 2}) {
    const auto small = make(site, true, max_rays);
    const NetworkCounts counts = small->count(site.stations, stations_of(site), {true, false, &part}, {});
    EXPECT_EQ(part.count, whole.count) << max_rays;
    EXPECT_EQ(part.stations, whole.stations) << max_rays;
    EXPECT_EQ(counts.points, expected.points);
    expect_equal_counts(counts, expected);
  }
}

TEST_P(Conformance, ACancelledCountSaysSoAndLeavesTheEngineWell) {
  const TestSite& site = sites()[2];
  const auto small = make(site, false, 20'000);
  std::vector<TraceStation> many;
  for (std::uint32_t i = 0; i < 40; ++i) many.push_back({site.stations[i % 3].origin, i});
  std::stop_source stop;
  double last = 0;
  bool ascending = true;
  const Progress progress{[&](double done) {
                            ascending &= done >= last;
                            last = done;
                            if (done > 0.1) stop.request_stop();
                          },
                          stop.get_token()};
  const NetworkCounts cut = small->count(many, 40, {true, true, nullptr}, progress);
  EXPECT_TRUE(cut.cancelled);
  EXPECT_TRUE(ascending);
  EXPECT_GT(last, 0.1);
  EXPECT_LT(last, 0.9);  // well before the end: several devices continue until this thread, which listens to them, gets
                         // its turn
  PassField again, expected;
  const NetworkCounts after = small->count(site.stations, stations_of(site), {true, false, &again}, {});
  EXPECT_FALSE(after.cancelled);
  count(site, false, {true, false, &expected});
  EXPECT_EQ(again.count, expected.count);
  EXPECT_EQ(again.stations, expected.stations);
}

// Skipping.

// Random heads inside and outside the site, some of them within a surveyed brick.
std::vector<TraceStation> random_stations(const TestSite& site, std::uint32_t n, std::uint64_t seed) {
  RandomStream random(seed);
  const Box& box = site.scene->local_bounds;
  const Vec3 size = box.size();
  std::vector<TraceStation> stations;
  for (std::uint32_t i = 0; i < n; ++i) {
    Vec3 p{box.min.x + size.x * (1.4 * random.uniform() - 0.2), box.min.y + size.y * (1.4 * random.uniform() - 0.2),
           box.min.z + size.z * (1.4 * random.uniform() - 0.2)};
    if (i % 4 == 3) {  // a few voxels off a surveyed surface
      const auto cell = morton_decode(
          site.grid->key(static_cast<std::uint64_t>(random.uniform() * static_cast<double>(site.grid->size()))));
      const auto at = [&](int axis) {
        return site.grid->min()[axis] + (cell[axis] + 0.5 + 3 * random.uniform()) * site.grid->voxel_size();
      };
      p = {at(0), at(1), at(2)};
    }
    stations.push_back({{static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z)}, i});
  }
  return stations;
}

TEST_P(Conformance, SkippingChangesNoVoxel) {
  for (const TestSite& site : sites()) {
    std::vector<TraceStation> stations = random_stations(site, 12, 99);
    for (const TraceStation& station : site.stations)
      stations.push_back({station.origin, static_cast<std::uint32_t>(stations.size())});
    const auto n = static_cast<std::uint32_t>(stations.size());
    for (const bool noisy : {false, true}) {
      SCOPED_TRACE(site.name + (noisy ? ", noise" : ""));
      PassField all, skipped;
      const NetworkCounts expected = tracer(site, noisy).count(stations, n, {true, false, &all}, {});
      const NetworkCounts counts = tracer(site, noisy).count(stations, n, {true, true, &skipped}, {});
      EXPECT_EQ(skipped.count, all.count);
      EXPECT_EQ(skipped.stations, all.stations);
      EXPECT_EQ(counts.points_on_surveyed, expected.points_on_surveyed);
      EXPECT_TRUE(counts.points.empty());
      // Each point that counts comes from a ray.
      EXPECT_GE(counts.rays, std::reduce(counts.points_on_surveyed.begin(), counts.points_on_surveyed.end()));
      EXPECT_LT(counts.rays, expected.rays);
      expect_equal_counts(counts, expected);
    }
  }
}

// Samples.

// Counts of a sample by definition, from the voxel field of the exact evaluation.
NetworkCounts sampled_slowly(const TestSite& site, const PassField& field, const Tracer::SampleJob& job,
                             std::uint32_t stations) {
  PassField sample;
  const auto pick = [&](std::size_t first, std::size_t step) {
    sample = {};
    std::vector<std::uint32_t> voxel_indices;
    for (std::size_t i = first; i < job.sample.size(); i += step) {
      sample.count.push_back(field.count[job.sample[i]]);
      if (job.masks) sample.stations.push_back(field.stations[job.sample[i]]);
      voxel_indices.push_back(job.sample[i]);
    }
    return reference_counts(sample, stations, goal_density, site.grid->demands().of(voxel_indices));
  };
  std::vector<NetworkCounts> groups;
  for (std::uint32_t g = 0; g < job.groups; ++g) groups.push_back(pick(g, job.groups));
  NetworkCounts counts = pick(0, 1);
  counts.groups = std::move(groups);
  if (job.groups == 0) {
    counts.successive_difference_sum = std::numeric_limits<double>::infinity();
    return counts;
  }
  const VoxelDemands& demands = site.grid->demands();
  const auto filled = [&](std::size_t i) {
    return std::min(1.0 * sample.count[i] * demands.point_weight(job.sample[i]) / (goal_density * counts.point_weight),
                    1.0);
  };
  for (std::size_t i = 1; i < sample.count.size(); ++i) {
    const double step = filled(i) - filled(i - 1);
    counts.successive_difference_sum += step * step;
  }
  return counts;
}

void expect_equal_samples(const NetworkCounts& got, const NetworkCounts& expected) {
  expect_equal_counts(got, expected);
  if (std::isinf(expected.successive_difference_sum)) {
    EXPECT_EQ(got.successive_difference_sum, expected.successive_difference_sum);
  } else {
    EXPECT_NEAR(got.successive_difference_sum, expected.successive_difference_sum,
                1e-9 * (1 + expected.successive_difference_sum));
  }
  ASSERT_EQ(got.groups.size(), expected.groups.size());
  for (std::size_t g = 0; g < got.groups.size(); ++g) {
    SCOPED_TRACE("group " + std::to_string(g));
    expect_equal_counts(got.groups[g], expected.groups[g]);
  }
}

// Returns every `step`-th voxel from `first` on, below `end`.
std::vector<std::uint32_t> every(std::uint32_t step, std::uint32_t first, std::uint32_t end) {
  std::vector<std::uint32_t> voxels;
  for (std::uint32_t voxel = first; voxel < end; voxel += step) voxels.push_back(voxel);
  return voxels;
}

// Each voxel is its own group, so groups are voxels.
Tracer::SampleJob voxel_by_voxel(std::span<const std::uint32_t> sample, bool masks) {
  return {sample, static_cast<std::uint32_t>(sample.size()), masks, 0};
}

TEST_P(Conformance, ASampleOfAllVoxelsIsTheExactEvaluation) {
  for (const TestSite& site : sites()) {
    std::vector<std::uint32_t> everything(site.grid->size());
    std::iota(everything.begin(), everything.end(), 0u);
    std::vector<std::vector<TraceStation>> networks{site.stations, random_stations(site, 8, 7)};
    const std::vector<std::uint32_t> sizes{4, 8};
    for (const bool noisy : {false, true}) {
      SCOPED_TRACE(site.name + (noisy ? ", noise" : ""));
      const Tracer::SampleJob job{everything, 20, true, 0};
      const std::vector<NetworkCounts> sampled = tracer(site, noisy).count_sampled(networks, sizes, job, {});
      ASSERT_EQ(sampled.size(), networks.size());
      for (std::size_t n = 0; n < networks.size(); ++n) {
        PassField field;
        const NetworkCounts exact = tracer(site, noisy).count(networks[n], sizes[n], {true, false, &field}, {});
        expect_equal_counts(sampled[n], exact);
        expect_equal_samples(sampled[n], sampled_slowly(site, field, job, sizes[n]));
      }
    }
  }
}

TEST_P(Conformance, EverySampledVoxelIsCountedAsTheExactEvaluationDoes) {
  for (const TestSite& site : sites()) {
    const std::vector<std::uint32_t> sample = every(29, 5, site.grid->size());
    const std::vector<std::vector<TraceStation>> networks{site.stations, random_stations(site, 6, 12)};
    const std::vector<std::uint32_t> sizes{4, 6};
    for (const bool noisy : {false, true}) {
      SCOPED_TRACE(site.name + (noisy ? ", noise" : ""));
      const Tracer::SampleJob job = voxel_by_voxel(sample, true);
      const auto sampled = tracer(site, noisy).count_sampled(networks, sizes, job, {});
      for (std::size_t n = 0; n < networks.size(); ++n) {
        PassField field;
        tracer(site, noisy).count(networks[n], sizes[n], {true, true, &field}, {});
        expect_equal_samples(sampled[n], sampled_slowly(site, field, job, sizes[n]));
      }
    }
  }
}

// Input of the coverage matrix: the points themselves, over any number of batches, and none of an interrupted count.
TEST_P(Conformance, PointsOfASampleAreThoseOfTheVoxelField) {
  for (const TestSite& site : sites()) {
    const std::vector<std::uint32_t> sample = every(3, 1, site.grid->size());
    std::vector<std::vector<TraceStation>> networks{site.stations, random_stations(site, 8, 7)};
    for (const TraceStation& station : site.stations) networks.push_back({{station.origin, 0}});
    const std::vector<std::uint32_t> sizes{4, 8, 1, 1, 1, 1};
    networks.resize(sizes.size());
    for (const bool noisy : {false, true}) {
      std::vector<PassField> fields(networks.size());
      for (std::size_t n = 0; n < networks.size(); ++n)
        tracer(site, noisy).count(networks[n], sizes[n], {false, true, &fields[n]}, {});
      for (const bool masks : {false, true}) {
        SCOPED_TRACE(site.name + (noisy ? ", noise" : "") + (masks ? ", masks" : ""));
        std::vector<std::vector<std::uint32_t>> points(networks.size());
        Tracer::SampleJob job{sample, 20, masks, 0};
        job.points = [&](std::size_t n, std::span<const std::uint32_t> of) {
          EXPECT_TRUE(points[n].empty()) << "network " << n << " was told of twice";
          points[n].assign(of.begin(), of.end());
        };
        tracer(site, noisy).count_sampled(networks, sizes, job, {});
        for (std::size_t n = 0; n < networks.size(); ++n) {
          std::vector<std::uint32_t> expected;
          for (const std::uint32_t voxel_index : sample) expected.push_back(fields[n].count[voxel_index]);
          EXPECT_EQ(points[n], expected) << "network " << n;
        }
      }
    }
  }
}

// Input of registration: the masks themselves, so that its sums are the same on every engine.
TEST_P(Conformance, StationMasksOfASampleAreThoseOfTheVoxelField) {
  for (const TestSite& site : sites()) {
    const std::vector<std::uint32_t> sample = every(3, 2, site.grid->size());
    const std::vector<std::vector<TraceStation>> networks{site.stations, random_stations(site, 40, 7)};
    const std::vector<std::uint32_t> sizes{4, 40};
    std::vector<std::vector<std::uint64_t>> masks(networks.size());
    Tracer::SampleJob job{sample, 20, true, 0};
    job.station_masks = [&](std::size_t first, std::span<const std::uint64_t> of) {
      for (std::size_t k = 0; k < of.size() / sample.size(); ++k) {
        const auto own = of.subspan(k * sample.size(), sample.size());
        masks[first + k].assign(own.begin(), own.end());
      }
    };
    tracer(site, false).count_sampled(networks, sizes, job, {});
    for (std::size_t n = 0; n < networks.size(); ++n) {
      PassField field;
      tracer(site, false).count(networks[n], sizes[n], {true, true, &field}, {});
      std::vector<std::uint64_t> expected;
      for (const std::uint32_t voxel_index : sample) expected.push_back(field.stations[voxel_index]);
      EXPECT_EQ(masks[n], expected) << site.name << ", network " << n;
    }
  }
}

// The sums themselves, to the last bit: of few stations and many, some pairs of which share nothing.
TEST_P(Conformance, RegistrationSumsAreThoseOfTheStationMasks) {
  for (const TestSite& site : sites()) {
    const std::vector<std::uint32_t> sample = every(17, 0, std::min<std::uint32_t>(site.grid->size(), 30'000));
    std::vector<std::vector<TraceStation>> networks{
        site.stations, random_stations(site, 40, 7), {site.stations[0]}, random_stations(site, 17, 8)};
    networks[0].erase(networks[0].begin() + 1);  // an inactive station keeps its place
    const std::vector<std::uint32_t> sizes{static_cast<std::uint32_t>(site.stations.size()), 40, 1, 17};
    SurfaceFinder surfaces(*site.scene, *site.grid);
    const auto patches = std::make_shared<const Patches>(make_patches(surfaces, *site.grid, sample, *site.pattern, {}));
    for (const auto& [noisy, groups] : {std::pair{false, false}, {true, false}, {true, true}}) {
      SCOPED_TRACE(site.name + (noisy ? ", noise" : "") + (groups ? ", groups" : ""));
      PatchScanner scanner{.noise = noisy ? site.noise : site.no_noise};
      if (noisy) scanner.angle = 7e-5f, scanner.offset_m = 1e-3f, scanner.scale = 1e-5f, scanner.range_m = 50;
      const RegistrationJob registration{patches, {scanner}, groups};
      std::vector<std::vector<std::uint64_t>> masks(networks.size());
      Tracer::SampleJob job{sample, 20, true, 0};
      job.station_masks = [&](std::size_t first, std::span<const std::uint64_t> of) {
        for (std::size_t k = 0; k < of.size() / sample.size(); ++k) {
          const auto own = of.subspan(k * sample.size(), sample.size());
          masks[first + k].assign(own.begin(), own.end());
        }
      };
      job.registration = &registration;
      const auto counts = tracer(site, false).count_sampled(networks, sizes, job, {});
      bool any = false;
      for (std::size_t n = 0; n < networks.size(); ++n) {
        const auto expected = sum_patches(registration, networks[n], sizes[n], masks[n], 20);
        EXPECT_EQ(counts[n].registration.pairs, expected[0].pairs) << n;
        EXPECT_EQ(counts[n].registration.surface, expected[0].surface) << n;
        EXPECT_EQ(counts[n].registration.instrument, expected[0].instrument) << n;
        EXPECT_EQ(expected[0].instrument.empty(), !noisy) << n;
        EXPECT_EQ(counts[n].registration.heads.size(), sizes[n]);
        for (std::size_t g = 0; groups && g < 20; ++g)
          EXPECT_EQ(counts[n].registration.groups[g].pairs, expected[g + 1].pairs) << n << ' ' << g;
        for (std::size_t g = 0; groups && g < 20; ++g)
          EXPECT_EQ(counts[n].registration.groups[g].instrument, expected[g + 1].instrument) << n << ' ' << g;
        any = any || std::ranges::any_of(expected[0].pairs, [](double sum) { return sum != 0; });
      }
      EXPECT_TRUE(any);
    }
  }
}

// Many scanners in one place: once the first saturate a voxel, the others need not look at it.
TEST_P(Conformance, SamplesStopAtTheGoalOnlyWhereAsked) {
  const TestSite& site = sites()[2];
  const std::vector<std::uint32_t> sample = every(7, 0, site.grid->size());
  std::vector<std::vector<TraceStation>> networks(1);
  for (std::uint32_t place = 0; place < 32; ++place) networks[0].push_back({site.stations[0].origin, place});
  const std::vector<std::uint32_t> sizes{32};
  // Dispatches so short that the scanners come one after another on any device.
  const auto tracer = make(site, true, 5000);
  const auto count = [&](bool masks, std::uint32_t stop_at) {
    const Tracer::SampleJob job{sample, 20, masks, stop_at};
    return tracer->count_sampled(networks, sizes, job, {})[0];
  };
  const auto goal = static_cast<std::uint32_t>(std::ceil(goal_density));
  for (const bool masks : {false, true}) {
    SCOPED_TRACE(masks ? "masks" : "no masks");
    const NetworkCounts whole = count(masks, 0), stopping = count(masks, goal);
    expect_equal_samples(stopping, whole);
    EXPECT_EQ(whole.seen.empty(), !masks);
    EXPECT_GT(whole.saturated, 0u);
    // The stations that see a voxel are known only after every station was traced.
    EXPECT_LT(static_cast<double>(stopping.rays), (masks ? 1.01 : 0.8) * static_cast<double>(whole.rays))
        << "rays were traced for voxels that need no more";
  }
}

// Near and far, full and not, half hidden and oblique: rays left out must not show.
TEST_P(Conformance, WhatAStoppedSampleLeavesOutDoesNotShow) {
  for (const TestSite& site : sites()) {
    const std::vector<std::uint32_t> sample = every(13, 2, site.grid->size());
    const std::vector<std::vector<TraceStation>> networks{site.stations, random_stations(site, 12, 21)};
    const std::vector<std::uint32_t> sizes{4, 12};
    for (const bool noisy : {false, true}) {
      Tracer& engine = tracer(site, noisy);
      for (const double goal : {2.2, goal_density}) {
        SCOPED_TRACE(site.name + (noisy ? ", noise" : "") + ", goal " + std::to_string(goal));
        engine.set_goal_density(goal);
        const auto stop_at = static_cast<std::uint32_t>(std::ceil(goal));
        for (const bool masks : {false, true}) {
          const auto whole = engine.count_sampled(networks, sizes, {sample, 20, masks, 0}, {});
          const auto stopped = engine.count_sampled(networks, sizes, {sample, 20, masks, stop_at}, {});
          const auto searched = engine.count_sampled(networks, sizes, {sample, 0, masks, stop_at}, {});
          for (std::size_t n = 0; n < networks.size(); ++n) {
            SCOPED_TRACE("network " + std::to_string(n));
            expect_equal_samples(stopped[n], whole[n]);
            expect_equal_counts(searched[n], whole[n]);
            EXPECT_TRUE(searched[n].groups.empty() && std::isinf(searched[n].successive_difference_sum));
            // More rays may be traced for hidden voxels, but not many more.
            EXPECT_LE(static_cast<double>(stopped[n].rays), 1.1 * static_cast<double>(whole[n].rays));
          }
        }
      }
      engine.set_goal_density(goal_density);
    }
  }
}

TEST_P(Conformance, SamplesDoNotDependOnOrderOrDispatches) {
  const TestSite& site = sites()[2];
  const std::vector<std::uint32_t> sample = every(31, 3, site.grid->size());
  std::vector<std::vector<TraceStation>> networks;
  std::vector<std::uint32_t> sizes;
  for (std::uint32_t n = 0; n < 6; ++n) {
    networks.push_back(random_stations(site, 2 + n, 1000 + n));
    sizes.push_back(2 + n + n % 2);  // one more than is active
  }
  networks.emplace_back();  // all in holes
  sizes.push_back(5);
  const Tracer::SampleJob job{sample, 20, true, 0};
  const auto all = tracer(site, true).count_sampled(networks, sizes, job, {});
  ASSERT_EQ(all.size(), networks.size());
  EXPECT_EQ(all.back().saturated + all.back().partial_points, 0u);

  std::vector<std::vector<TraceStation>> reversed(networks.rbegin(), networks.rend());
  std::vector<std::uint32_t> reversed_sizes(sizes.rbegin(), sizes.rend());
  for (const std::uint64_t max_rays : {1, 5000}) {
    const auto backwards = make(site, true, max_rays)->count_sampled(reversed, reversed_sizes, job, {});
    for (std::size_t n = 0; n < networks.size(); ++n) {
      SCOPED_TRACE("network " + std::to_string(n) + ", " + std::to_string(max_rays) + " rays");
      expect_equal_samples(backwards[networks.size() - 1 - n], all[n]);
      EXPECT_EQ(backwards[networks.size() - 1 - n].rays, all[n].rays);
    }
  }
  for (std::size_t n = 0; n < networks.size(); ++n) {
    SCOPED_TRACE("network " + std::to_string(n) + " alone");
    const auto alone = tracer(site, true).count_sampled({&networks[n], 1}, {&sizes[n], 1}, job, {});
    expect_equal_samples(alone[0], all[n]);
  }
}

// After many stations that see nothing, more pairs are open at once than a device has room for.
TEST_P(Conformance, SamplesDoNotDependOnWhatWasCountedBefore) {
  const TestSite& site = sites()[2];
  const std::vector<std::uint32_t> sample = every(7, 3, site.grid->size());
  std::vector<TraceStation> far = site.stations;
  for (TraceStation& station : far) station.origin.x += 1000;
  const std::vector<std::vector<TraceStation>> near_ones{site.stations}, far_ones{far};
  const std::vector<std::uint32_t> sizes{4};
  const Tracer::SampleJob job{sample, 20, true, 0};
  const auto small = make(site, true, 5000);
  for (int k = 0; k < 10; ++k) {
    const auto nothing = small->count_sampled(far_ones, sizes, job, {});
    EXPECT_EQ(nothing[0].saturated + nothing[0].partial_points, 0u);
  }
  const auto after = small->count_sampled(near_ones, sizes, job, {});
  const auto usual = tracer(site, true).count_sampled(near_ones, sizes, job, {});
  EXPECT_GT(usual[0].saturated + usual[0].partial_points, 0u);
  expect_equal_samples(after[0], usual[0]);
  EXPECT_EQ(after[0].rays, usual[0].rays);
}

// Tested by progress: a device reports every submission, and the first has one dispatch of rays if these are limited.
TEST_P(Conformance, SamplesKeepToTheLimitOfADispatch) {
  const TestSite& site = sites()[2];
  const std::vector<std::uint32_t> sample = every(31, 3, site.grid->size());
  const std::vector<std::vector<TraceStation>> networks{site.stations};
  const std::vector<std::uint32_t> sizes{4};
  const auto first_report = [&](std::uint64_t max_rays) {
    double first = 0;
    const Progress progress{[&](double done) {
                              if (first == 0) first = done;
                            },
                            {}};
    make(site, false, max_rays)->count_sampled(networks, sizes, {sample, 20, true, 0}, progress);
    return first;
  };
  const double limited = first_report(2000), unlimited = first_report(0);
  EXPECT_GT(unlimited, 0);
  EXPECT_LE(limited, unlimited);
  if (tracer(site, false).info().engine != Engine::embree) {  // Embree has no dispatches
    EXPECT_LT(limited, 0.5 * unlimited);
  }
}

INSTANTIATE_TEST_SUITE_P(Engines, Conformance, testing::ValuesIn(engines_under_test()),
                         [](const auto& instance) { return instance.param.name; });

// Engines of this machine.

TEST(Engines, ThisMachineHasThemAll) {
  for (const Engine engine : {Engine::embree, Engine::ray_query, Engine::compute_bvh}) {
    std::string refusals;
    bool usable = false;
    for (const EngineInfo& info : list_engines()) {
      if (info.engine != engine) continue;
      usable |= info.usable;
      refusals += "\n  " + (info.device.empty() ? "no device" : info.device) + ": " + info.reason;
    }
    EXPECT_TRUE(usable) << "no device runs " << to_string(engine)
                        << "; these tests need Vulkan with ray queries: install mesa-vulkan-drivers >= 24.1 (on Debian "
                           "12 from bookworm-backports)"
                        << refusals;
  }
}

TEST(Engines, OneIsTheDefault) {
  const std::vector<EngineInfo> engines = list_engines();
  EXPECT_EQ(std::count_if(engines.begin(), engines.end(),
                          [](const EngineInfo& info) { return info.chosen_by_default && info.usable; }),
            1);
}

}  // namespace
}  // namespace vantage::test
