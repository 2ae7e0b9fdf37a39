// SPDX-License-Identifier: Apache-2.0
#include "trace/embree/picture.hpp"

#include <tbb/enumerable_thread_specific.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <limits>
#include <numbers>
#include <tuple>
#include <utility>

#include "core/parallel.hpp"
#include "core/target_clones.hpp"
#include "trace/embree/drawn_triangle.hpp"
#include "trace/embree/vectors.hpp"
#include "trace/fast_atan2.hpp"
#include "trace/rays_of_box.hpp"

namespace vantage {
namespace {

constexpr std::uint32_t kInDoubt = 0x80000000u;

// Below this ratio of two inverse distances, either may be the larger one. In float, C sin θ + D cos θ has an error
// of 2^-21 of the inverse of the plane's height. That is 2^-17 of the value if the cosine of the incidence is
// `kSteepCosine`.
constexpr float kApart = 1 + 0x1p-15f;
constexpr float kSteepCosine = 0x1p-4f;
constexpr double kLeastSlope = 0x1p-9;     // Planes clamps distances at half of it
constexpr float kAngleDoubt = 0x1.8p-20f;  // radians; of rows computed in float
constexpr float kPastAll = 8;              // beyond any angle

constexpr std::int32_t kRowLanes = 8;
constexpr std::int32_t kFewRows = 32;  // up to so many rows are evaluated faster than bounded

// Coefficients from which a triangle's rows are computed, in the scanner's frame.
struct Outline {
  float x[3], y[3], z[3], doubt[3];                       // edges
  float inverse_x, inverse_y, inverse_z, inverse_height;  // inverse distance along d: their product with d
  float least_zenith, most_zenith;                        // of its rays
};

// Rows of one triangle in each column of a strip: those that may hit it, `begin` to `end`, and those that must.
struct Rows {
  alignas(64) std::int32_t begin[Picture::kStripColumns], end[Picture::kStripColumns],
      sure_begin[Picture::kStripColumns], sure_end[Picture::kStripColumns];
  alignas(64) float c[Picture::kStripColumns];
};

struct Columns {
  alignas(64) float cosine[Picture::kStripColumns], sine[Picture::kStripColumns];
};

// Bounds the zenith in eight columns by all edges. In a column an edge is R sin(θ₀ − θ) or R sin(θ − θ₀); its doubt
// moves θ₀ by asin(doubt / R) either way.
[[gnu::always_inline]] inline void find_rows(const Outline& outline, const Columns& columns, std::uint32_t column,
                                             float first, float step, std::int32_t row_begin, std::int32_t row_end,
                                             Rows& rows) {
  constexpr std::uint32_t kColumnsAtOnce = kRowLanes;
  const float *const cos_azimuth = columns.cosine + column, *const sin_azimuth = columns.sine + column;
  constexpr float kPi = std::numbers::pi_v<float>;
  alignas(64) float low[kColumnsAtOnce], high[kColumnsAtOnce], sure_low[kColumnsAtOnce], sure_high[kColumnsAtOnce];
  for (std::uint32_t j = 0; j < kColumnsAtOnce; ++j)
    low[j] = sure_low[j] = -kPastAll, high[j] = sure_high[j] = kPastAll;
  for (std::uint32_t k = 0; k < 3; ++k) {
    const float x = outline.x[k], y = outline.y[k], z = outline.z[k], doubt = outline.doubt[k];
    const float size = std::abs(z), toward = z >= 0 ? -1.0f : 1.0f;
    const float least = outline.least_zenith, most = outline.most_zenith;
    for (std::uint32_t j = 0; j < kColumnsAtOnce; ++j) {
      const float a = x * cos_azimuth[j] + y * sin_azimuth[j];
      const float r = std::sqrt(a * a + z * z);
      const float zero = fast_atan2(size, toward * a);
      const float moved = r > 2 * doubt ? 1.05f * doubt / r + kAngleDoubt : kPastAll / 2;
      // An edge whose plane holds the axis to within `moved` may also let rays at the other pole pass.
      if (z >= 0) {
        const bool below = zero < moved && most > zero + kPi - moved, above = !below || least < zero + moved;
        high[j] = std::min(high[j], below ? kPastAll : zero + moved);
        low[j] = std::max(low[j], above ? -kPastAll : zero + kPi - moved);
        sure_high[j] = std::min(sure_high[j], zero - moved);
        sure_low[j] = std::max(sure_low[j], zero - kPi + moved);
      } else {
        const bool above = kPi - zero < moved && least < zero - kPi + moved, below = !above || most > zero - moved;
        low[j] = std::max(low[j], above ? -kPastAll : zero - moved);
        high[j] = std::min(high[j], below ? kPastAll : zero - kPi + moved);
        sure_low[j] = std::max(sure_low[j], zero + moved);
        sure_high[j] = std::min(sure_high[j], zero + kPi - moved);
      }
    }
  }
  const float inverse = 1 / step;
  const auto from = static_cast<float>(row_begin), to = static_cast<float>(row_end);
  for (std::uint32_t j = 0; j < kColumnsAtOnce; ++j) {
    // Rounds up to the least row at or above, and down to the end of rows at or below.
    const auto up = [&](float angle) {
      const float row = std::min(std::max((angle - first) * inverse, from), to);
      const auto whole = static_cast<std::int32_t>(row);
      return whole + (static_cast<float>(whole) < row ? 1 : 0);
    };
    const auto down = [&](float angle) {
      const float row = (angle - first) * inverse + 1;
      return static_cast<std::int32_t>(std::min(std::max(row, from), to));
    };
    const std::int32_t begin = up(low[j]), end = down(high[j]);
    rows.begin[column + j] = begin;
    rows.end[column + j] = end;
    rows.sure_begin[column + j] = std::max(begin, up(sure_low[j]));
    rows.sure_end[column + j] = std::min(end, down(sure_high[j]));
    rows.c[column + j] = outline.inverse_x * cos_azimuth[j] + outline.inverse_y * sin_azimuth[j];
  }
}

}  // namespace

bool Picture::Item::operator<(const Item& other) const {
  return std::tuple(-nearest, triangle, column_begin) < std::tuple(-other.nearest, other.triangle, other.column_begin);
}

// Drawing visits every triangle, tracing only those near a ray. On a plant of 300 000 triangles, with this many rays
// for each, both take equally long (docs/evidence/benchmarks.md).
constexpr std::uint64_t kLeastRaysATriangle = 16;
bool Picture::pays(std::size_t triangles, std::uint64_t rays) {
  return triangles < kNone && rays >= kLeastRaysATriangle * triangles;
}

std::unique_ptr<const Picture> Picture::where_it_pays(const StationRays& rays, const TraceStation& station,
                                                      const TileEnds& ends) {
  const SceneData& scene = rays.scene();
  // Embree tests the edges of a shared mesh in its frame, where a picture does not know the rounding.
  if (rays.whole_scans() == WholeScans::traced || scene.shares()) return nullptr;
  // A picture is a grid of azimuths and zeniths, but rays with arbitrary directions have no steps.
  const RayPattern& pattern = rays.pattern();
  if (!(pattern.zenith_step > 0 && pattern.azimuth_step > 0)) return nullptr;
  std::uint64_t within = 0;
  for (const SelectedTile& each : selected(ends, rays.pattern())) within += each.tile.rows * each.tile.columns;
  if (rays.whole_scans() == WholeScans::faster && !pays(scene.opaque_count(), within)) return nullptr;
  auto picture = std::make_unique<const Picture>(rays, station, ends);
  return picture->drawable() ? std::move(picture) : nullptr;
}

namespace {

DrawnTriangle drawn(const StationRays& rays, const TraceStation& station, std::uint32_t triangle) {
  const SceneData& scene = rays.scene();
  std::array<Vec3, 3> corners;
  for (std::size_t k = 0; k < 3; ++k)
    corners[k] = widen(scene.positions[scene.triangles[triangle][k]]) - widen(station.origin);
  return {corners, station.turn.has_value()};
}

const Turn* turn_of(const TraceStation& station) { return station.turn ? &*station.turn : nullptr; }

}  // namespace

Picture::Picture(const StationRays& rays, const TraceStation& station, const TileEnds& ends)
    : rays_(rays), station_(station), ends_(ends) {
  const RayPattern& pattern = rays.pattern();
  start_ = pattern.min_range > 0 ? 1 / pattern.min_range : std::numeric_limits<float>::infinity();
  for (const float end : ends.end) farthest_ = std::max(farthest_, end);
  sine_.resize(ends.tall + 1);
  cosine_.resize(ends.tall + 1);
  for (std::uint32_t r = 0; r < pattern.rows(); ++r) {
    sine_[r / kBlockRows].of[r % kBlockRows] = pattern.sin_zenith[r];
    cosine_[r / kBlockRows].of[r % kBlockRows] = pattern.cos_zenith[r];
  }

  tbb::enumerable_thread_specific<std::vector<Item>> found;
  std::atomic<bool> drawable = true;
  parallel::for_all(tbb::blocked_range<std::size_t>(0, rays.scene().opaque_triangles().size(), 1024),
                    [&](const auto& range) {
                      std::vector<Item>& items = found.local();
                      for (std::size_t k = range.begin(); k < range.end() && drawable; ++k)
                        if (!place(static_cast<std::uint32_t>(k), items)) drawable = false;
                    });
  drawable_ = drawable;
  if (!drawable_) return;
  std::vector<Item> all;
  for (const std::vector<Item>& items : found) all.insert(all.end(), items.begin(), items.end());
  parallel::sort(all.begin(), all.end());

  begin_.assign(std::size_t{strips()} + 1, 0);
  const auto each_strip = [](const Item& item, const auto& f) {
    for (std::uint32_t s = item.column_begin / kStripColumns; s <= (item.column_end - 1) / kStripColumns; ++s) f(s);
  };
  for (const Item& item : all) each_strip(item, [&](std::uint32_t s) { ++begin_[s + 1]; });
  for (std::size_t s = 0; s < strips(); ++s) begin_[s + 1] += begin_[s];
  items_.resize(begin_.back());
  std::vector<std::size_t> next(begin_.begin(), begin_.end() - 1);
  for (const Item& item : all) each_strip(item, [&](std::uint32_t s) { items_[next[s]++] = item; });
}

bool Picture::place(std::uint32_t triangle, std::vector<Item>& items) const {
  const RayPattern& pattern = rays_.pattern();
  const double start = static_cast<double>(pattern.min_range), end = static_cast<double>(farthest_) * (1 + 0x1p-8);
  const DrawnTriangle seen = drawn(rays_, station_, triangle);
  const double away = std::sqrt(dot(seen.middle, seen.middle));
  const double reach =
      seen.flat ? Planes::reach(seen.radius, seen.farthest, station_.origin) : seen.radius * (1 + seen.stretch);
  if ((away + reach) * (1 + 0x1p-8) < start || away - reach > end) return true;
  double nearest = away - reach;
  RayRanges ranges;
  if (!seen.flat) {
    nearest = std::max(seen.height, seen.distance() - seen.stretch * seen.radius);
    ranges = seen.rays(pattern, turn_of(station_));
  } else if (nearest > 0x1p-8 * reach) {
    Vec3 low = seen.middle - Vec3{reach, reach, reach}, high = seen.middle + Vec3{reach, reach, reach};
    if (station_.turn) turn_back(*station_.turn, low, high);
    ranges = rays_of_box(pattern, low, high);
  } else if (std::isinf(seen.band().doubt)) {
    return false;
  } else {
    ranges.rows = {0, pattern.rows()};
    ranges.columns[0] = {0, pattern.columns()};
  }
  nearest = std::max(nearest, start * (1 - 0x1p-12));
  if (ranges.empty() || nearest > end) return true;
  const float inverse = static_cast<float>(std::min((1 + 0x1p-20) / nearest, 1e30));
  for (const RayRanges::Range& columns : ranges.columns)
    if (!columns.empty())
      items.push_back({inverse, triangle, ranges.rows.begin, ranges.rows.end, columns.begin, columns.end});
  return true;
}

// Draws one strip.
class Picture::StripDrawing {
 public:
  StripDrawing(const Picture& picture, std::uint32_t index, const Tiles& tiles, Strip& strip)
      : picture_(picture), tiles_(tiles), strip_(strip) {
    const RayPattern& pattern = picture.rays_.pattern();
    const TileEnds& ends = picture.ends_;
    strip.first = index * kStripColumns;
    strip.columns = std::min(kStripColumns, pattern.columns() - strip.first);
    strip.blocks_ = ends.tall;
    strip.rays = strip.traced = 0;
    for (std::uint32_t a = tiles.first; a < tiles.end; ++a)
      if (ends.of(a, index) > 0) strip.rays += strip.columns * std::min(kBlockRows, pattern.rows() - a * kBlockRows);
    strip.inverse_.resize(std::size_t{kStripColumns} * ends.tall);
    strip.triangle_.resize(std::size_t{kStripColumns} * ends.tall + 1);  // searches for runs read past the end
    strip.farthest_.assign(ends.tall, 0);
    strip.stale_.assign(ends.tall, 1);
    strip.doubts_.assign(ends.tall, 0);
    constexpr float kNowhere = std::numeric_limits<float>::infinity();
    for (std::uint32_t j = 0; j < kStripColumns; ++j) {
      for (std::uint32_t a = tiles.first; a < tiles.end; ++a) {
        Block<float>& inverse = strip.inverse_[j * ends.tall + a];
        const float end = ends.of(a, index);
        std::fill_n(inverse.of, kBlockRows, j < strip.columns && end > 0 ? 1 / end : kNowhere);
        std::fill_n(strip.triangle_[j * ends.tall + a].of, kBlockRows, kNone);
      }
      if (pattern.rows() % kBlockRows != 0) {
        Block<float>& last = strip.inverse_[j * ends.tall + ends.tall - 1];
        std::fill(last.of + pattern.rows() % kBlockRows, last.of + kBlockRows, kNowhere);
      }
      columns_.cosine[j] = j < strip.columns ? pattern.cos_azimuth[strip.first + j] : 0;
      columns_.sine[j] = j < strip.columns ? pattern.sin_azimuth[strip.first + j] : 0;
    }
    first_ = static_cast<float>(pattern.first_zenith);
    step_ = static_cast<float>(pattern.zenith_step);
    middle_azimuth_ = pattern.first_azimuth + (strip.first + 0.5 * (strip.columns - 1)) * pattern.azimuth_step;
    tile_radius_ = 0.5 * kBlockRows * (pattern.zenith_step + pattern.azimuth_step) + 0x1p-18;
  }

