// SPDX-License-Identifier: Apache-2.0
#include "trace/registration_sums.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <numbers>
#include <optional>
#include <utility>

#include "core/parallel.hpp"
#include "core/target_clones.hpp"
#include "trace/embree/range_noise.hpp"
#include "trace/exact_arithmetic.hpp"

namespace vantage {
namespace {

constexpr std::size_t kOfPair = RegistrationSums::of_pair, kOfStation = RegistrationSums::of_station;
constexpr std::size_t kPatchesABlock = kPatchesIn64Bits / 2;
constexpr std::size_t kOfErrors = 6 * RegistrationSums::instrument_errors;
static_assert(kOfPair == pair_sums && kOfStation == station_sums && kOfErrors == instrument_sums);
static_assert(instrument_errors == RegistrationSums::instrument_errors &&
              instrument_errors == start_draws * angle_errors + 2);
using Deviations = std::array<float, RegistrationSums::instrument_errors>;
constexpr double kLeastShare = 0.5;     // least share of one plane in a voxel's surface, and in the surface around it
constexpr double kLeastArea = 1e-3;     // in faces; smaller surfaces are corners that no scan resolves
constexpr double kPointsOfAPlane = 10;  // least points in a patch for a normal to register by
// Distance, as a share of a patch's side, within which a surface must be flat. A scan's normal is fitted to points
// around it, within the patch of constant error; a pipe thinner than that has no normal, however fine the voxels.
constexpr double kFlatPart = 0.5;
constexpr double kWidestFit_m = 1;  // largest surface for a normal's fit, however large patches are

constexpr double kLargestSection = 1.5;  // in faces: a plane's section of a cube is at most 3√3/4

int quantised(double x) { return static_cast<int>(std::lround(x * kPatchUnit)); }

__extension__ using Wide = __int128;

// Sums of one block, or of several.
template <class Number>
struct Accumulator {
  std::vector<Number> pairs, surface, instrument;
  Accumulator(std::size_t stations, std::size_t pairs_kept, bool errors)
      : pairs(pairs_kept * kOfPair), surface(stations * kOfStation), instrument(errors ? stations * kOfErrors : 0) {}
  template <class Other>
  void add(const Accumulator<Other>& other) {
    for (std::size_t k = 0; k < pairs.size(); ++k) pairs[k] += other.pairs[k];
    for (std::size_t k = 0; k < surface.size(); ++k) surface[k] += other.surface[k];
    for (std::size_t k = 0; k < instrument.size(); ++k) instrument[k] += other.instrument[k];
  }
};

// A station's view of a plane.
struct View {
  float weight = 0;  // 1 / s²
  bool behind = false;
};

// Scanner head that sees the planes.
struct Head {
  Float3 origin;
  std::optional<Float3> axis;                // set if the scanner is turned
  std::array<Float3, start_draws> starts{};  // directions in which its scan begins
  const RangeNoise* noise = nullptr;
  float density = 1;
  DeviationErrors errors;
};

// w = 1/s² of docs/method.md; 0 if the plane is seen too obliquely, or with too few points.
View view_of(const RegistrationPatch& patch, const Head& head) {
  const float x = head.origin.x - patch.point.x, y = head.origin.y - patch.point.y, z = head.origin.z - patch.point.z;
  const float xx = x * x, yy = y * y, zz = z * z;
  float level = xx + yy;
  const float square = std::max(level + zz, 1e-6f);
  if (head.axis) {
    const float along = x * head.axis->x + y * head.axis->y + z * head.axis->z;
    level = std::max(square - along * along, 0.0f);
  }
  const float inverse = exact_inverse_sqrt(square);
  const float nx = patch.normal.x * x, ny = patch.normal.y * y, nz = patch.normal.z * z;
  const float nxy = nx + ny;
  const float facing = (nxy + nz) * inverse;
  const float cosine = std::abs(facing);
  if (cosine < least_cosine) return {};
  const float inverse_square = inverse * inverse;
  const float flat = std::max(level * inverse_square, least_sin_zenith_squared);
  const float seen = patch.rays * head.density * cosine;
  const float density = seen * inverse_square;
  const float expected = density * exact_inverse_sqrt(flat);
  if (expected < patch.least) return {};
  float variance = patch.variance;
  if (head.noise->enabled()) {
    const float points = std::max(expected, 1.0f);
    const float sigma = head.noise->sigma(square * inverse, patch.diffuse * cosine);
    const float along = sigma * cosine;  // part of the range noise along the normal
    variance = variance + along * along * exact_reciprocal(points);
  }
  return {exact_reciprocal(variance), facing < 0};
}

// Distances along the normal by which the scanner's errors move a plane, in units of the largest deviation. The two
// faces of a mirror see errors of angles with opposite signs.
Deviations deviations_of(const RegistrationPatch& patch, const Head& head) {
  const float x = head.origin.x - patch.point.x, y = head.origin.y - patch.point.y, z = head.origin.z - patch.point.z;
  const float xx = x * x, yy = y * y, zz = z * z;
  float level = xx + yy;
  const float square = std::max(level + zz, 1e-6f);
  const float nx = patch.normal.x * x, ny = patch.normal.y * y, nz = patch.normal.z * z;
  const float nxy = nx + ny;
  const float along = nxy + nz;
  float height = z, up = patch.normal.z, across = patch.normal.y * x - patch.normal.x * y;
  std::array<float, start_draws> sides{};
  for (std::size_t draw = 0; draw < start_draws; ++draw)
    sides[draw] = head.starts[draw].x * y - head.starts[draw].y * x;
  if (head.axis) {
    const Float3& a = *head.axis;
    height = x * a.x + y * a.y + z * a.z;
    level = std::max(square - height * height, 0.0f);
    up = patch.normal.x * a.x + patch.normal.y * a.y + patch.normal.z * a.z;
    const Float3 turned{a.y * z - a.z * y, a.z * x - a.x * z, a.x * y - a.y * x};  // axis × v
    across = patch.normal.x * turned.x + patch.normal.y * turned.y + patch.normal.z * turned.z;
    const Float3& start = head.starts.front();
    sides.fill(-(start.x * turned.x + start.y * turned.y + start.z * turned.z));
  }
  const float inverse = exact_inverse_sqrt(square);
  const float least_level = square * least_sin_zenith_squared;
  const float inverse_level = exact_inverse_sqrt(std::max(level, least_level));
  const float sideways = across * inverse_level;
  const float lifted = height * along, sunk = square * up;
  const float upwards = (lifted - sunk) * inverse_level;
  const float range = square * inverse;
  const float collimation = range * sideways, trunnion = height * sideways, facing = along * inverse;
  Deviations moved;
  for (std::size_t draw = 0; draw < start_draws; ++draw) {
    const float angle = sides[draw] < 0 ? -head.errors.angle : head.errors.angle;
    float* const of = moved.data() + draw * angle_errors;
    of[0] = upwards * angle, of[1] = collimation * angle, of[2] = trunnion * angle;
  }
  moved[start_draws * angle_errors] = facing * head.errors.offset;
  moved[start_draws * angle_errors + 1] = along * head.errors.scale;
  for (float& one : moved) one = std::min(std::max(one, -1.0f), 1.0f);
  return moved;
}

VANTAGE_TARGET_CLONES
void add_products(std::int64_t* sums, const std::int32_t* products, const std::int32_t* weights,
                  const std::uint32_t* columns, std::size_t many) {
  for (std::size_t k = 0; k < many; ++k) {
    const std::int32_t x = weights[k];
    std::int64_t* of = sums + std::size_t{columns[k]} * kOfPair;
    for (std::size_t c = 0; c < kOfPair; ++c) of[c] += std::int64_t{x} * products[c];
  }
}

// Stations with a point in each voxel: by word of a sample's masks, or as a field keeps them.
struct SeenBy {
  std::span<const std::uint64_t> words;
  std::size_t voxels = 0;
  const StationMasks* kept = nullptr;
  std::size_t first = 0;  // voxel of the field that is voxel 0 here

