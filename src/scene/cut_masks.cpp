// SPDX-License-Identifier: Apache-2.0
// Averages of a mask that keep its filled share: Castaño, "Computing alpha mipmaps", 2010.
#include "scene/cut_masks.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <cstdio>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <utility>

#include "core/parallel.hpp"
#include "scene/sound_triangle.hpp"

namespace vantage {
namespace {

constexpr std::size_t kBlock = 64;             // triangles cut by one task
constexpr double kThinnest_m = 2e-5;           // thinner parts are left out; no beam is so thin
constexpr double kMostCells = 0x1p28;          // of textures, visited in all triangles together; some seconds
constexpr double kMostRepeats = 1000;          // of a texture along a triangle
constexpr std::uint64_t kTriangleBytes = 400;  // of a new triangle: three vertices with all attributes, twice

// Averages of a texture's alpha, each half as wide and tall as the one before.
class AlphaLevels {
 public:
  struct Level {
    std::uint32_t width = 1, height = 1;
    std::vector<float> alpha = {};  // in [0, 1], row by row
    double cutoff = 0;              // for this level's alpha
  };

  AlphaLevels(const Image* image, const Material& material, double cutoff)
      : repeat_u_(material.repeat_u), repeat_v_(material.repeat_v) {
    const double factor = material.base_colour[3];
    Level level{.cutoff = factor > 0 ? cutoff / factor : std::numeric_limits<double>::infinity()};
    if (image) {
      level.width = image->width, level.height = image->height;
      level.alpha.resize(std::size_t{level.width} * level.height);
      for (std::size_t k = 0; k < level.alpha.size(); ++k)
        level.alpha[k] = static_cast<float>(image->rgba[4 * k + 3]) / 255.0f;
    } else {
      level.alpha = {1};
    }
    const auto filled = static_cast<std::size_t>(
        std::ranges::count_if(level.alpha, [&](float a) { return static_cast<double>(a) >= level.cutoff; }));
    uniform_ = filled == 0 || filled == level.alpha.size();
    levels_.push_back(std::move(level));
    if (uniform_) return;
    const double share = share_filled(levels_.front(), levels_.front().cutoff);
    while (levels_.back().width > 1 || levels_.back().height > 1) {
      levels_.push_back(half(levels_.back()));
      levels_.back().cutoff = cutoff_for(levels_.back(), share);
    }
  }

  std::size_t count() const { return levels_.size(); }
  const Level& level(std::size_t k) const { return levels_[k]; }
  // Returns true if the texture is filled everywhere or nowhere.
  bool uniform() const { return uniform_; }

  // Returns alpha at the middle of a texel; the texture continues beyond its edges.
  double at(const Level& level, std::int64_t x, std::int64_t y) const {
    return static_cast<double>(
        level.alpha[place(y, level.height, repeat_v_) * level.width + place(x, level.width, repeat_u_)]);
  }

 private:
  static std::size_t place(std::int64_t x, std::uint32_t size, bool repeat) {
    const auto wide = static_cast<std::int64_t>(size);
    return static_cast<std::size_t>(repeat ? (x % wide + wide) % wide : std::clamp<std::int64_t>(x, 0, wide - 1));
  }

  static Level half(const Level& fine) {
    Level coarse{.width = std::max(fine.width / 2, 1u), .height = std::max(fine.height / 2, 1u)};
    coarse.alpha.resize(std::size_t{coarse.width} * coarse.height);
    for (std::uint32_t y = 0; y < coarse.height; ++y)
      for (std::uint32_t x = 0; x < coarse.width; ++x) {
        float sum = 0;
        for (std::uint32_t k = 0; k < 4; ++k)
          sum += fine.alpha[std::size_t{std::min(2 * y + k / 2, fine.height - 1)} * fine.width +
                            std::min(2 * x + k % 2, fine.width - 1)];
        coarse.alpha[std::size_t{y} * coarse.width + x] = sum / 4;
      }
    return coarse;
  }

  // Returns the share of a level on which alpha reaches a cut-off; alpha is linear on each half of a cell.
  double share_filled(const Level& level, double cutoff) const {
    double filled = 0;
    for (std::uint32_t y = 0; y < level.height; ++y)
      for (std::uint32_t x = 0; x < level.width; ++x) {
        const double a = at(level, x, y), b = at(level, x + 1, y), c = at(level, x + 1, y + 1), d = at(level, x, y + 1);
        filled += share_above(a, b, c, cutoff) + share_above(a, c, d, cutoff);
      }
    return filled / (2.0 * level.width * level.height);
  }

