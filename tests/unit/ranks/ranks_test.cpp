// SPDX-License-Identifier: Apache-2.0
// Several ranks must count what one counts, integer by integer.
#include <gtest/gtest.h>

#include <map>
#include <thread>

#include "local_transport.hpp"
#include "ranks/rank_tracers.hpp"
#include "ranks/remote_tracer.hpp"
#include "support/expect_counts.hpp"
#include "support/trace_scenes.hpp"
#include "trace/embree/embree_tracer.hpp"

namespace vantage::ranks {
namespace {

constexpr double goal = 40;
constexpr std::uint64_t fingerprint = 7;

TraceScene two_walls(double second_wall_m = 6) {
  return vantage::test::trace_scene(
      vantage::test::SceneBuilder()
          .mesh(Role::surveyed, vantage::test::quad({-3, 3, 0}, {6, 0, 0}, {0, 0, 3}))
          .mesh(Role::surveyed, vantage::test::quad({3, -3, 0}, {0, static_cast<float>(second_wall_m), 0}, {0, 0, 3}))
          .finish(),
      {.azimuth_step = Angle::degrees(1), .zenith_step = Angle::degrees(1), .noise = rtc360_noise()}, 0.2);
}

// Rank 0 and others in one process, each with its own tracer over `scenes[rank]`.
class Job {
 public:
  explicit Job(const std::vector<TraceScene>& scenes, std::vector<std::uint64_t> fingerprints = {}) {
    fingerprints.resize(scenes.size(), fingerprint);
    for (std::size_t k = 0; k < scenes.size(); ++k)
      transports_.push_back(std::make_unique<test::LocalTransport>(k, transports_));
    for (std::size_t k = 1; k < scenes.size(); ++k)
      others_.emplace_back([this, k, scene = scenes[k], print = fingerprints[k]] {
        Server server(*transports_[k], "host" + std::to_string(k), {});
        const auto tracer = Worker(server).make(make_embree_tracer(scene), scene, print);
        server.serve([] {});
        transports_[k]->close();
      });
    session_ = std::make_shared<Session>(*transports_[0]);
    first_ = std::make_unique<Coordinator>(
        session_, [this](const std::string& line) { told_ = line; },
        [this](const std::string& line) { warned_ += line; });
  }
  ~Job() {
    session_->end();
    others_.clear();
    transports_[0]->close();
  }

  std::unique_ptr<Tracer> tracer(const TraceScene& scene) {
    auto tracer = first_->make(make_embree_tracer(scene), scene, fingerprint);
    tracer->set_goal_density(goal);
    return tracer;
  }
  // Tracer of another rank, which does all the work.
  std::unique_ptr<Tracer> remote(const TraceScene& scene, std::uint32_t number = 0) {
    tracer(scene);
    auto there = std::make_unique<RemoteTracer>(session_, 1, number, EngineInfo{}, std::vector<std::uint64_t>{3600});
    there->set_goal_density(goal);
    return there;
  }
  std::size_t bytes(std::size_t rank) const { return transports_[rank]->bytes(); }
  const std::string& told() const { return told_; }
  const std::string& warned() const { return warned_; }

 private:
  std::vector<std::unique_ptr<test::LocalTransport>> transports_;
  std::vector<std::jthread> others_;
  std::shared_ptr<Session> session_;
  std::unique_ptr<Coordinator> first_;
  std::string told_, warned_;
};

// From nobody of this program: the server says so, and neither waits nor ends its process.
TEST(Ranks, AMessageWithoutAHeadEndsTheServer) {
  std::vector<std::unique_ptr<test::LocalTransport>> transports;
  for (int k = 0; k < 2; ++k) transports.push_back(std::make_unique<test::LocalTransport>(k, transports));
  {
    Server server(*transports[1], "host", {});
    transports[0]->send(1, Message());
    try {
      server.serve([] {});
      ADD_FAILURE() << "served";
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), Errc::device_failure);
    }
    transports[1]->close();
  }
}

struct Work {
  std::vector<std::vector<TraceStation>> networks;
  std::vector<std::uint32_t> sizes, sample;

  explicit Work(const TraceScene& scene) {
    RandomStream random(5);
    using vantage::test::between;
    for (std::uint32_t n = 0; n < 19; ++n) {
      auto& network = networks.emplace_back();
      for (std::uint32_t place = 0; place < 2 + n % 4; ++place)
        network.push_back({{between(random, -2.5, 2.5), between(random, -2.5, 2.5), 1.5f}, place});
      if (n % 3 == 0) network.front().turn = Turn{{0, -1, 0}, {1, 0, 0}, {0, 0, 1}};
      sizes.push_back(static_cast<std::uint32_t>(network.size()));
    }
    for (std::uint32_t rank = 0; rank < scene.grid->size(); rank += 2) sample.push_back(rank);
  }
};

