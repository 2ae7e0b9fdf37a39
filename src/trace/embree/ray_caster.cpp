// SPDX-License-Identifier: Apache-2.0
#include "trace/embree/ray_caster.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <string>
#include <tuple>
#include <utility>

#include "core/target_clones.hpp"

namespace vantage {
namespace {

constexpr std::uint32_t packet = 8;
constexpr std::uint32_t packets = RayBundle::capacity / packet;

constexpr float before = 1 - RayCaster::doubt, beyond = 1 + RayCaster::doubt;

struct Context {
  embree::Context rtc;  // first member: Embree passes its address to the filters
  const Planes& planes;
  Float3 origin;
  float start;
  float* t;  // by the ray's id; initially the ray's end
  std::uint32_t* primitive;
  std::uint32_t first = 0;  // triangle of the tree
  std::vector<RayCaster::Crossing>* all = nullptr;
};

// Calls take(ray, primitive, distance) for rays `first` to first + n to which Embree proposes a triangle. A ray goes on
// if it returns false.
template <unsigned n, class Take>
[[gnu::always_inline]] inline void judge(const RTCFilterFunctionNArguments* args, unsigned first,
                                         const Context& context, const Take& take) {
  const unsigned all = args->N;
  unsigned primitive = RayBundle::no_hit;
  alignas(32) float t[n]{};
  alignas(32) std::int32_t beside[n]{};
  for (unsigned k = 0; k < n; ++k) {
    const unsigned i = first + k;
    if (args->valid[i] == 0) continue;
    const unsigned proposed = context.first + RTCHitN_primID(args->hit, all, i);
    if (proposed != primitive) {  // mostly, all rays of a packet meet the same triangle
      primitive = proposed;
      context.planes.distances<n>(context.planes.seen(primitive, context.origin), primitive, context.origin,
                                  &RTCRayN_dir_x(args->ray, all, first), &RTCRayN_dir_y(args->ray, all, first),
                                  &RTCRayN_dir_z(args->ray, all, first), t);
      context.planes.beside<n>(primitive, context.origin, &RTCRayN_dir_x(args->ray, all, first),
                               &RTCRayN_dir_y(args->ray, all, first), &RTCRayN_dir_z(args->ray, all, first), t, beside);
    }
    if (beside[k] == 0 && take(RTCRayN_id(args->ray, all, i), primitive, t[k])) {
      RTCRayN_tfar(args->ray, all, i) = t[k] * beyond;
    } else {
      args->valid[i] = 0;
    }
  }
}

template <class Take>
[[gnu::always_inline]] inline void judge(const RTCFilterFunctionNArguments* args, const Take& take) {
  const Context& context = *reinterpret_cast<const Context*>(args->context);
  unsigned first = 0;
  for (; first + packet <= args->N; first += packet) judge<packet>(args, first, context, take);
  for (; first < args->N; ++first) judge<1>(args, first, context, take);
}

VANTAGE_TARGET_CLONES
void keep_least(const RTCFilterFunctionNArguments* args) {
  const Context& context = *reinterpret_cast<const Context*>(args->context);
  judge(args, [&](unsigned ray, unsigned primitive, float t) {
    float& best = context.t[ray];
    if (t <= context.start || t > best || (t == best && primitive >= context.primitive[ray])) return false;
    best = t;
    context.primitive[ray] = primitive;
    return true;
  });
}

// Notes any hit that counts.
VANTAGE_TARGET_CLONES
void note(const RTCFilterFunctionNArguments* args) {
  const Context& context = *reinterpret_cast<const Context*>(args->context);
  judge(args, [&](unsigned ray, unsigned primitive, float t) {
    if (t <= context.start || t > context.t[ray]) return false;
    context.primitive[ray] = primitive;
    return true;
  });
}

// Notes every hit, and lets the rays go on.
VANTAGE_TARGET_CLONES
void note_all(const RTCFilterFunctionNArguments* args) {
  const Context& context = *reinterpret_cast<const Context*>(args->context);
  judge(args, [&](unsigned ray, unsigned primitive, float t) {
    if (t > context.start && t <= context.t[ray]) context.all->push_back({ray, t, primitive});
    return false;
  });
}

}  // namespace

RayCaster::RayCaster(std::shared_ptr<const SceneData> scene, std::shared_ptr<const Planes> planes, Of of)
    : scene_(std::move(scene)), planes_(std::move(planes)), device_(embree::new_device()) {
  const std::span<const Triangle> opaque = scene_->opaque_triangles();
  const std::span<const Triangle> triangles =
      of == Of::opaque ? opaque : std::span(scene_->triangles).subspan(opaque.size());
  first_ = of == Of::opaque ? 0 : static_cast<std::uint32_t>(opaque.size());
  RTCDevice device = device_.get();
  tree_.reset(rtcNewScene(device));
  rtcSetSceneFlags(tree_.get(), RTC_SCENE_FLAG_ROBUST);
  rtcSetSceneBuildQuality(tree_.get(), RTC_BUILD_QUALITY_MEDIUM);
  const embree::Geometry geometry(rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE));
  // Vertices are copied, since Embree reads past the end of a shared buffer.
  if (!scene_->positions.empty()) {
    void* vertices = rtcSetNewGeometryBuffer(geometry.get(), RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                             sizeof(Float3), scene_->positions.size());
    embree::check(device, "taking the scene's vertices");
    std::memcpy(vertices, scene_->positions.data(), scene_->positions.size() * sizeof(Float3));
    rtcSetSharedGeometryBuffer(geometry.get(), RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, triangles.data(), 0,
                               sizeof(Triangle), triangles.size());
  }
  rtcSetGeometryIntersectFilterFunction(geometry.get(), of == Of::opaque ? keep_least : note_all);
  rtcSetGeometryOccludedFilterFunction(geometry.get(), note);
  rtcCommitGeometry(geometry.get());
  rtcAttachGeometry(tree_.get(), geometry.get());
  rtcCommitScene(tree_.get());
  embree::check(device, "building the tree over " + std::to_string(triangles.size()) + " triangles");
}