  // Returns the share of a triangle on which a linear function, given at its corners, is at least `least`.
  static double share_above(double low, double middle, double high, double least) {
    if (low > middle) std::swap(low, middle);
    if (middle > high) std::swap(middle, high);
    if (low > middle) std::swap(low, middle);
    if (least <= low) return 1;
    if (least > high) return 0;
    if (least <= middle) return 1 - (least - low) * (least - low) / ((middle - low) * (high - low));
    return (high - least) * (high - least) / ((high - middle) * (high - low));
  }

  // Returns the cut-off that fills this share of a level, to the steps in which textures state alpha.
  double cutoff_for(const Level& level, double share) const {
    double low = 0, high = 1;
    while (high - low > 1.0 / 1024) {
      const double middle = (low + high) / 2;
      (share_filled(level, middle) >= share ? low : high) = middle;
    }
    return (low + high) / 2;
  }

  std::vector<Level> levels_;
  bool repeat_u_, repeat_v_, uniform_ = true;
};

using Polygon = std::vector<glm::dvec2>;

// Clips a convex polygon to the part with inside(p) >= 0, a linear function.
template <class Inside>
void clip(Polygon& polygon, Polygon& spare, Inside&& inside) {
  spare.clear();
  for (std::size_t k = 0; k < polygon.size(); ++k) {
    const glm::dvec2 &a = polygon[k], &b = polygon[(k + 1) % polygon.size()];
    const double da = inside(a), db = inside(b);
    if (da >= 0) spare.push_back(a);
    if ((da >= 0) == (db >= 0)) continue;
    // Interpolates from the inner end, so that neighbours find the same point.
    const bool from_a = da >= 0;
    const glm::dvec2 &p = from_a ? a : b, &q = from_a ? b : a;
    const double dp = from_a ? da : db, dq = from_a ? db : da;
    spare.push_back(p + (q - p) * (dp / (dp - dq)));
  }
  std::swap(polygon, spare);
}

// Remaining parts of one triangle, as triangles of barycentric coordinates: weights of its second and third corner.
struct Cutout {
  bool whole = false;
  std::vector<glm::dvec2> corners;
};

class TriangleCut {
 public:
  TriangleCut(const RawScene& raw, const Triangle& triangle, const AlphaLevels& levels) : levels_(levels) {
    for (std::size_t c = 0; c < 3; ++c) {
      position_[c] = raw.positions[triangle[c]];
      if (raw.texcoords.size() > triangle[c])
        uv_[c] = {static_cast<double>(raw.texcoords[triangle[c]].x), static_cast<double>(raw.texcoords[triangle[c]].y)};
      if (raw.colours.size() > triangle[c]) vertex_[c] = (raw.colours[triangle[c]] >> 24) / 255.0;
    }
  }

  // Returns the number of texture cells around the triangle.
  double cells(double texel_m) const {
    const AlphaLevels::Level& level = levels_.level(level_for(texel_m));
    const auto wide = [&](double a, double b, double c, std::uint32_t size) {
      return (std::max({a, b, c}) - std::min({a, b, c})) * size + 2;
    };
    return plain() ? 1
                   : wide(uv_[0].x, uv_[1].x, uv_[2].x, level.width) * wide(uv_[0].y, uv_[1].y, uv_[2].y, level.height);
  }

