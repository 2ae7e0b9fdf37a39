// SPDX-License-Identifier: Apache-2.0
// Shortest paths by Dijkstra: A Note on Two Problems in Connexion with Graphs, 1959.
#include "evaluate/ways.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <queue>
#include <utility>

#include "core/graph.hpp"
#include "core/parallel.hpp"
#include "core/person.hpp"

namespace vantage {
namespace {

constexpr double kMostPlaces = 20'000, kFinest_m = 0.25;
// Places in one column that are further apart are on different levels.
constexpr double kSameLevel_m = 0.4;
// Places of two cells coincide where ground touches the cells' common side. Distances must grow from place to place,
// so that a path can go back along them.
constexpr double kLeastLink_m = 1e-3;
constexpr double kGap_m = 0.75;  // ground may be missing in a passage for so much
// Cached stations: several of the largest networks.
constexpr std::size_t kMostKnown = 2'048;

std::uint64_t cell_key(std::int64_t x, std::int64_t y) {
  return (static_cast<std::uint64_t>(static_cast<std::uint32_t>(x)) << 32) | static_cast<std::uint32_t>(y);
}

double plan_distance(const Vec3& a, const Vec3& b) { return std::hypot(a.x - b.x, a.y - b.y); }

// True if a person can step or climb from one place to a neighbouring one.
bool climbs(const Vec3& a, const Vec3& b) {
  return std::abs(a.z - b.z) <= person::kWayStep_m + person::kWaySlope * plan_distance(a, b);
}

double plan_area(const Vec3& a, const Vec3& b, const Vec3& c) {
  return std::abs((b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x)) / 2;
}

// The point of a triangle nearest to a point of its plan.
Vec3 nearest_in_plan(const std::array<Vec3, 3>& t, double x, double y) {
  const double area = (t[1].x - t[0].x) * (t[2].y - t[0].y) - (t[1].y - t[0].y) * (t[2].x - t[0].x);
  if (area != 0) {
    const double b = ((x - t[0].x) * (t[2].y - t[0].y) - (y - t[0].y) * (t[2].x - t[0].x)) / area;
    const double c = ((t[1].x - t[0].x) * (y - t[0].y) - (t[1].y - t[0].y) * (x - t[0].x)) / area;
    if (b >= 0 && c >= 0 && b + c <= 1) return {x, y, t[0].z + b * (t[1].z - t[0].z) + c * (t[2].z - t[0].z)};
  }
  Vec3 best;
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k < 3; ++k) {
    const Vec3 &from = t[k], edge = t[(k + 1) % 3] - from;
    const double length2 = edge.x * edge.x + edge.y * edge.y;
    const double share =
        length2 > 0 ? std::clamp(((x - from.x) * edge.x + (y - from.y) * edge.y) / length2, 0.0, 1.0) : 0;
    const Vec3 point = from + edge * share;
    if (const double away = std::hypot(point.x - x, point.y - y); away < least) least = away, best = point;
  }
  return best;
}

// Douglas and Peucker (Algorithms for the Reduction of the Number of Points, 1973), to half a step between places,
// which takes out the corners that only the grid makes. A corner stays if there is no straight way past it.
std::vector<Vec3> without_straight(const std::vector<Vec3>& points, double spacing,
                                   const std::function<bool(const Vec3&, const Vec3&)>& sees) {
  std::vector<bool> kept(points.size(), false);
  kept.front() = kept.back() = true;
  std::vector<std::pair<std::size_t, std::size_t>> open{{0, points.size() - 1}};
  while (!open.empty()) {
    const auto [first, last] = open.back();
    open.pop_back();
    const Vec3 line = points[last] - points[first];
    double farthest = -1;
    std::size_t corner = 0;
    for (std::size_t k = first + 1; k < last; ++k) {
      const Vec3 away = points[k] - points[first];
      const double share = dot(line, line) > 0 ? std::clamp(dot(away, line) / dot(line, line), 0.0, 1.0) : 0;
      const Vec3 off = away - line * share;
      if (const double metres = std::sqrt(dot(off, off)); metres > farthest) farthest = metres, corner = k;
    }
    if (corner == 0 || (farthest <= spacing / 2 && sees(points[first], points[last]))) continue;
    kept[corner] = true;
    open.emplace_back(first, corner), open.emplace_back(corner, last);
  }
  std::vector<Vec3> corners;
  for (std::size_t k = 0; k < points.size(); ++k)
    if (kept[k]) corners.push_back(points[k]);
  return corners;
}

}  // namespace

