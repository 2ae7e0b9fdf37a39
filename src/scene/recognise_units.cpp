// SPDX-License-Identifier: Apache-2.0
#include "scene/recognise_units.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <set>
#include <utility>

#include "core/disjoint_sets.hpp"
#include "core/parallel.hpp"
#include "core/person.hpp"
#include "scene/columns.hpp"
#include "scene/open_doors.hpp"
#include "scene/positions.hpp"
#include "scene/shared_meshes.hpp"
#include "scene/sound_triangle.hpp"
#include "scene/winding.hpp"

namespace vantage {
namespace {

constexpr std::array<UpAxis, 3> kAxes{UpAxis::y, UpAxis::z, UpAxis::x};
constexpr std::array<Unit, 5> kUnits{Unit::metre, Unit::foot, Unit::inch, Unit::centimetre, Unit::millimetre};

// Measures of what is built for a person, in metres.
constexpr double kRoom_m2 = 2;
constexpr double kDoorWidth = 0.9, kNarrowestDoor = 0.55, kWidestDoor = 2.4, kLowestDoor = 1.85, kHighestDoor = 2.6,
                 kThickestWall = 0.8, kLintel = 0.1;
constexpr double kLeastRise = 0.12, kMostRise = 0.215, kLeastGoing = 0.2, kMostGoing = 0.45;
constexpr int kFewestRises = 3;

// Weights of the features of a hypothesis, in their order. They were fitted, as a
// multinomial logit, to sites of known truth (`hypotheses --features`), and
// rounded.
constexpr std::array<double, kFeatures> kWeights{4, 3.5, 5, 3, 3.5, 5, 2, 4, 0.7, 0.5};
// Least lead of the best hypothesis: with glTF's rule, and with any other.
constexpr double kRuleLead = 0.3, kLead = 1.3;
constexpr std::size_t kMostChoices = 3;

constexpr double kNoSite_m = 1, kNoSiteEither_m = 10'000;
// Limits: ground lies within kNoHeight_m; national coordinates exceed kNational_m on both axes.
constexpr double kNoHeight_m = 10'000, kNational_m = 50'000;

double extent_of(const Hypothesis& h) { return std::max({h.size.x, h.size.y, h.size.z}); }

// Returns 1 in a range, falling to 0 at its outer limits, by the logarithm.
double within(double x, double none_below, double low, double high, double none_above) {
  if (!(x > none_below) || !(x < none_above)) return 0;
  if (x < low) return std::log(x / none_below) / std::log(low / none_below);
  if (x > high) return std::log(none_above / x) / std::log(none_above / high);
  return 1;
}

// Places that a person can reach, if lengths are in this unit.
class Walk {
 public:
  Walk(const Columns& columns, double metres)
      : c_(columns),
        metres_(metres),
        tall_(static_cast<float>(person::kHeight_m / metres)),
        climb_(static_cast<float>(std::max(person::kStep_m / metres, 0.9 * columns.cell()))),
        parts_(columns.levels().size()) {
    for (std::uint32_t column = 0; column < c_.count(); ++column)
      for (int axis = 0; axis < 2; ++axis)
        if (const auto beside = neighbour(column, axis))
          for (std::uint32_t a = c_.first(column); a < c_.first(column + 1); ++a)
            for (std::uint32_t b = c_.first(*beside); b < c_.first(*beside + 1); ++b)
              if (linked(column, axis, a, b)) parts_.join(a, b);
  }