  // Draws all of its triangles.
  [[gnu::always_inline]] void draw_all() {
    const std::size_t index = strip_.first / kStripColumns;
    const SceneData& scene = picture_.rays_.scene();
    const std::size_t end = picture_.begin_[index + 1];
    for (std::size_t k = picture_.begin_[index]; k < end; ++k) {
      // Prefetches, as triangles sorted by distance lie anywhere in memory.
      if (k + 8 < end && in_sight(picture_.items_[k + 8]))
        __builtin_prefetch(&scene.triangles[picture_.items_[k + 8].triangle]);
      if (k + 4 < end && in_sight(picture_.items_[k + 4]))
        for (const std::uint32_t corner : scene.triangles[picture_.items_[k + 4].triangle])
          __builtin_prefetch(&scene.positions[corner]);
      if (in_sight(picture_.items_[k])) draw(picture_.items_[k]);
    }
  }

 private:
  // Returns true if the triangle is to be drawn in any of the tiles.
  bool in_sight(const Item& item) const {
    return item.row_begin < tiles_.end * kBlockRows && item.row_end > tiles_.first * kBlockRows;
  }
  // REQUIRES: in_sight(item).
  [[gnu::always_inline]] void draw(const Item& item);

  float* inverse(std::uint32_t column) { return strip_.inverse_[column * strip_.blocks_].of; }
  std::uint32_t* triangles(std::uint32_t column) { return strip_.triangle_[column * strip_.blocks_].of; }
  const float* sine() const { return picture_.sines(); }
  const float* cosine() const { return picture_.cosines(); }