  Cutout cut(double texel_m) {
    Cutout out;
    level_ = &levels_.level(level_for(texel_m));
    if (plain()) {
      const double mean = (vertex_[0] + vertex_[1] + vertex_[2]) / 3;
      const glm::dvec2 uv = (uv_[0] + uv_[1] + uv_[2]) / 3.0;
      const bool known = std::isfinite(uv.x) && std::isfinite(uv.y) && std::abs(uv.x) < 1e9 && std::abs(uv.y) < 1e9;
      const double alpha = known ? levels_.at(*level_, static_cast<std::int64_t>(std::floor(uv.x * level_->width)),
                                              static_cast<std::int64_t>(std::floor(uv.y * level_->height)))
                                 : 1;
      out.whole = alpha * mean >= level_->cutoff;
      return out;
    }
    // Texel coordinates, with whole numbers at the middles of texels.
    for (std::size_t c = 0; c < 3; ++c)
      texel_[c] = uv_[c] * glm::dvec2(level_->width, level_->height) - glm::dvec2(0.5);
    const auto bound = [&](int axis, bool high) {
      const auto [least, most] = std::minmax({texel_[0][axis], texel_[1][axis], texel_[2][axis]});
      return static_cast<std::int64_t>(std::floor(high ? most : least)) + (high ? 1 : 0);
    };
    low_x_ = bound(0, false), high_x_ = bound(0, true);
    low_y_ = bound(1, false), high_y_ = bound(1, true);
    area_ = cross_of(texel_[0], texel_[1], texel_[2]);
    const auto columns = static_cast<std::size_t>(high_x_ - low_x_);
    std::vector<double> below(columns + 1), above(columns + 1);
    fill_row(low_y_, below);
    struct Run {
      std::int64_t x0, x1, y0;
    };
    std::vector<Run> open, next;  // runs of full cells that continue from row to row
    bool all = true;
    for (std::int64_t y = low_y_; y < high_y_; ++y, std::swap(below, above)) {
      fill_row(y + 1, above);
      next.clear();
      for (std::int64_t x = low_x_; x < high_x_; ++x) {
        const auto i = static_cast<std::size_t>(x - low_x_);
        const std::array<double, 4> corner{below[i], below[i + 1], above[i + 1], above[i]};
        const auto filled = std::ranges::count_if(corner, [](double a) { return a >= 0; });
        if (filled == 4) {
          if (!next.empty() && next.back().x1 == x)
            next.back().x1 = x + 1;
          else
            next.push_back({x, x + 1, y});
          continue;
        }
        all = false;
        if (filled == 0) continue;
        const glm::dvec2 p(static_cast<double>(x), static_cast<double>(y));
        // Alpha is linear on each half of the cell.
        half_cell({p, p + glm::dvec2(1, 0), p + glm::dvec2(1, 1)}, {corner[0], corner[1], corner[2]}, out);
        half_cell({p, p + glm::dvec2(1, 1), p + glm::dvec2(0, 1)}, {corner[0], corner[2], corner[3]}, out);
      }
      for (const Run& run : open) {
        const auto same = std::ranges::find_if(next, [&](const Run& n) { return n.x0 == run.x0 && n.x1 == run.x1; });
        if (same != next.end())
          same->y0 = run.y0;
        else
          rectangle(run.x0, run.x1, run.y0, y, out);
      }
      std::swap(open, next);
    }
    if (all) return {.whole = true, .corners = {}};
    for (const Run& run : open) rectangle(run.x0, run.x1, run.y0, high_y_, out);
    return out;
  }

 private:
  static double cross_of(const glm::dvec2& a, const glm::dvec2& b, const glm::dvec2& c) {
    return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
  }

  // Returns true if the triangle is kept or dropped as a whole: no texture area, one colour, or absurd repetition.
  bool plain() const {
    const double area = std::abs(cross_of(uv_[0], uv_[1], uv_[2]));
    const bool tinted = vertex_[0] != vertex_[1] || vertex_[0] != vertex_[2];
    for (int axis = 0; axis < 2; ++axis) {
      const auto [least, most] = std::minmax({uv_[0][axis], uv_[1][axis], uv_[2][axis]});
      if (!(most - least < kMostRepeats)) return true;
    }
    return !(area > 1e-18) || (levels_.uniform() && !tinted);
  }

  // Returns the coarsest level whose texels are at most `texel_m` wide on the surface.
  std::size_t level_for(double texel_m) const {
    const double area = cross_of(uv_[0], uv_[1], uv_[2]);
    if (!(std::abs(area) > 1e-18)) return 0;
    const glm::dvec3 p = position_[1] - position_[0], q = position_[2] - position_[0];
    const glm::dvec2 s = uv_[1] - uv_[0], t = uv_[2] - uv_[0];
    const double along_u = length(p * t.y - q * s.y) / std::abs(area),
                 along_v = length(q * s.x - p * t.x) / std::abs(area);
    std::size_t level = 0;
    while (level + 1 < levels_.count() && along_u / levels_.level(level + 1).width <= texel_m &&
           along_v / levels_.level(level + 1).height <= texel_m)
      ++level;
    return level;
  }

