// SPDX-License-Identifier: Apache-2.0
#include "trace/embree/ray_caster.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <tuple>
#include <utility>

#include "core/target_clones.hpp"

namespace vantage {
namespace {

constexpr std::uint32_t kPacketRays = 8;
constexpr std::uint32_t kBundlePackets = RayBundle::kCapacity / kPacketRays;

constexpr float kBefore = 1 - RayCaster::kDoubt, kBeyond = 1 + RayCaster::kDoubt;

struct Context {
  embree::Context rtc;  // first member: Embree passes its address to the filters
  const Planes& planes;
  const SceneTree* tree;
  Float3 origin;
  float start;
  float* t;  // by the ray's id; initially the ray's end
  std::uint32_t* primitive;
  std::vector<RayCaster::Crossing>* all = nullptr;
  // Directions by the ray's id, as Embree got them; null if nothing is shared.
  const float *x = nullptr, *y = nullptr, *z = nullptr;
  const Float3* origins = nullptr;  // by the ray's id; null: all are `origin`
  bool changed = false;             // the scene is later than the tree
};

// Calls take(ray, primitive, distance) for rays `first` to first + n from `origin` to which Embree proposes a triangle.
// A ray continues if it returns false. `placed`: nodes share meshes, and Embree's ray is in the frame of such a mesh.
template <unsigned n, bool placed, bool changed, class Take>
[[gnu::always_inline]] inline void judge(const RTCFilterFunctionNArguments* args, unsigned first,
                                         const Context& context, const Float3& origin, const Take& take) {
  const unsigned all = args->N;
  alignas(32) float own_x[n], own_y[n], own_z[n];
  const float *x = own_x, *y = own_y, *z = own_z;
  if constexpr (placed) {
    for (unsigned k = 0; k < n; ++k) {
      const bool valid = args->valid[first + k] != 0;
      const unsigned id = valid ? RTCRayN_id(args->ray, all, first + k) : 0;
      own_x[k] = valid ? context.x[id] : 1, own_y[k] = valid ? context.y[id] : 1, own_z[k] = valid ? context.z[id] : 1;
    }
  } else {
    x = &RTCRayN_dir_x(args->ray, all, first);
    y = &RTCRayN_dir_y(args->ray, all, first);
    z = &RTCRayN_dir_z(args->ray, all, first);
  }
  std::uint32_t primitive = RayBundle::kNoHit;
  alignas(32) float t[n]{};
  alignas(32) std::int32_t beside[n]{};
  if constexpr (changed) std::fill_n(beside, n, 1);  // for kInNone, which equals kNoHit
  for (unsigned k = 0; k < n; ++k) {
    const unsigned i = first + k;
    if (args->valid[i] == 0) continue;
    const unsigned named = RTCHitN_primID(args->hit, all, i);
    const std::uint32_t proposed = changed ? context.tree->number_by_runs(named)
                                           : context.tree->number(RTCHitN_instID(args->hit, all, i, 0), named);
    if (proposed != primitive) {  // mostly, all rays of a packet hit the same triangle
      primitive = proposed;
      if constexpr (changed)
        if (proposed == SceneTree::kInNone) {
          std::fill_n(beside, n, 1);
          args->valid[i] = 0;
          continue;
        }
      context.planes.distances<n>(context.planes.seen(primitive, origin), primitive, origin, x, y, z, t);
      context.planes.beside<n>(primitive, origin, x, y, z, t, beside);
    }
    if (beside[k] == 0 && take(RTCRayN_id(args->ray, all, i), primitive, t[k])) {
      RTCRayN_tfar(args->ray, all, i) = t[k] * kBeyond;
    } else {
      args->valid[i] = 0;
    }
  }
}

template <bool placed, bool changed, class Take>
[[gnu::always_inline]] inline void judge(const RTCFilterFunctionNArguments* args, const Context& context,
                                         const Take& take) {
  unsigned first = 0;
  for (; first + kPacketRays <= args->N; first += kPacketRays)
    judge<kPacketRays, placed, changed>(args, first, context, context.origin, take);
  for (; first < args->N; ++first) judge<1, placed, changed>(args, first, context, context.origin, take);
}

template <bool placed, bool changed, class Take>
[[gnu::always_inline]] inline void judge_each(const RTCFilterFunctionNArguments* args, const Context& context,
                                              const Take& take) {
  for (unsigned k = 0; k < args->N; ++k)
    if (args->valid[k] != 0)
      judge<1, placed, changed>(args, k, context, context.origins[RTCRayN_id(args->ray, args->N, k)], take);
}

template <class Take>
[[gnu::always_inline]] inline void judge(const RTCFilterFunctionNArguments* args, const Take& take) {
  const Context& context = *reinterpret_cast<const Context*>(args->context);
  if (context.changed) [[unlikely]]  // it shares no meshes
    context.origins ? judge_each<false, true>(args, context, take) : judge<false, true>(args, context, take);
  else if (context.origins)
    context.x ? judge_each<true, false>(args, context, take) : judge_each<false, false>(args, context, take);
  else if (context.x)
    judge<true, false>(args, context, take);
  else
    judge<false, false>(args, context, take);
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

// Notes every hit, and lets rays continue.
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
    : scene_(std::move(scene)),
      of_tree_(scene_),
      planes_(std::move(planes)),
      device_(embree::new_device()),
      tree_(device_.get(), *scene_, of == Of::opaque ? 0 : scene_->opaque_count(),
            of == Of::opaque ? scene_->opaque_count() : scene_->triangle_count(),
            {of == Of::opaque ? keep_least : note_all, note}, of == Of::opaque ? "of rays" : "of glass") {}

std::optional<RayCaster::Change> RayCaster::prepare(std::shared_ptr<const SceneData> scene,
                                                    const SceneDifference& difference) const {
  // Largest share of the tree's triangles, as 1/kShare, that may be gone or new, since rays visit both.
  constexpr std::uint32_t kShare = 4;
  Change change;
  change.numbers = of_tree_ == scene_ ? difference.kept : joined(numbers_, difference.kept);
  const std::uint32_t before = of_tree_->opaque_count(), after = scene->opaque_count();
  const std::vector<KeptRun> added = not_kept(change.numbers, after);
  std::uint64_t kept = 0, is_new = 0;
  for (const KeptRun& run : change.numbers)
    if (run.first < before) kept += run.count;
  for (const KeptRun& run : added) is_new += run.count;
  if ((before - kept + is_new) * kShare > before) return std::nullopt;
  if (is_new > 0)
    change.added = std::make_unique<const SceneTree>(device_.get(), *scene, added, SceneTree::Filters{keep_least, note},
                                                     "of what changed");
  change.scene = std::move(scene);
  return change;
}

void RayCaster::take(Change change) noexcept {
  scene_ = std::move(change.scene);
  added_ = std::move(change.added);
  tree_.renumber(change.numbers);
  changed_ = true;
  numbers_ = std::move(change.numbers);
}

void RayCaster::any_hits(const Float3& origin, float start, std::span<Probe> probes) const {
  constexpr std::size_t kStreamRays = 64;
  std::array<std::uint32_t, kStreamRays> hit;
  std::array<float, kStreamRays> end, x, y, z;
  alignas(64) std::array<RTCRay, kStreamRays> rays;
  const bool shared = scene_->shares();
  for (std::size_t first = 0; first < probes.size(); first += kStreamRays) {
    const std::size_t n = std::min(kStreamRays, probes.size() - first);
    for (std::size_t i = 0; i < n; ++i) {
      const Probe& probe = probes[first + i];
      end[i] = probe.end;
      rays[i] = {origin.x,
                 origin.y,
                 origin.z,
                 start * kBefore,
                 RayCaster::safe(probe.d.x),
                 RayCaster::safe(probe.d.y),
                 RayCaster::safe(probe.d.z),
                 0,
                 probe.end * kBeyond,
                 0xFFFFFFFFu,
                 static_cast<unsigned>(i),
                 0};
      if (shared) x[i] = rays[i].dir_x, y[i] = rays[i].dir_y, z[i] = rays[i].dir_z;
    }
    hit.fill(RayBundle::kNoHit);
    Context context{{}, *planes_, &tree_, origin, start, end.data(), hit.data()};
    if (shared) context.x = x.data(), context.y = y.data(), context.z = z.data();
    context.changed = changed_;
    const auto trace = [&](std::size_t many) {
#if VANTAGE_EMBREE_MAJOR >= 4
      rtcInitRayQueryContext(&context.rtc);
      RTCOccludedArguments arguments;
      rtcInitOccludedArguments(&arguments);
      arguments.context = &context.rtc;
      for (std::size_t i = 0; i < many; ++i) rtcOccluded1(context.tree->get(), &rays[i], &arguments);
#else
      rtcInitIntersectContext(&context.rtc);
      rtcOccluded1M(context.tree->get(), &context.rtc, rays.data(), static_cast<unsigned>(many), sizeof(RTCRay));
#endif
    };
    trace(n);
    if (added_) {
      std::size_t open = 0;
      for (std::size_t i = 0; i < n; ++i)
        if (hit[i] == RayBundle::kNoHit) rays[open++] = rays[i];
      context.tree = added_.get();
      if (open > 0) trace(open);
    }
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
  alignas(64) RTCRayHit8 hits[kBundlePackets];
  const std::uint32_t used = (rays.size + kPacketRays - 1) / kPacketRays;
  for (std::uint32_t i = rays.size; i < used * kPacketRays; ++i) {
    rays.x[i] = rays.y[i] = rays.z[i] = 1;
    rays.end[i] = -std::numeric_limits<float>::infinity();  // an end before the start disables the ray
  }
  for (std::uint32_t p = 0; p < used; ++p) {
    RTCRay8& ray = hits[p].ray;
    for (std::uint32_t lane = 0; lane < kPacketRays; ++lane) {
      const std::uint32_t i = p * kPacketRays + lane;
      const Float3& origin = rays.origins && i < rays.size ? rays.origins[i] : rays.origin;
      ray.org_x[lane] = origin.x;
      ray.org_y[lane] = origin.y;
      ray.org_z[lane] = origin.z;
      ray.tnear[lane] = rays.start * kBefore;
      ray.dir_x[lane] = RayCaster::safe(rays.x[i]);
      ray.dir_y[lane] = RayCaster::safe(rays.y[i]);
      ray.dir_z[lane] = RayCaster::safe(rays.z[i]);
      ray.time[lane] = 0;
      ray.tfar[lane] = rays.end[i] * kBeyond;
      ray.mask[lane] = 0xFFFFFFFFu;
      ray.id[lane] = i;
      ray.flags[lane] = 0;
      hits[p].hit.geomID[lane] = RTC_INVALID_GEOMETRY_ID;
      hits[p].hit.instID[0][lane] = RTC_INVALID_GEOMETRY_ID;
    }
  }
  std::copy_n(rays.end, used * kPacketRays, rays.t);
  std::fill_n(rays.primitive, used * kPacketRays, RayBundle::kNoHit);

  Context context{{}, *planes_, &tree_, rays.origin, rays.start, rays.t, rays.primitive, all};
  alignas(64) float x[RayBundle::kCapacity], y[RayBundle::kCapacity], z[RayBundle::kCapacity];
  if (scene_->shares()) {
    for (std::uint32_t i = 0; i < used * kPacketRays; ++i)
      x[i] = safe(rays.x[i]), y[i] = safe(rays.y[i]), z[i] = safe(rays.z[i]);
    context.x = x, context.y = y, context.z = z;
  }
  context.origins = rays.origins;
  context.changed = changed_;
  for (const SceneTree* const tree : {&tree_, added_.get()}) {
    if (!tree) break;
    context.tree = tree;
#if VANTAGE_EMBREE_MAJOR >= 4
    rtcInitRayQueryContext(&context.rtc);
    RTCIntersectArguments arguments;
    rtcInitIntersectArguments(&arguments);
    arguments.flags = RTC_RAY_QUERY_FLAG_COHERENT;
    arguments.context = &context.rtc;
    for (std::uint32_t p = 0; p < used; ++p) {
      alignas(32) int valid[packet];
      for (std::uint32_t lane = 0; lane < packet; ++lane) valid[lane] = p * packet + lane < rays.size ? -1 : 0;
      rtcIntersect8(valid, tree->get(), &hits[p], &arguments);
    }
#else
    rtcInitIntersectContext(&context.rtc);
    context.rtc.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
    rtcIntersectNM(tree->get(), &context.rtc, reinterpret_cast<RTCRayHitN*>(hits), kPacketRays, used,
                   sizeof(RTCRayHit8));
#endif
  }
  for (std::uint32_t i = 0; i < rays.size; ++i) {
    if (rays.primitive[i] == RayBundle::kNoHit) rays.t[i] = std::numeric_limits<float>::infinity();
  }
}

}  // namespace vantage