Ways::Ways(const SearchMesh& ground, std::function<bool(const Vec3&, const Vec3&)> sees) : sees_(std::move(sees)) {
  const auto corners = [&](const std::array<std::uint32_t, 3>& t) {
    return std::array<Vec3, 3>{ground.positions[t[0]], ground.positions[t[1]], ground.positions[t[2]]};
  };
  double area = 0;
  for (const auto& t : ground.triangles) {
    const auto [a, b, c] = corners(t);
    area += plan_area(a, b, c);
  }
  spacing_ = std::max(kFinest_m, std::sqrt(area / kMostPlaces));

  // Each cell of the grid that ground lies in has a place, the ground's nearest point to its middle: ground in a
  // doorway is narrower than a cell.
  std::vector<std::pair<std::int64_t, std::int64_t>> cell_of;
  std::vector<double> off;  // distance of each place from the middle of its cell
  for (const auto& t : ground.triangles) {
    const auto triangle = corners(t);
    const auto [low_x, high_x] = std::minmax({triangle[0].x, triangle[1].x, triangle[2].x});
    const auto [low_y, high_y] = std::minmax({triangle[0].y, triangle[1].y, triangle[2].y});
    const auto cell = [&](double v) { return static_cast<std::int64_t>(std::lround(v / spacing_)); };
    for (std::int64_t i = cell(low_x); i <= cell(high_x); ++i) {
      for (std::int64_t j = cell(low_y); j <= cell(high_y); ++j) {
        const double x = static_cast<double>(i) * spacing_, y = static_cast<double>(j) * spacing_;
        const Vec3 point = nearest_in_plan(triangle, x, y);
        if (std::abs(point.x - x) > spacing_ / 2 || std::abs(point.y - y) > spacing_ / 2) continue;
        const double away = std::hypot(point.x - x, point.y - y);
        auto& levels = cells_[cell_key(i, j)];
        const auto known = std::ranges::find_if(
            levels, [&](std::uint32_t place) { return std::abs(places_[place].z - point.z) < kSameLevel_m; });
        if (known != levels.end()) {
          if (away < off[*known]) places_[*known] = point, off[*known] = away;
          continue;
        }
        levels.push_back(static_cast<std::uint32_t>(places_.size()));
        places_.push_back(point);
        cell_of.emplace_back(i, j);
        off.push_back(away);
      }
    }
  }

  const auto step_to = [&](std::uint32_t from, std::int64_t di, std::int64_t dj) -> std::optional<std::uint32_t> {
    const auto [i, j] = cell_of[from];
    const auto found = cells_.find(cell_key(i + di, j + dj));
    if (found == cells_.end()) return std::nullopt;
    std::optional<std::uint32_t> best;
    for (const std::uint32_t to : found->second) {
      if (!climbs(places_[from], places_[to])) continue;
      const double rise = std::abs(places_[to].z - places_[from].z);
      if (!best || rise < std::abs(places_[*best].z - places_[from].z)) best = to;
    }
    return best;
  };
  constexpr std::array<std::pair<int, int>, 4> kHalfOfSides{{{1, 0}, {0, 1}, {1, 1}, {1, -1}}};
  std::vector<std::array<std::optional<std::uint32_t>, 4>> ahead(places_.size());
  parallel::for_all(std::size_t{0}, places_.size(), [&](std::size_t k) {
    const auto from = static_cast<std::uint32_t>(k);
    for (std::size_t d = 0; d < kHalfOfSides.size(); ++d) {
      const auto to = step_to(from, kHalfOfSides[d].first, kHalfOfSides[d].second);
      if (to && sees_(places_[from], places_[*to])) ahead[k][d] = to;
    }
  });
  links_.resize(places_.size());
  const auto link = [&](std::uint32_t a, std::uint32_t b) {
    const Vec3 way = places_[b] - places_[a];
    const auto metres = static_cast<float>(std::max(std::sqrt(dot(way, way)), kLeastLink_m));
    links_[a].push_back({b, metres}), links_[b].push_back({a, metres});
  };
  const auto linked = [&](std::uint32_t a, std::uint32_t b) {
    return std::ranges::any_of(links_[a], [&](const Link& l) { return l.to == b; });
  };
  for (std::uint32_t k = 0; k < places_.size(); ++k)
    for (const auto& to : ahead[k])
      if (to && !linked(k, *to)) link(k, *to);
  // Paths in eight directions are up to 8 % too long; with knight's moves, if both ways round are free, 3 %.
  std::vector<std::pair<std::uint32_t, std::uint32_t>> knights;
  for (std::uint32_t k = 0; k < places_.size(); ++k) {
    for (const auto& [di, dj] : std::array<std::pair<int, int>, 4>{{{2, 1}, {1, 2}, {2, -1}, {1, -2}}}) {
      const int si = di == 2 ? 1 : 0, sj = di == 2 ? 0 : (dj > 0 ? 1 : -1);
      const auto straight = step_to(k, si, sj), slanted = step_to(k, 1, dj > 0 ? 1 : -1);
      if (!straight || !slanted || !linked(k, *straight) || !linked(k, *slanted)) continue;
      const auto to = step_to(*straight, di - si, dj - sj);
      if (to && linked(*straight, *to) && linked(*slanted, *to) && sees_(places_[k], places_[*to]))
        knights.emplace_back(k, *to);
    }
  }
  for (const auto& [a, b] : knights)
    if (!linked(a, b)) link(a, b);
  for (const auto& [a, b] : gaps(cell_of)) link(a, b);

  part_ = components_along(places_.size(), [&](std::size_t k, const auto& visit) {
            for (const Link& l : links_[k]) visit(l.to);
          }).of;
}

