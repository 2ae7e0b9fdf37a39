// SPDX-License-Identifier: Apache-2.0
// Several devices must give the same results as one, bit for bit, whatever happens to them.
#include "trace/spread/spread_tracer.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <cstring>
#include <stop_token>
#include <thread>

#include "support/expect_counts.hpp"
#include "support/trace_scenes.hpp"
#include "trace/embree/embree_tracer.hpp"
#include "vantage/error.hpp"

namespace vantage {
namespace {

constexpr double wanted = 40;
constexpr std::uint32_t all_outputs = Tracer::range | Tracer::position | Tracer::normal | Tracer::reflectivity |
                                      Tracer::primitive | Tracer::barycentric | Tracer::voxel;

// Fails for good at its n-th call, after the work, so that results of the call were already delivered. Takes its time.
class Frail : public Tracer {
 public:
  struct Manner {
    int fails_at = 0;  // 0: never
    Errc why = Errc::device_failure;
    int delay_ms = 0;
  };
  Frail(std::unique_ptr<Tracer> tracer, Manner manner) : tracer_(std::move(tracer)), manner_(manner) {}

  const EngineInfo& info() const override { return tracer_->info(); }
  void set_goal_density(double density) override { tracer_->set_goal_density(density); }
  std::uint64_t preferred_scan_rays(std::uint32_t scanner) const override {
    return tracer_->preferred_scan_rays(scanner);
  }
  void scan(const TraceStation& station, std::uint64_t first_ray, std::uint64_t ray_count, std::uint32_t outputs,
            RawChunk& chunk) override {
    tracer_->scan(station, first_ray, ray_count, outputs, chunk);
    live();
  }
  NetworkCounts count(std::span<const TraceStation> stations, std::uint32_t station_count, const CountOptions& options,
                      const Progress& progress) override {
    NetworkCounts counts = tracer_->count(stations, station_count, options, progress);
    live();
    return counts;
  }
  std::vector<NetworkCounts> count_sampled(std::span<const std::vector<TraceStation>> networks,
                                           std::span<const std::uint32_t> station_counts, const SampleJob& job,
                                           const Progress& progress) override {
    std::vector<NetworkCounts> counts = tracer_->count_sampled(networks, station_counts, job, progress);
    live();
    return counts;
  }

 private:
  void live() {
    std::this_thread::sleep_for(std::chrono::milliseconds(manner_.delay_ms));
    if (manner_.fails_at > 0 && ++calls_ >= manner_.fails_at) throw Error(manner_.why, "the cable is cut");
  }

  std::unique_ptr<Tracer> tracer_;
  Manner manner_;
  int calls_ = 0;
};

// Networks and voxels of each sampled count.
using Asked = std::vector<std::pair<std::size_t, std::size_t>>;

// Records its requests.
class Attentive final : public Frail {
 public:
  Attentive(std::unique_ptr<Tracer> tracer, Asked& asked) : Frail(std::move(tracer), {}), asked_(asked) {}
  std::vector<NetworkCounts> count_sampled(std::span<const std::vector<TraceStation>> networks,
                                           std::span<const std::uint32_t> station_counts, const SampleJob& job,
                                           const Progress& progress) override {
    asked_.emplace_back(networks.size(), job.sample.size());
    return Frail::count_sampled(networks, station_counts, job, progress);
  }

 private:
  Asked& asked_;
};

// Two walls at a corner, a screen in front of them, and several heads.
struct Site {
  TraceScene scene = test::trace_scene(
      test::SceneBuilder()
          .mesh(Role::surveyed, test::quad({-3, 3, 0}, {6, 0, 0}, {0, 0, 3}))
          .mesh(Role::surveyed, test::quad({3, -3, 0}, {0, 6, 0}, {0, 0, 3}))
          .mesh(Role::blocking, test::quad({1, 1, 0}, {1, -1, 0}, {0, 0, 2}))
          .finish(),
      {.azimuth_step = Angle::degrees(1), .zenith_step = Angle::degrees(1), .noise = rtc360_noise()}, 0.2);
  std::vector<std::vector<TraceStation>> networks;
  std::vector<std::uint32_t> sizes;
  std::vector<std::uint32_t> sample;