  // Fills a row with alpha minus the cut-off, at the middles of texels.
  void fill_row(std::int64_t y, std::vector<double>& row) const {
    for (std::int64_t x = low_x_; x <= high_x_; ++x) {
      double alpha = levels_.at(*level_, x, y);
      const glm::dvec2 w = weights({static_cast<double>(x), static_cast<double>(y)});
      const double tint = vertex_[0] + (vertex_[1] - vertex_[0]) * w.x + (vertex_[2] - vertex_[0]) * w.y;
      row[static_cast<std::size_t>(x - low_x_)] = alpha * std::clamp(tint, 0.0, 1.0) - level_->cutoff;
    }
  }

  glm::dvec2 weights(const glm::dvec2& p) const {
    return {cross_of(texel_[0], p, texel_[2]) / area_, cross_of(texel_[0], texel_[1], p) / area_};
  }

  void half_cell(const std::array<glm::dvec2, 3>& corner, const std::array<double, 3>& excess, Cutout& out) {
    polygon_.assign(corner.begin(), corner.end());
    // The excess is linear over a right triangle with sides of one texel.
    const glm::dvec2 a = corner[1] - corner[0], b = corner[2] - corner[0];
    const double turn = a.x * b.y - a.y * b.x;
    clip(polygon_, spare_, [&](const glm::dvec2& p) {
      const glm::dvec2 d = p - corner[0];
      const double u = (d.x * b.y - d.y * b.x) / turn, v = (a.x * d.y - a.y * d.x) / turn;
      return excess[0] * (1 - u - v) + excess[1] * u + excess[2] * v;
    });
    add(out);
  }

  void rectangle(std::int64_t x0, std::int64_t x1, std::int64_t y0, std::int64_t y1, Cutout& out) {
    const glm::dvec2 low(static_cast<double>(x0), static_cast<double>(y0)),
        high(static_cast<double>(x1), static_cast<double>(y1));
    polygon_ = {low, {high.x, low.y}, high, {low.x, high.y}};
    add(out);
  }

  // Adds the part of the polygon within the triangle.
  void add(Cutout& out) {
    for (std::size_t c = 0; c < 3 && polygon_.size() >= 3; ++c) {
      const glm::dvec2 &a = texel_[c], &b = texel_[(c + 1) % 3];
      clip(polygon_, spare_, [&](const glm::dvec2& p) { return cross_of(a, b, p) * (area_ > 0 ? 1 : -1); });
    }
    for (std::size_t k = 2; k < polygon_.size(); ++k) {
      std::array<glm::dvec2, 3> w{weights(polygon_[0]), weights(polygon_[k - 1]), weights(polygon_[k])};
      if (area_ < 0) std::swap(w[1], w[2]);
      if (thick(w)) out.corners.insert(out.corners.end(), w.begin(), w.end());
    }
  }

  bool thick(const std::array<glm::dvec2, 3>& w) const {
    std::array<glm::dvec3, 3> p;
    for (std::size_t c = 0; c < 3; ++c)
      p[c] = position_[0] + (position_[1] - position_[0]) * w[c].x + (position_[2] - position_[0]) * w[c].y;
    const double longest = std::max({length(p[1] - p[0]), length(p[2] - p[1]), length(p[0] - p[2])});
    return length(cross(p[1] - p[0], p[2] - p[0])) > kThinnest_m * longest;
  }

