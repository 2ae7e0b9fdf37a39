// SPDX-License-Identifier: Apache-2.0
// Rays of a caller's own on every engine of this machine: the processor's answers, to the bit.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <functional>
#include <limits>
#include <stop_token>
#include <string>
#include <utility>
#include <vector>

#include "core/philox.hpp"
#include "scene/scene_data.hpp"
#include "support/engines.hpp"
#include "support/glb_builder.hpp"
#include "trace/device_fault.hpp"
#include "trace/rays/ray_batches.hpp"
#include "vantage/error.hpp"
#include "vantage/rays.hpp"

namespace vantage {
namespace {

constexpr double kForever = std::numeric_limits<double>::infinity();

double within(RandomStream& random, double low, double high) { return low + (high - low) * random.uniform(); }
Vec3 vector_of(RandomStream& random, double size) {
  return {within(random, -size, size), within(random, -size, size), within(random, -size, size)};
}

// Every engine but the processor's. A machine without any fails.
std::vector<EngineInfo> devices() {
  std::vector<EngineInfo> all = test::usable_engines();
  std::erase_if(all, [](const EngineInfo& info) { return info.engine == Engine::embree; });
  for (const Engine engine : {Engine::ray_query, Engine::compute_bvh})
    EXPECT_TRUE(std::ranges::any_of(all, [&](const EngineInfo& info) { return info.engine == engine; }))
        << to_string(engine) << " runs nowhere here: install mesa-vulkan-drivers >= 24.1";
  return all;
}
DeviceChoice choice_of(const EngineInfo& info) { return {info.engine, info.device_index}; }

template <class T>
bool equal_to_the_bit(const std::vector<T>& a, const std::vector<T>& b) {
  return a.size() == b.size() && (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(T)) == 0);
}

// The processor's answers and a device's, of all three questions. Returns the number of hits.
std::size_t expect_same(const RayTracer& processor, const RayTracer& device, const Rays& rays,
                        const RayOptions& options) {
  const RayHits expected = processor.nearest(rays, options), hits = device.nearest(rays, options);
  EXPECT_TRUE(equal_to_the_bit(hits.primitive, expected.primitive));
  EXPECT_TRUE(equal_to_the_bit(hits.range_m, expected.range_m));
  EXPECT_TRUE(equal_to_the_bit(hits.position, expected.position));
  EXPECT_TRUE(equal_to_the_bit(hits.normal, expected.normal));
  EXPECT_TRUE(equal_to_the_bit(hits.reflectivity, expected.reflectivity));
  EXPECT_TRUE(equal_to_the_bit(hits.diffuse, expected.diffuse));
  EXPECT_TRUE(equal_to_the_bit(hits.mesh, expected.mesh));
  for (std::size_t k = 0, told = 0; k < hits.size() && told < 3; ++k)
    if (hits.primitive[k] != expected.primitive[k]) {
      ++told;
      ADD_FAILURE() << "ray " << k << ": triangle " << hits.primitive[k] << " at " << hits.range_m[k] << " for "
                    << expected.primitive[k] << " at " << expected.range_m[k];
    }
  EXPECT_EQ(device.blocked(rays, options), processor.blocked(rays, options));
  EXPECT_EQ(device.count(rays, options), processor.count(rays, options));
  return static_cast<std::size_t>(std::ranges::count_if(hits.mesh, [](std::int32_t mesh) { return mesh >= 0; }));
}

struct Triangles {
  std::vector<Vec3> positions;
  std::vector<std::array<std::uint32_t, 3>> corners;
  void add(const Vec3& a, const Vec3& b, const Vec3& c) {
    const auto first = static_cast<std::uint32_t>(positions.size());
    for (const Vec3& p : {a, b, c}) positions.push_back(p);
    corners.push_back({first, first + 1, first + 2});
  }
  Scene scene() const { return Scene::from_triangles(positions, corners); }
};

// Triangles of all sizes and shapes, slivers, copies and coplanar neighbours included, in a cube of this half size.
Triangles heap(std::size_t many, const Vec3& middle, double size, std::uint64_t seed) {
  RandomStream random(seed);
  Triangles heap;
  for (std::size_t k = 0; k < many; ++k) {
    const Vec3 a = middle + vector_of(random, size);
    const double own = size * std::pow(10.0, within(random, -3, -0.3));
    const Vec3 b = a + vector_of(random, own);
    const Vec3 c = k % 5 == 0 ? a + (b - a) * 0.5 + vector_of(random, 1e-3 * own) : a + vector_of(random, own);
    heap.add(a, b, c);
    if (k % 7 == 0) heap.add(b, a, c);
    if (k % 11 == 0) heap.add(a, c, a + (c - a) * 0.5 + (b - a) * -0.3);
  }
  return heap;
}

struct GivenRays {
  std::vector<Vec3> origins, directions;
  std::vector<double> ranges;
  void add(const Vec3& origin, const Vec3& direction, double range = kForever) {
    origins.push_back(origin), directions.push_back(direction), ranges.push_back(range);
  }
  Rays rays() const { return {origins, directions, ranges}; }
};

// From within, from around and from afar, at anything, at corners and at edges; some end at what they aim at, and some
// begin there.
GivenRays rays_at(const Scene& scene, const Vec3& middle, double size, std::size_t many, std::uint64_t seed) {
  RandomStream random(seed);
  GivenRays given;
  const SceneData& data = scene.data();
  for (std::size_t k = 0; k < many; ++k) {
    const double from = k % 5 == 0 ? 1 : k % 5 == 1 ? 3 : k % 5 == 2 ? 1000 : 0.3;
    const Vec3 origin = middle + vector_of(random, std::min(size * from, 9e5));
    const auto triangle = static_cast<std::uint32_t>(random.uniform() * data.triangle_count());
    const auto corners = data.corners(triangle);
    const Vec3 a = widen(corners[0]) + data.origin, b = widen(corners[1]) + data.origin;
    const Vec3 edge = a + (b - a) * random.uniform();
    switch (k % 8) {
      case 0: given.add(origin, a - origin); break;
      case 1: given.add(origin, edge - origin); break;
      case 2: given.add(origin, edge - origin, std::sqrt(dot(edge - origin, edge - origin))); break;
      case 3: given.add(edge, vector_of(random, 1)); break;
      case 4: given.add(origin, (b - a), within(random, 0, 2) * size); break;
      case 5: given.add(a - (b - a), b - a); break;  // along an edge
      default: given.add(origin, middle + vector_of(random, size) - origin, k % 3 == 0 ? size : kForever);
    }
  }
  return given;
}

TEST(DeviceRays, AnswersAreTheProcessorsToTheBit) {
  struct Place {
    Vec3 middle;
    double size;
  };
  const std::vector<Place> places{{{}, 20}, {{431'000.25, 5'812'000.5, 312.75}, 20}, {{}, 4000}, {{100, 5, 0}, 1e-3}};
  for (const EngineInfo& info : devices()) {
    SCOPED_TRACE(test::name_of(info));
    for (const Place& place : places) {
      SCOPED_TRACE(place.size);
      const Scene scene = heap(1500, place.middle, place.size, 3).scene();
      const RayTracer processor(scene), device(scene, choice_of(info));
      EXPECT_EQ(device.engine().engine, info.engine);
      EXPECT_EQ(processor.engine().engine, Engine::embree);
      const GivenRays given = rays_at(scene, place.middle, place.size, 40'000, 7);
      EXPECT_GT(expect_same(processor, device, given.rays(), {}), 5000u);
      expect_same(processor, device, given.rays(), {.from_m = 0.05 * place.size});
    }
  }
}

// A closed box of many triangles, seen from inside at its corners and edges: each ray is a close call.
TEST(DeviceRays, NoRayPassesBetweenTriangles) {
  Triangles box;
  constexpr int n = 12;
  const auto point = [](int face, int i, int j) {
    const double u = -1 + 2.0 * i / n, v = -1 + 2.0 * j / n, w = face % 2 == 0 ? -1 : 1;
    return (face / 2 == 0 ? Vec3{w, u, v} : face / 2 == 1 ? Vec3{u, w, v} : Vec3{u, v, w}) * 3.3;
  };
  for (int face = 0; face < 6; ++face)
    for (int i = 0; i < n; ++i)
      for (int j = 0; j < n; ++j) {
        box.add(point(face, i, j), point(face, i + 1, j), point(face, i + 1, j + 1));
        box.add(point(face, i, j), point(face, i + 1, j + 1), point(face, i, j + 1));
      }
  const Scene scene = box.scene();
  const RayTracer processor(scene);
  GivenRays given;
  RandomStream random(3);
  for (std::uint32_t k = 0; k < scene.triangle_count(); ++k) {
    const auto corners = scene.data().corners(k);
    for (std::size_t c = 0; c < 3; ++c) {
      const Vec3 origin{0.1, -0.2, 0.3}, a = widen(corners[c]) + scene.data().origin,
                                         b = widen(corners[(c + 1) % 3]) + scene.data().origin;
      given.add(origin, a - origin);
      given.add(origin, a + (b - a) * random.uniform() - origin);
    }
  }
  for (const EngineInfo& info : devices()) {
    SCOPED_TRACE(test::name_of(info));
    const RayTracer device(scene, choice_of(info));
    EXPECT_EQ(expect_same(processor, device, given.rays(), {}), given.origins.size());
  }
}

// Nodes that turn, scale, shear and mirror meshes, near and far, one of them of glass.
TEST(DeviceRays, SharedMeshesAndGlass) {
  test::GlbBuilder builder;
  builder.json["asset"]["extras"]["vantage"] = nlohmann::json::object();  // in metres, Y up
  RandomStream random(8);
  const auto mesh = [&](double size, const Vec3& at) {
    std::vector<float> corners;
    for (int k = 0; k < 80; ++k) {
      const Vec3 a = at + vector_of(random, size);
      for (int c = 0; c < 3; ++c) {
        const Vec3 p = a + vector_of(random, 0.6 * size);
        for (const double x : {p.x, p.y, p.z}) corners.push_back(static_cast<float>(x));
      }
    }
    return builder.mesh({{"attributes", {{"POSITION", builder.positions(corners)}}}});
  };
  const std::array meshes{mesh(1, {}), mesh(1000, {5000, 0, 0}), mesh(0.5, {3, 3, 3})};
  for (int k = 0; k < 60; ++k) {
    const Vec3 at = vector_of(random, 30) + (k % 10 == 9 ? Vec3{3000, 100, 0} : Vec3{}), turn = vector_of(random, 1);
    const double size = std::pow(10.0, within(random, -1, 1)) * (k % 3 == 1 ? 1e-3 : 1), mirrored = k % 4 == 0 ? -1 : 1;
    const double length = std::sqrt(1 + dot(turn, turn));
    builder.node({{"name", k % 6 == 5 ? "pane" : "thing"},
                  {"mesh", meshes[static_cast<std::size_t>(k) % 3]},
                  {"translation", {at.x, at.y, at.z}},
                  {"rotation", {turn.x / length, turn.y / length, turn.z / length, 1 / length}},
                  {"scale", {mirrored * size, size, (k % 7 == 3 ? 12 : 1.5) * size}}});
  }
  const int standing = builder.positions({-40, -40, 5, 40, -40, 5, 0, 40, 6});
  builder.node({{"name", "wall"}, {"mesh", builder.mesh({{"attributes", {{"POSITION", standing}}}})}});
  for (const SharedMeshes shared : {SharedMeshes::always, SharedMeshes::never}) {
    const Scene scene = test::load(builder, {.glass = {"pane"}, .shared_meshes = shared});
    ASSERT_EQ(scene.data().shares(), shared == SharedMeshes::always);
    ASSERT_TRUE(scene.data().has_glass());
    const RayTracer processor(scene);
    const GivenRays given = rays_at(scene, {}, 30, 40'000, 11);
    for (const EngineInfo& info : devices()) {
      SCOPED_TRACE(test::name_of(info));
      const RayTracer device(scene, choice_of(info));
      for (const bool glass : {false, true})
        EXPECT_GT(expect_same(processor, device, given.rays(), {.from_m = 0.25, .glass = glass}), 5000u);
    }
  }
}

// A device that left most rays to the processor would be right, and of no use.
TEST(DeviceRays, DevicesDecideMostRays) {
  const Scene scene = heap(1500, {}, 20, 3).scene();
  const std::shared_ptr<const SceneData> data(std::make_shared<Scene>(scene), &scene.data());
  for (const EngineInfo& info : devices()) {
    SCOPED_TRACE(test::name_of(info));
    const auto finder = make_ray_finder(choice_of(info), data);
    ASSERT_NE(finder, nullptr);
    constexpr std::size_t many = 50'000;
    finder->reserve(many);
    RandomStream random(2);
    for (std::size_t k = 0; k < many; ++k) {
      const Vec3 at = vector_of(random, 18), way = vector_of(random, 1);
      const Float3 origin = narrow(at - data->origin), unit = narrow(way * (1 / std::sqrt(dot(way, way))));
      finder->rays(1)[k] = {.origin = {origin.x, origin.y, origin.z},
                            .from = 0,
                            .direction = {unit.x, unit.y, unit.z},
                            .range = k % 10 == 0   ? own_ray_misses
                                     : k % 10 == 1 ? own_ray_open
                                                   : std::numeric_limits<float>::infinity()};
    }
    for (const auto& [question, most] :
         {std::pair{RayQuestion::nearest, 0.005}, {RayQuestion::blocked, 0.005}, {RayQuestion::count, 0.01}}) {
      finder->find(1, many, question, data->triangle_count());
      std::size_t open = 0, wrong = 0;
      for (std::size_t k = 0; k < many; ++k) {
        const std::uint32_t answer = finder->answers(1)[k];
        if (k % 10 == 0)
          wrong += answer != (question == RayQuestion::nearest ? no_primitive : 0);
        else if (k % 10 == 1)
          wrong += answer != open_answer;
        else
          open += answer == open_answer;
      }
      EXPECT_EQ(wrong, 0u);
      EXPECT_LT(static_cast<double>(open), most * many);
      EXPECT_GT(open, 0u);
    }
    EXPECT_GT(finder->device_seconds(), 0);
  }
}

TEST(DeviceRays, NoRaysOneRayAndManyBatches) {
  const Scene scene = heap(300, {}, 5, 1).scene();
  const RayTracer processor(scene);
  RandomStream random(4);
  GivenRays given;
  for (int k = 0; k < 400'000; ++k) given.add(vector_of(random, 6), vector_of(random, 1));
  for (const EngineInfo& info : devices()) {
    SCOPED_TRACE(test::name_of(info));
    const RayTracer device(scene, choice_of(info));
    EXPECT_EQ(device.nearest({}).size(), 0u);
    EXPECT_TRUE(device.blocked({}).empty());
    const Rays one{std::span(given.origins).first(1), std::span(given.directions).first(1)};
    expect_same(processor, device, one, {});
    // One origin of many directions, and one range; the device takes several batches.
    const Vec3 origin{0.1, 0.2, 0.3};
    const double range = 4;
    EXPECT_GT(expect_same(processor, device, {{&origin, 1}, given.directions, {&range, 1}}, {}), 1000u);
    EXPECT_GT(expect_same(processor, device, given.rays(), {}), 1000u);
    std::vector<double> told;
    const Progress progress{.report = [&](double done) { told.push_back(done); }, .stop = {}};
    EXPECT_EQ(device.count(given.rays(), {}, progress).size(), given.origins.size());
    EXPECT_GT(told.size(), info.software ? 2u : 0u);  // graphics cards take more at once
    EXPECT_TRUE(std::ranges::is_sorted(told));
    EXPECT_EQ(told.back(), 1);
    std::stop_source stop;
    EXPECT_TRUE(device.blocked(given.rays(), {}, {[&](double) { stop.request_stop(); }, stop.get_token()}).empty());
    EXPECT_EQ(device.nearest(one).size(), 1u);
  }
}

std::string refusal_of(Errc code, const std::function<void()>& call) {
  try {
    call();
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), code);
    return error.what();
  }
  return "";
}

TEST(DeviceRays, ErrorsAreThoseOfTheProcessor) {
  const Scene scene = heap(300, {}, 5, 1).scene();
  const RayTracer processor(scene);
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  for (const EngineInfo& info : devices()) {
    const RayTracer device(scene, choice_of(info));
    GivenRays bad;
    for (int k = 0; k < 4; ++k) bad.add({}, {1, 0, 0}, 2);
    const auto same = [&] {
      const std::string own = refusal_of(Errc::invalid_argument, [&] { processor.nearest(bad.rays()); });
      EXPECT_EQ(refusal_of(Errc::invalid_argument, [&] { device.nearest(bad.rays()); }), own);
      EXPECT_FALSE(own.empty());
    };
    bad.ranges[3] = 0, same();
    bad.directions[2] = {}, same();
    bad.origins[1] = {nan, 0, 0}, same();
    bad.origins.pop_back(), same();
    const Vec3 origin{}, along{1, 0, 0};
    const Rays rays{{&origin, 1}, {&along, 1}};
    const auto again = [&](double) { device.blocked(rays); };
    EXPECT_NE(refusal_of(Errc::invalid_argument, [&] { device.nearest(rays, {}, {.report = again, .stop = {}}); }), "");
    EXPECT_EQ(device.blocked(rays).size(), 1u);
    EXPECT_NE(refusal_of(Errc::no_suitable_device, [&] { RayTracer(scene, {info.engine, 99}); }), "");
  }
  EXPECT_NE(refusal_of(Errc::no_suitable_device, [&] { RayTracer(scene, {Engine::embree, 1}); }), "");
  const auto listed = list_engines();
  const auto best = std::ranges::find(listed, true, &EngineInfo::chosen_by_default);
  EXPECT_EQ(RayTracer(scene, {Engine::automatic}).engine().engine, best->engine);
}

// A device that answers with the index of each ray's origin, and fails on request.
struct Fragile {
  int made = 0, lose_builds = 0, lose_calls = 0;
  std::size_t room = 1'000'000, finds = 0;
};
class FragileFinder final : public RayFinder {
 public:
  explicit FragileFinder(Fragile& fragile) : fragile_(fragile) {
    ++fragile_.made;
    if (fragile_.lose_builds-- > 0) throw DeviceFault(Errc::device_failure, "lost while it was built");
  }
  const EngineInfo& info() const override { return info_; }
  std::size_t most_rays() const override { return 10'000; }
  void reserve(std::size_t rays) override {
    if (rays > fragile_.room) throw DeviceFault(Errc::out_of_memory, "too many rays");
    for (auto& slot : rays_) slot.resize(rays);
    for (auto& slot : answers_) slot.resize(rays);
  }
  std::span<OwnRay> rays(std::size_t slot) override { return rays_[slot]; }
  void find(std::size_t slot, std::size_t count, RayQuestion, std::uint32_t end) override {
    if (++fragile_.finds % 3 == 0 && fragile_.lose_calls-- > 0) throw DeviceFault(Errc::device_failure, "lost");
    for (std::size_t k = 0; k < count; ++k) answers_[slot][k] = static_cast<std::uint32_t>(rays_[slot][k].range) + end;
  }
  std::span<const std::uint32_t> answers(std::size_t slot) const override { return answers_[slot]; }
  double device_seconds() const override { return 0; }

 private:
  Fragile& fragile_;
  EngineInfo info_;
  std::vector<OwnRay> rays_[kSlots];
  std::vector<std::uint32_t> answers_[kSlots];
};

struct Batches {
  Fragile fragile;
  RayBatches batches{[this] { return std::make_unique<FragileFinder>(fragile); }};
  std::size_t largest = 0;

  // Returns true if every ray got its own answer.
  bool run(std::size_t many) {
    std::vector<std::uint32_t> answers(many);
    const bool whole = batches.run(many,
                                   {RayQuestion::count, 5,
                                    [](std::size_t first, std::span<OwnRay> rays) {
                                      for (std::size_t k = 0; k < rays.size(); ++k)
                                        rays[k].range = static_cast<float>(first + k);
                                    },
                                    [&](std::size_t first, std::span<const std::uint32_t> given) {
                                      largest = std::max(largest, given.size());
                                      std::ranges::copy(given, answers.begin() + static_cast<std::ptrdiff_t>(first));
                                    }},
                                   {});
    for (std::size_t k = 0; k < many; ++k)
      if (answers[k] != k + 5) return false;
    return whole;
  }
};

TEST(RayBatches, EveryRayIsAnsweredOnce) {
  Batches batches;
  EXPECT_TRUE(batches.batches.on_device());
  for (const std::size_t many : {0, 1, 9'999, 10'000, 10'001, 20'000, 95'432}) EXPECT_TRUE(batches.run(many)) << many;
  EXPECT_EQ(batches.largest, 10'000u);
  EXPECT_EQ(batches.fragile.made, 1);
  EXPECT_FALSE(RayBatches([] { return std::unique_ptr<RayFinder>(); }).on_device());
}

TEST(RayBatches, AFailedDeviceIsSetUpAnewOnceForEachBatch) {
  Batches batches;
  batches.fragile.lose_calls = 4;
  EXPECT_TRUE(batches.run(95'432));
  EXPECT_EQ(batches.fragile.made, 5);
  batches.fragile.finds = 0, batches.fragile.lose_calls = 1, batches.fragile.lose_builds = 1;
  EXPECT_THROW(batches.run(95'432), DeviceFault);
  EXPECT_TRUE(batches.run(95'432));  // the next call sets it up
  Fragile lost{.lose_builds = 1};
  EXPECT_TRUE(RayBatches([&] { return std::make_unique<FragileFinder>(lost); }).on_device());
  lost.lose_builds = 2;
  EXPECT_THROW(RayBatches([&] { return std::make_unique<FragileFinder>(lost); }), DeviceFault);
}

TEST(RayBatches, ShortMemoryTakesFewerRaysAtOnce) {
  Batches batches;
  batches.fragile.room = 3000;
  EXPECT_TRUE(batches.run(95'432));
  EXPECT_EQ(batches.largest, 2500u);
  batches.fragile.room = 100;
  EXPECT_THROW(batches.run(95'432), DeviceFault);
}

}  // namespace
}  // namespace vantage