  void measure(Hypothesis& h) {
    const double cell = c_.cell() * metres_, square = cell * cell;
    std::vector<std::uint32_t> size(parts_.size(), 0);
    std::vector<std::pair<double, double>> headroom;
    double under = 0;
    for (std::uint32_t i = 0; i < parts_.size(); ++i) {
      const Columns::Level& level = c_.levels()[i];
      if (level.free >= tall_) ++size[parts_.find(i)];
      if (std::isinf(level.free)) continue;
      under += 1;
      h.rooms += within(level.free * metres_, 1.7, 2.2, 5, 12);
    }
    const double outline = c_.outline() * metres_ * metres_;
    h.covered = std::min(1.0, under * square / outline);
    if (under > 0) h.rooms /= under;
    std::uint32_t largest = 0;
    for (const std::uint32_t n : size) {
      largest = std::max(largest, n);
      if (n * square >= kRoom_m2) h.floor_m2 += n * square;
    }
    std::vector<float> heights;
    for (std::uint32_t i = 0; i < parts_.size(); ++i)
      if (const float free = c_.levels()[i].free;
          !std::isinf(free) && size[parts_.find(i)] * square >= kRoom_m2 && free >= tall_)
        heights.push_back(free);
    if (!heights.empty()) {
      const auto middle = heights.begin() + static_cast<std::ptrdiff_t>(heights.size() / 2);
      std::ranges::nth_element(heights, middle);
      h.headroom_m = *middle * metres_;
    }
    h.reached = largest * square / outline;
    std::array<std::vector<std::uint8_t>, 2> lintel;
    for (auto& some : lintel) some.assign(parts_.size(), 0);
    const auto for_places = [&](const auto& visit) {
      for (std::uint32_t column = 0; column < c_.count(); ++column)
        for (std::uint32_t i = c_.first(column); i < c_.first(column + 1); ++i)
          if (c_.levels()[i].free >= tall_ && size[parts_.find(i)] * square >= kRoom_m2) visit(Place{column, i});
    };
    for_places([&](const Place& at) {
      for (int axis = 0; axis < 2; ++axis) {
        lintel[static_cast<std::size_t>(axis)][at.level] = begins_door(at, axis);
        h.flights += begins_flight(at, axis) ? cell / kDoorWidth : 0;
      }
    });
    // Counts doors: runs of places under a lintel, as wide as doors.
    for_places([&](const Place& at) {
      for (int axis = 0; axis < 2; ++axis) {
        const auto& under = lintel[static_cast<std::size_t>(axis)];
        const auto before = next(at, 1 - axis, true);
        if (!under[at.level] || (before && under[before->level])) continue;
        double width = 0;
        for (std::optional<Place> along = at; along && under[along->level] && width <= kWidestDoor;
             along = next(*along, 1 - axis, false))
          width += cell;
        if (width >= kNarrowestDoor && width <= kWidestDoor) h.doors += 1;
      }
    });
  }

 private:
  struct Place {
    std::uint32_t column, level;
  };

  std::optional<std::uint32_t> neighbour(std::uint32_t column, int axis, bool back = false) const {
    const std::uint32_t step = axis == 0 ? 1 : c_.nx();
    if (back) {
      if (axis == 0 ? column % c_.nx() == 0 : column < step) return std::nullopt;
      return column - step;
    }
    if (axis == 0 ? column % c_.nx() + 1 == c_.nx() : column + step >= c_.count()) return std::nullopt;
    return column + step;
  }

  // Returns true if a person can step between levels of a column and the next.
  bool linked(std::uint32_t column, int axis, std::uint32_t a, std::uint32_t b) const {
    const Columns::Level &p = c_.levels()[a], &q = c_.levels()[b];
    if (p.free < tall_ || q.free < tall_ || std::abs(p.z - q.z) > climb_) return false;
    const float low = std::max(p.z, q.z);
    return std::min(p.z + p.free, q.z + q.free) - low >= tall_ && !c_.wall(column, axis, low + climb_, low + tall_);
  }

  std::optional<Place> next(const Place& from, int axis, bool back) const {
    const auto beside = neighbour(from.column, axis, back);
    if (!beside) return std::nullopt;
    for (std::uint32_t b = c_.first(*beside); b < c_.first(*beside + 1); ++b)
      if (back ? linked(*beside, axis, b, from.level) : linked(from.column, axis, from.level, b))
        return Place{*beside, b};
    return std::nullopt;
  }

  float free(const Place& at) const { return c_.levels()[at.level].free; }
  float z(const Place& at) const { return c_.levels()[at.level].z; }

