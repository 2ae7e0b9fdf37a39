// SPDX-License-Identifier: Apache-2.0
#include "bare_embree.hpp"

#include <tbb/blocked_range2d.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <limits>
#include <memory>

namespace vantage::bench {
namespace {

constexpr std::uint32_t side = 16;  // rays of a tile, each way

void set_ray(RTCRayHit8& rays, std::uint32_t lane, const RayPattern& pattern, std::uint32_t row, std::uint32_t column,
             const Float3& origin) {
  rays.ray.org_x[lane] = origin.x;
  rays.ray.org_y[lane] = origin.y;
  rays.ray.org_z[lane] = origin.z;
  rays.ray.dir_x[lane] = pattern.sin_zenith[row] * pattern.cos_azimuth[column];
  rays.ray.dir_y[lane] = pattern.sin_zenith[row] * pattern.sin_azimuth[column];
  rays.ray.dir_z[lane] = pattern.cos_zenith[row];
  rays.ray.tnear[lane] = pattern.min_range;
  rays.ray.tfar[lane] = pattern.max_range;
  rays.ray.time[lane] = 0;
  rays.ray.mask[lane] = 0xFFFFFFFFu;
  rays.ray.flags[lane] = 0;
  rays.hit.geomID[lane] = RTC_INVALID_GEOMETRY_ID;
  rays.hit.instID[0][lane] = RTC_INVALID_GEOMETRY_ID;
}

// All rays of a station, packets of eight neighbours in a row; by streams of 32 packets where `stream` is set.
void trace(RTCScene tree, const RayPattern& pattern, const Float3& origin, bool stream) {
  const tbb::blocked_range2d<std::uint32_t> all(0, (pattern.rows() + side - 1) / side, 0,
                                                (pattern.columns() + side - 1) / side);
  tbb::parallel_for(all, [&](const tbb::blocked_range2d<std::uint32_t>& part) {
    constexpr std::uint32_t packets = side * side / 8;
    alignas(64) int valid[8];
    auto rays = std::make_unique<std::array<RTCRayHit8, packets>>();
#if VANTAGE_EMBREE_MAJOR >= 4
    RTCRayQueryContext context;
    rtcInitRayQueryContext(&context);
    RTCIntersectArguments arguments;
    rtcInitIntersectArguments(&arguments);
    arguments.context = &context;
    arguments.flags = RTC_RAY_QUERY_FLAG_COHERENT;
#else
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
#endif
    for (std::uint32_t y = part.rows().begin(); y < part.rows().end(); ++y)
      for (std::uint32_t x = part.cols().begin(); x < part.cols().end(); ++x) {
        std::uint32_t used = 0;
        for (std::uint32_t row = y * side; row < std::min((y + 1) * side, pattern.rows()); ++row)
          for (std::uint32_t first = x * side; first < std::min((x + 1) * side, pattern.columns()); first += 8) {
            const std::uint32_t lanes = std::min(8u, pattern.columns() - first);
            for (std::uint32_t lane = 0; lane < 8; ++lane) {
              valid[lane] = lane < lanes ? -1 : 0;
              set_ray((*rays)[used], lane, pattern, row, std::min(first + lane, pattern.columns() - 1), origin);
              if (lane >= lanes) (*rays)[used].ray.tfar[lane] = -1;  // not traced
            }
#if VANTAGE_EMBREE_MAJOR >= 4
            rtcIntersect8(valid, tree, &(*rays)[used], &arguments);
#else
            if (!stream) rtcIntersect8(valid, tree, &context, &(*rays)[used]);
#endif
            ++used;
          }
#if VANTAGE_EMBREE_MAJOR < 4
        if (stream)
          rtcIntersectNM(tree, &context, reinterpret_cast<RTCRayHitN*>(rays->data()), 8, used, sizeof(RTCRayHit8));
#endif
      }
  });
  (void)stream;
}

struct Way {
  const char* name;
  double best = std::numeric_limits<double>::infinity();
};

}  // namespace

embree::Scene tree_of(RTCDevice device, std::span<const Float3> positions, std::span<const Triangle> triangles) {
  embree::Scene tree(rtcNewScene(device));
  rtcSetSceneFlags(tree.get(), RTC_SCENE_FLAG_ROBUST);  // as the engine's
  const embree::Geometry geometry(rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE));
  std::memcpy(rtcSetNewGeometryBuffer(geometry.get(), RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, sizeof(Float3),
                                      positions.size()),
              positions.data(), positions.size_bytes());
  std::memcpy(rtcSetNewGeometryBuffer(geometry.get(), RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, sizeof(Triangle),
                                      triangles.size()),
              triangles.data(), triangles.size_bytes());
  rtcCommitGeometry(geometry.get());
  rtcAttachGeometry(tree.get(), geometry.get());
  rtcCommitScene(tree.get());
  embree::check(device, "building the tree");
  return tree;
}

void BareEmbreeOptions::add(CLI::App& command) { site.add(command); }

void run_bare_embree(const BareEmbreeOptions& options) {
  const Scene scene = Scene::load(options.site.scene);
  TracedSite site = options.site.traced(scene, options.site.stations());
  site.scene.whole_scans = WholeScans::traced;  // as the bare loops do
  const RayPattern& pattern = *site.scene.scanners[0].pattern;
  const auto engine = make_tracer(Engine::embree, std::nullopt, site.scene);
  engine->set_goal_density(site.goal_density);
  const embree::Device device = embree::new_device();
  const embree::Scene tree = tree_of(device.get(), scene.data().positions, scene.data().triangles);

  std::vector<Way> ways{{"rtcIntersect8"}, {"rtcIntersectNM"}, {"engine, tracing and counting"}};
#if VANTAGE_EMBREE_MAJOR >= 4
  ways.erase(ways.begin() + 1);  // Embree 4 has no streams
#endif
  for (std::uint32_t round = 0; round <= options.site.repeats; ++round)  // the first warms up
    for (Way& way : ways) {
      const Stopwatch watch;
      if (&way == &ways.back()) {
        engine->count(site.stations, static_cast<std::uint32_t>(site.stations.size()), {.masks = true, .skip = false},
                      {});
      } else {
        for (const TraceStation& station : site.stations)
          trace(tree.get(), pattern, station.origin, &way != &ways.front());
      }
      if (round > 0) way.best = std::min(way.best, watch.seconds());
    }
  const std::uint64_t rays_each = options.site.scanner().rays();
  const double rays = static_cast<double>(rays_each * site.stations.size());
  double bare = std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k + 1 < ways.size(); ++k) bare = std::min(bare, ways[k].best);
  std::printf("# %zu triangles, %zu stations, %llu rays each, %llu voxels\n", scene.triangle_count(),
              site.stations.size(), static_cast<unsigned long long>(rays_each),
              static_cast<unsigned long long>(site.scene.grid->size()));
  std::printf("way,million_rays_per_second,share_of_the_faster_bare_loop\n");
  for (const Way& way : ways) std::printf("%s,%.2f,%.3f\n", way.name, rays / way.best * 1e-6, bare / way.best);
}

}  // namespace vantage::bench
