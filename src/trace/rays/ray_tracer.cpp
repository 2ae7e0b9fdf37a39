// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <utility>

#include "core/parallel.hpp"
#include "core/site_reach.hpp"
#include "core/text.hpp"
#include "scene/scene_data.hpp"
#include "shared/own_ray_types.h"
#include "trace/embree/embree_tracer.hpp"
#include "trace/rays/ray_batches.hpp"
#include "trace/rays/sheared_ray.hpp"
#include "trace/rays/widened_tree.hpp"
#include "vantage/error.hpp"
#include "vantage/rays.hpp"

namespace vantage {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr std::uint32_t kNoTriangle = no_primitive;
// The processor traces rays that enter the scene farther away than this many scene sizes. Up to here, double precision
// rounds the way to the scene by less than a device allows for.
constexpr double kFarthestEntry = 0x1p18;
// Rays between two reports of progress, and of one task.
constexpr std::size_t kAtOnce = std::size_t{1} << 18, kGrain = 256;

// Returns element k of an array with one element for all rays, or one for each.
template <class T>
const T& one_of(std::span<const T> values, std::size_t k) {
  return values[values.size() == 1 ? 0 : k];
}

[[noreturn]] void refuse(const std::string& why) { throw Error(Errc::invalid_argument, "rays: " + why); }

std::string row(std::size_t k) { return "row " + std::to_string(k) + ", counted from 0, "; }

// Returns the number of rays.
std::size_t number_of(const Rays& rays) {
  const std::size_t sizes[] = {rays.origins.size(), rays.directions.size(),
                               rays.ranges_m.empty() ? 1 : rays.ranges_m.size()};
  std::size_t n = 1;
  for (const std::size_t size : sizes)
    if (size != 1) n = size;
  for (const std::size_t size : sizes)
    if (size != n && size != 1)
      refuse("there are " + std::to_string(sizes[0]) + " origins and " + std::to_string(sizes[1]) + " directions" +
             (rays.ranges_m.empty() ? "" : " and " + std::to_string(sizes[2]) + " ranges") +
             "; give as many of each, or one for all");
  return n;
}

// Returns the index of the first bad value, or the number of values.
template <class T, class Good>
std::size_t first_bad(std::span<const T> values, const Good& good) {
  return parallel::reduce(
      tbb::blocked_range<std::size_t>(0, values.size(), kGrain * kGrain), values.size(),
      [&](const auto& range, std::size_t first) {
        for (std::size_t k = range.begin(); k < std::min(range.end(), first); ++k)
          if (!good(values[k])) return k;
        return first;
      },
      [](std::size_t a, std::size_t b) { return std::min(a, b); });
}

void check(const Rays& rays, const RayOptions& options, const Vec3& origin) {
  std::size_t k = first_bad(rays.origins, [&](const Vec3& from) { return in_reach(from, origin); });
  if (k < rays.origins.size()) refuse_position(rays.origins[k], "rays: the origin in " + row(k) + "is");
  k = first_bad(rays.directions, [](const Vec3& d) {
    return std::isfinite(d.x) && std::isfinite(d.y) && std::isfinite(d.z) && !(d == Vec3{});
  });
  if (k < rays.directions.size()) {
    const Vec3& d = rays.directions[k];
    refuse("the direction in " + row(k) + "is (" + number(d.x) + ", " + number(d.y) + ", " + number(d.z) +
           "); a direction must be finite and longer than 0");
  }
  k = first_bad(rays.ranges_m, [](double range) { return range > 0; });
  if (k < rays.ranges_m.size())
    refuse("the range in " + row(k) + "is " + number(rays.ranges_m[k]) + " m; a range must be above 0");
  if (!(options.from_m >= 0 && std::isfinite(options.from_m)))
    refuse("hits count from " + number(options.from_m) + " m on; that must be finite and 0 or more");
}

// Returns the unit vector along a direction, whose components may be as small or as large as doubles are.
Vec3 unit_of(const Vec3& direction) {
  const double most = std::max({std::abs(direction.x), std::abs(direction.y), std::abs(direction.z)});
  // Scaling by a power of 2 changes no bit of the result unless it keeps squares and quotients within range.
  const auto usual = [](double part) { return part == 0 || std::abs(part) > 0x1p-300; };
  if (most < 0x1p300 && usual(direction.x) && usual(direction.y) && usual(direction.z)) {
    const double length = std::sqrt(dot(direction, direction));
    return {direction.x / length, direction.y / length, direction.z / length};
  }
  int exponent = 0;
  std::frexp(most, &exponent);
  const Vec3 scaled{std::ldexp(direction.x, -exponent), std::ldexp(direction.y, -exponent),
                    std::ldexp(direction.z, -exponent)};
  const double length = std::sqrt(dot(scaled, scaled));
  return {scaled.x / length, scaled.y / length, scaled.z / length};
}

// A ray and the limits of its hits.
struct LocalRay {
  Vec3 origin, unit;  // local frame
  double from, range;
};

// Tests which triangles count for a ray.
class Meeting : public WidenedTree::Query {
 public:
  Meeting(const SceneData& scene, const LocalRay& ray, std::uint32_t end)
      : scene_(scene), ray_(ray), sheared_(ray.origin, ray.unit), end_(end) {}

