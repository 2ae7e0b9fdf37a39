// SPDX-License-Identifier: Apache-2.0
#include "scan/wide_beam.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <span>
#include <utility>

#include "core/parallel.hpp"
#include "core/philox.hpp"
#include "trace/embree/hits.hpp"
#include "trace/embree/point_judge.hpp"
#include "trace/embree/range_noise.hpp"

namespace vantage {
namespace {

using std::numbers::pi;

constexpr std::size_t kMostSubRays = 19, kMostReturns = 15;  // of LAS
// A point is mixed if it is farther than this, in metres, from the planes of all surfaces that contributed to it.
constexpr double kMixed_m = 0.005;
// Brightness of a pane that reflects the beam near its normal, relative to a white surface: it outshines all else.
constexpr double kPaneGleam = 100;
constexpr std::uint32_t kTwistStream = 3;
constexpr std::uint64_t kPart = 1024;  // rays that a task follows

// Places of sub-rays over the footprint, in units of its radius at 1/e², and their shares of the power of a Gaussian
// beam. Each stands for a hexagonal cell; all cells together have the footprint's area.
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
  Float3 from, way;  // of its sub-ray
  RayFollower::Seen seen;
};

WideBeam::WideBeam(std::shared_ptr<const SceneData> scene, std::shared_ptr<const VoxelGrid> grid)
    : scene_(std::move(scene)), grid_(std::move(grid)), rays_(scene_) {}

// Follows the rays of one station, one after the other.
class WideBeam::Follower {
 public:
  Follower(const WideBeam& beam, const Scanner& scanner, const TraceScanner& traced, const TraceStation& station,
           const BeamOptions& options)
      : beam_(beam),
        scanner_(scanner),
        pattern_(*traced.pattern),
        station_(station),
        options_(options),
        seed_(traced.noise->seed),
        noise_(traced.noise),
        judge_(traced.limits) {}

  // Returns the wanted returns of a ray, until the next call. If none is detected, the strongest one, not `detected`.
  std::span<const Return> returns_of(std::uint64_t ray);

 private:
  void find_echoes(std::uint64_t ray);
  // Merges the echoes from begin to end into one return.
  Return merged(std::uint64_t ray, std::size_t begin, std::size_t end, double strength) const;