std::unique_ptr<Tracer> alone(const TraceScene& scene) {
  auto tracer = make_embree_tracer(scene);
  tracer->set_goal_density(goal);
  return tracer;
}

void expect_all_equal(const NetworkCounts& got, const NetworkCounts& expected) {
  vantage::test::expect_equal_counts(got, expected);
  EXPECT_EQ(got.points, expected.points);
  EXPECT_EQ(got.points_on_surveyed, expected.points_on_surveyed);
  EXPECT_EQ(got.dropped, expected.dropped);
  EXPECT_EQ(got.rays, expected.rays);
  EXPECT_EQ(got.successive_difference_sum, expected.successive_difference_sum);
  EXPECT_EQ(got.registration.pairs, expected.registration.pairs);
  EXPECT_EQ(got.registration.surface, expected.registration.surface);
  EXPECT_EQ(got.registration.instrument, expected.registration.instrument);
  EXPECT_EQ(got.registration.radius_m, expected.registration.radius_m);
  EXPECT_FALSE(got.cancelled);
  ASSERT_EQ(got.groups.size(), expected.groups.size());
  for (std::size_t g = 0; g < got.groups.size(); ++g) expect_all_equal(got.groups[g], expected.groups[g]);
}

RegistrationJob registration(const TraceScene& scene, std::span<const std::uint32_t> sample) {
  SurfaceFinder surfaces(*scene.scene, *scene.grid);
  return {std::make_shared<const Patches>(make_patches(surfaces, *scene.grid, sample, *scene.scanners[0].pattern, {})),
          {{scene.scanners[0].noise, 1.0f}},
          true};
}

TEST(Ranks, CountSamplesAsOneDoes) {
  const TraceScene scene = two_walls();
  const Work work(scene);
  const RegistrationJob sums = registration(scene, work.sample);
  using Points = std::map<std::size_t, std::vector<std::uint32_t>>;
  using Masks = std::map<std::size_t, std::vector<std::uint64_t>>;
  const auto run = [&](Tracer& tracer, Points& points, Masks& masks) {
    return tracer.count_sampled(
        work.networks, work.sizes,
        {.sample = work.sample,
         .stop_at = 41,
         .points =
             [&](std::size_t k, std::span<const std::uint32_t> told) {
               EXPECT_TRUE(points.emplace(k, std::vector(told.begin(), told.end())).second) << "told twice";
             },
         .station_masks =
             [&](std::size_t first, std::span<const std::uint64_t> told) {
               for (std::size_t at = 0; at < told.size(); at += work.sample.size(), ++first) {
                 const auto own = told.subspan(at, work.sample.size());
                 EXPECT_TRUE(masks.emplace(first, std::vector(own.begin(), own.end())).second) << "told twice";
               }
             },
         .registration = &sums},
        {});
  };
  Points expected_points, points;
  Masks expected_masks, masks;
  const auto expected = run(*alone(scene), expected_points, expected_masks);
  Job job({scene, scene, scene});
  const auto tracer = job.tracer(scene);
  const auto got = run(*tracer, points, masks);
  ASSERT_EQ(got.size(), expected.size());
  for (std::size_t k = 0; k < got.size(); ++k) expect_all_equal(got[k], expected[k]);
  EXPECT_EQ(points, expected_points);
  EXPECT_EQ(masks, expected_masks);
  EXPECT_GT(job.bytes(0), 0u) << "nobody else counted";
  EXPECT_NE(job.told().find("3 ranks"), std::string::npos) << job.told();
  EXPECT_EQ(job.warned(), "");
}

TEST(Ranks, SendASampleOnce) {
  const TraceScene scene = two_walls();
  const Work work(scene);
  Job job({scene, scene});
  const auto there = job.remote(scene);
  const auto ask = [&](std::span<const std::uint32_t> sample) {
    const std::size_t before = job.bytes(1);
    const auto counts =
        there->count_sampled(std::span(work.networks).first(1), std::span(work.sizes).first(1), {.sample = sample}, {});
    EXPECT_EQ(counts.at(0).voxels, sample.size());
    return job.bytes(1) - before;
  };
  const std::size_t of_sample = work.sample.size() * sizeof(std::uint32_t);
  EXPECT_GT(ask(work.sample), of_sample);
  EXPECT_LT(ask(work.sample), of_sample);
  const std::vector<std::uint32_t> other(work.sample.begin(), work.sample.end() - 1);
  EXPECT_GE(ask(other), of_sample - sizeof(std::uint32_t));
}