  // Returns true if headroom drops to that of a door here, and rises again behind a wall's thickness.
  bool begins_door(const Place& here, int axis) const {
    const double high = free(here) * metres_;
    if (high < kLowestDoor || high > kHighestDoor) return false;
    const double more = free(here) + kLintel / metres_;
    const auto before = next(here, axis, true);
    if (!before || free(*before) < more) return false;
    std::optional<Place> at = here;
    for (double gone = 0; gone <= kThickestWall; gone += c_.cell() * metres_) {
      at = next(*at, axis, false);
      if (!at) return false;
      if (free(*at) >= more) return true;
    }
    return false;
  }

  // Returns true if a stair begins here: equal rises, each behind a tread.
  bool begins_flight(const Place& from, int axis) const {
    const double cell = c_.cell() * metres_;
    if (cell > kLeastGoing) return false;
    for (const bool back : {false, true}) {
      Place at = from;
      double rise = 0, going = 0;
      int rises = 0;
      while (rises < kFewestRises) {
        const auto to = next(at, axis, back);
        if (!to) break;
        const double dz = (z(*to) - z(at)) * metres_;
        going += cell;
        at = *to;
        if (dz >= kLeastRise && dz <= kMostRise && (rises == 0 || std::abs(dz - rise) < 0.1 * rise)) {
          if (rises == 0 ? going > cell * 1.5 : going < std::max(kLeastGoing - cell, 1.5 * cell)) break;
          rise = dz, going = 0, ++rises;
        } else if (std::abs(dz) > 0.02 || going > kMostGoing || rises == 0) {
          break;
        }
      }
      if (rises == kFewestRises) return true;
    }
    return false;
  }