  const AlphaLevels& levels_;
  const AlphaLevels::Level* level_ = nullptr;
  std::array<glm::dvec3, 3> position_;
  std::array<glm::dvec2, 3> uv_{}, texel_{};
  std::array<double, 3> vertex_{1, 1, 1};
  std::int64_t low_x_ = 0, high_x_ = 0, low_y_ = 0, high_y_ = 0;
  double area_ = 0;  // twice the area in texels, signed
  Polygon polygon_, spare_;
};

double area_of(const RawScene& raw, const Triangle& t) {
  return 0.5 * length(cross(raw.positions[t[1]] - raw.positions[t[0]], raw.positions[t[2]] - raw.positions[t[0]]));
}

std::uint32_t mixed(const std::array<std::uint32_t, 3>& colours, const glm::dvec2& w) {
  std::uint32_t out = 0;
  for (int shift = 0; shift < 32; shift += 8) {
    const auto channel = [&](std::size_t c) { return static_cast<double>(colours[c] >> shift & 255u); };
    const double value = channel(0) * (1 - w.x - w.y) + channel(1) * w.x + channel(2) * w.y;
    out |= static_cast<std::uint32_t>(std::lround(std::clamp(value, 0.0, 255.0))) << shift;
  }
  return out;
}

class MaskCutter {
 public:
  MaskCutter(RawScene& raw, const std::vector<double>& cutoffs, const LoadBudget& budget) : raw_(raw) {
    for (const MeshRange& range : raw.ranges) {
      const double cutoff = range.material < cutoffs.size() ? cutoffs[range.material] : 0;
      if (cutoff <= 0) continue;
      const auto [levels, added] = levels_.try_emplace(range.material);
      if (added) levels->second = levels_of(raw, raw.materials[range.material], cutoff, budget);
      if (levels->second) masked_ += range.triangle_count;
    }
  }

  bool nothing() const { return masked_ == 0; }

  void cut(double texel_m, std::size_t most_triangles) {
    for (double wanted = texel_m; wanted < 1e6; wanted *= 2) {
      if (!fits(wanted) || !make(wanted, most_triangles)) continue;
      put(texel_m, wanted);
      return;
    }
    raw_.notes.push_back("the holes of masked textures on " + std::to_string(masked_) +
                         " triangles are too many to be cut out; these surfaces are opaque");
  }

 private:
  static std::optional<AlphaLevels> levels_of(RawScene& raw, const Material& material, double cutoff,
                                              const LoadBudget& budget) {
    const Image* image = material.image < 0 ? nullptr : &raw.images[static_cast<std::size_t>(material.image)];
    // Memory: its alpha, the averages, and a sorted copy of one of them.
    if (!image || std::uint64_t{8} * image->width * image->height <= budget.left())
      return AlphaLevels(image, material, cutoff);
    raw.notes.push_back("the holes of a texture of " + std::to_string(image->width) + " × " +
                        std::to_string(image->height) + " pixels do not fit into memory; its surfaces are opaque");
    return std::nullopt;
  }

  // Returns null if the mesh is opaque.
  const AlphaLevels* levels(const MeshRange& range) const {
    const auto found = levels_.find(range.material);
    return found != levels_.end() && found->second ? &*found->second : nullptr;
  }

  bool fits(double texel_m) const {
    double cells = 0;
    for (const MeshRange& range : raw_.ranges) {
      const AlphaLevels* const mask = levels(range);
      if (!mask) continue;
      for (std::uint32_t t = range.first_triangle; t < range.first_triangle + range.triangle_count; ++t) {
        cells += TriangleCut(raw_, raw_.triangles[t], *mask).cells(texel_m);
      }
    }
    return cells <= kMostCells;
  }

  // Makes all cutouts; returns false if they have too many triangles.
  bool make(double texel_m, std::size_t most) {
    cutouts_.assign(raw_.triangles.size(), {});
    std::atomic<std::size_t> made = 0;
    for (const MeshRange& range : raw_.ranges) {
      const AlphaLevels* const mask = levels(range);
      if (!mask) continue;
      parallel::for_all(std::size_t{0}, (range.triangle_count + kBlock - 1) / kBlock, [&](std::size_t block) {
        const std::size_t first = range.first_triangle + block * kBlock,
                          end = std::min<std::size_t>(first + kBlock, range.first_triangle + range.triangle_count);
        for (std::size_t t = first; t < end && made <= most; ++t) {
          if (!sound_corners(raw_.triangles[t])) {  // dropped later
            cutouts_[t].whole = true;
            continue;
          }
          cutouts_[t] = TriangleCut(raw_, raw_.triangles[t], *mask).cut(texel_m);
          made += cutouts_[t].corners.size() / 3;
        }
      });
      if (made > most) return false;
    }
    return true;
  }

  bool sound_corners(const Triangle& t) const {
    return std::ranges::all_of(t, [&](std::uint32_t v) { return sound(raw_.positions[v]); });
  }