  // Returns true if nearer hits hide everything in the tile from `nearest` on.
  [[gnu::always_inline]] bool hidden(std::uint32_t tile, float nearest) {
    if (nearest * kApart < strip_.farthest_[tile]) return true;
    if (strip_.stale_[tile] == 0) return false;
    Floats8 low = std::numeric_limits<float>::infinity() - Floats8{};
    for (std::uint32_t j = 0; j < kStripColumns; ++j)
      for (std::uint32_t half = 0; half < 2; ++half) {
        Floats8 values;
        load(values, strip_.inverse_[j * strip_.blocks_ + tile].of + half * kRowLanes);
        low = values < low ? values : low;
      }
    float least = low[0];
    for (std::int32_t k = 1; k < kRowLanes; ++k) least = std::min(least, low[k]);
    strip_.farthest_[tile] = least;
    strip_.stale_[tile] = 0;
    return nearest * kApart < least;
  }
  // Notes that a ray may hit a triangle in this row, no nearer than this.
  void doubt(std::uint32_t column, std::int32_t row, float nearest) {
    float& value = inverse(column)[row];
    if (nearest * kApart < value) return;
    value = std::max(value, nearest);
    triangles(column)[row] |= kInDoubt;
    strip_.doubts_[static_cast<std::uint32_t>(row) / kBlockRows] = 1;
  }
  Float3 direction(std::uint32_t column, std::int32_t row) const {
    const float s = sine()[row];
    const Float3 d{s * columns_.cosine[column], s * columns_.sine[column], cosine()[row]};
    const Float3 turned = picture_.station_.turn ? (*picture_.station_.turn)(d) : d;
    return {RayCaster::safe(turned.x), RayCaster::safe(turned.y), RayCaster::safe(turned.z)};
  }
  // Chooses between two certain hits as RayCaster does.
  void settle(std::uint32_t column, std::int32_t row, float value, std::uint32_t triangle) {
    std::uint32_t& held = triangles(column)[row];
    if (held >= kNone) return doubt(column, row, value);
    const Planes& planes = picture_.rays_.planes();
    const Float3 &o = picture_.station_.origin, d = direction(column, row);
    float own, other;
    planes.distances<1>(planes.seen(triangle, o), triangle, o, &d.x, &d.y, &d.z, &own);
    planes.distances<1>(planes.seen(held, o), held, o, &d.x, &d.y, &d.z, &other);
    if (own < other || (own == other && triangle < held)) held = triangle;
    inverse(column)[row] = std::max(inverse(column)[row], value);
  }
  // Draws eight rows at inverse distances `value`. Those in `possible` may hit the triangle; of these, those in `sure`
  // do. Each row keeps its nearest hit, or is marked as in doubt.
  [[gnu::always_inline]] void merge(std::uint32_t column, std::int32_t row, std::uint32_t triangle,
                                    const Floats8& value, const Ints8& possible, const Ints8& sure) {
    float* const inverses = inverse(column) + row;
    std::uint32_t* const held = triangles(column) + row;
    Floats8 old;
    Ints8 ids;
    load(old, inverses);
    load(ids, held);
    const Ints8 nearer = sure & (value > old * kApart);
    const Ints8 rest = possible & ~nearer & (value * kApart >= old);
    old = nearer ? value : old;
    ids = nearer ? static_cast<std::int32_t>(triangle) - Ints8{} : ids;
    store(inverses, old);
    store(held, ids);
    if (!any(rest)) [[likely]]
      return;
    for (std::int32_t k = 0; k < kRowLanes; ++k) {
      if (rest[k] == 0) continue;
      if (sure[k] != 0) {
        settle(column, row + k, value[k], triangle);
      } else {
        doubt(column, row + k, value[k]);
      }
    }
  }
  [[gnu::always_inline]] void load_zeniths(std::int32_t row, Floats8& sines, Floats8& cosines) const {
    load(sines, sine() + row);
    load(cosines, cosine() + row);
  }