  const Columns& c_;
  double metres_;
  float tall_, climb_;
  DisjointSets parts_;
};

// Unit of a model's drawing grid. Most faces across an axis lie at multiples of 8 if drawn in inches, of 10 if in parts
// of a metre.
struct DrawingGrid {
  bool inches = false, parts_of_a_metre = false;
};
DrawingGrid drawing_grid(const RawScene& raw) {
  constexpr double kWhole = 1e-3, kAcross = 0.9999, kMost = 0.5;
  constexpr std::size_t kFewest = 30;  // different coordinates; fewer may be coincidence
  double all = 0, eights = 0, tens = 0;
  std::set<double> whole;
  for (const Triangle& t : raw.triangles) {
    const glm::dvec3 &a = raw.positions[t[0]], &b = raw.positions[t[1]], &c = raw.positions[t[2]];
    if (!sound(a) || !sound(b) || !sound(c)) continue;
    const glm::dvec3 n = cross(b - a, c - a);
    const double area = length(n);
    for (int axis = 0; axis < 3; ++axis) {
      if (!(std::abs(n[axis]) > kAcross * area) || area == 0) continue;
      all += area;
      const double nearest = std::round(std::abs(a[axis]));
      if (nearest == 0 || std::abs(std::abs(a[axis]) - nearest) > kWhole) continue;
      if (whole.size() < kFewest) whole.insert(nearest);
      if (std::fmod(nearest, 8) == 0) eights += area;
      if (std::fmod(nearest, 10) == 0) tens += area;
    }
  }
  if (whole.size() < kFewest) return {};
  return {eights > kMost * all && eights > 2 * tens, tens > kMost * all && tens > 2 * eights};
}

std::string rounded(double value) {
  char text[32];
  std::snprintf(text, sizeof text, value < 1000 ? "%.3g" : "%.0f", value);
  return text;
}

std::string plural(Unit unit) {
  switch (unit) {
    case Unit::metre: return "metres";
    case Unit::centimetre: return "centimetres";
    case Unit::millimetre: return "millimetres";
    case Unit::inch: return "inches";
    case Unit::foot: return "feet";
  }
  return {};
}

// "millimetres, Z up (60.6 x 30.6 x 10.5 m, 1480 m² of floor, rooms 2.7 m high, stairs)"
std::string meaning(const Hypothesis& h) {
  constexpr double kSome = 0.5;
  return plural(h.unit) + ", " +
         (h.up == UpAxis::x   ? "X"
          : h.up == UpAxis::y ? "Y"
                              : "Z") +
         " up (" + rounded(h.size.x) + " x " + rounded(h.size.y) + " x " + rounded(h.size.z) + " m" +
         (h.floor_m2 > 0 ? ", " + rounded(h.floor_m2) + " m² of floor" : "") +
         (h.headroom_m > 0 ? ", rooms " + rounded(h.headroom_m) + " m high" : "") + (h.doors > kSome ? ", doors" : "") +
         (h.flights > kSome ? ", stairs" : "") + ")";
}

// Returns triangles of leaves in any possible unit, since a closed leaf hides its opening.
std::vector<std::uint8_t> leaves_in_any(const RawScene& raw, const std::optional<Unit>& unit, UpAxis up) {
  std::array<std::vector<std::size_t>, kUnits.size()> leaves;
  parallel::for_all(std::size_t{0}, kUnits.size(), [&](std::size_t i) {
    if (unit.value_or(kUnits[i]) == kUnits[i]) leaves[i] = leaves_if(raw, kUnits[i], up);
  });
  std::vector<std::uint8_t> out;
  for (const auto& some : leaves)
    for (const std::size_t m : some) {
      out.resize(raw.triangles.size(), 0);
      std::fill_n(out.begin() + raw.ranges[m].first_triangle, raw.ranges[m].triangle_count, std::uint8_t{1});
    }
  return out;
}

// Returns the place of a model in a unit and axis: one of its vertices, in metres.
glm::dvec3 place_by(const RawScene& raw, Unit unit, UpAxis up) {
  const auto some = std::ranges::find_if(raw.positions, [](const glm::dvec3& p) { return sound(p); });
  return some == raw.positions.end() ? glm::dvec3(0) : with_up(up, *some) * metres_in(unit);
}

bool is_national(const glm::dvec3& place) {
  return std::min(std::abs(place.x), std::abs(place.y)) > kNational_m && std::abs(place.z) < kNoHeight_m;
}

double score_of(const Hypothesis& h) {
  const std::array<double, kFeatures> f = features_of(h);
  double score = 0;
  for (std::size_t i = 0; i < kFeatures; ++i) score += kWeights[i] * f[i];
  return score;
}
}  // namespace

std::array<double, kFeatures> features_of(const Hypothesis& h) {
  const double extent = extent_of(h), wide = std::sqrt(h.size.x * h.size.y);
  return {within(extent, 1.5, 4, 400, 2500),
          std::min(1.0, h.reached),
          h.covered * h.rooms + (1 - h.covered) * 0.4,
          h.doors / (h.doors + 0.5),  // few say as much as many
          h.flights / (h.flights + 5),
          std::clamp(0.5 - 0.5 * std::log2(h.size.z / wide), 0.0, 1.0),
          h.upright,
          h.grid,
          h.unit == Unit::metre ? 1.0 : 0.0,
          h.up == UpAxis::y   ? 1.0
          : h.up == UpAxis::z ? 0.0
                              : -2.0};  // few models have X up
}

namespace {
// Returns true if the winding of a model's faces, by some hundreds of its meshes, tells nothing.
bool wound_either_way(const RawScene& raw) {
  constexpr std::size_t kLookedAt = 500;
  Winding winding;
  for (std::size_t m = 0; m < raw.ranges.size(); m += raw.ranges.size() / kLookedAt + 1)
    winding += winding_of(raw.ranges[m].triangle_count, [&](std::uint32_t k) {
      const Triangle& t = raw.triangles[raw.ranges[m].first_triangle + k];
      return std::array{raw.positions[t[0]], raw.positions[t[1]], raw.positions[t[2]]};
    });
  return winding.either_way();
}
}  // namespace

std::vector<Hypothesis> weigh_hypotheses(const RawScene& raw, const std::optional<Unit>& unit,
                                         const std::optional<UpAxis>& up) {
  std::vector<Hypothesis> all;
  const DrawingGrid grid = drawing_grid(raw);
  const bool either_way = wound_either_way(raw);
  for (const UpAxis axis : kAxes) {
    if (up.value_or(axis) != axis) continue;
    const Columns columns(raw, axis, leaves_in_any(raw, unit, axis), either_way);
    if (columns.empty()) return {};
    const std::size_t first = all.size();
    for (const Unit length : kUnits) {
      if (unit.value_or(length) != length) continue;
      Hypothesis& h = all.emplace_back();
      h.unit = length, h.up = axis, h.upright = columns.upright(), h.inside_out = columns.inside_out();
      const bool part = length == Unit::centimetre || length == Unit::millimetre;
      h.grid = (length == Unit::inch && grid.inches) || (part && grid.parts_of_a_metre) ? 1 : 0;
    }
    parallel::for_all(first, all.size(), [&](std::size_t i) {
      const double metres = metres_in(all[i].unit);
      all[i].size = to_vec3(columns.size() * metres);
      if (extent_of(all[i]) < kNoSite_m || extent_of(all[i]) > kNoSiteEither_m) return;  // nobody walks there
      Walk(columns, metres).measure(all[i]);
    });
  }
  // Pitched roofs are vertical along their ridge, so X is compared with the other two, which ignore it.
  double upright = 0.01, with_x = 0.01;  // less than this says nothing
  for (const UpAxis axis : kAxes)
    if (const auto h = std::ranges::find(all, axis, &Hypothesis::up); h != all.end())
      (axis == UpAxis::x ? with_x : upright) += h->upright;
  with_x += upright;
  for (Hypothesis& h : all) {
    h.upright /= h.up == UpAxis::x ? with_x : upright;
    h.score = score_of(h);
  }
  std::ranges::stable_sort(all, [](const Hypothesis& a, const Hypothesis& b) { return a.score > b.score; });
  return all;
}

namespace {
constexpr double kSize = 0.3;  // least share of a plausible extent

// Returns true if only headroom decides, without doors, stairs or a drawing grid; halls have any headroom.
bool as_good_by_headroom(const Hypothesis& best, const Hypothesis& other) {
  constexpr double kPlausible = 0.2;
  const bool told = best.doors >= 1 || best.flights >= 1 || best.grid > 0;
  return !told && other.up == best.up && other.unit != best.unit && features_of(other)[0] >= kSize &&
         other.rooms >= kPlausible * best.rooms;
}

// Returns true if round columns and turned walls stand along the other axis, and no door is along this one.
bool stands_as_well(const Hypothesis& best, const Hypothesis& other) {
  constexpr double kMostUpright = 0.5;
  return best.doors < 1 && other.unit == best.unit && other.up != best.up && other.up != UpAxis::x &&
         other.upright >= kMostUpright;
}

// Returns true if the drawing is on another unit's grid: doors and stairs may then fit by coincidence. A site in metres
// has no such grid.
bool drawn_otherwise(const Hypothesis& best, const Hypothesis& other) {
  return best.unit != Unit::metre && best.grid == 0 && other.grid > 0 && other.up == best.up &&
         features_of(other)[0] >= kSize;
}

bool has_ways(const Hypothesis& h) { return h.doors >= 1 || h.flights >= 1; }

// Returns true if the other unit makes rooms that nobody builds out of rooms of a person's height with doors.
bool is_for_giants(const Hypothesis& best, const Hypothesis& other) {
  constexpr double kLowestRoom_m = 2, kHighestRoom_m = 6, kNoRoom_m = 20;
  return other.up == best.up && best.doors >= 1 && best.headroom_m >= kLowestRoom_m &&
         best.headroom_m <= kHighestRoom_m && other.headroom_m > kNoRoom_m;
}

// Returns true for X up without a door or a stair. A tower on its side has floors, too, and few models have X up, so X
// yields to an axis with doors or stairs, and is never taken without asking.
bool is_doubtful(const Hypothesis& h, const std::optional<UpAxis>& up) {
  return !up && h.up == UpAxis::x && !has_ways(h);
}
}  // namespace

Recognised recognise(const RawScene& raw, const std::optional<Unit>& unit, const std::optional<UpAxis>& up,
                     bool keeps_rule) {
  Recognised out{unit.value_or(Unit::metre), up.value_or(UpAxis::y)};
  std::vector<Hypothesis> all = weigh_hypotheses(raw, unit, up);
  if (all.empty()) return out;
  if (!up) {  // national coordinates tell the axis: none is a height
    const auto too_high = [&](const Hypothesis& h) { return std::abs(place_by(raw, h.unit, h.up).z) > kNoHeight_m; };
    if (!std::ranges::all_of(all, too_high)) std::erase_if(all, too_high);
  }
  const auto usual = std::ranges::find_if(all, [](const Hypothesis& h) { return h.up != UpAxis::x; });
  if (usual != all.end() && has_ways(*usual))
    std::erase_if(all, [&](const Hypothesis& h) { return is_doubtful(h, up); });
  const Hypothesis& best = all[0];
  const bool rule = best.unit == out.unit && best.up == out.up;
  out.unit = best.unit, out.up = best.up, out.inside_out = best.inside_out;
  const std::string settings = unit ? "the setting up"
                               : up ? "the setting unit"
                                    : "the setting unit and the setting up";
  const bool national = best.unit == Unit::metre && is_national(place_by(raw, best.unit, best.up));
  const auto rivals = [&](const Hypothesis& other) {
    // National coordinates are in metres nearly everywhere; only doors and stairs can show otherwise.
    if (national && other.unit != best.unit && (has_ways(best) || !has_ways(other))) return false;
    if (is_doubtful(best, up) && other.up != UpAxis::x) return true;
    if (is_for_giants(best, other)) return false;
    // A rule that files may break weighs less than doors and stairs that only the other hypothesis has.
    const bool by_rule = rule && keeps_rule && (has_ways(best) || !has_ways(other));
    return best.score - other.score < (by_rule ? kRuleLead : kLead) ||
           (!rule && (as_good_by_headroom(best, other) || stands_as_well(best, other) || drawn_otherwise(best, other)));
  };
  if (std::any_of(all.begin() + 1, all.end(), rivals)) {
    out.question =
        "its unit and up axis are not clear: a person could walk in it read in several ways; give " + settings;
    for (const Hypothesis& h : all)
      if (out.choices.size() < kMostChoices && (&h == &best || rivals(h)))
        out.choices.push_back(meaning(h) + ": unit " + to_string(h.unit) + ", up " + to_string(h.up));
    return out;
  }
  if (rule) return out;
  const Unit usual_unit = unit.value_or(Unit::metre);
  const UpAxis usual_up = up.value_or(UpAxis::y);
  const auto stated =
      std::ranges::find_if(all, [&](const Hypothesis& h) { return h.unit == usual_unit && h.up == usual_up; });
  const bool same_unit = best.unit == usual_unit, same_axis = best.up == usual_up;
  out.note = "read as " + meaning(best) +
             (stated == all.end() ? "; otherwise its coordinates would be heights"
                                  : "; as " + meaning(*stated) + ", a person could walk less of it") +
             "; if that is wrong, give " +
             (same_unit   ? "the setting up"
              : same_axis ? "the setting unit"
                          : "the setting unit and the setting up");
  return out;
}

void turn_faces(RawScene& raw) {
  for (Triangle& t : raw.triangles) std::swap(t[1], t[2]);
  for (Float3& n : raw.normals) n = without_minus_zero({-n.x, -n.y, -n.z});
  for (SharedMesh& mesh : raw.shared) {
    for (Triangle& t : mesh.triangles) std::swap(t[1], t[2]);
    for (Float3& n : mesh.normals) n = without_minus_zero({-n.x, -n.y, -n.z});
  }
}

void reinterpret_axes(RawScene& raw, Unit unit, UpAxis up) {
  const double metres = metres_in(unit);
  const bool turn = up != UpAxis::y;
  if (metres == 1 && !turn) return;
  const auto point = [&](const glm::dvec3& p) { return with_up(up, p) * metres; };
  for (glm::dvec3& p : raw.positions) p = point(p);
  for (glm::dvec3& p : raw.search_positions) p = point(p);
  for (auto& range : raw.placed)
    for (PlacedShared& placed : range) placed.place = reinterpreted(placed.place, unit, up);
  if (turn)
    for (Float3& n : raw.normals) n = without_minus_zero(to_float3(with_up(up, to_glm(n))));
  raw.coarsest_input_spacing_m *= metres;
}

}  // namespace vantage