  // Replaces the triangles by the cutouts.
  void put(double asked_m, double texel_m) {
    std::vector<Triangle> triangles;
    std::size_t made = 0;
    double before = 0, after = 0;
    for (MeshRange& range : raw_.ranges) {
      const std::uint32_t first = range.first_triangle, end = first + range.triangle_count;
      range.first_triangle = static_cast<std::uint32_t>(triangles.size());
      if (!levels(range)) {
        triangles.insert(triangles.end(), raw_.triangles.begin() + first, raw_.triangles.begin() + end);
      } else {
        for (std::uint32_t t = first; t < end; ++t) {
          const Triangle whole = raw_.triangles[t];
          const bool measured = sound_corners(whole);
          if (measured) before += area_of(raw_, whole);
          const std::size_t from = triangles.size();
          if (cutouts_[t].whole)
            triangles.push_back(whole);
          else
            append(whole, cutouts_[t].corners, triangles);
          made += triangles.size() - from;
          for (std::size_t k = from; measured && k < triangles.size(); ++k) after += area_of(raw_, triangles[k]);
        }
      }
      range.triangle_count = static_cast<std::uint32_t>(triangles.size()) - range.first_triangle;
    }
    raw_.triangles = std::move(triangles);
    drop_empty_meshes(raw_);
    char text[256];
    std::snprintf(
        text, sizeof text,
        "rays pass the holes of masked textures: %.3g of %.4g m² are empty, cut out as far as texels of %.3g mm "
        "show them (%zu triangles became %zu)",
        std::max(before - after, 0.0), before, 1e3 * texel_m, masked_, made);
    raw_.notes.emplace_back(text);
    if (texel_m > asked_m) raw_.notes.back() += "; finer ones would be too many";
  }

  void append(const Triangle& of, const std::vector<glm::dvec2>& corners, std::vector<Triangle>& out) {
    std::map<std::pair<double, double>, std::uint32_t> known;
    for (std::size_t k = 0; k < corners.size(); k += 3) {
      Triangle t;
      for (std::size_t c = 0; c < 3; ++c) {
        const glm::dvec2& w = corners[k + c];
        const auto [place, added] = known.try_emplace({w.x, w.y}, static_cast<std::uint32_t>(raw_.positions.size()));
        if (added) add_vertex(of, w);
        t[c] = place->second;
      }
      out.push_back(t);
    }
  }

  void add_vertex(const Triangle& of, const glm::dvec2& w) {
    const double w0 = 1 - w.x - w.y;
    const std::size_t count = raw_.positions.size();
    raw_.positions.push_back(raw_.positions[of[0]] * w0 + raw_.positions[of[1]] * w.x + raw_.positions[of[2]] * w.y);
    const auto blend = [&](float a, float b, float c) {
      return static_cast<float>(static_cast<double>(a) * w0 + static_cast<double>(b) * w.x +
                                static_cast<double>(c) * w.y);
    };
    if (!raw_.normals.empty()) {
      raw_.normals.resize(count);
      const Float3 a = raw_.normals[of[0]], b = raw_.normals[of[1]], c = raw_.normals[of[2]];
      raw_.normals.push_back({blend(a.x, b.x, c.x), blend(a.y, b.y, c.y), blend(a.z, b.z, c.z)});
    }
    if (!raw_.texcoords.empty()) {
      raw_.texcoords.resize(count);
      const Float2 a = raw_.texcoords[of[0]], b = raw_.texcoords[of[1]], c = raw_.texcoords[of[2]];
      raw_.texcoords.push_back({blend(a.x, b.x, c.x), blend(a.y, b.y, c.y)});
    }
    if (!raw_.colours.empty()) {
      raw_.colours.resize(count, 0xFFFFFFFF);
      raw_.colours.push_back(mixed({raw_.colours[of[0]], raw_.colours[of[1]], raw_.colours[of[2]]}, w));
    }
  }

  RawScene& raw_;
  std::map<std::uint32_t, std::optional<AlphaLevels>> levels_;  // by material
  std::vector<Cutout> cutouts_;                                 // by triangle
  std::size_t masked_ = 0;
};

}  // namespace

void cut_masks(RawScene& raw, const std::vector<double>& cutoffs, const LoadBudget& budget, double texel_m,
               std::size_t most_triangles) {
  MaskCutter cutter(raw, cutoffs, budget);
  if (cutter.nothing()) return;
  cutter.cut(texel_m, std::min<std::size_t>(most_triangles, budget.left() / kTriangleBytes));
}

}  // namespace vantage