 protected:
  std::optional<ShearedRay::Hit> meet(std::uint32_t triangle) const {
    if (triangle >= end_) return std::nullopt;
    const auto hit = sheared_.meet(scene_.corners(triangle));
    return hit && hit->t > ray_.from && hit->t <= ray_.range ? hit : std::nullopt;
  }

  const SceneData& scene_;
  const LocalRay& ray_;
  const ShearedRay sheared_;
  const std::uint32_t end_;  // glass from here on is passed
};

struct NearestQuery final : Meeting {
  using Meeting::Meeting;
  double take(std::uint32_t number) override {
    const auto met = meet(number);
    if (met && (met->t < hit.t || (met->t == hit.t && number < triangle))) hit = *met, triangle = number;
    return triangle == kNoTriangle ? ray_.range : hit.t;
  }
  ShearedRay::Hit hit{kInfinity, {}};
  std::uint32_t triangle = kNoTriangle;
};

struct BlockedQuery final : Meeting {
  using Meeting::Meeting;
  double take(std::uint32_t number) override {
    found = found || meet(number);
    return found ? -kInfinity : ray_.range;
  }
  bool found = false;
};

struct CountQuery final : Meeting {
  using Meeting::Meeting;
  double take(std::uint32_t number) override {
    if (meet(number)) ++count;
    return ray_.range;
  }
  std::uint32_t count = 0;
};

// Returns the unit normal at a hit, turned against the ray: interpolated from the corners, or the plane's.
Vec3 normal_of(const SceneData& scene, const NearestQuery& found, const Vec3& unit) {
  const auto corners = scene.corners(found.triangle);
  const Vec3 a = widen(corners[0]);
  Vec3 normal = cross(widen(corners[1]) - a, widen(corners[2]) - a);
  if (!scene.normals.empty()) {
    const auto normals = scene.corner_normals(found.triangle);
    const auto [second, third] = found.hit.weights;
    const Vec3 smooth =
        widen(normals[0]) * (1 - second - third) + widen(normals[1]) * second + widen(normals[2]) * third;
    if (dot(smooth, smooth) > 0) normal = smooth;
  }
  const double length = std::sqrt(dot(normal, normal));
  return normal * ((dot(normal, unit) > 0 ? -1 : 1) / length);
}

}  // namespace

struct RayTracer::Impl {
  Impl(const Scene& of, const DeviceChoice& device)
      : scene(of), data(share(of)), tree(data), batches([shared = data, device] {
          return shared->triangle_count() > 0 ? make_ray_finder(device, shared) : nullptr;
        }) {}