  Site() {
    RandomStream random(5);
    for (std::uint32_t n = 0; n < 23; ++n) {
      auto& network = networks.emplace_back();
      for (std::uint32_t place = 0; place < 2 + n % 5; ++place)
        network.push_back({{test::between(random, -2.5, 2.5), test::between(random, -2.5, 2.5), 1.5f}, place});
      sizes.push_back(static_cast<std::uint32_t>(network.size()));
    }
    for (std::uint32_t voxel_index = 0; voxel_index < scene.grid->size(); voxel_index += 3)
      sample.push_back(voxel_index);
  }
  std::unique_ptr<Tracer> one() const {
    auto tracer = make_embree_tracer(scene);
    tracer->set_goal_density(wanted);
    return tracer;
  }
  std::unique_ptr<SpreadTracer> several(const std::vector<Frail::Manner>& manners, WorkerPool::Warn warn = {},
                                        SpreadTracer::Options options = {
                                            .split = SpreadTracer::Split::always,
                                            .population = SpreadTracer::Population::by_voxels}) const {
    std::vector<std::unique_ptr<Tracer>> tracers;
    for (const Frail::Manner& manner : manners)
      tracers.push_back(std::make_unique<Frail>(make_embree_tracer(scene), manner));
    auto tracer = std::make_unique<SpreadTracer>(std::move(tracers), scene, std::move(warn), std::move(options));
    tracer->set_goal_density(wanted);
    return tracer;
  }
  std::uint64_t rays() const {
    return std::uint64_t{scene.scanners[0].pattern->rows()} * scene.scanners[0].pattern->columns();
  }
};

void expect_all_equal(const NetworkCounts& got, const NetworkCounts& expected) {
  test::expect_equal_counts(got, expected);
  EXPECT_EQ(got.rays, expected.rays);
  EXPECT_EQ(got.points, expected.points);
  EXPECT_EQ(got.points_on_surveyed, expected.points_on_surveyed);
  EXPECT_EQ(got.dropped, expected.dropped);
  EXPECT_EQ(got.successive_difference_sum, expected.successive_difference_sum);
  EXPECT_FALSE(got.cancelled);
  ASSERT_EQ(got.groups.size(), expected.groups.size());
  for (std::size_t g = 0; g < got.groups.size(); ++g) test::expect_equal_counts(got.groups[g], expected.groups[g]);
}

// All results of a tracer, with those delivered on the way.
struct Answers {
  Tracer::RawChunk scan;
  NetworkCounts exact;
  PassField field;
  std::vector<NetworkCounts> each, sampled, searched;
  std::vector<std::vector<std::uint32_t>> points;
  std::vector<std::vector<std::uint64_t>> masks;
};

Answers ask(Tracer& tracer, const Site& site) {
  Answers answers;
  const std::uint64_t columns = site.scene.scanners[0].pattern->columns();
  tracer.scan(site.networks[0][0], 10 * columns, site.rays() - 30 * columns, all_outputs, answers.scan);
  answers.exact = tracer.count(site.networks[4], site.sizes[4], {true, false, &answers.field}, {});
  answers.each = tracer.count_each(site.networks, site.sizes, {true, true, nullptr}, {});
  answers.points.resize(site.networks.size());
  answers.masks.resize(site.networks.size());
  const std::thread::id here = std::this_thread::get_id();
  Tracer::SampleJob job{site.sample, 20, true, 0};
  job.points = [&](std::size_t n, std::span<const std::uint32_t> of) {
    EXPECT_EQ(std::this_thread::get_id(), here);
    EXPECT_TRUE(answers.points[n].empty()) << "network " << n << " was told of twice";
    answers.points[n].assign(of.begin(), of.end());
  };
  job.station_masks = [&](std::size_t first, std::span<const std::uint64_t> of) {
    EXPECT_EQ(std::this_thread::get_id(), here);
    for (std::size_t k = 0; k < of.size() / site.sample.size(); ++k) {
      EXPECT_TRUE(answers.masks[first + k].empty()) << "network " << first + k << " was told of twice";
      const auto own = of.subspan(k * site.sample.size(), site.sample.size());
      answers.masks[first + k].assign(own.begin(), own.end());
    }
  };
  double told = 0;
  const Progress progress{.report =
                              [&](double done) {
                                EXPECT_EQ(std::this_thread::get_id(), here);
                                EXPECT_GE(done, told);
                                told = done;
                              },
                          .stop = {}};
  answers.sampled = tracer.count_sampled(site.networks, site.sizes, job, progress);
  EXPECT_DOUBLE_EQ(told, 1);
  told = 0;
  answers.searched = tracer.count_sampled(site.networks, site.sizes, {site.sample, 0, true, 0}, progress);
  EXPECT_DOUBLE_EQ(told, 1);
  return answers;
}

template <class T>
bool same_bits(const std::vector<T>& a, const std::vector<T>& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(T)) == 0;
}

void expect_same_answers(const Answers& got, const Answers& expected) {
  EXPECT_TRUE(same_bits(got.scan.range, expected.scan.range));
  EXPECT_TRUE(same_bits(got.scan.position, expected.scan.position));
  EXPECT_TRUE(same_bits(got.scan.normal, expected.scan.normal));
  EXPECT_TRUE(same_bits(got.scan.reflectivity, expected.scan.reflectivity));
  EXPECT_TRUE(same_bits(got.scan.primitive, expected.scan.primitive));
  EXPECT_TRUE(same_bits(got.scan.barycentric, expected.scan.barycentric));
  EXPECT_TRUE(same_bits(got.scan.voxel, expected.scan.voxel));
  expect_all_equal(got.exact, expected.exact);
  EXPECT_EQ(got.field.count, expected.field.count);
  EXPECT_EQ(got.field.stations, expected.field.stations);
  for (std::size_t n = 0; n < expected.each.size(); ++n) {
    SCOPED_TRACE("network " + std::to_string(n));
    expect_all_equal(got.each[n], expected.each[n]);
    expect_all_equal(got.sampled[n], expected.sampled[n]);
    // Except rays: which voxels are requested together may cost some, and changes no count.
    test::expect_equal_counts(got.searched[n], expected.searched[n]);
    EXPECT_FALSE(got.searched[n].cancelled);
    EXPECT_TRUE(got.searched[n].groups.empty());
    EXPECT_EQ(got.searched[n].successive_difference_sum, expected.searched[n].successive_difference_sum);
    EXPECT_EQ(got.points[n], expected.points[n]);
    EXPECT_EQ(got.masks[n], expected.masks[n]);
  }
}

class Populations : public testing::TestWithParam<SpreadTracer::Population> {};

TEST_P(Populations, AreGivenAsByOneDevice) {
  const Site site;
  const Answers expected = ask(*site.one(), site);
  EXPECT_GT(expected.exact.saturated, 0u);
  EXPECT_GT(expected.exact.partial_points, 0u);
  for (const std::vector<Frail::Manner>& manners : {std::vector<Frail::Manner>(1),
                                                    std::vector<Frail::Manner>(2),
                                                    std::vector<Frail::Manner>(3),
                                                    {{.delay_ms = 0}, {.delay_ms = 40}},
                                                    {{.delay_ms = 15}, {}, {.delay_ms = 3}}}) {
    SCOPED_TRACE(std::to_string(manners.size()) + " devices");
    const auto tracer = site.several(manners, {}, {.split = SpreadTracer::Split::always, .population = GetParam()});
    expect_same_answers(ask(*tracer, site), expected);
    expect_same_answers(ask(*tracer, site), expected);  // now that it knows each one's speed
  }
}

INSTANTIATE_TEST_SUITE_P(SpreadTracer, Populations,
                         testing::Values(SpreadTracer::Population::by_networks, SpreadTracer::Population::by_voxels),
                         [](const auto& of) {
                           return of.param == SpreadTracer::Population::by_voxels ? "ByVoxels" : "ByNetworks";
                         });

// Each worker has some voxels and all networks, or all voxels and some networks.
TEST(SpreadTracer, SplitsAPopulationAsItIsTold) {
  const Site site;
  for (const auto population : {SpreadTracer::Population::by_networks, SpreadTracer::Population::by_voxels}) {
    std::vector<std::unique_ptr<Tracer>> tracers;
    std::vector<Asked> asked(2);
    for (Asked& own : asked) tracers.push_back(std::make_unique<Attentive>(make_embree_tracer(site.scene), own));
    SpreadTracer tracer(std::move(tracers), site.scene, {}, {.population = population});
    tracer.count_sampled(site.networks, site.sizes, {site.sample, 0, true, 0}, {});
    const bool by_voxels = population == SpreadTracer::Population::by_voxels;
    for (const Asked& own : asked)
      for (const auto& [networks, voxels] : own) {
        EXPECT_EQ(networks == site.networks.size(), by_voxels);
        EXPECT_EQ(voxels == site.sample.size(), !by_voxels);
      }
    EXPECT_FALSE(asked[0].empty() && asked[1].empty());
  }
}

TEST(SpreadTracer, ANetworkIsSplitOnlyWhereThatPays) {
  const Site site;
  const auto tracer = site.several(std::vector<Frail::Manner>(2), {}, {.split = SpreadTracer::Split::where_it_pays});
  const Answers expected = ask(*site.one(), site);
  for (int round = 0; round < 3; ++round) expect_same_answers(ask(*tracer, site), expected);
}

TEST(SpreadTracer, WhatALostDeviceLeavesTheOthersDo) {
  const Site site;
  const Answers expected = ask(*site.one(), site);
  for (const Errc why : {Errc::device_failure, Errc::out_of_memory})
    for (int call = 1; call <= 9; ++call) {
      SCOPED_TRACE("fails at call " + std::to_string(call));
      std::vector<std::string> lines;
      const auto tracer = site.several({{.fails_at = call, .why = why}, {.delay_ms = 1}},
                                       [&](const std::string& line) { lines.push_back(line); });
      for (int round = 0; round < 3; ++round) expect_same_answers(ask(*tracer, site), expected);
      ASSERT_EQ(lines.size(), 1u);
      EXPECT_NE(lines[0].find("the cable is cut"), std::string::npos) << lines[0];
      EXPECT_NE(lines[0].find("embree on device 0"), std::string::npos) << lines[0];
      EXPECT_EQ(lines[0].find('\n'), std::string::npos);
    }
}

TEST(SpreadTracer, AllButOneMayBeLost) {
  const Site site;
  const Answers expected = ask(*site.one(), site);
  std::vector<std::string> lines;
  const auto tracer = site.several({{.fails_at = 4}, {.fails_at = 2}, {}, {.fails_at = 3}},
                                   [&](const std::string& line) { lines.push_back(line); });
  for (int round = 0; round < 4; ++round) expect_same_answers(ask(*tracer, site), expected);
  EXPECT_EQ(lines.size(), 3u);
}

TEST(SpreadTracer, TheLastOneLostIsAnError) {
  const Site site;
  const auto tracer = site.several({{.fails_at = 1}, {.fails_at = 1}});
  try {
    tracer->count_sampled(site.networks, site.sizes, {site.sample, 20, true, 0}, {});
    FAIL() << "there is no device left";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), Errc::device_failure);
    EXPECT_STREQ(error.what(), "the cable is cut");
  }
}