// Pairs of places across a short gap in the ground: a doorway too narrow to stand in is walked through.
std::vector<std::pair<std::uint32_t, std::uint32_t>> Ways::gaps(
    const std::vector<std::pair<std::int64_t, std::int64_t>>& cell_of) const {
  const auto reach = static_cast<std::int64_t>(std::floor(kGap_m / spacing_));
  std::vector<std::vector<std::uint32_t>> across(places_.size());
  parallel::for_all(std::size_t{0}, places_.size(), [&](std::size_t k) {
    constexpr std::size_t kAround = 8;  // neighbours of a place in the middle of the ground
    if (reach < 2 || links_[k].size() >= kAround) return;
    const auto from = static_cast<std::uint32_t>(k);
    // Places that are near on foot, too.
    std::vector<std::uint32_t> near{from};
    std::size_t ring = 0;
    for (std::int64_t steps = 0; steps <= reach; ++steps)
      for (const std::size_t end = near.size(); ring < end; ++ring)
        for (const Link& l : links_[near[ring]])
          if (std::ranges::find(near, l.to) == near.end()) near.push_back(l.to);
    std::ranges::sort(near);
    const auto [i, j] = cell_of[k];
    for (std::int64_t di = -reach; di <= reach; ++di)
      for (std::int64_t dj = -reach; dj <= reach; ++dj) {
        const auto found = cells_.find(cell_key(i + di, j + dj));
        if (found == cells_.end()) continue;
        for (const std::uint32_t to : found->second) {
          if (to <= from || std::ranges::binary_search(near, to) || !climbs(places_[from], places_[to])) continue;
          if (plan_distance(places_[from], places_[to]) <= kGap_m && sees_(places_[from], places_[to]))
            across[k].push_back(to);
        }
      }
  });
  std::vector<std::pair<std::uint32_t, std::uint32_t>> pairs;
  for (std::uint32_t k = 0; k < across.size(); ++k)
    for (const std::uint32_t to : across[k]) pairs.emplace_back(k, to);
  return pairs;
}