  // Fills `seen` with the stations that saw a voxel, ascending, and returns their number.
  std::size_t stations_of(std::size_t voxel, std::array<std::uint16_t, max_stations>& seen) const {
    std::size_t many = 0;
    const auto add = [&](std::size_t station) { seen[many++] = static_cast<std::uint16_t>(station); };
    if (kept)
      kept->for_each_station(first + voxel, add);
    else
      for (std::size_t at = voxel, station = 0; at < words.size(); at += voxels, station += mask_bits)
        for (std::uint64_t mask = words[at]; mask != 0; mask &= mask - 1)
          add(station + static_cast<std::size_t>(std::countr_zero(mask)));
    return many;
  }
};

// Pairs that are summed: all; in large networks only those that share a voxel.
class PairNumbers {
 public:
  explicit PairNumbers(std::size_t stations) : stations_(stations) {}
  // `shared`: voxels of each pair.
  PairNumbers(std::size_t stations, std::span<const std::uint64_t> shared) : stations_(stations) {
    if (stations <= mask_bits) return;
    number_.assign(all(), 0);
    for (std::size_t p = 0; p < shared.size(); ++p) {
      if (shared[p] == 0) continue;
      number_[p] = static_cast<std::uint32_t>(kept_.size());
      kept_.push_back(static_cast<std::uint32_t>(p));
    }
    if (kept_.empty()) kept_.push_back(0);  // no shared voxel: a single sum of nothing
  }