  static std::shared_ptr<const SceneData> share(const Scene& scene) {
    const auto kept = std::make_shared<const Scene>(scene);
    return {kept, &kept->data()};
  }

  // Calls trace(k, ray, end, answer) for each ray in parallel. `end`: of the triangles that count; `answer`: the
  // device's, or open_answer. Returns false if stopped.
  template <class Trace>
  bool for_each(const Rays& rays, std::size_t n, const RayOptions& options, const Progress& progress,
                RayQuestion question, const Trace& trace) const {
    const std::uint32_t end = options.glass ? data->triangle_count() : data->opaque_count();
    const auto ray_at = [&](std::size_t k) {
      return LocalRay{one_of(rays.origins, k) - data->origin, unit_of(one_of(rays.directions, k)), options.from_m,
                      rays.ranges_m.empty() ? kInfinity : one_of(rays.ranges_m, k)};
    };
    const auto in_parallel = [](std::size_t first, std::size_t last, const auto& each) {
      parallel::for_all(tbb::blocked_range<std::size_t>(first, last, kGrain), [&](const auto& range) {
        for (std::size_t k = range.begin(); k < range.end(); ++k) each(k);
      });
    };
    if (batches.on_device())
      return batches.run(n,
                         {question, end,
                          [&](std::size_t first, std::span<OwnRay> to) {
                            in_parallel(0, to.size(), [&](std::size_t k) { to[k] = own_ray(ray_at(first + k)); });
                          },
                          [&](std::size_t first, std::span<const std::uint32_t> answers) {
                            in_parallel(0, answers.size(),
                                        [&](std::size_t k) { trace(first + k, ray_at(first + k), end, answers[k]); });
                          }},
                         progress);
    for (std::size_t first = 0; first < n; first += kAtOnce) {
      if (progress.stopped()) return false;
      const std::size_t last = std::min(n, first + kAtOnce);
      in_parallel(first, last, [&](std::size_t k) { trace(k, ray_at(k), end, open_answer); });
      progress(static_cast<double>(last) / static_cast<double>(n));
    }
    return !progress.stopped();
  }

  // Returns the ray for a device, from its entry into the scene. Limits outside the scene are dropped, so that rounding
  // makes no hits at its ends doubtful.
  OwnRay own_ray(const LocalRay& ray) const {
    OwnRay own{.origin = {}, .from = 0, .direction = {}, .range = own_ray_misses};
    const auto way = ray.from < ray.range ? tree.way_of(ray.origin, ray.unit, ray.from, ray.range) : std::nullopt;
    if (!way) return own;
    if (way->begin > kFarthestEntry * tree.size()) {
      own.range = own_ray_open;
      return own;
    }
    const Float3 at = narrow(ray.origin + ray.unit * way->begin), unit = narrow(ray.unit);
    own.origin = {at.x, at.y, at.z};
    own.direction = {unit.x, unit.y, unit.z};
    own.from = way->begin > ray.from ? -std::numeric_limits<float>::infinity() : 0;
    own.range =
        way->end < ray.range ? std::numeric_limits<float>::infinity() : static_cast<float>(ray.range - way->begin);
    return own;
  }

  template <class Query>
  Query run(const LocalRay& ray, std::uint32_t end) const {
    Query query(*data, ray, end);
    if (ray.from < ray.range) tree.run(ray.origin, ray.unit, ray.from, ray.range, query);
    return query;
  }

  // Returns the nearest hit, which a device may have found already.
  NearestQuery nearest(const LocalRay& ray, std::uint32_t end, std::uint32_t answer) const {
    if (answer != open_answer) {
      NearestQuery known(*data, ray, end);
      if (answer != kNoTriangle) known.take(answer);
      if (known.triangle == answer) return known;
      assert(false);  // a device's answers are certain
    }
    return run<NearestQuery>(ray, end);
  }