std::optional<std::uint32_t> Ways::nearest(const Vec3& ground) const {
  const auto i = static_cast<std::int64_t>(std::lround(ground.x / spacing_)),
             j = static_cast<std::int64_t>(std::lround(ground.y / spacing_));
  constexpr std::int64_t kReach = 3;
  std::vector<std::pair<double, std::uint32_t>> near;
  for (std::int64_t di = -kReach; di <= kReach; ++di) {
    for (std::int64_t dj = -kReach; dj <= kReach; ++dj) {
      const auto found = cells_.find(cell_key(i + di, j + dj));
      if (found == cells_.end()) continue;
      for (const std::uint32_t place : found->second) {
        const Vec3 away = places_[place] - ground;
        if (std::abs(away.z) > person::kWayStep_m + person::kWaySlope * spacing_ * 2 * kReach) continue;
        // Another level counts as further than it looks.
        near.emplace_back(std::hypot(away.x, away.y) + 4 * std::abs(away.z), place);
      }
    }
  }
  if (near.empty()) return std::nullopt;
  std::ranges::sort(near);
  // Not one behind a wall, if there is another.
  const auto seen = std::ranges::find_if(near, [&](const auto& one) { return sees_(ground, places_[one.second]); });
  return (seen == near.end() ? near.front() : *seen).second;
}

std::vector<float> Ways::distances_within(std::uint32_t place, double most_m) const {
  std::vector<float> far(places_.size(), std::numeric_limits<float>::infinity());
  using Entry = std::pair<float, std::uint32_t>;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> open;
  far[place] = 0;
  open.emplace(0.0F, place);
  while (!open.empty()) {
    const auto [metres, at] = open.top();
    open.pop();
    if (metres > far[at]) continue;
    for (const Link& link : links_[at]) {
      if (const float sum = metres + link.metres; sum < far[link.to] && static_cast<double>(sum) <= most_m)
        far[link.to] = sum, open.emplace(sum, link.to);
    }
  }
  return far;
}

std::shared_ptr<const std::vector<float>> Ways::distances_from(std::uint32_t place) const {
  {
    const std::scoped_lock lock(mutex_);
    if (const auto found = known_.find(place); found != known_.end()) return found->second;
  }
  auto found =
      std::make_shared<const std::vector<float>>(distances_within(place, std::numeric_limits<double>::infinity()));
  const std::scoped_lock lock(mutex_);
  if (known_.size() >= kMostKnown) known_.clear();
  known_[place] = found;
  return found;
}

std::optional<double> Ways::between(const Vec3& from, const Vec3& to) const {
  return between(from, to, nearest(from), nearest(to), [this](std::uint32_t place) { return distances_from(place); });
}

std::vector<std::vector<std::optional<double>>> Ways::between_all(std::span<const Vec3> points) const {
  std::vector<std::optional<std::uint32_t>> places(points.size());
  parallel::for_all(std::size_t{0}, points.size(), [&](std::size_t k) { places[k] = nearest(points[k]); });
  // Each place of the graph is a source once, before the pairs ask for it.
  std::vector<std::uint32_t> sources;
  for (const auto& place : places)
    if (place) sources.push_back(*place);
  std::ranges::sort(sources);
  sources.erase(std::ranges::unique(sources).begin(), sources.end());
  // Kept here: a thousand stations may be more than the cache holds.
  std::vector<std::shared_ptr<const std::vector<float>>> far(sources.size());
  parallel::for_all(std::size_t{0}, sources.size(), [&](std::size_t k) { far[k] = distances_from(sources[k]); });
  const auto from_place = [&](std::uint32_t place) {
    return far[static_cast<std::size_t>(std::ranges::lower_bound(sources, place) - sources.begin())];
  };
  std::vector<std::vector<std::optional<double>>> metres(points.size());
  parallel::for_all(std::size_t{0}, points.size(), [&](std::size_t i) {
    metres[i].resize(points.size());
    for (std::size_t j = i + 1; j < points.size(); ++j)
      metres[i][j] = between(points[i], points[j], places[i], places[j], from_place);
  });
  return metres;
}

