// SPDX-License-Identifier: Apache-2.0
#include "scan/wide_beam.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <span>
#include <utility>

#include "core/philox.hpp"
#include "trace/embree/hits.hpp"
#include "trace/embree/point_judge.hpp"
#include "trace/embree/range_noise.hpp"

namespace vantage {
namespace {

using std::numbers::pi;

constexpr std::size_t kMostSubRays = 19, kMostReturns = 15;  // of LAS
// A point farther than this from the planes of all surfaces that it was made of is mixed, in metres.
constexpr double kMixed_m = 0.005;
// How much brighter than a white surface a pane returns the beam near its normal: enough to outshine all else.
constexpr double kPaneGleam = 100;
// The apex of a beam lies at most so far behind the head: farther, floats are too coarse, and the beam is as good as
// parallel.
constexpr double kFarthestApex_m = 100;
constexpr std::uint32_t kTwistStream = 3;

// Places of sub-rays over the footprint, in units of its radius at 1/e², and their shares of the power of a Gaussian
// beam: a hexagon's cell each, which together have the footprint's area.
struct SubRays {
  std::array<double, kMostSubRays> x, y, share;
};
SubRays make_sub_rays(std::uint32_t count) {
  const double side = std::sqrt(2 * pi / (static_cast<double>(count) * std::sqrt(3)));
  SubRays rays{};
  std::size_t n = 1;  // the first in the middle
  const int rings = count == 7 ? 1 : 2;
  for (int i = -rings; i <= rings; ++i)
    for (int j = std::max(-rings, -i - rings); j <= std::min(rings, -i + rings); ++j) {
      if (i == 0 && j == 0) continue;
      rays.x[n] = side * (i + 0.5 * j);
      rays.y[n++] = side * std::sqrt(0.75) * j;
    }
  double sum = 0;
  for (std::size_t k = 0; k < count; ++k)
    sum += rays.share[k] = std::exp(-2 * (rays.x[k] * rays.x[k] + rays.y[k] * rays.y[k]));
  for (std::size_t k = 0; k < count; ++k) rays.share[k] /= sum;
  return rays;
}

Vec3 unit(const Vec3& v) { return v * (1 / std::sqrt(dot(v, v))); }

}  // namespace

struct WideBeam::Echo {
  double t, strength, reflectivity;
  std::uint32_t triangle;
  bool ghost;
  RayFollower::Seen seen;
};

WideBeam::WideBeam(std::shared_ptr<const SceneData> scene, std::shared_ptr<const VoxelGrid> grid)
    : scene_(std::move(scene)), grid_(std::move(grid)), rays_(scene_) {
  if (scene_->has_glass()) glass_ = std::make_unique<const GlassPanes>(scene_, rays_.planes());
}

std::vector<WideBeam::Return> WideBeam::returns_of(const Scanner& scanner, const TraceStation& station,
                                                   const BeamOptions& options, const RayPattern& pattern,
                                                   std::uint64_t ray, std::uint64_t seed) const {
  const static SubRays seven = make_sub_rays(7), nineteen = make_sub_rays(19);
  const SubRays& places = options.sub_rays == 7 ? seven : nineteen;
  const Float3 axis = direction_of(pattern, station, ray);
  const Vec3 d = widen(axis);
  const Vec3 u = unit(cross(std::abs(d.z) < 0.9 ? Vec3{0, 0, 1} : Vec3{1, 0, 0}, d)), v = cross(d, u);
  // Rays of a beam that is as wide as the exit there, and widens, come from an apex behind the head.
  const double wide = std::max(scanner.beam_divergence.in_radians(), scanner.exit_diameter_m / kFarthestApex_m);
  const double behind = scanner.exit_diameter_m / wide;
  // Each footprint is turned by chance, so that no edge meets the same places everywhere.
  const std::uint32_t chance = philox4x32(
      seed, {static_cast<std::uint32_t>(ray), static_cast<std::uint32_t>(ray >> 32), station.place, kTwistStream})[0];
  const double twist = 2 * pi * chance / 4294967296.0, c = std::cos(twist), s = std::sin(twist);
  RayBundle rays;
  rays.origin = narrow(widen(station.origin) - d * behind);
  rays.size = options.sub_rays;
  for (std::uint32_t k = 0; k < rays.size; ++k) {
    const double x = c * places.x[k] - s * places.y[k], y = s * places.x[k] + c * places.y[k];
    const Float3 way = narrow(d + (u * x + v * y) * (wide / 2));
    rays.x[k] = way.x;
    rays.y[k] = way.y;
    rays.z[k] = way.z;
    rays.end[k] = static_cast<float>(behind) + pattern.max_range;
  }
  rays.start = static_cast<float>(behind) + pattern.min_range;
  rays_.caster().cast(rays);
  std::array<Passed, kMostSubRays> passed;
  bool behind_glass = false;
  if (glass_ && scanner.detection_range_m > 0) {
    RayBundle beams = rays;
    beams.start = static_cast<float>(behind);
    for (std::uint32_t k = 0; k < rays.size; ++k)
      if (rays.primitive[k] != RayBundle::no_hit) beams.end[k] = rays.t[k];
    behind_glass = glass_->follow(beams, passed);
  }

  // An echo of strength 1 is just detected.
  const double bright = scanner.detection_range_m > 0
                            ? scanner.detection_range_m * scanner.detection_range_m / scanner.detection_reflectivity
                            : 0;
  std::vector<Echo> echoes;
  for (std::uint32_t k = 0; k < rays.size; ++k) {
    const Float3 way{rays.x[k], rays.y[k], rays.z[k]};
    Echo echo{0, 0, 0, rays.primitive[k], false, {}};
    double gleam = 1;
    if (behind_glass && passed[k].pane != RayBundle::no_hit && passed[k].t >= rays.start) {
      echo.triangle = passed[k].pane;
      echo.t = static_cast<double>(passed[k].t);
      echo.seen = rays_.seen(rays.origin, way, passed[k].t, echo.triangle);
      echo.reflectivity = places.share[k];
      gleam = kPaneGleam;
    } else {
      if (echo.triangle == RayBundle::no_hit) continue;
      if (rays_.is_mirror(echo.triangle)) {
        echo.seen = rays_.follow(rays.origin, way, rays.start, rays.end[k]);
        echo.ghost = true;
        if (echo.seen.triangle == RayBundle::no_hit) continue;
        echo.triangle = echo.seen.triangle;
      } else {
        echo.seen = rays_.seen(rays.origin, way, rays.t[k], echo.triangle);
      }
      echo.t = static_cast<double>(echo.seen.t);
      echo.reflectivity =
          places.share[k] * (behind_glass ? passed[k].share : 1) * static_cast<double>(echo.seen.reflectivity);
    }
    echo.t -= behind;
    echo.strength = gleam * echo.reflectivity / (echo.t * echo.t);
    if (echo.strength > 0) echoes.push_back(echo);
  }
  std::ranges::sort(echoes, {}, [](const Echo& e) { return std::pair(e.t, e.triangle); });

  std::vector<Return> found;
  std::vector<double> strengths;
  for (std::size_t begin = 0, end = 0; begin < echoes.size() && found.size() < kMostReturns; begin = end) {
    double strength = 0, reach = 0, reflectivity = 0;
    std::size_t strongest = begin;
    for (; end < echoes.size() && (end == begin || echoes[end].t - echoes[end - 1].t <= options.pulse_m / 2); ++end) {
      strength += echoes[end].strength;
      reach += echoes[end].strength * echoes[end].t;
      reflectivity += echoes[end].reflectivity;
      if (echoes[end].strength > echoes[strongest].strength) strongest = end;
    }
    if (bright > 0 && strength * bright < 1) continue;
    const Echo& main = echoes[strongest];
    const double t = reach / strength;
    double off = std::numeric_limits<double>::infinity();
    const Vec3 point = widen(station.origin) + d * t;
    for (std::size_t k = begin; k < end; ++k)
      off = std::min(off, echoes[k].ghost ? 0 : rays_.distance_from_plane(echoes[k].triangle, point));
    strengths.push_back(strength);
    found.push_back({.ray = ray,
                     .number = 1,
                     .of = 1,
                     .ghost = main.ghost,
                     .mixed = off > kMixed_m,
                     .t = static_cast<float>(t),
                     .reflectivity = static_cast<float>(std::min(reflectivity, 1.0)),
                     .triangle = main.triangle,
                     .cosine = main.seen.cosine,
                     .direction = axis,
                     .normal = main.seen.normal,
                     .weights = main.seen.weights});
  }
  if (found.size() > 1 && options.returns != Returns::all) {
    const auto chosen = options.returns == Returns::first  ? std::ptrdiff_t{0}
                        : options.returns == Returns::last ? std::ssize(found) - 1
                                                           : std::ranges::max_element(strengths) - strengths.begin();
    found = {found[static_cast<std::size_t>(chosen)]};
  }
  for (std::size_t k = 0; k < found.size(); ++k) {
    found[k].number = static_cast<std::uint8_t>(k + 1);
    found[k].of = static_cast<std::uint8_t>(found.size());
  }
  return found;
}

std::vector<WideBeam::Return> WideBeam::returns(const Scanner& scanner, const TraceScanner& traced,
                                                const TraceStation& station, const BeamOptions& options,
                                                std::uint64_t first_ray, std::uint64_t ray_count) const {
  constexpr std::uint64_t kPart = 1024;
  std::vector<std::vector<Return>> parts((ray_count + kPart - 1) / kPart);
  tbb::parallel_for(std::size_t{0}, parts.size(), [&](std::size_t p) {
    for (std::uint64_t ray = first_ray + p * kPart; ray < first_ray + std::min(ray_count, (p + 1) * kPart); ++ray) {
      const std::vector<Return> own = returns_of(scanner, station, options, *traced.pattern, ray, traced.noise->seed);
      parts[p].insert(parts[p].end(), own.begin(), own.end());
    }
  });
  std::vector<Return> all;
  for (const std::vector<Return>& part : parts) all.insert(all.end(), part.begin(), part.end());
  return all;
}

void WideBeam::fill(const TraceScanner& traced, const TraceStation& station, const std::vector<Return>& returns,
                    std::uint8_t number, std::uint64_t first_ray, std::uint64_t ray_count, Tracer::RawChunk& raw,
                    std::vector<std::uint8_t>& ghost, std::vector<std::uint8_t>& count, ScanSummary& summary) const {
  const RangeNoise noise(traced.noise);
  const PointJudge judge(traced.limits);
  raw.range.assign(ray_count, std::numeric_limits<float>::infinity());
  raw.position.assign(ray_count, {});
  raw.normal.assign(ray_count, {});
  raw.reflectivity.assign(ray_count, 0);
  raw.primitive.assign(ray_count, RayBundle::no_hit);
  raw.barycentric.assign(ray_count, {});
  raw.voxel.assign(ray_count, no_voxel);
  ghost.assign(ray_count, 0);
  count.assign(ray_count, 0);
  for (const Return& own : returns) {
    if (own.number != number) continue;
    const std::uint64_t k = own.ray - first_ray;
    const float t = noise.enabled() ? noise.displaced(own.t, own.reflectivity, own.ray, station.place) : own.t;
    const Float3 point = point_at(station.origin, own.direction, t);
    const std::uint32_t mesh = rays_.mesh(own.triangle);
    raw.range[k] = t;
    raw.position[k] = point;
    raw.normal[k] = own.normal;
    raw.reflectivity[k] = own.reflectivity;
    raw.primitive[k] = own.triangle;
    raw.barycentric[k] = own.weights;
    ghost[k] = own.ghost ? 1 : 0;
    count[k] = own.of;
    bool counts = !own.ghost && scene_->meshes[mesh].role == Role::surveyed;
    if (counts && judge.enabled()) {
      const DroppedPoints dropped = judge.missed(mesh, own.cosine, own.t, own.reflectivity, 1);
      counts = dropped.incidence + dropped.footprint + dropped.noise == 0;  // the echo was judged by its strength
    }
    if (counts) raw.voxel[k] = grid_->index_of(point);
    if (own.mixed) {
      ++summary.mixed;
      summary.mixed_counted += raw.voxel[k] != no_voxel ? 1 : 0;
    }
  }
}

}  // namespace vantage