  std::size_t size() const { return kept_.empty() ? all() : kept_.size(); }
  std::size_t all() const { return stations_ * (stations_ - 1) / 2; }
  // Returns the index among all pairs of the k-th summed pair; number() is its inverse.
  std::size_t pair(std::size_t k) const { return kept_.empty() ? k : kept_[k]; }
  std::uint32_t number(std::size_t i, std::size_t j) const {
    const std::size_t pair = i * (2 * stations_ - i - 1) / 2 + j - i - 1;
    return number_.empty() ? static_cast<std::uint32_t>(pair) : number_[pair];
  }

 private:
  std::size_t stations_;
  std::vector<std::uint32_t> number_, kept_;  // empty if all pairs are summed
};

std::vector<std::uint64_t> shared_of(const SeenBy& seen_by, std::size_t stations) {
  const PairNumbers pairs(stations);
  std::vector<std::uint64_t> shared(pairs.all(), 0);
  std::array<std::uint16_t, max_stations> seen;
  for (std::size_t k = 0; k < seen_by.voxels; ++k) {
    const std::size_t many = seen_by.stations_of(k, seen);
    for (std::size_t a = 0; a + 1 < many; ++a)
      for (std::size_t b = a + 1; b < many; ++b) ++shared[pairs.number(seen[a], seen[b])];
  }
  return shared;
}

class Heads {
 public:
  Heads(std::span<const PatchScanner> scanners, double deviation, std::span<const TraceStation> stations,
        std::size_t count)
      : heads_(count), deviation_(deviation) {
    for (const PatchScanner& scanner : scanners) noise_.emplace_back(scanner.noise);
    for (const TraceStation& station : stations) {
      const PatchScanner& scanner = scanners[station.scanner];
      heads_[station.place] = {station.origin,           std::nullopt,    {},
                               &noise_[station.scanner], scanner.density, deviation_errors(scanner, deviation)};
      for (std::uint32_t draw = 0; draw < start_draws; ++draw)
        heads_[station.place].starts[draw] = scan_start(station.place, draw);
      if (!station.turn) continue;
      heads_[station.place].axis = Float3{station.turn->x.z, station.turn->y.z, station.turn->z.z};
      heads_[station.place].starts.fill({station.turn->x.x, station.turn->y.x, station.turn->z.x});
    }
  }
  Heads(const Heads&) = delete;
  const Head& operator[](std::size_t place) const { return heads_[place]; }
  std::size_t size() const { return heads_.size(); }
  double deviation() const { return deviation_; }  // unit of the scanners' errors; 0: none are stated

 private:
  std::vector<RangeNoise> noise_;  // by scanner
  std::vector<Head> heads_;        // by place
  double deviation_;
};

class Summer {
 public:
  Summer(const Patches& patches, const Heads& heads, const PairNumbers& pairs, const SeenBy& seen_by)
      : patches_(patches),
        heads_(heads),
        pairs_(pairs),
        seen_by_(seen_by),
        units_(static_cast<float>(kPatchWeightUnits / patches.largest)) {}

  // Sums every `step`-th patch from `first` on.
  Accumulator<Wide> sum(std::size_t first, std::size_t step) const {
    const std::size_t voxels = patches_.patches.size(), some = voxels > first ? (voxels - first + step - 1) / step : 0,
                      blocks = (some + kPatchesABlock - 1) / kPatchesABlock;
    return parallel::reduce(
        tbb::blocked_range<std::size_t>(0, blocks, 1), Accumulator<Wide>(heads_.size(), pairs_.size(), errors()),
        [&](const tbb::blocked_range<std::size_t>& range, Accumulator<Wide> sums) {
          for (std::size_t b = range.begin(); b != range.end(); ++b) {
            Accumulator<std::int64_t> here(heads_.size(), pairs_.size(), errors());
            for (std::size_t k = b * kPatchesABlock; k < std::min(some, (b + 1) * kPatchesABlock); ++k)
              add_voxel(first + k * step, here);
            sums.add(here);
          }
          return sums;
        },
        [](Accumulator<Wide> a, const Accumulator<Wide>& b) {
          a.add(b);
          return a;
        });
  }