  [[gnu::always_inline]] void draw_span(const Outline& outline, std::uint32_t triangle, std::uint32_t column,
                                        const Rows& rows) {
    const std::int32_t begin = rows.begin[column], end = rows.end[column];
    for (std::int32_t row = begin & ~(kRowLanes - 1); row < end; row += kRowLanes) {
      Floats8 sines, cosines;
      load_zeniths(row, sines, cosines);
      const Floats8 value = rows.c[column] * sines + outline.inverse_z * cosines;
      const Ints8 at = Ints8{0, 1, 2, 3, 4, 5, 6, 7} + row;
      merge(column, row, triangle, value, (at >= begin) & (at < end),
            (at >= rows.sure_begin[column]) & (at < rows.sure_end[column]));
    }
  }
  // Evaluates the edges instead of solving for their rows, which is faster for few rows.
  [[gnu::always_inline]] void draw_few(const Outline& outline, std::uint32_t triangle, std::uint32_t column,
                                       std::int32_t begin, std::int32_t end) {
    const float cos_azimuth = columns_.cosine[column], sin_azimuth = columns_.sine[column];
    const float c = outline.inverse_x * cos_azimuth + outline.inverse_y * sin_azimuth;
    float a[3];
    for (std::uint32_t k = 0; k < 3; ++k) a[k] = outline.x[k] * cos_azimuth + outline.y[k] * sin_azimuth;
    for (std::int32_t row = begin & ~(kRowLanes - 1); row < end; row += kRowLanes) {
      Floats8 sines, cosines;
      load_zeniths(row, sines, cosines);
      const Ints8 at = Ints8{0, 1, 2, 3, 4, 5, 6, 7} + row;
      Ints8 possible = (at >= begin) & (at < end), sure = possible;
      for (std::uint32_t k = 0; k < 3; ++k) {
        const Floats8 edge = a[k] * sines + outline.z[k] * cosines;
        possible &= edge >= -outline.doubt[k];
        sure &= edge >= outline.doubt[k];
      }
      merge(column, row, triangle, c * sines + outline.inverse_z * cosines, possible, sure);
    }
  }
  // Draws grazing rays and near hits, with all their uncertainties.
  [[gnu::always_inline]] void draw_carefully(const DrawnTriangle& seen, const Item& item, std::uint32_t column,
                                             const Rows& rows) {
    const std::int32_t begin = rows.begin[column], end = rows.end[column];
    const std::int32_t sure_begin = seen.certain ? rows.sure_begin[column] : end, sure_end = rows.sure_end[column];
    const double scale = 1 / seen.height;
    const float least = static_cast<float>(kLeastSlope * scale) * (1 + 0x1p-20f), start = picture_.start_;
    const Turn* const turn = turn_of(picture_.station_);
    for (std::int32_t row = begin & ~(kRowLanes - 1); row < end; row += kRowLanes) {
      Floats8 sines, z;
      load_zeniths(row, sines, z);
      Floats8 x = sines * columns_.cosine[column], y = sines * columns_.sine[column];
      if (turn) {
        const Floats8 tx = turn->x.x * x + turn->x.y * y + turn->x.z * z,
                      ty = turn->y.x * x + turn->y.y * y + turn->y.z * z,
                      tz = turn->z.x * x + turn->z.y * y + turn->z.z * z;
        x = tx, y = ty, z = tz;
      }
      Doubles4 lx, ly, lz, hx, hy, hz;
      widen(x, lx, hx);
      widen(y, ly, hy);
      widen(z, lz, hz);
      Floats8 value;
      narrow((seen.normal.x * lx + seen.normal.y * ly + seen.normal.z * lz) * scale,
             (seen.normal.x * hx + seen.normal.y * hy + seen.normal.z * hz) * scale, value);
      const Ints8 at = Ints8{0, 1, 2, 3, 4, 5, 6, 7} + row, grazing = ~(value >= least);
      const Ints8 possible = (at >= begin) & (at < end) & (grazing | (value <= start * kApart));
      const Ints8 sure = possible & (at >= sure_begin) & (at < sure_end) & ~grazing & (value * kApart < start);
      value = grazing ? item.nearest - Floats8{} : value;
      merge(column, row, item.triangle, value, possible, sure);
    }
  }
  // Marks the rays within the band of a flat triangle as in doubt. They lie around the two zeniths at which the band's
  // plane meets the column: |R sin(θ₀ − θ)| <= doubt.
  void draw_band(const DrawnTriangle::Band& band, const Item& item, std::uint32_t column, std::int32_t row_begin,
                 std::int32_t row_end) {
    const RayPattern& pattern = picture_.rays_.pattern();
    const auto draw_between = [&](double least, double most) {
      const double begin = std::ceil((least - pattern.first_zenith) / pattern.zenith_step),
                   end = std::floor((most - pattern.first_zenith) / pattern.zenith_step) + 1;
      const auto from = static_cast<std::int32_t>(std::clamp(begin, 0.0 + row_begin, 0.0 + row_end)),
                 to = static_cast<std::int32_t>(std::clamp(end, 0.0 + row_begin, 0.0 + row_end));
      for (std::int32_t row = from; row < to; ++row) doubt(column, row, item.nearest);
    };
    constexpr double kPi = std::numbers::pi;
    const Vec3 m = turned_back(turn_of(picture_.station_), band.normal);
    const double a = m.x * columns_.cosine[column] + m.y * columns_.sine[column], r = std::sqrt(a * a + m.z * m.z);
    if (!(r > 2 * band.doubt)) return draw_between(0, kPi);
    const double zero = fast_atan2(std::abs(m.z), m.z >= 0 ? -a : a), moved = 1.05 * band.doubt / r + 0x1p-20;
    draw_between(zero - moved, zero + moved);
    draw_between(zero - moved - kPi, zero + moved - kPi);
    draw_between(zero - moved + kPi, zero + moved + kPi);
  }