  const WideBeam& beam_;
  const Scanner& scanner_;
  const RayPattern& pattern_;
  const TraceStation& station_;
  const BeamOptions& options_;
  std::uint64_t seed_;
  RangeNoise noise_;
  PointJudge judge_;
  // State of the current ray.
  Float3 axis_{};
  std::vector<Echo> echoes_;
  std::vector<Return> found_;
  std::vector<double> strengths_;
};

void WideBeam::Follower::find_echoes(std::uint64_t ray) {
  const static SubRays seven = make_sub_rays(7), nineteen = make_sub_rays(19);
  const SubRays& places = options_.sub_rays == 7 ? seven : nineteen;
  axis_ = direction_of(pattern_, station_, ray);
  const Vec3 d = widen(axis_);
  const Vec3 u = unit(cross(std::abs(d.z) < 0.9 ? Vec3{0, 0, 1} : Vec3{1, 0, 0}, d)), v = cross(d, u);
  // Lines through the exit that are skewed sideways form the surface of a Gaussian beam, of radius √(exit² + (spread
  // t)²).
  const double exit = scanner_.exit_diameter_m / 2, spread = scanner_.beam_divergence.in_radians() / 2;
  // Each footprint is turned randomly, so that no edge meets the same places everywhere.
  const std::uint32_t chance = random_bits(seed_, ray, station_.place, kTwistStream);
  const double twist = 2 * pi * chance / 4294967296.0, c = std::cos(twist), s = std::sin(twist);
  std::array<Float3, kMostSubRays> from;
  RayBundle rays;
  rays.origin = station_.origin;
  rays.origins = from.data();
  rays.size = options_.sub_rays;
  for (std::uint32_t k = 0; k < rays.size; ++k) {
    const double x = c * places.x[k] - s * places.y[k], y = s * places.x[k] + c * places.y[k];
    from[k] = narrow(widen(station_.origin) + (u * x + v * y) * exit);
    const Float3 way = narrow(d + (v * x - u * y) * spread);
    rays.x[k] = way.x;
    rays.y[k] = way.y;
    rays.z[k] = way.z;
    rays.end[k] = pattern_.max_range;
  }
  rays.start = pattern_.min_range;
  beam_.rays_.caster().cast(rays);
  std::array<Passed, kMostSubRays> passed;
  bool behind_glass = false;
  const GlassPanes* const glass = scanner_.detection_range_m > 0 ? beam_.rays_.glass() : nullptr;
  if (glass) {
    RayBundle beams = rays;
    beams.start = 0;
    for (std::uint32_t k = 0; k < rays.size; ++k)
      if (rays.primitive[k] != RayBundle::kNoHit) beams.end[k] = rays.t[k];
    behind_glass = glass->follow(beams, passed);
  }

  echoes_.clear();
  for (std::uint32_t k = 0; k < rays.size; ++k) {
    const Float3 way{rays.x[k], rays.y[k], rays.z[k]};
    Echo echo{0, 0, 0, rays.primitive[k], false, from[k], way, {}};
    double gleam = 1;
    if (behind_glass && passed[k].pane != RayBundle::kNoHit && passed[k].t >= rays.start) {
      echo.triangle = passed[k].pane;
      echo.t = static_cast<double>(passed[k].t);
      echo.seen = beam_.rays_.seen(from[k], way, passed[k].t, echo.triangle);
      echo.reflectivity = places.share[k];
      gleam = kPaneGleam;
    } else {
      if (echo.triangle == RayBundle::kNoHit) continue;
      if (beam_.rays_.is_mirror(echo.triangle)) {
        echo.seen = beam_.rays_.follow(from[k], way, rays.start, rays.end[k]);
        echo.ghost = true;
        if (echo.seen.triangle == RayBundle::kNoHit) continue;
        echo.triangle = echo.seen.triangle;
      } else {
        echo.seen = beam_.rays_.seen(from[k], way, rays.t[k], echo.triangle);
        if (behind_glass) echo.seen.passed = passed[k].share;
      }
      echo.t = static_cast<double>(echo.seen.t);
      echo.reflectivity =
          places.share[k] * (glass ? echo.seen.passed : 1) * static_cast<double>(echo.seen.reflectivity);
    }
    echo.strength = gleam * echo.reflectivity / (echo.t * echo.t);
    if (echo.strength > 0) echoes_.push_back(echo);
  }
  std::ranges::sort(echoes_, {}, [](const Echo& e) { return std::pair(e.t, e.triangle); });
}

WideBeam::Return WideBeam::Follower::merged(std::uint64_t ray, std::size_t begin, std::size_t end,
                                            double strength) const {
  double reach = 0, reflectivity = 0;
  const Echo* main = &echoes_[begin];
  for (std::size_t k = begin; k < end; ++k) {
    reach += echoes_[k].strength * echoes_[k].t;
    reflectivity += echoes_[k].reflectivity;
    if (echoes_[k].strength > main->strength) main = &echoes_[k];
  }
  const auto t = static_cast<float>(reach / strength);
  double off = std::numeric_limits<double>::infinity();
  const Vec3 undisturbed = widen(station_.origin) + widen(axis_) * (reach / strength);
  for (std::size_t k = begin; k < end; ++k)
    off = std::min(off, echoes_[k].ghost ? 0 : beam_.rays_.distance_from_plane(echoes_[k].triangle, undisturbed));
  Return made{.ray = ray,
              .number = 1,
              .of = 1,
              .detected = true,
              .ghost = main->ghost,
              .mixed = off > kMixed_m,
              .wrong_voxel = false,
              .t = t,
              .reflectivity = static_cast<float>(std::min(reflectivity, 1.0)),
              .triangle = main->triangle,
              .voxel = kNoVoxel,
              .dropped = {},
              .point = {},
              .normal = main->seen.normal,
              .weights = main->seen.weights};
  if (noise_.enabled()) made.t = noise_.displaced(t, made.reflectivity, ray, station_.place);
  made.point = point_at(station_.origin, axis_, made.t);
  if (made.ghost) return made;
  const std::uint32_t voxel_index = beam_.grid_->index_of(made.point), mesh = beam_.rays_.mesh(made.triangle);
  if (voxel_index == kNoVoxel) return made;
  made.wrong_voxel = made.mixed && std::none_of(echoes_.begin() + static_cast<std::ptrdiff_t>(begin),
                                                echoes_.begin() + static_cast<std::ptrdiff_t>(end), [&](const Echo& e) {
                                                  return beam_.grid_->index_of(point_at(
                                                             e.from, e.way, static_cast<float>(e.t))) == voxel_index;
                                                });
  if (made.wrong_voxel || beam_.scene_->meshes[mesh].role != Role::surveyed) return made;
  if (judge_.enabled()) {
    made.dropped = judge_.missed(mesh, main->seen.cosine, t, made.reflectivity, 1);
    made.dropped.echo = 0;  // judged by its strength
    made.dropped.points = made.dropped.incidence + made.dropped.footprint + made.dropped.noise > 0;
  }
  if (made.dropped.points == 0) made.voxel = voxel_index;
  return made;
}

std::span<const WideBeam::Return> WideBeam::Follower::returns_of(std::uint64_t ray) {
  find_echoes(ray);
  // An echo of strength 1 is just detected.
  const double bright = scanner_.detection_range_m > 0
                            ? scanner_.detection_range_m * scanner_.detection_range_m / scanner_.detection_reflectivity
                            : 0;
  found_.clear(), strengths_.clear();
  const bool all_lost = judge_.lost(ray, station_.place);
  double strongest_lost = 0;
  std::pair<std::size_t, std::size_t> lost;
  for (std::size_t begin = 0, end = 0; begin < echoes_.size() && found_.size() < kMostReturns; begin = end) {
    double strength = 0;
    for (; end < echoes_.size() && (end == begin || echoes_[end].t - echoes_[end - 1].t <= options_.pulse_m / 2); ++end)
      strength += echoes_[end].strength;
    if (!all_lost && (bright == 0 || strength * bright >= 1)) {
      strengths_.push_back(strength);
      found_.push_back(merged(ray, begin, end, strength));
    } else if (strength > strongest_lost) {
      strongest_lost = strength, lost = {begin, end};
    }
  }
  if (found_.empty() && strongest_lost > 0) {
    found_.push_back(merged(ray, lost.first, lost.second, strongest_lost));
    Return& lost_one = found_.front();
    DroppedPoints& dropped = lost_one.dropped;
    if (lost_one.voxel != kNoVoxel || dropped.points > 0) dropped.echo = dropped.points = 1;
    lost_one.detected = false, lost_one.voxel = kNoVoxel;
    return found_;
  }
  if (found_.size() > 1 && options_.returns != Returns::all) {
    const auto chosen = options_.returns == Returns::first  ? std::ptrdiff_t{0}
                        : options_.returns == Returns::last ? std::ssize(found_) - 1
                                                            : std::ranges::max_element(strengths_) - strengths_.begin();
    found_ = {found_[static_cast<std::size_t>(chosen)]};
  }
  for (std::size_t k = 0; k < found_.size(); ++k) {
    found_[k].number = static_cast<std::uint8_t>(k + 1);
    found_[k].of = static_cast<std::uint8_t>(found_.size());
  }
  return found_;
}

std::vector<WideBeam::Return> WideBeam::returns(const Scanner& scanner, const TraceScanner& traced,
                                                const TraceStation& station, const BeamOptions& options,
                                                std::uint64_t first_ray, std::uint64_t ray_count) const {
  std::vector<std::vector<Return>> parts((ray_count + kPart - 1) / kPart);
  parallel::for_all(std::size_t{0}, parts.size(), [&](std::size_t p) {
    Follower follower(*this, scanner, traced, station, options);
    for (std::uint64_t ray = first_ray + p * kPart; ray < first_ray + std::min(ray_count, (p + 1) * kPart); ++ray)
      for (const Return& own : follower.returns_of(ray))
        if (own.detected) parts[p].push_back(own);
  });
  std::vector<Return> all;
  for (const std::vector<Return>& part : parts) all.insert(all.end(), part.begin(), part.end());
  return all;
}

std::optional<WideBeam::Totals> WideBeam::count(const Scanner& scanner, const TraceScanner& traced,
                                                const TraceStation& station, const BeamOptions& options,
                                                std::span<std::uint32_t> points, const Progress& progress) const {
  std::fill(points.begin(), points.end(), 0);
  constexpr std::uint64_t kBetweenChecks = 256 * kPart;  // of the stop token
  const std::uint64_t rays = scanner.rays();
  Totals totals;
  for (std::uint64_t first = 0; first < rays; first += kBetweenChecks) {
    if (progress.stopped()) return std::nullopt;
    const Totals part = parallel::reduce(
        tbb::blocked_range<std::uint64_t>(first, std::min(rays, first + kBetweenChecks), kPart), Totals{},
        [&](const auto& range, Totals sum) {
          Follower follower(*this, scanner, traced, station, options);
          for (std::uint64_t ray = range.begin(); ray < range.end(); ++ray)
            for (const Return& own : follower.returns_of(ray)) {
              sum.dropped = sum.dropped + own.dropped;
              if (!own.detected) continue;
              ++sum.points;
              sum.mixed = sum.mixed + mixed_points(own);
              if (own.voxel == kNoVoxel) continue;
              ++sum.points_on_surveyed;
              std::atomic_ref(points[own.voxel]).fetch_add(1, std::memory_order_relaxed);
            }
          return sum;
        },
        std::plus<>());
    totals = totals + part;
    progress(static_cast<double>(std::min(rays, first + kBetweenChecks)) / static_cast<double>(rays));
  }
  return totals;
}

MixedPoints WideBeam::mixed_points(const Return& own) {
  if (!own.mixed) return {};
  return {.points = 1, .counted = own.voxel != kNoVoxel ? 1u : 0u, .wrong_voxel = own.wrong_voxel ? 1u : 0u};
}

void WideBeam::fill(const std::vector<Return>& returns, std::uint8_t number, std::uint64_t first_ray,
                    std::uint64_t ray_count, Tracer::RawChunk& raw, std::vector<std::uint8_t>& ghost,
                    std::vector<std::uint8_t>& count, ScanSummary& summary) {
  raw.range.assign(ray_count, std::numeric_limits<float>::infinity());
  raw.position.assign(ray_count, {});
  raw.normal.assign(ray_count, {});
  raw.reflectivity.assign(ray_count, 0);
  raw.primitive.assign(ray_count, RayBundle::kNoHit);
  raw.barycentric.assign(ray_count, {});
  raw.voxel.assign(ray_count, kNoVoxel);
  ghost.assign(ray_count, 0);
  count.assign(ray_count, 0);
  for (const Return& own : returns) {
    if (own.number != number) continue;
    const std::uint64_t k = own.ray - first_ray;
    raw.range[k] = own.t;
    raw.position[k] = own.point;
    raw.normal[k] = own.normal;
    raw.reflectivity[k] = own.reflectivity;
    raw.primitive[k] = own.triangle;
    raw.barycentric[k] = own.weights;
    raw.voxel[k] = own.voxel;
    ghost[k] = own.ghost ? 1 : 0;
    count[k] = own.of;
    summary.mixed = summary.mixed + mixed_points(own);
  }
}

}  // namespace vantage
