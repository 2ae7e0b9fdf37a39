// SPDX-License-Identifier: Apache-2.0
// Parts of the ground behind obstacles: the kind of obstacle, and the decision to enter them nevertheless.
#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <utility>

#include "core/parallel.hpp"
#include "placement/ground_field.hpp"

namespace vantage {
namespace {

// A closed part is entered from this share of the reached floor, or this area, on: 20 m² for a passage of 0.6 m.
constexpr double kEnteredShare = 0.1, kEnteredRooms = 22;
constexpr double kHighestStep = 4;                       // in steps of a person: 1 m
constexpr double kHighestRung = 1.8, kLowestRung = 0.6;  // in such steps: 0.45 m and 0.15 m between two rungs
constexpr std::size_t kMostRungs = 400'000;
constexpr int kDirections = 16;

glm::dvec3 direction(int k, int of = kDirections) {
  const double angle = 2 * 3.14159265358979323846 * k / of;
  return {std::cos(angle), std::sin(angle), 0};
}

}  // namespace

bool GroundField::has_room(std::uint32_t sample) const { return part_[sample] != kNowhere; }

double GroundField::reached_area() const {
  double area = 0;
  for (std::size_t i = 0; i < parts_.size(); ++i)
    if (access_[i] == Access::reached) area += parts_[i].area(cell_);
  return area;
}

// Returns those of the marked samples that lie on level strips no longer than a rung; boards of a shelf and ledges of a
// wall are longer. Unmarks the others.
std::vector<std::uint32_t> GroundField::narrow_ones(std::vector<std::uint8_t>& marked) const {
  const double longest = 5 * radius_;  // 1.5 m
  const auto level = static_cast<float>(0.12 * climb_);
  std::vector<std::uint32_t> narrow, strip;
  std::vector<std::uint8_t> seen(z_.size(), 0);
  for (std::uint32_t seed = 0; seed < z_.size(); ++seed) {
    if (!marked[seed] || seen[seed]) continue;
    strip.assign(1, seed), seen[seed] = 1;
    glm::dvec2 least = middle(column_[seed]), most = least;
    for (std::size_t k = 0; k < strip.size(); ++k) {
      const glm::dvec2 p = middle(column_[strip[k]]);
      least = glm::min(least, p), most = glm::max(most, p);
      for_neighbours(strip[k], [&](std::uint32_t n) {
        if (!marked[n] || seen[n] || std::abs(z_[n] - z_[strip[k]]) > level) return;
        seen[n] = 1;
        strip.push_back(n);
      });
    }
    if (std::max(most.x - least.x, most.y - least.y) <= longest)
      narrow.insert(narrow.end(), strip.begin(), strip.end());
    else
      for (const std::uint32_t s : strip) marked[s] = 0;
  }
  std::ranges::sort(narrow);
  return narrow;
}

// Links samples with room and rungs if a person climbs from one to the other by hand. A rung has another rung, or a
// floor, one rung's height above or below it, and room for an upright body before it.
std::vector<std::pair<std::uint32_t, std::uint32_t>> GroundField::climbs(const MeshTree& tree) const {
  const double most = kHighestRung * climb_, least = kLowestRung * climb_;
  const auto near = static_cast<std::int64_t>(std::ceil(radius_ / cell_)) + 1;  // a step ahead, from before a stringer
  const auto for_near = [&](std::uint32_t sample, std::int64_t far, const auto& visit) {
    const std::int64_t x = column_[sample] % columns_, y = column_[sample] / columns_;
    for (std::int64_t ny = std::max<std::int64_t>(0, y - far); ny <= std::min<std::int64_t>(y + far, rows_ - 1); ++ny)
      for (std::int64_t nx = std::max<std::int64_t>(0, x - far); nx <= std::min<std::int64_t>(x + far, columns_ - 1);
           ++nx) {
        const auto other = static_cast<std::uint32_t>(ny * columns_ + nx);
        for (std::uint32_t n = first_[other]; n < first_[other + 1]; ++n)
          if (std::abs(double{z_[n]} - z_[sample]) <= most) visit(n);
      }
  };
  std::vector<std::uint8_t> is_rung(z_.size(), 0);
  parallel::for_all(std::size_t{0}, z_.size(), [&](std::size_t k) {
    const auto s = static_cast<std::uint32_t>(k);
    if (has_room(s)) return;
    bool above = false, below = false;
    for_near(s, near / 2 + 1, [&](std::uint32_t n) {
      const double rise = double{z_[n]} - z_[s];
      above = above || rise >= least, below = below || rise <= -least;
    });
    is_rung[k] = above && below;
  });
  std::vector<std::uint32_t> rungs = narrow_ones(is_rung);
  if (rungs.size() > kMostRungs) return {};
  std::vector<std::uint8_t> climbed(rungs.size(), 0);
  parallel::for_all(std::size_t{0}, rungs.size(), [&](std::size_t k) {
    const glm::dvec2 p = middle(column_[rungs[k]]);
    const double body = 0.7 * radius_;
    for (int d = 0; d < 8 && !climbed[k]; ++d) {
      const glm::dvec3 from = glm::dvec3(p.x, p.y, z_[rungs[k]] + body + 0.1 * height_) + direction(d, 8) * radius_;
      climbed[k] = !tree.within_of_segment(from, from + glm::dvec3{0, 0, 0.75 * height_ - body}, body);
    }
  });
  for (std::size_t k = 0; k < rungs.size(); ++k) is_rung[rungs[k]] = climbed[k];
  std::vector<std::pair<std::uint32_t, std::uint32_t>> links;
  for (std::size_t k = 0; k < rungs.size(); ++k) {
    if (!climbed[k]) continue;
    for_near(rungs[k], 2 * near, [&](std::uint32_t n) {
      if (n == rungs[k] || !(has_room(n) || is_rung[n])) return;
      links.emplace_back(rungs[k], n), links.emplace_back(n, rungs[k]);
    });
  }
  parallel::sort(links.begin(), links.end(), std::less<>{});
  links.erase(std::unique(links.begin(), links.end()), links.end());
  return links;
}

const GroundField::Ways& GroundField::ways_from_reached() {
  if (!ways_) ways_ = find_ways();
  return *ways_;
}

GroundField::Ways GroundField::find_ways() const {
  Ways ways{std::vector<std::uint8_t>(z_.size(), kEfforts), std::vector<std::uint32_t>(z_.size(), kNowhere)};
  std::array<std::vector<std::uint32_t>, kEfforts> open;
  std::vector<std::uint8_t> done(z_.size(), 0);
  const auto across = static_cast<std::int64_t>(std::ceil(radius_ / cell_)) + 1;
  const auto reached = [&](std::uint32_t s) { return has_room(s) && access_[part_[s]] == Access::reached; };
  // Skips samples amid reached ones, from where nothing new begins; most are such.
  parallel::for_all(std::size_t{0}, z_.size(), [&](std::size_t k) {
    const auto s = static_cast<std::uint32_t>(k);
    if (!reached(s)) return;
    ways.effort[s] = walk;
    bool leads_on = false;
    for_neighbours(s, [&](std::uint32_t n) { leads_on = leads_on || !reached(n); });
    for_columns_beside(column_[s], across, [&](std::uint32_t other) {
      for (std::uint32_t n = first_[other]; n < first_[other + 1] && !leads_on; ++n) leads_on = !reached(n);
    });
    done[s] = !leads_on;
  });
  for (const auto& link : climbs_)
    if (reached(link.first)) done[link.first] = 0;
  for (std::uint32_t s = 0; s < z_.size(); ++s)
    if (ways.effort[s] == walk && !done[s]) open[walk].push_back(s);
  for (std::size_t now = 0; now < kEfforts;) {
    if (open[now].empty()) {
      ++now;
      continue;
    }
    const std::uint32_t s = open[now].back();
    open[now].pop_back();
    if (done[s]) continue;
    done[s] = 1;
    const auto go = [&](std::uint32_t n, std::size_t effort) {
      effort = std::max(effort, now);
      if (effort >= ways.effort[n]) return;
      ways.effort[n] = static_cast<std::uint8_t>(effort), ways.from[n] = s;
      open[effort].push_back(n);
    };
    for_neighbours(s, [&](std::uint32_t n) {
      if (has_room(n)) return go(n, walk);
      if (!(taken_[n] & (kBeside | kOverhead))) return go(n, through_door);
      if (!(taken_[n] & kLow)) go(n, stoop);
    });
    for (auto link = std::lower_bound(climbs_.begin(), climbs_.end(), std::pair{s, 0U});
         link != climbs_.end() && link->first == s; ++link)
      go(link->second, climb);
    if (!has_room(s)) continue;
    for_columns_beside(column_[s], across, [&](std::uint32_t other) {
      for (std::uint32_t n = first_[other]; n < first_[other + 1]; ++n) {
        const double step = std::abs(double{z_[n]} - z_[s]);
        if (!has_room(n) || part_[n] == part_[s] || step > kHighestStep * climb_) continue;
        const double share = (step / climb_ - 1) / (kHighestStep - 1);  // between an easy step, 0, and the highest, 1
        constexpr std::size_t kClasses = kEfforts - high_step;
        go(n, share <= 0 ? std::size_t{step_over}
                         : high_step + std::min(kClasses - 1, static_cast<std::size_t>(share * kClasses)));
      }
    });
  }
  return ways;
}

std::vector<std::uint32_t> GroundField::easiest_samples(const Ways& ways) const {
  std::vector<std::uint32_t> easiest(parts_.size(), kNowhere);
  for (std::uint32_t s = 0; s < z_.size(); ++s) {
    if (!has_room(s) || ways.effort[s] == kEfforts) continue;
    std::uint32_t& best = easiest[part_[s]];
    if (best == kNowhere || ways.effort[s] < ways.effort[best]) best = s;
  }
  return easiest;
}

std::vector<std::uint32_t> GroundField::first_closed(const Ways& ways) const {
  std::vector<std::uint32_t> first(parts_.size(), kNowhere);
  const std::vector<std::uint32_t> easiest = easiest_samples(ways);
  for (std::uint32_t i = 0; i < parts_.size(); ++i) {
    first[i] = i;
    if (easiest[i] == kNowhere) continue;
    for (std::uint32_t s = ways.from[easiest[i]]; s != kNowhere; s = ways.from[s])
      if (has_room(s) && access_[part_[s]] != Access::reached && parts_[part_[s]].area(cell_) >= room())
        first[i] = part_[s];
  }
  return first;
}

// Returns true for floor under a sloped roof, bordered by floor on which one can only stoop.
bool GroundField::is_attic(std::uint32_t part) const {
  constexpr double kUnderEaves_m = 0.4;  // of the side of a square as large, for a passage of 0.6 m
  std::vector<std::uint8_t> seen(z_.size(), 0);
  std::vector<std::uint32_t> open(members(part).begin(), members(part).end());
  std::size_t stooped = 0;
  while (!open.empty()) {
    const std::uint32_t s = open.back();
    open.pop_back();
    for_neighbours(s, [&](std::uint32_t n) {
      if (seen[n] || has_room(n) || (taken_[n] & (kLow | kLeaf))) return;
      seen[n] = 1, ++stooped;
      open.push_back(n);
    });
  }
  const double strip = kUnderEaves_m / 0.3 * radius_;
  return static_cast<double>(stooped) * cell_ * cell_ > strip * std::sqrt(parts_[part].area(cell_));
}

bool GroundField::is_above_ceiling(const MeshTree& tree, std::uint32_t part) const {
  if (ceilings_.empty()) return false;
  constexpr std::size_t kMost = 200;
  const auto all = members(part);
  const std::size_t stride = std::max<std::size_t>(1, all.size() / kMost);
  std::size_t looked_at = 0, above = 0;
  for (std::size_t k = 0; k < all.size(); k += stride, ++looked_at) {
    const glm::dvec2 p = middle(column_[all[k]]);
    const auto hit = tree.first({p.x, p.y, z_[all[k]] + 0.25 * climb_}, {0, 0, -1});
    if (!hit) continue;
    const auto after = std::ranges::upper_bound(ceilings_, hit->triangle, {}, &MeshRange::first_triangle);
    above += after != ceilings_.begin() && hit->triangle - after[-1].first_triangle < after[-1].triangle_count;
  }
  return 2 * above > looked_at;
}

// Returns true if a person can turn on the part, as on a platform but not on a rack.
bool GroundField::is_wide(std::uint32_t part) const {
  const auto far = static_cast<std::int64_t>(std::ceil(2.5 * radius_ / cell_));
  for (const std::uint32_t s : members(part)) {
    int sides = 0;
    for_columns_beside(column_[s], far, [&](std::uint32_t other) {
      for (std::uint32_t n = first_[other]; n < first_[other + 1]; ++n)
        if (part_[n] == part && std::abs(double{z_[n]} - z_[s]) <= climb_) {
          ++sides;
          break;
        }
    });
    if (sides == 4) return true;
  }
  return false;
}

std::vector<GroundField::Rim> GroundField::rims_of(std::uint32_t part) const {
  std::vector<Rim> rims;
  const double step = std::max(climb_, 2.2 * std::tan(slope_) * cell_);
  for (const std::uint32_t s : members(part)) {
    const std::int64_t x = column_[s] % columns_, y = column_[s] / columns_;
    for (const auto& [dx, dy] : {std::pair<int, int>{1, 0}, {-1, 0}, {0, 1}, {0, -1}}) {
      bool goes_on = false, bare = true;
      for (std::int64_t far = 1; far <= 2; ++far) {
        const std::int64_t nx = x + dx * far, ny = y + dy * far;
        if (nx < 0 || ny < 0 || nx >= columns_ || ny >= rows_) continue;
        const auto other = static_cast<std::uint32_t>(ny * columns_ + nx);
        for (std::uint32_t n = first_[other]; n < first_[other + 1]; ++n) {
          if (std::abs(double{z_[n]} - z_[s]) > step) continue;
          bare = false, goes_on = goes_on || part_[n] == part;
        }
      }
      if (!goes_on) rims.push_back({s, {double(dx), double(dy), 0}, bare});
    }
  }
  constexpr std::size_t kMost = 2000;
  const std::size_t stride = std::max<std::size_t>(1, rims.size() / kMost);
  std::vector<Rim> some;
  for (std::size_t k = 0; k < rims.size(); k += stride) some.push_back(rims[k]);
  return some;
}

bool GroundField::is_top(const MeshTree& tree, std::uint32_t part) const {
  constexpr double kMostFaces = 0.6;
  const std::vector<Rim> rims = rims_of(part);
  std::atomic<std::size_t> steep = 0;
  parallel::for_all(std::size_t{0}, rims.size(), [&](std::size_t k) {
    const Rim& rim = rims[k];
    const glm::dvec2 p = middle(column_[rim.sample]);
    // Distance beyond a parapet or beside the bare edge; and under eaves.
    const double beyond = rim.bare ? 2 * cell_ : beyond_rim(), under = 3 * radius_;
    const auto met = [&](double above, double from, double to) {
      const glm::dvec3 at{p.x, p.y, z_[rim.sample] + above * height_};
      return tree.between(at + rim.out * from, at + rim.out * to);
    };
    if (!met(0.8, 0, beyond) && met(-0.25, beyond, -under) && met(-0.8, beyond, -under)) ++steep;
  });
  return !rims.empty() && static_cast<double>(steep.load()) > kMostFaces * static_cast<double>(rims.size());
}

// Heights as shares of a person's: rails reach from the knee to the hip, and one looks over them at head height.
constexpr std::array kRailHeights{0.25, 0.4, 0.5, 0.57};
constexpr std::array kHeadHeight{0.8};

bool GroundField::stands_beyond(const MeshTree& tree, const Rim& rim, std::span<const double> heights) const {
  const glm::dvec2 p = middle(column_[rim.sample]);
  return std::ranges::any_of(heights, [&](double share) {
    const glm::dvec3 from{p.x, p.y, z_[rim.sample] + share * height_};
    return tree.between(from, from + rim.out * beyond_rim());
  });
}

std::optional<std::uint32_t> GroundField::column_beyond(const Rim& rim) const {
  const glm::dvec2 p = middle(column_[rim.sample]);
  return column_at(p.x + rim.out.x * beyond_rim(), p.y + rim.out.y * beyond_rim());
}

bool GroundField::is_gallery(const MeshTree& tree, std::uint32_t part) const {
  constexpr double kLeastGuarded = 0.8, kLeastOver = 0.02;
  if (!is_wide(part)) return false;
  const std::vector<Rim> rims = rims_of(part);
  std::atomic<std::size_t> guarded = 0, over = 0;
  parallel::for_all(std::size_t{0}, rims.size(), [&](std::size_t k) {
    const Rim& rim = rims[k];
    if (!stands_beyond(tree, rim, kRailHeights)) return;
    ++guarded;
    if (stands_beyond(tree, rim, kHeadHeight)) return;
    const auto column = column_beyond(rim);
    if (!column) return;
    std::uint32_t below = kNowhere;  // the highest surface below
    for (std::uint32_t n = first_[*column]; n < first_[*column + 1]; ++n)
      if (z_[n] < z_[rim.sample] && (below == kNowhere || z_[n] > z_[below])) below = n;
    if (below != kNowhere && has_room(below) && access_[part_[below]] == Access::reached) ++over;
  });
  const auto all = static_cast<double>(rims.size());
  return static_cast<double>(guarded.load()) > kLeastGuarded * all &&
         static_cast<double>(over.load()) > kLeastOver * all;
}

bool GroundField::is_open_ground(const MeshTree& tree, std::uint32_t number) const {
  const Part& part = parts_[number];
  return part.area(cell_) >= 10 * room() && part.under_the_sky() && !is_top(tree, number);
}

double GroundField::open_ground_area(const MeshTree& tree) const {
  double area = 0;
  for (std::uint32_t i = 0; i < parts_.size(); ++i)
    if (!is_roof(parts_[i]) && is_open_ground(tree, i)) area += parts_[i].area(cell_);
  return area;
}

bool GroundField::is_open_deck(const MeshTree& tree, std::uint32_t part) const {
  constexpr double kMostOpen = 0.5;
  const std::vector<Rim> rims = rims_of(part);
  std::atomic<std::size_t> open = 0;
  parallel::for_all(std::size_t{0}, rims.size(), [&](std::size_t k) {
    const Rim& rim = rims[k];
    if (stands_beyond(tree, rim, kRailHeights) || stands_beyond(tree, rim, kHeadHeight)) return;
    const auto column = column_beyond(rim);
    if (!column) return;
    for (std::uint32_t n = first_[*column]; n < first_[*column + 1]; ++n)
      if (has_room(n) && part_[n] != part && z_[n] < z_[rim.sample] - height_) {
        ++open;
        return;
      }
  });
  return static_cast<double>(open.load()) > kMostOpen * static_cast<double>(rims.size());
}

bool GroundField::has_openings(const MeshTree& tree, std::uint32_t part) const {
  constexpr std::size_t kMost = 400;
  const std::span<const std::uint32_t> samples = members(part);
  // Returns how far one sees, through panes; infinity if out of the model.
  const auto sight = [&](glm::dvec3 from, const glm::dvec3& way) {
    constexpr int kPanes = 8;
    constexpr double kBehind_m = 1e-3;
    double far = 0;
    for (int pane = 0; pane < kPanes; ++pane) {
      const auto hit = tree.first(from, way);
      if (!hit) return std::numeric_limits<double>::infinity();
      far += hit->distance;
      if (hit->triangle < opaque_) break;
      from += way * (hit->distance + kBehind_m), far += kBehind_m;
    }
    return far;
  };
  std::map<std::uint32_t, bool> grounds;  // by part: true if it may be ground or water
  const auto is_ground = [&](std::uint32_t number) {
    const auto [at, is_new] = grounds.try_emplace(number, false);
    if (is_new) at->second = is_open_ground(tree, number);
    return at->second;
  };
  // A view out of the model beneath ground or water is no opening.
  const auto leaves_beneath_ground = [&](const glm::dvec3& from, const glm::dvec3& way) {
    double end = 0;  // end of the drawn ground
    for (double at = 0; const auto column = column_at(from.x + way.x * at, from.y + way.y * at); at += cell_)
      if (first_[*column] < first_[*column + 1]) end = at;
    bool beneath = false;
    for (double at = std::max(0.0, end - 3.3 * radius_); at <= end; at += cell_) {  // a metre; water is drawn with gaps
      const auto column = column_at(from.x + way.x * at, from.y + way.y * at);
      if (!column) break;
      beneath = beneath || (wet_[*column] && from.z < top_[*column]);
      for (std::uint32_t n = first_[*column]; n < first_[*column + 1]; ++n) {
        if (!has_room(n)) continue;
        if (z_[n] < from.z && access_[part_[n]] == Access::reached) return false;
        beneath = beneath || (z_[n] > from.z && is_ground(part_[n]));
      }
    }
    return beneath;
  };
  const std::size_t stride = std::max<std::size_t>(1, samples.size() / kMost);
  const double far = cell_ * (columns_ + rows_), along = 4 * cell_;
  for (std::size_t k = 0; k < samples.size(); k += stride) {
    const glm::dvec2 p = middle(column_[samples[k]]);
    for (int d = 0; d < kDirections; ++d) {
      const glm::dvec3 from{p.x, p.y, z_[samples[k]] + 0.8 * height_}, way = direction(d);
      const double seen = sight(from, way);
      if (seen > far && !leaves_beneath_ground(from, way)) return true;
      for (double at = along; at < seen; at += along) {
        const glm::dvec3 q = from + way * at;
        const auto column = column_at(q.x, q.y);
        if (!column) break;
        for (std::uint32_t n = first_[*column]; n < first_[*column + 1]; ++n)
          if (has_room(n) && access_[part_[n]] == Access::reached && z_[n] < q.z && z_[n] > q.z - height_) return true;
      }
    }
  }
  return false;
}

// Returns true for ground under the sky that is large enough to be entered, sealed parts as large as a room, and
// covered ones as large as a hall.
bool GroundField::may_be_told(std::uint32_t part) const {
  const Part& p = parts_[part];
  const double area = p.area(cell_), hall = 10 * room();
  if (access_[part] == Access::reached) return false;
  if (p.under_the_sky()) return area >= kEnteredRooms * room();
  return area >= (access_[part] == Access::sealed ? 3 * room() : hall);
}

GroundField::ClosedPart GroundField::closed_part(const MeshTree& tree, const Ways& ways, std::uint32_t number) const {
  const Part& part = parts_[number];
  ClosedPart closed{.area_m2 = part.area(cell_), .middle = middle_of(number)};
  std::uint32_t at = kNowhere;
  for (const std::uint32_t s : members(number))
    if (at == kNowhere || ways.effort[s] < ways.effort[at]) at = s;
  const std::uint8_t effort = ways.effort[at];
  const bool sky = part.under_the_sky(), above = 2 * part.above_others > part.samples;
  if (effort == through_door) closed.bar = Bar::door;
  if (effort == stoop) closed.bar = Bar::headroom, closed.height_m = height_;
  if (effort == climb) closed.bar = Bar::climb;
  const bool by_step = effort >= high_step && effort < kEfforts;
  if (by_step || effort == step_over) closed.bar = Bar::step;
  for (std::uint32_t s = at, before = kNowhere; s != kNowhere && effort != kEfforts; before = s, s = ways.from[s]) {
    if (!has_room(s) && (taken_[s] & kLeaf) && !(taken_[s] & (kBeside | kOverhead))) {
      const auto mesh = std::lower_bound(leaves_.begin(), leaves_.end(), std::pair{s, 0U});
      if (mesh != leaves_.end() && mesh->first == s &&
          std::ranges::find(closed.doors, mesh->second) == closed.doors.end())
        closed.doors.insert(closed.doors.begin(), mesh->second);
    }
    if (effort == stoop && ways.effort[s] == stoop && !has_room(s)) {
      const glm::dvec2 p = middle(column_[s]);
      const double skin = 0.25 * climb_;
      if (const auto over = tree.first({p.x, p.y, z_[s] + skin}, {0, 0, 1}))
        closed.height_m = std::min(closed.height_m, over->distance + skin);
    }
    if (before != kNowhere && (by_step || effort == climb))
      closed.height_m = std::max(closed.height_m, std::abs(double{z_[before]} - z_[s]));
  }
  if (sky) {
    const bool way = effort <= climb, canopy = 2 * part.above_surfaces > part.samples;  // as over a stand's seats
    closed.kind = !is_wide(number)                             ? ClosedKind::top
                  : !above && !canopy && !is_top(tree, number) ? ClosedKind::ground
                  : way                                        ? ClosedKind::room
                                                               : ClosedKind::top;
    return closed;
  }
  if (by_step || effort == climb) {
    // People also climb onto goods and machines, so only a wide part is a floor, and a high one needs a rail.
    if (!is_wide(number) || (is_top(tree, number) && !is_gallery(tree, number))) closed.kind = ClosedKind::top;
    if (by_step && is_attic(number)) closed.kind = ClosedKind::attic;
  }
  if (effort != kEfforts) return closed;
  if ((access_[number] == Access::unreachable && !above) || is_top(tree, number) || is_open_deck(tree, number)) {
    closed.kind = ClosedKind::top;
    return closed;
  }
  const glm::dvec3 inside = closed.middle + glm::dvec3{0, 0, 0.5 * height_};
  if (tree.inside_solid(inside) || !(has_openings(tree, number) || is_gallery(tree, number)))
    closed.kind = ClosedKind::hollow;
  else if (is_attic(number) || is_above_ceiling(tree, number))
    closed.kind = ClosedKind::attic;
  return closed;
}

void GroundField::enter_closed(const MeshTree& tree) {
  const double enough = std::min(kEnteredShare * reached_area(), kEnteredRooms * room());
  while (enter_next_closed(tree, enough)) {
  }
  std::ranges::stable_sort(entered_, std::ranges::greater{}, &ClosedPart::area_m2);
}

bool GroundField::enter_next_closed(const MeshTree& tree, double enough) {
  std::vector<std::uint32_t> told;
  double all = 0;
  for (std::uint32_t i = 0; i < parts_.size(); ++i)
    if (may_be_told(i)) told.push_back(i), all += parts_[i].area(cell_);
  if (all < enough) return false;
  const Ways& ways = ways_from_reached();
  const std::vector<std::uint32_t> first = first_closed(ways);
  std::map<std::uint32_t, std::vector<std::pair<std::uint32_t, ClosedPart>>> together;  // by the first part entered
  for (const std::uint32_t i : told) {
    ClosedPart part = closed_part(tree, ways, i);
    if (part.kind == ClosedKind::room || part.kind == ClosedKind::ground)
      together[first[i]].emplace_back(i, std::move(part));
  }
  bool any = false;
  for (auto& [number, parts] : together) {
    double area = 0;
    for (const auto& [i, part] : parts) area += part.area_m2;
    if (area < enough) continue;
    any = true;
    for (auto& [i, part] : parts) {
      access_[i] = Access::reached;
      entered_.push_back(std::move(part));
    }
  }
  if (any) ways_.reset();
  return any;
}

std::vector<GroundField::ClosedPart> GroundField::not_entered(const MeshTree& tree) {
  std::vector<ClosedPart> closed;
  std::vector<std::uint32_t> told;
  for (std::uint32_t i = 0; i < parts_.size(); ++i)
    if (may_be_told(i)) told.push_back(i);
  closed = low_floors(tree);
  if (told.empty()) return closed;
  const Ways& ways = ways_from_reached();
  const double reached = reached_area();
  for (const std::uint32_t i : told) {
    ClosedPart part = closed_part(tree, ways, i);
    const bool sky = parts_[i].under_the_sky();
    // Terrain drawn as a block ends like the top of an object; it is reported if larger than all reached ground.
    const bool block = !is_roof(parts_[i]) && part.area_m2 > reached;
    if (!sky || part.kind != ClosedKind::top || block) closed.push_back(std::move(part));
  }
  std::ranges::stable_sort(closed, std::ranges::greater{}, &ClosedPart::area_m2);
  return closed;
}

std::vector<GroundField::ClosedPart> GroundField::low_floors(const MeshTree& tree) {
  const double enough = std::min(kEnteredShare * reached_area(), kEnteredRooms * room());
  const auto stoops = [&](std::uint32_t s) { return !has_room(s) && !(taken_[s] & (kLow | kLeaf)); };
  std::size_t below = 0;
  for (std::uint32_t s = 0; s < z_.size(); ++s) below += stoops(s) && (taken_[s] & kOverhead);
  if (static_cast<double>(below) * cell_ * cell_ < enough) return {};
  const Ways& ways = ways_from_reached();
  // Between two beams a head may have room.
  const auto is_low = [&](std::uint32_t s) {
    if (ways.effort[s] != stoop) return false;
    return stoops(s) || (has_room(s) && parts_[part_[s]].area(cell_) < room());
  };
  constexpr double kMostOpen = 0.35;  // share of its border: a room's or open ground's rim, under a slope or a tree
  constexpr std::size_t kMeasured = 400;
  const auto far = static_cast<std::int64_t>(std::ceil(2.5 * radius_ / cell_));
  std::vector<ClosedPart> floors;
  std::vector<std::uint8_t> seen(z_.size(), 0);
  std::vector<std::uint32_t> floor;
  for (std::uint32_t seed = 0; seed < z_.size(); ++seed) {
    if (seen[seed] || !is_low(seed)) continue;
    floor.assign(1, seed), seen[seed] = 1;
    std::size_t border = 0, open = 0;
    bool wide = false;
    for (std::size_t k = 0; k < floor.size(); ++k) {
      const std::uint32_t s = floor[k];
      for_neighbours(s, [&](std::uint32_t n) {
        if (!is_low(n)) return void(open += has_room(n));
        if (seen[n]) return;
        seen[n] = 1;
        floor.push_back(n);
      });
      const auto sides = [&](std::int64_t columns) {
        int found = 0;
        for_columns_beside(column_[s], columns, [&](std::uint32_t other) {
          for (std::uint32_t n = first_[other]; n < first_[other + 1]; ++n)
            if (is_low(n) && std::abs(double{z_[n]} - z_[s]) <= climb_) return void(++found);
        });
        return found;
      };
      const bool amid = sides(1) == 4;
      border += !amid;
      wide = wide || (amid && sides(far) == 4);
    }
    const double area = static_cast<double>(floor.size()) * cell_ * cell_;
    if (!wide || area < enough || static_cast<double>(open) > kMostOpen * 3 * static_cast<double>(border)) continue;
    glm::dvec3 mean(0);
    for (const std::uint32_t s : floor)
      mean += glm::dvec3(middle(column_[s]), z_[s]) / static_cast<double>(floor.size());
    const auto place = [&](std::uint32_t s) { return glm::dvec3(middle(column_[s]), z_[s]); };
    const std::uint32_t at =
        *std::ranges::min_element(floor, {}, [&](std::uint32_t s) { return dot(place(s) - mean, place(s) - mean); });
    ClosedPart told{
        .area_m2 = area, .middle = place(at), .kind = ClosedKind::low, .bar = Bar::headroom, .height_m = height_};
    std::vector<double> headrooms{height_};
    for (std::size_t k = 0; k < floor.size(); k += floor.size() / kMeasured + 1)
      if (const auto over = tree.first(place(floor[k]) + glm::dvec3{0, 0, climb_}, {0, 0, 1}))
        headrooms.push_back(over->distance + climb_);
    const auto tenth = headrooms.begin() + static_cast<std::ptrdiff_t>(headrooms.size() / 10);  // not counting stairs
    std::ranges::nth_element(headrooms, tenth);
    told.height_m = std::min(height_, *tenth);
    floors.push_back(std::move(told));
  }
  return floors;
}

std::vector<GroundField::Patch> GroundField::thin_floors() const {
  std::vector<Patch> patches;
  const auto level = static_cast<float>(0.04 * climb_);
  // Narrow triangles that fill all columns around make a floor of slivers, not a grating.
  constexpr double kMostFilled = 0.7;
  const auto is_grating = [&](std::uint32_t sample) {
    constexpr std::int64_t kAround = 4;
    const std::int64_t x = column_[sample] % columns_, y = column_[sample] / columns_;
    int all = 0, filled = 0;
    for (std::int64_t ny = std::max<std::int64_t>(0, y - kAround); ny <= std::min<std::int64_t>(y + kAround, rows_ - 1);
         ++ny)
      for (std::int64_t nx = std::max<std::int64_t>(0, x - kAround);
           nx <= std::min<std::int64_t>(x + kAround, columns_ - 1); ++nx) {
        const auto other = static_cast<std::uint32_t>(ny * columns_ + nx);
        for (std::uint32_t n = first_[other]; n < first_[other + 1]; ++n)
          if ((taken_[n] & kThin) && std::abs(z_[n] - z_[sample]) <= level)
            ++all, filled += (taken_[n] & kCovered) != 0;
      }
    return filled <= kMostFilled * all;
  };
  const auto wanted = [&](std::uint32_t s) {
    return (taken_[s] & kThin) && has_room(s) && access_[part_[s]] == Access::reached && is_grating(s);
  };
  // Runs of samples in a row, merged with equal runs of the following rows.
  struct Run {
    std::uint32_t from, to, row;
    float z;
    std::size_t patch;
  };
  std::vector<Run> before, now;
  for (std::uint32_t row = 0; row < rows_; ++row) {
    now.clear();
    std::vector<Run> open, next;
    for (std::uint32_t x = 0; x < columns_; ++x) {
      next.clear();
      const std::uint32_t column = row * columns_ + x;
      for (std::uint32_t s = first_[column]; s < first_[column + 1]; ++s) {
        if (!wanted(s)) continue;
        const auto same = std::ranges::find_if(open, [&](const Run& run) { return std::abs(run.z - z_[s]) <= level; });
        if (same == open.end()) {
          next.push_back({x, x + 1, row, z_[s], 0});
        } else {
          next.push_back(*same), next.back().to = x + 1;
          open.erase(same);
        }
      }
      now.insert(now.end(), open.begin(), open.end());
      std::swap(open, next);
    }
    now.insert(now.end(), open.begin(), open.end());
    for (Run& run : now) {
      const auto same = std::ranges::find_if(before, [&](const Run& other) {
        return other.from == run.from && other.to == run.to && std::abs(other.z - run.z) <= level;
      });
      const double y = corner_.y + row * cell_;
      if (same != before.end()) {
        run.z = same->z, run.patch = same->patch;
        patches[run.patch].high.y = y + cell_;
        continue;
      }
      run.patch = patches.size();
      patches.push_back({{corner_.x + run.from * cell_, y, run.z}, {corner_.x + run.to * cell_, y + cell_}});
    }
    std::swap(before, now);
  }
  return patches;
}

}  // namespace vantage