std::vector<std::uint8_t> Ways::longer(std::span<const Vec3> points, std::span<const OnSite::Way> than) const {
  std::vector<std::uint8_t> asked(points.size(), 0), found(than.size(), 0);
  for (const OnSite::Way& one : than) asked[one.a] = asked[one.b] = 1;
  std::vector<std::optional<std::uint32_t>> places(points.size());
  parallel::for_all(std::size_t{0}, points.size(), [&](std::size_t k) {
    if (asked[k] != 0) places[k] = nearest(points[k]);
  });
  // Those with one source of `between` follow each other.
  std::vector<std::pair<std::uint32_t, std::size_t>> order;
  for (std::size_t k = 0; k < than.size(); ++k)
    if (const auto a = places[than[k].a], b = places[than[k].b]; a && b && part_[*a] == part_[*b])
      order.emplace_back(std::min(*a, *b), k);
  std::ranges::sort(order);
  std::vector<std::size_t> firsts;
  for (std::size_t at = 0; at < order.size(); ++at)
    if (at == 0 || order[at].first != order[at - 1].first) firsts.push_back(at);
  firsts.push_back(order.size());
  parallel::for_all(std::size_t{0}, firsts.size() - 1, [&](std::size_t group) {
    const auto same = std::span(order).subspan(firsts[group], firsts[group + 1] - firsts[group]);
    double most_m = 0;
    for (const auto& [source, k] : same) most_m = std::max(most_m, than[k].metres);
    const auto far = std::make_shared<const std::vector<float>>(distances_within(same.front().first, most_m));
    for (const auto& [source, k] : same) {
      const auto& [a, b, limit_m] = than[k];
      const auto way = between(points[a], points[b], places[a], places[b], [&](std::uint32_t) { return far; });
      found[k] = !way || *way > limit_m;
    }
  });
  return found;
}

std::optional<double> Ways::between(const Vec3& from, const Vec3& to, std::optional<std::uint32_t> a,
                                    std::optional<std::uint32_t> b, const DistancesFrom& distances_from) const {
  if (!a || !b) return std::nullopt;
  const auto length = [](const Vec3& v) { return std::sqrt(dot(v, v)); };
  if (*a == *b) return length(to - from);
  // From the place with the smaller number, so that both directions have the same length to the last bit.
  const double metres = static_cast<double>((*distances_from(std::min(*a, *b)))[std::max(*a, *b)]);
  if (!std::isfinite(metres)) return std::nullopt;
  return length(places_[*a] - from) + metres + length(to - places_[*b]);
}

std::vector<Vec3> Ways::path(const Vec3& from, const Vec3& to) const {
  const auto a = nearest(from), b = nearest(to);
  std::vector<Vec3> points{from};
  if (a && b && *a != *b) {
    // Downhill from the place with the larger number, as `between` measures.
    const std::uint32_t source = std::min(*a, *b);
    const auto far = distances_from(source);
    std::uint32_t at = std::max(*a, *b);
    if (std::isfinite((*far)[at])) {
      std::vector<Vec3> steps{places_[at]};
      while (at != source) {
        const auto through = [&](const Link& l) {
          return (*far)[l.to] < (*far)[at] ? (*far)[l.to] + l.metres : std::numeric_limits<float>::infinity();
        };
        const auto next = std::ranges::min_element(links_[at], {}, through);
        if (!std::isfinite(through(*next))) break;  // so far away that float has no millimetres
        at = next->to;
        steps.push_back(places_[at]);
      }
      if (source == *a) std::ranges::reverse(steps);
      points.insert(points.end(), steps.begin(), steps.end());
    }
  }
  points.push_back(to);
  return without_straight(points, spacing_, sees_);
}

}  // namespace vantage