  const Picture& picture_;
  const Tiles tiles_;
  Strip& strip_;
  Columns columns_;
  float first_, step_;
  double middle_azimuth_, tile_radius_;
};

inline void Picture::StripDrawing::draw(const Item& item) {
  const std::uint32_t first_column = std::max(item.column_begin, strip_.first) - strip_.first,
                      last_column = std::min(item.column_end, strip_.first + strip_.columns) - strip_.first;
  std::uint32_t top = std::max(item.row_begin / kBlockRows, tiles_.first),
                bottom = std::min((item.row_end - 1) / kBlockRows + 1, tiles_.end);  // tiles
  while (top < bottom && hidden(top, item.nearest)) ++top;
  while (bottom > top && hidden(bottom - 1, item.nearest)) --bottom;
  if (top == bottom) return;

  const DrawnTriangle seen = drawn(picture_.rays_, picture_.station_, item.triangle);
  const Turn* const turn = turn_of(picture_.station_);
  const RayPattern& pattern = picture_.rays_.pattern();
  if (seen.flat) {
    const DrawnTriangle::Band band = seen.band();
    std::fill(strip_.stale_.begin() + top, strip_.stale_.begin() + bottom, std::uint8_t{1});
    for (std::uint32_t j = first_column; j < last_column; ++j)
      draw_band(band, item, j, static_cast<std::int32_t>(std::max(item.row_begin, top * kBlockRows)),
                static_cast<std::int32_t>(std::min(item.row_end, bottom * kBlockRows)));
    return;
  }
  Outline outline;
  for (std::uint32_t k = 0; k < 3; ++k) {
    const Vec3 m = turned_back(turn, seen.edge[k]);
    outline.x[k] = static_cast<float>(m.x);
    outline.y[k] = static_cast<float>(m.y);
    outline.z[k] = static_cast<float>(m.z);
    outline.doubt[k] = static_cast<float>(seen.doubt[k]) * (1 + 0x1p-20f);
  }
  outline.least_zenith = static_cast<float>(pattern.first_zenith + (item.row_begin - 1.0) * pattern.zenith_step);
  outline.most_zenith = static_cast<float>(pattern.first_zenith + (item.row_end + 0.0) * pattern.zenith_step);
  const Vec3 plane = turned_back(turn, seen.normal) * (1 / seen.height);
  outline.inverse_x = static_cast<float>(plane.x);
  outline.inverse_y = static_cast<float>(plane.y);
  outline.inverse_z = static_cast<float>(plane.z);
  outline.inverse_height = static_cast<float>(1 / seen.height);
  if (bottom - top > 4) {
    // Only the part of a large triangle in the tile counts.
    const double cosine = std::cos(middle_azimuth_), sine = std::sin(middle_azimuth_);
    const double radius = tile_radius_ / seen.height;
    const auto nearest_in = [&](std::uint32_t tile) {
      const double zenith = pattern.first_zenith + (tile * kBlockRows + 0.5 * (kBlockRows - 1)) * pattern.zenith_step;
      const double s = std::sin(zenith);
      const double bound = plane.x * s * cosine + plane.y * s * sine + plane.z * std::cos(zenith) + radius;
      // Distances of grazing rays may differ from the plane's.
      return bound * seen.height < 2 * kLeastSlope ? item.nearest : std::min(item.nearest, static_cast<float>(bound));
    };
    while (top < bottom && hidden(top, nearest_in(top))) ++top;
    while (bottom > top && hidden(bottom - 1, nearest_in(bottom - 1))) --bottom;
    if (top == bottom) return;
  }
  const auto row_begin = static_cast<std::int32_t>(std::max(item.row_begin, top * kBlockRows)),
             row_end = static_cast<std::int32_t>(std::min(item.row_end, bottom * kBlockRows));
  const bool plain = seen.certain && item.nearest * kApart < picture_.start_;
  // The incidence within the triangle is least steep at the farthest corner.
  const bool all_steep =
      seen.height > 1.01 * static_cast<double>(kSteepCosine) * seen.farthest * (1 + 4 * seen.stretch);
  std::fill(strip_.stale_.begin() + top, strip_.stale_.begin() + bottom, std::uint8_t{1});
  if (plain && all_steep && row_end - row_begin <= kFewRows) {
    for (std::uint32_t j = first_column; j < last_column; ++j) draw_few(outline, item.triangle, j, row_begin, row_end);
    return;
  }
  Rows rows;
  for (std::uint32_t j = first_column & ~7u; j < last_column; j += kRowLanes)
    find_rows(outline, columns_, j, first_, step_, row_begin, row_end, rows);
  for (std::uint32_t j = first_column; j < last_column; ++j) {
    const std::int32_t begin = rows.begin[j], end = rows.end[j];
    if (begin >= end) continue;
    const auto is_steep = [&](std::int32_t row) {
      return rows.c[j] * sine()[row] + outline.inverse_z * cosine()[row] >= kSteepCosine * outline.inverse_height;
    };
    if (plain && (all_steep || (is_steep(begin) && is_steep(end - 1)))) {
      draw_span(outline, item.triangle, j, rows);
    } else {
      draw_carefully(seen, item, j, rows);
    }
  }
}

namespace {

// Traces those rays of a strip whose hit is in doubt, many at once.
struct DoubtBundle {
  RayBundle rays;
  std::uint32_t* hit[RayBundle::kCapacity];