TEST(SpreadTracer, AnErrorThatIsNoDevicesIsThrown) {
  const Site site;
  int warned = 0;
  const auto tracer =
      site.several({{.fails_at = 2, .why = Errc::invalid_argument}, {}}, [&](const std::string&) { ++warned; });
  EXPECT_THROW(for (int k = 0; k < 3; ++k) tracer->count_each(site.networks, site.sizes, {true, true, nullptr}, {}),
               Error);
  EXPECT_EQ(warned, 0);
}

TEST(SpreadTracer, WhatACallbackThrowsComesOut) {
  const Site site;
  const auto tracer = site.several(std::vector<Frail::Manner>(3));
  Tracer::SampleJob job{site.sample, 20, true, 0};
  job.points = [](std::size_t n, std::span<const std::uint32_t>) {
    if (n == 7) throw std::runtime_error("seven");
  };
  EXPECT_THROW(tracer->count_sampled(site.networks, site.sizes, job, {}), std::runtime_error);
  expect_same_answers(ask(*tracer, site), ask(*site.one(), site));
}

TEST(SpreadTracer, StoppedHalfWayItSaysSoAndIsWell) {
  const Site site;
  const auto tracer = site.several(std::vector<Frail::Manner>(2));
  std::stop_source stop;
  const Progress progress{.report =
                              [&](double done) {
                                if (done > 0.2) stop.request_stop();
                              },
                          .stop = stop.get_token()};
  const auto each = tracer->count_each(site.networks, site.sizes, {true, true, nullptr}, progress);
  ASSERT_EQ(each.size(), site.networks.size());
  EXPECT_TRUE(each.back().cancelled);
  const auto sampled = tracer->count_sampled(site.networks, site.sizes, {site.sample, 20, true, 0}, progress);
  ASSERT_EQ(sampled.size(), site.networks.size());
  EXPECT_TRUE(sampled.front().cancelled);
  expect_same_answers(ask(*tracer, site), ask(*site.one(), site));
}

}  // namespace
}  // namespace vantage
