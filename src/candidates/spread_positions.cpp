// SPDX-License-Identifier: Apache-2.0
// The pool: evenly spread points of the unit square (Roberts: The Unreasonable Effectiveness of Quasirandom Sequences,
// 2018), mapped to the triangles by area. The order: farthest point first (Gonzalez: Clustering to Minimize the Maximum
// Intercluster Distance, 1985), for every n within a factor of two of the densest cover by n points.
#include "candidates/spread_positions.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

#include "core/parallel.hpp"
#include "core/plastic_number.hpp"

namespace vantage {
namespace {

constexpr std::size_t kPoolPerPosition = 4;
constexpr std::size_t kTriesPerPosition = 48;  // for sites with mostly forbidden ground
constexpr std::size_t kTriesAtOnce = 4096;
constexpr double kStepBack_m = 1.5;  // from a drop

double fraction(double x) { return x - std::floor(x); }

class GroundByArea {
 public:
  explicit GroundByArea(const SearchMesh& mesh) : mesh_(mesh) {
    double sum = 0;
    for (const auto& t : mesh.triangles) {
      const Vec3& a = mesh.positions[t[0]];
      const Vec3 normal = cross(mesh.positions[t[1]] - a, mesh.positions[t[2]] - a);
      below_.push_back(sum);
      sum += 0.5 * std::sqrt(dot(normal, normal));
    }
    below_.push_back(sum);
  }
  double area() const { return below_.back(); }

  // (u, v) of a point of the unit square: the triangles lie side by side along s, each as wide as its area.
  Uv at(double s, double t) const {
    const double along = s * area();
    const auto next = std::upper_bound(below_.begin() + 1, below_.end() - 1, along);
    const auto k = static_cast<std::size_t>(next - below_.begin()) - 1;
    const double root = std::sqrt(std::clamp((along - below_[k]) / (below_[k + 1] - below_[k]), 0.0, 1.0));
    const double a = 1 - root, b = root * (1 - t), c = root * t;
    const auto& corner = mesh_.triangles[k];
    const Uv &p = mesh_.uvs[corner[0]], &q = mesh_.uvs[corner[1]], &r = mesh_.uvs[corner[2]];
    return {a * p.u + b * q.u + c * r.u, a * p.v + b * q.v + c * r.v};
  }

 private:
  const SearchMesh& mesh_;
  std::vector<double> below_;  // area of all triangles before each, and of all together
};

std::vector<PlacedStation> allowed_positions(const PlacementOracle& site, const SearchMesh& mesh, double height_m,
                                             std::size_t wanted, std::size_t tries) {
  const GroundByArea ground(mesh);
  std::vector<PlacedStation> allowed;
  if (!(ground.area() > 0)) return allowed;
  for (std::size_t first = 0; first < tries && allowed.size() < wanted; first += kTriesAtOnce) {
    const std::size_t here = std::min(kTriesAtOnce, tries - first);
    std::vector<PlacedStation> tried(here);
    parallel::for_all(std::size_t{0}, here, [&](std::size_t k) {
      const double n = static_cast<double>(first + k + 1);
      tried[k] = place_station(site, ground.at(fraction(0.5 + n / kPlastic), fraction(0.5 + n / (kPlastic * kPlastic))),
                               height_m);
    });
    for (const PlacedStation& station : tried)
      if (station.status == StationStatus::ok && allowed.size() < wanted) allowed.push_back(station);
  }
  return allowed;
}

// Finds positions that are not at a drop.
class StepBack {
 public:
  StepBack(const PlacementOracle& site, std::span<const PlacedStation> pool)
      : site_(site), pool_(pool), known_(pool.size(), Brink::unknown) {}

  // The position of the pool that is nearest to one at a drop, and at none; the same one if it is at none, or no such
  // is near.
  std::size_t operator()(std::size_t from) {
    if (!site_.at_brink || !at_brink(from)) return from;
    std::vector<std::pair<double, std::size_t>> near;
    for (std::size_t k = 0; k < pool_.size(); ++k)
      if (const Vec3 apart = pool_[k].ground - pool_[from].ground; dot(apart, apart) <= kStepBack_m * kStepBack_m)
        near.emplace_back(dot(apart, apart), k);
    std::ranges::sort(near);
    const auto found = std::ranges::find_if(near, [&](const auto& one) { return !at_brink(one.second); });
    return found == near.end() ? from : found->second;
  }