TEST(Ranks, CountEveryRayAsOneDoes) {
  const TraceScene scene = two_walls();
  const Work work(scene);
  const auto single = alone(scene);
  Job job({scene, scene});
  const auto there = job.remote(scene), spread = job.tracer(scene);
  const auto each = single->count_each(work.networks, work.sizes, {}, {}),
             each_spread = spread->count_each(work.networks, work.sizes, {}, {});
  for (std::size_t k = 0; k < each.size(); ++k) expect_all_equal(each_spread[k], each[k]);
  for (const bool skip : {true, false}) {
    PassField field, field_there;
    const auto expected = single->count(work.networks[3], work.sizes[3], {.skip = skip, .field = &field}, {});
    expect_all_equal(there->count(work.networks[3], work.sizes[3], {.skip = skip, .field = &field_there}, {}),
                     expected);
    EXPECT_EQ(field_there.count, field.count);
    EXPECT_EQ(field_there.stations, field.stations);
    expect_all_equal(there->count(work.networks[3], work.sizes[3], {.skip = skip}, {}), expected);
  }
}

TEST(Ranks, ScanAsOneDoes) {
  const TraceScene scene = two_walls();
  const Work work(scene);
  Job job({scene, scene});
  const auto there = job.remote(scene);
  Tracer::RawChunk got, expected;
  constexpr std::uint32_t all = Tracer::range | Tracer::position | Tracer::normal | Tracer::reflectivity |
                                Tracer::primitive | Tracer::barycentric | Tracer::voxel;
  const std::uint64_t columns = scene.scanners[0].pattern->columns();
  there->scan(work.networks[0][1], 2 * columns, 50 * columns, all, got);
  alone(scene)->scan(work.networks[0][1], 2 * columns, 50 * columns, all, expected);
  EXPECT_EQ(got.range, expected.range);
  EXPECT_EQ(got.position, expected.position);
  EXPECT_EQ(got.normal, expected.normal);
  EXPECT_EQ(got.reflectivity, expected.reflectivity);
  EXPECT_EQ(got.primitive, expected.primitive);
  EXPECT_EQ(got.barycentric, expected.barycentric);
  EXPECT_EQ(got.voxel, expected.voxel);
}

TEST(Ranks, RefuseAnotherScene) {
  const TraceScene scene = two_walls();
  Job other_scene({scene, scene, scene}, {fingerprint, fingerprint, 0xABCD});
  try {
    other_scene.tracer(scene);
    FAIL() << "taken";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), Errc::invalid_argument);
    const std::string what = error.what();
    EXPECT_NE(what.find("rank 2 on host2"), std::string::npos) << what;
    EXPECT_NE(what.find("000000000000abcd"), std::string::npos) << what;
  }
  Job other_voxels({scene, two_walls(4)});
  try {
    other_voxels.tracer(scene);
    FAIL() << "taken";
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("voxels"), std::string::npos) << error.what();
  }
}

// Scenes that the others do not have are traced here.
TEST(Ranks, TraceAloneWhatTheOthersDoNotHave) {
  const TraceScene scene = two_walls(), own = two_walls(4);
  const Work work(own);
  Job job({scene, scene});
  job.tracer(scene);
  const auto tracer = job.tracer(own);
  const auto expected = alone(own)->count_each(work.networks, work.sizes, {}, {}),
             got = tracer->count_each(work.networks, work.sizes, {}, {});
  for (std::size_t k = 0; k < got.size(); ++k) expect_all_equal(got[k], expected[k]);
}

TEST(Ranks, StopAtOnceAndGoOn) {
  const TraceScene scene = two_walls();
  const Work work(scene);
  Job job({scene, scene});
  const auto there = job.remote(scene);
  std::stop_source stop;
  stop.request_stop();
  const auto stopped = there->count_each(work.networks, work.sizes, {}, {.stop = stop.get_token()});
  EXPECT_TRUE(stopped.back().cancelled);
  // The next request gets its own answer, not the previous one's.
  expect_all_equal(there->count(work.networks[5], work.sizes[5], {}, {}),
                   alone(scene)->count(work.networks[5], work.sizes[5], {}, {}));
}

TEST(Ranks, AnErrorThereIsAnErrorHere) {
  const TraceScene scene = two_walls();
  const Work work(scene);
  Job job({scene, scene});
  const auto there = job.remote(scene, 9);  // which no rank has
  try {
    there->count(work.networks[0], work.sizes[0], {}, {});
    FAIL() << "counted";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), Errc::device_failure);  // one of several members is dropped, the others continue
    EXPECT_EQ(std::string(error.what()).find("rank 1: on host1: "), 0u) << error.what();
  }
}

}  // namespace
}  // namespace vantage::ranks