  void trace(const RayCaster& caster) {
    caster.cast(rays);
    for (std::uint32_t k = 0; k < rays.size; ++k)
      *hit[k] = rays.primitive[k] == RayBundle::kNoHit ? Picture::kNone : rays.primitive[k];
    rays.size = 0;
  }
};

}  // namespace

void Picture::trace_doubts(std::uint32_t index, const Tiles& tiles, Strip& strip) const {
  const RayPattern& pattern = rays_.pattern();
  DoubtBundle bundle;
  bundle.rays.origin = station_.origin;
  bundle.rays.start = pattern.min_range;
  bundle.rays.size = 0;
  for (std::uint32_t tile = tiles.first; tile < tiles.end; ++tile) {
    if (strip.doubts_[tile] == 0) continue;
    for (std::uint32_t j = 0; j < strip.columns; ++j) {
      std::uint32_t* const triangles = strip.triangle_[j * strip.blocks_ + tile].of;
      for (std::uint32_t r = 0; r < kBlockRows; ++r) {
        if ((triangles[r] & kInDoubt) == 0) continue;
        RayBundle& rays = bundle.rays;
        const std::uint32_t row = tile * kBlockRows + r, column = strip.first + j;
        const float sine = pattern.sin_zenith[row];
        Float3 d{sine * pattern.cos_azimuth[column], sine * pattern.sin_azimuth[column], pattern.cos_zenith[row]};
        if (station_.turn) d = (*station_.turn)(d);
        rays.x[rays.size] = d.x;
        rays.y[rays.size] = d.y;
        rays.z[rays.size] = d.z;
        rays.end[rays.size] = ends_.of(tile, index);
        bundle.hit[rays.size++] = &triangles[r];
        ++strip.traced;
        if (rays.size == RayBundle::kCapacity) bundle.trace(rays_.caster());
      }
    }
  }
  bundle.trace(rays_.caster());
}

VANTAGE_TARGET_CLONES
void Picture::draw_triangles(std::uint32_t index, const Tiles& tiles, Strip& strip) const {
  StripDrawing(*this, index, tiles, strip).draw_all();
}

void Picture::draw(std::uint32_t index, const Tiles& tiles, Strip& strip) const {
  draw_triangles(index, tiles, strip);
  trace_doubts(index, tiles, strip);
}

VANTAGE_TARGET_CLONES
void Picture::fill(const Strip& strip, const RayTile& tile, RayBundle& rays) const {
  alignas(64) float x[RayBundle::kCapacity], y[RayBundle::kCapacity], z[RayBundle::kCapacity];
  for (std::uint32_t k = 0; k < rays.size; ++k) {
    x[k] = RayCaster::safe(rays.x[k]);
    y[k] = RayCaster::safe(rays.y[k]);
    z[k] = RayCaster::safe(rays.z[k]);
  }
  for (std::uint32_t j = 0; j < tile.columns; ++j) {
    const std::uint32_t* const triangles = strip.triangles(tile.column + j - strip.first) + tile.row;
    for (std::uint32_t i = 0; i < tile.rows; ++i) rays.primitive[i * tile.columns + j] = triangles[i];
  }
  const Planes& planes = rays_.planes();
  const Float3& o = station_.origin;
  for (std::uint32_t k = 0; k < rays.size;) {
    const std::uint32_t triangle = rays.primitive[k];
    std::uint32_t end = k + 1;
    while (end < rays.size && rays.primitive[end] == triangle) ++end;
    if (triangle == kNone) {
      std::fill(rays.primitive + k, rays.primitive + end, RayBundle::kNoHit);
      std::fill(rays.t + k, rays.t + end, std::numeric_limits<float>::infinity());
      k = end;
      continue;
    }
    const Planes::Seen plane = planes.seen(triangle, o);
    for (; k + kRowLanes <= end; k += kRowLanes)
      planes.distances<kRowLanes>(plane, triangle, o, x + k, y + k, z + k, rays.t + k);
    for (; k < end; ++k) planes.distances<1>(plane, triangle, o, x + k, y + k, z + k, rays.t + k);
  }
}

}  // namespace vantage