 private:
  bool errors() const { return heads_.deviation() > 0; }

  void add_voxel(std::size_t k, Accumulator<std::int64_t>& sums) const {
    std::array<std::uint16_t, max_stations> places;
    const auto seen = std::span(places).first(seen_by_.stations_of(k, places));
    if (seen.empty()) return;
    const RegistrationPatch& patch = patches_.patches[k];
    add_surface(patch, seen, sums.surface.data());
    if (seen.size() > 1 && patch.variance > 0) add_pairs(patch, seen, sums);
  }

  // Adds moments of the covered surface; the stations that see a voxel share it.
  void add_surface(const RegistrationPatch& patch, std::span<const std::uint16_t> seen, std::int64_t* sums) const {
    const auto weight =
        static_cast<std::int64_t>(patch.extent * exact_reciprocal(static_cast<float>(seen.size())) + 0.5f);
    const std::int64_t x = patch.place[0], y = patch.place[1], z = patch.place[2];
    const std::array<std::int64_t, kOfStation> moments{1, x, y, z, x * x, x * y, x * z, y * y, y * z, z * z};
    for (const std::size_t station : seen) {
      std::int64_t* of = sums + station * kOfStation;
      for (std::size_t m = 0; m < kOfStation; ++m) of[m] += weight * moments[m];
    }
  }

  void add_pairs(const RegistrationPatch& patch, std::span<const std::uint16_t> seen,
                 Accumulator<std::int64_t>& sums) const {
    // Stations on each side of the plane.
    std::array<std::array<std::uint16_t, max_stations>, 2> places;
    std::array<std::array<float, max_stations>, 2> weights;
    std::array<std::size_t, 2> many{};
    std::array<float, 2> total{};
    for (const std::uint16_t place : seen) {
      const View view = view_of(patch, heads_[place]);
      if (view.weight == 0) continue;
      const std::size_t side = view.behind;
      places[side][many[side]] = place;
      weights[side][many[side]++] = view.weight;
      total[side] = total[side] + view.weight;
    }
    if (many[0] < 2 && many[1] < 2) return;
    std::array<std::int32_t, kOfPair> products;
    std::size_t m = 0;
    for (std::size_t a = 0; a < 6; ++a)
      for (std::size_t b = a; b < 6; ++b) products[m++] = patch.jacobian[a] * patch.jacobian[b];
    for (std::size_t side = 0; side < 2; ++side) {
      if (many[side] < 2) continue;
      const float scale = units_ * exact_reciprocal(total[side]);
      for (std::size_t a = 0; a + 1 < many[side]; ++a) {
        const std::size_t i = places[side][a];
        const float scaled = weights[side][a] * scale;
        // One row of pairs: station i with each station after it.
        std::array<std::int32_t, max_stations> shared;
        std::array<std::uint32_t, max_stations> columns;
        std::size_t length = 0;
        for (std::size_t b = a + 1; b < many[side]; ++b, ++length) {
          shared[length] = static_cast<std::int32_t>(scaled * weights[side][b] + 0.5f);
          columns[length] = pairs_.number(i, places[side][b]);
        }
        add_products(sums.pairs.data(), products.data(), shared.data(), columns.data(), length);
      }
      if (errors())
        add_errors(patch, std::span(places[side]).first(many[side]), std::span(weights[side]).first(many[side]),
                   total[side], sums.instrument.data());
    }
  }