  std::size_t checked(const Rays& rays, const RayOptions& options) const {
    const std::size_t n = number_of(rays);
    check(rays, options, data->origin);
    return n;
  }

  Scene scene;
  std::shared_ptr<const SceneData> data;
  WidenedTree tree;
  mutable RayBatches batches;
  EngineInfo engine = batches.on_device() ? batches.info() : embree_engine_info();
};

RayTracer::RayTracer(const Scene& scene, const DeviceChoice& device)
    : impl_(std::make_shared<const Impl>(scene, device)) {}

const Scene& RayTracer::scene() const noexcept { return impl_->scene; }
const EngineInfo& RayTracer::engine() const noexcept { return impl_->engine; }

RayHits RayTracer::nearest(const Rays& rays, const RayOptions& options, const Progress& progress) const {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  const SceneData& data = *impl_->data;
  const std::size_t n = impl_->checked(rays, options);
  RayHits hits;
  // In parallel, since first writes to fresh memory take most of the time.
  tbb::task_group arrays;
  arrays.run([&] { hits.position.assign(n, {kNan, kNan, kNan}); });
  arrays.run([&] { hits.normal.resize(n); });
  arrays.run([&] { hits.range_m.assign(n, kInfinity); });
  arrays.run([&] { hits.reflectivity.resize(n), hits.diffuse.resize(n); });
  arrays.run([&] { hits.mesh.assign(n, -1), hits.primitive.assign(n, kNoTriangle); });
  parallel::wait(arrays);
  const bool whole = impl_->for_each(rays, n, options, progress, RayQuestion::nearest,
                                     [&](std::size_t k, const LocalRay& ray, std::uint32_t end, std::uint32_t answer) {
                                       const NearestQuery found = impl_->nearest(ray, end, answer);
                                       if (found.triangle == kNoTriangle) return;
                                       const std::uint32_t mesh = data.mesh_of(found.triangle);
                                       const Vec3 normal = normal_of(data, found, ray.unit);
                                       const double diffuse = data.meshes[mesh].diffuse;
                                       hits.range_m[k] = found.hit.t;
                                       hits.position[k] = one_of(rays.origins, k) + ray.unit * found.hit.t;
                                       const Float3 narrowed = narrow(normal);
                                       hits.normal[k] = {narrowed.x, narrowed.y, narrowed.z};
                                       hits.reflectivity[k] =
                                           static_cast<float>(std::clamp(-diffuse * dot(normal, ray.unit), 0.0, 1.0));
                                       hits.diffuse[k] = static_cast<float>(diffuse);
                                       hits.mesh[k] = static_cast<std::int32_t>(mesh);
                                       hits.primitive[k] = found.triangle;
                                     });
  if (!whole) return {};
  return hits;
}

std::vector<std::uint8_t> RayTracer::blocked(const Rays& rays, const RayOptions& options,
                                             const Progress& progress) const {
  std::vector<std::uint8_t> blocked(impl_->checked(rays, options));
  const bool whole =
      impl_->for_each(rays, blocked.size(), options, progress, RayQuestion::blocked,
                      [&](std::size_t k, const LocalRay& ray, std::uint32_t end, std::uint32_t answer) {
                        blocked[k] = answer == open_answer ? impl_->run<BlockedQuery>(ray, end).found : answer != 0;
                      });
  if (!whole) return {};
  return blocked;
}

std::vector<std::uint32_t> RayTracer::count(const Rays& rays, const RayOptions& options,
                                            const Progress& progress) const {
  std::vector<std::uint32_t> counts(impl_->checked(rays, options));
  const bool whole = impl_->for_each(rays, counts.size(), options, progress, RayQuestion::count,
                                     [&](std::size_t k, const LocalRay& ray, std::uint32_t end, std::uint32_t answer) {
                                       counts[k] =
                                           answer == open_answer ? impl_->run<CountQuery>(ray, end).count : answer;
                                     });
  if (!whole) return {};
  return counts;
}

}  // namespace vantage