void RayCaster::any_hits(const Float3& origin, float start, std::span<Probe> probes) const {
  constexpr std::size_t stream = 64;
  std::array<std::uint32_t, stream> hit;
  std::array<float, stream> end;
  alignas(64) std::array<RTCRay, stream> rays;
  for (std::size_t first = 0; first < probes.size(); first += stream) {
    const std::size_t n = std::min(stream, probes.size() - first);
    for (std::size_t i = 0; i < n; ++i) {
      const Probe& probe = probes[first + i];
      end[i] = probe.end;
      rays[i] = {origin.x,
                 origin.y,
                 origin.z,
                 start * before,
                 RayCaster::safe(probe.d.x),
                 RayCaster::safe(probe.d.y),
                 RayCaster::safe(probe.d.z),
                 0,
                 probe.end * beyond,
                 0xFFFFFFFFu,
                 static_cast<unsigned>(i),
                 0};
    }
    hit.fill(RayBundle::no_hit);
    Context context{{}, *planes_, origin, start, end.data(), hit.data(), first_};
#if VANTAGE_EMBREE_MAJOR >= 4
    rtcInitRayQueryContext(&context.rtc);
    RTCOccludedArguments arguments;
    rtcInitOccludedArguments(&arguments);
    arguments.context = &context.rtc;
    for (std::size_t i = 0; i < n; ++i) rtcOccluded1(tree_.get(), &rays[i], &arguments);
#else
    rtcInitIntersectContext(&context.rtc);
    rtcOccluded1M(tree_.get(), &context.rtc, rays.data(), static_cast<unsigned>(n), sizeof(RTCRay));
#endif
    for (std::size_t i = 0; i < n; ++i) probes[first + i].hit = hit[i];
  }
}

void RayCaster::cast(RayBundle& rays) const { cast(rays, nullptr); }

std::vector<RayCaster::Crossing> RayCaster::crossings(RayBundle& rays) const {
  std::vector<Crossing> all;
  cast(rays, &all);
  std::ranges::sort(all, {}, [](const Crossing& c) { return std::tuple(c.ray, c.t, c.triangle); });
  return all;
}

void RayCaster::cast(RayBundle& rays, std::vector<Crossing>* all) const {
  if (rays.size == 0) return;
  alignas(64) RTCRayHit8 hits[packets];
  const std::uint32_t used = (rays.size + packet - 1) / packet;
  for (std::uint32_t i = rays.size; i < used * packet; ++i) {
    rays.x[i] = rays.y[i] = rays.z[i] = 1;
    rays.end[i] = -std::numeric_limits<float>::infinity();  // an end before the start disables the ray
  }
  for (std::uint32_t p = 0; p < used; ++p) {
    RTCRay8& ray = hits[p].ray;
    for (std::uint32_t lane = 0; lane < packet; ++lane) {
      const std::uint32_t i = p * packet + lane;
      ray.org_x[lane] = rays.origin.x;
      ray.org_y[lane] = rays.origin.y;
      ray.org_z[lane] = rays.origin.z;
      ray.tnear[lane] = rays.start * before;
      ray.dir_x[lane] = RayCaster::safe(rays.x[i]);
      ray.dir_y[lane] = RayCaster::safe(rays.y[i]);
      ray.dir_z[lane] = RayCaster::safe(rays.z[i]);
      ray.time[lane] = 0;
      ray.tfar[lane] = rays.end[i] * beyond;
      ray.mask[lane] = 0xFFFFFFFFu;
      ray.id[lane] = i;
      ray.flags[lane] = 0;
      hits[p].hit.geomID[lane] = RTC_INVALID_GEOMETRY_ID;
      hits[p].hit.instID[0][lane] = RTC_INVALID_GEOMETRY_ID;
    }
  }
  std::copy_n(rays.end, used * packet, rays.t);
  std::fill_n(rays.primitive, used * packet, RayBundle::no_hit);

  Context context{{}, *planes_, rays.origin, rays.start, rays.t, rays.primitive, first_, all};
#if VANTAGE_EMBREE_MAJOR >= 4
  rtcInitRayQueryContext(&context.rtc);
  RTCIntersectArguments arguments;
  rtcInitIntersectArguments(&arguments);
  arguments.flags = RTC_RAY_QUERY_FLAG_COHERENT;
  arguments.context = &context.rtc;
  for (std::uint32_t p = 0; p < used; ++p) {
    alignas(32) int valid[packet];
    for (std::uint32_t lane = 0; lane < packet; ++lane) valid[lane] = p * packet + lane < rays.size ? -1 : 0;
    rtcIntersect8(valid, tree_.get(), &hits[p], &arguments);
  }
#else
  rtcInitIntersectContext(&context.rtc);
  context.rtc.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
  rtcIntersectNM(tree_.get(), &context.rtc, reinterpret_cast<RTCRayHitN*>(hits), packet, used, sizeof(RTCRayHit8));
#endif
  for (std::uint32_t i = 0; i < rays.size; ++i) {
    if (rays.primitive[i] == RayBundle::no_hit) rays.t[i] = std::numeric_limits<float>::infinity();
  }
}

}  // namespace vantage