  // Adds w_i (b_i − b̄) J of the stations on one side of a plane.
  void add_errors(const RegistrationPatch& patch, std::span<const std::uint16_t> places, std::span<const float> weights,
                  float total, std::int64_t* sums) const {
    std::array<Deviations, max_stations> moved;
    Deviations mean{};
    for (std::size_t k = 0; k < places.size(); ++k) {
      moved[k] = deviations_of(patch, heads_[places[k]]);
      for (std::size_t e = 0; e < mean.size(); ++e) {
        const float weighted = weights[k] * moved[k][e];
        mean[e] = mean[e] + weighted;
      }
    }
    const float inverse = exact_reciprocal(total);
    for (float& one : mean) one = one * inverse;
    for (std::size_t k = 0; k < places.size(); ++k) {
      const float scaled = weights[k] * units_;
      std::int64_t* of = sums + places[k] * kOfErrors;
      for (std::size_t e = 0; e < mean.size(); ++e) {
        const float apart = moved[k][e] - mean[e];
        const float share = scaled * apart;
        const float quanta = share * deviation_quanta;
        const auto whole = static_cast<std::int64_t>(std::floor(quanta + 0.5f));
        for (std::size_t c = 0; c < 6; ++c) of[c * mean.size() + e] += whole * patch.jacobian[c];
      }
    }
  }