 private:
  enum class Brink : char { unknown, no, yes };
  bool at_brink(std::size_t k) {
    if (known_[k] == Brink::unknown) known_[k] = site_.at_brink(pool_[k].ground) ? Brink::yes : Brink::no;
    return known_[k] == Brink::yes;
  }

  const PlacementOracle& site_;
  std::span<const PlacedStation> pool_;
  std::vector<Brink> known_;
};

// Positions by squares of the plan, for those near a place.
class PositionGrid {
 public:
  explicit PositionGrid(double side_m) : side_m_(side_m) {}
  void add(const Vec3& position) { squares_[square(position)].push_back(position); }
  // True if with(position) holds for a position within a square's side.
  template <class With>
  bool any_near(const Vec3& place, const With& with) const {
    const auto [x, y] = square(place);
    for (long i = x - 1; i <= x + 1; ++i)
      for (long j = y - 1; j <= y + 1; ++j)
        if (const auto here = squares_.find({i, j}); here != squares_.end())
          for (const Vec3& one : here->second) {
            const Vec3 apart = one - place;
            if (dot(apart, apart) <= side_m_ * side_m_ && with(one)) return true;
          }
    return false;
  }

 private:
  std::pair<long, long> square(const Vec3& place) const {
    return {std::lround(std::floor(place.x / side_m_)), std::lround(std::floor(place.y / side_m_))};
  }
  double side_m_;
  std::map<std::pair<long, long>, std::vector<Vec3>> squares_;
};

}  // namespace

double ground_area_m2(const SearchMesh& mesh) { return GroundByArea(mesh).area(); }

std::vector<PlacedStation> unseen_positions(const PlacementOracle& site, std::span<const PlacedStation> stations,
                                            std::span<const PlacedStation> others, double reach_m) {
  std::vector<PlacedStation> unseen;
  if (!(reach_m > 0)) return unseen;
  PositionGrid known(reach_m), added(reach_m);
  for (const PlacedStation& station : stations) known.add(station.position);
  std::vector<char> alone(others.size(), 0);
  const auto seen_by = [&](const PositionGrid& grid, const Vec3& from) {
    return grid.any_near(from, [&](const Vec3& head) { return site.sees(head, from); });
  };
  parallel::for_all(std::size_t{0}, others.size(),
                    [&](std::size_t k) { alone[k] = !seen_by(known, others[k].position); });
  for (std::size_t k = 0; k < others.size(); ++k) {
    if (!alone[k] || seen_by(added, others[k].position)) continue;
    added.add(others[k].position);
    unseen.push_back(others[k]);
  }
  return unseen;
}

SpreadPositions spread_positions(const PlacementOracle& site, const SearchMesh& mesh, double height_m,
                                 std::size_t most) {
  const std::vector<PlacedStation> pool =
      allowed_positions(site, mesh, height_m, kPoolPerPosition * most, kTriesPerPosition * most);
  SpreadPositions spread;
  std::vector<double> square(pool.size(), std::numeric_limits<double>::infinity());  // to the nearest taken position
  std::vector<char> taken_already(pool.size(), 0);
  StepBack step_back(site, pool);
  std::size_t next = 0;
  while (spread.stations.size() < std::min(most, pool.size())) {
    const std::size_t behind = step_back(next);
    const bool taken_before = taken_already[behind] != 0;
    square[next] = 0, taken_already[next] = taken_already[behind] = 1;
    if (!taken_before) {
      const Vec3 taken = pool[behind].position;
      for (std::size_t k = 0; k < pool.size(); ++k) {
        const Vec3 apart = pool[k].position - taken;
        square[k] = std::min(square[k], dot(apart, apart));
      }
      spread.stations.push_back(pool[behind]);
    }
    next = static_cast<std::size_t>(std::max_element(square.begin(), square.end()) - square.begin());
    if (!taken_before) spread.spacing_m.push_back(std::sqrt(square[next]));
    if (square[next] == 0) break;  // all others coincide with taken ones
  }
  for (std::size_t k = 0; k < pool.size(); ++k)
    if (!taken_already[k] && square[k] > 0) spread.others.push_back(pool[k]);
  return spread;
}

}  // namespace vantage