  const Patches& patches_;
  const Heads& heads_;
  const PairNumbers& pairs_;
  const SeenBy& seen_by_;
  float units_;
};

// Converts sums. `pairs`, `surface` and `instrument`: of all stations. `deviation`: unit of `instrument`.
template <class Number>
RegistrationSums to_sums(std::span<const Number> pairs, std::span<const Number> surface,
                         std::span<const Number> instrument, double deviation, const Patches& patches,
                         std::span<const TraceStation> stations, std::size_t count) {
  RegistrationSums sums;
  sums.centre = patches.centre;
  sums.radius_m = patches.radius;
  sums.heads.assign(count, Vec3{});
  for (const TraceStation& s : stations)
    sums.heads[s.place] = Vec3{s.origin.x, s.origin.y, s.origin.z} - patches.centre;
  const double weight = patches.largest / static_cast<double>(kPatchWeightUnits) / kPatchUnit / kPatchUnit;
  for (const Number& sum : pairs) sums.pairs.push_back(static_cast<double>(sum) * weight);
  constexpr std::array<int, kOfStation> kPowers{0, 1, 1, 1, 2, 2, 2, 2, 2, 2};
  for (std::size_t k = 0; k < surface.size(); ++k)
    sums.surface.push_back(static_cast<double>(surface[k]) * 0x1p-15 / std::pow(kPatchUnit, kPowers[k % kOfStation]));
  const double moved = patches.largest / static_cast<double>(kPatchWeightUnits) / kPatchUnit * deviation /
                       static_cast<double>(deviation_quanta);
  for (const Number& sum : instrument) sums.instrument.push_back(static_cast<double>(sum) * moved);
  return sums;
}

// Converts the sums of every pair.
RegistrationSums to_sums(const Accumulator<Wide>& all, const PairNumbers& pairs, double deviation,
                         const Patches& patches, std::span<const TraceStation> stations, std::size_t count) {
  if (pairs.all() <= pairs.size())
    return to_sums(std::span(all.pairs).first(pairs.all() * kOfPair), std::span(all.surface), std::span(all.instrument),
                   deviation, patches, stations, count);
  std::vector<Wide> whole(pairs.all() * kOfPair);
  for (std::size_t p = 0; p < pairs.size(); ++p)
    std::ranges::copy(std::span(all.pairs).subspan(p * kOfPair, kOfPair),
                      whole.begin() + static_cast<std::ptrdiff_t>(pairs.pair(p) * kOfPair));
  return to_sums(std::span<const Wide>(whole), std::span(all.surface), std::span(all.instrument), deviation, patches,
                 stations, count);
}

// Converts only pairs with sums other than 0 in the whole. Sums include squares, so others are 0 in every part.
RegistrationSums to_sums_of_part(const Accumulator<Wide>& part, const Accumulator<Wide>& whole,
                                 const PairNumbers& pairs, double deviation, const Patches& patches,
                                 std::span<const TraceStation> stations, std::size_t count) {
  std::vector<Wide> kept;
  for (std::size_t p = 0; p < pairs.size(); ++p) {
    const auto of_whole = std::span(whole.pairs).subspan(p * kOfPair, kOfPair);
    if (std::ranges::all_of(of_whole, [](Wide sum) { return sum == 0; })) continue;
    const auto of_part = std::span(part.pairs).subspan(p * kOfPair, kOfPair);
    kept.insert(kept.end(), of_part.begin(), of_part.end());
  }
  return to_sums(std::span<const Wide>(kept), std::span(part.surface), std::span(part.instrument), deviation, patches,
                 stations, count);
}

}  // namespace

DeviationErrors deviation_errors(const PatchScanner& scanner, double deviation) {
  const auto in_units = [&](float error) { return deviation > 0 ? static_cast<float>(error / deviation) : 0; };
  return {in_units(scanner.angle) / std::sqrt(static_cast<float>(start_draws)), in_units(scanner.offset_m),
          in_units(scanner.scale)};
}

double deviation_unit(std::span<const PatchScanner> scanners) {
  float largest = 0;
  for (const PatchScanner& scanner : scanners)
    largest = std::max({largest, scanner.angle * scanner.range_m, scanner.offset_m, scanner.scale * scanner.range_m});
  return static_cast<double>(largest);
}

// The golden angle lies between scans; draws differ by quarter turns from one scan to the next.
Float3 scan_start(std::uint32_t place, std::uint32_t draw) {
  const double golden = std::numbers::pi * (3 - std::sqrt(5.0)), quarter = std::numbers::pi / 2;
  const double azimuth = place * (golden + draw * quarter) + draw * quarter / start_draws;
  return {static_cast<float>(std::cos(azimuth)), static_cast<float>(std::sin(azimuth)), 0};
}

std::vector<RegistrationSums> with_voxels(std::vector<RegistrationSums> sums, const Patches& patches) {
  const std::size_t voxels = patches.patches.size(), groups = sums.size() - 1;
  sums.front().voxels = voxels;
  for (std::size_t g = 0; g < groups; ++g) sums[g + 1].voxels = (voxels + groups - 1 - g) / groups;
  return sums;
}

Patches make_patches(std::span<const VoxelSurface> surfaces, const PatchFrame& frame, const RayPattern& pattern,
                     const RegistrationModel& model) {
  Patches made;
  made.model = model;
  made.centre = frame.centre;
  made.radius = frame.side_m * std::sqrt(0.75);
  const double face = frame.voxel_m * frame.voxel_m;
  const double floor = model.rho_m * model.rho_m * model.patch_m * model.patch_m;
  made.largest = kLargestSection * face / floor;
  made.patches.resize(surfaces.size());
  parallel::for_all(std::size_t{0}, surfaces.size(), [&](std::size_t i) {
    const VoxelSurface& surface = surfaces[i];
    RegistrationPatch patch{};
    patch.point = {surface.point.x, surface.point.y, surface.point.z};
    patch.normal = {surface.normal.x, surface.normal.y, surface.normal.z};
    patch.diffuse = surface.diffuse;
    patch.rays = static_cast<float>(surface.area / pattern.cell());
    patch.least = static_cast<float>(kPointsOfAPlane * surface.area / (model.patch_m * model.patch_m));
    if (surface.share >= kLeastShare && surface.area >= kLeastArea * face)
      patch.variance = static_cast<float>(floor / surface.area);
    patch.extent = static_cast<float>(surface.extent / face * 0x1p15);
    const std::array<double, 3> q{(surface.point.x - frame.centre.x) / made.radius,
                                  (surface.point.y - frame.centre.y) / made.radius,
                                  (surface.point.z - frame.centre.z) / made.radius};
    const std::array<double, 3> n{surface.normal.x, surface.normal.y, surface.normal.z};
    for (std::size_t a = 0; a < 3; ++a) {
      const std::size_t b = (a + 1) % 3, c = (a + 2) % 3;
      patch.place[a] = quantised(q[a]);
      patch.jacobian[a] = quantised(q[b] * n[c] - q[c] * n[b]);
      patch.jacobian[3 + a] = quantised(n[a]);
    }
    made.patches[i] = patch;
  });
  return made;
}

Patches make_patches(SurfaceFinder& surfaces, const VoxelGrid& grid, std::span<const std::uint32_t> voxel_indices,
                     const RayPattern& pattern, const RegistrationModel& model, const std::stop_token& stop) {
  const double side = std::ldexp(grid.voxel_size(), grid.depth());
  const auto middle = [&](int axis) { return grid.min()[static_cast<std::size_t>(axis)] + side / 2; };
  const double window_m = std::min(kFlatPart * model.patch_m, kWidestFit_m);
  return make_patches(surfaces.find(voxel_indices, window_m, stop),
                      {{middle(0), middle(1), middle(2)}, side, grid.voxel_size()}, pattern, model);
}

std::vector<RegistrationSums> sum_patches(const Patches& patches, std::span<const PatchScanner> scanners,
                                          std::span<const TraceStation> stations, std::uint32_t station_count,
                                          std::span<const std::uint64_t> masks, std::uint32_t groups) {
  const SeenBy seen_by{.words = masks, .voxels = patches.patches.size(), .kept = nullptr};
  const bool large = station_count > mask_bits;
  const PairNumbers pairs =
      large ? PairNumbers(station_count, shared_of(seen_by, station_count)) : PairNumbers(station_count);
  const double deviation = deviation_unit(scanners);
  const Heads heads(scanners, deviation, stations, station_count);
  const Summer summer(patches, heads, pairs, seen_by);
  if (groups == 0)
    return with_voxels({to_sums(summer.sum(0, 1), pairs, deviation, patches, stations, station_count)}, patches);
  std::vector<Accumulator<Wide>> parts(groups, Accumulator<Wide>(0, 0, false));
  parallel::for_all(std::uint32_t{0}, groups, [&](std::uint32_t g) { parts[g] = summer.sum(g, groups); });
  Accumulator<Wide> whole(station_count, pairs.size(), deviation > 0);
  for (const Accumulator<Wide>& part : parts) whole.add(part);
  std::vector<RegistrationSums> sums{to_sums(whole, pairs, deviation, patches, stations, station_count)};
  for (Accumulator<Wide>& part : parts) {
    sums.push_back(large ? to_sums_of_part(part, whole, pairs, deviation, patches, stations, station_count)
                         : to_sums(part, pairs, deviation, patches, stations, station_count));
    part = Accumulator<Wide>(0, 0, false);
  }
  return with_voxels(std::move(sums), patches);
}

std::optional<RegistrationSums> sum_patches(const PatchesFrom& patches_from, std::size_t part_voxels,
                                            std::span<const PatchScanner> scanners,
                                            std::span<const TraceStation> stations, const NetworkCounts& counts,
                                            const StationMasks& masks) {
  const PairNumbers pairs(counts.stations, counts.shared);
  const Heads heads(scanners, deviation_unit(scanners), stations, counts.stations);
  Accumulator<Wide> whole(counts.stations, pairs.size(), heads.deviation() > 0);
  std::shared_ptr<const Patches> patches;
  for (std::size_t first = 0; first < masks.voxels() || !patches; first += part_voxels) {
    patches = patches_from(first, std::min(part_voxels, masks.voxels() - first));
    if (!patches) return std::nullopt;
    const SeenBy seen_by{.words = {}, .voxels = patches->patches.size(), .kept = &masks, .first = first};
    whole.add(Summer(*patches, heads, pairs, seen_by).sum(0, 1));
  }
  RegistrationSums sums = to_sums(whole, pairs, heads.deviation(), *patches, stations, counts.stations);
  sums.voxels = masks.voxels();
  return sums;
}

void for_summed_pairs(const RegistrationSums& whole, const std::function<void(std::size_t)>& with) {
  for (std::size_t first = 0; first < whole.pairs.size(); first += kOfPair)
    if (std::ranges::any_of(std::span(whole.pairs).subspan(first, kOfPair), [](double sum) { return sum != 0; }))
      with(first);
}

std::vector<RegistrationSums> sum_patches(const RegistrationJob& job, std::span<const TraceStation> stations,
                                          std::uint32_t station_count, std::span<const std::uint64_t> masks,
                                          std::uint32_t groups) {
  return sum_patches(*job.patches, job.scanners, stations, station_count, masks, job.groups ? groups : 0);
}

void take_registration(NetworkCounts& counts, std::vector<RegistrationSums> sums) {
  counts.registration = std::move(sums[0]);
  counts.registration.groups.assign(std::make_move_iterator(sums.begin() + 1), std::make_move_iterator(sums.end()));
}

RegistrationSums registration_sums(const Patches& patches, std::span<const TraceStation> stations,
                                   std::uint32_t station_count, std::span<const std::int64_t> sums, double deviation) {
  const std::size_t count = station_count, pairs = count * (count - 1) / 2 * kOfPair, moments = count * kOfStation;
  return with_voxels({to_sums(sums.first(pairs), sums.subspan(pairs, moments),
                              sums.subspan(pairs + moments, deviation > 0 ? count * kOfErrors : 0), deviation, patches,
                              stations, count)},
                     patches)
      .front();
}

}  // namespace vantage
