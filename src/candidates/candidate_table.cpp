// SPDX-License-Identifier: Apache-2.0
#include "candidates/candidate_table.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <utility>

#include "candidates/sample_seen.hpp"

namespace vantage {
namespace {

double apart_m(const PlacedStation& a, const PlacedStation& b) {
  const Vec3 way = a.position - b.position;
  return std::sqrt(dot(way, way));
}

constexpr double kStep_m = 0.1;  // along a way
// Further positions on each side of a place where nobody may stand, and their radius.
constexpr std::size_t kBySide = 8;
constexpr double kBySide_m = 0.75;

}  // namespace

TraceColumns columns_of(Simulator& simulator, std::uint64_t sample_voxels, std::vector<double> goals) {
  return [&simulator, sample_voxels, goals = std::move(goals)](std::span<const PlacedStation> stations,
                                                               const Progress& progress) {
    CoverageMatrix matrix = sample_coverage(simulator, stations, sample_voxels, progress).matrix();
    if (!goals.empty()) matrix.set_goals(goals);
    return matrix;
  };
}

TraceColumns seen_columns_of(Simulator& surroundings, std::uint64_t sample_voxels) {
  return [&surroundings, sample_voxels](std::span<const PlacedStation> stations, const Progress& progress) {
    return sample_seen(surroundings, stations, sample_voxels, progress);
  };
}

double spacing_by_view(const PlacedStation& station, std::span<const CoverageMatrix::Entry> column,
                       const CoverageMatrix& matrix, std::span<const Vec3> centres) {
  std::vector<double> ranges;
  for (const CoverageMatrix::Entry& one : column) {
    if (matrix.weight(one.element) <= 0 || one.amount < 0.5 * matrix.goal(one.element)) continue;
    const Vec3 way = centres[one.element] - station.position;
    ranges.push_back(std::sqrt(dot(way, way)));
  }
  if (ranges.empty()) return 0;
  const auto middle = ranges.begin() + static_cast<std::ptrdiff_t>(ranges.size() / 2);
  std::ranges::nth_element(ranges, middle);
  return kSpacingShare * *middle;
}

double least_share(double share, double size, double errors) {
  const double z2 = errors * errors / size;
  const double deviation = std::sqrt(z2 * (share * (1 - share) + z2 / 4));
  return std::max(0.0, (share + z2 / 2 - deviation) / (1 + z2));
}

CandidateTable::CandidateTable(TraceColumns surveyed, TraceColumns surroundings, StationSpacing spacing,
                               double unsampled)
    : surveyed_(std::move(surveyed)),
      surroundings_(std::move(surroundings)),
      spacing_(std::move(spacing)),
      unsampled_(unsampled),
      matrix_(surveyed_({}, {})),
      around_(surroundings_ ? surroundings_({}, {}) : CoverageMatrix()) {}

bool CandidateTable::add(std::span<const PlacedStation> stations, const Progress& progress) {
  const CoverageMatrix fresh = surveyed_(stations, progress);
  const std::size_t count = std::min(stations.size(), fresh.candidates());
  return add(stations.first(count), fresh, progress) && count == stations.size();
}

bool CandidateTable::add(std::span<const PlacedStation> stations, const CoverageMatrix& known, const Progress& progress,
                         std::size_t column) {
  std::size_t count = std::min(stations.size(), known.candidates() - column);
  if (surroundings_) {
    const CoverageMatrix fresh = surroundings_(stations.first(count), {.stop = progress.stop});
    around_.append(fresh);
    count = std::min(count, fresh.candidates());
  }
  if (column == 0)
    matrix_.append(known, count);
  else
    for (std::size_t k = column; k < column + count; ++k) matrix_.add(known.column(k));
  stations_.insert(stations_.end(), stations.begin(), stations.begin() + static_cast<std::ptrdiff_t>(count));
  const std::size_t first = graph_.size();
  bring_back_ties();
  graph_.extend(around_, stations_.size());
  if (errors_ > 0) {
    sampled_.extend(around_, stations_.size());
    lower_overlaps(first);
  }
  std::vector<Vec3> positions;
  for (const PlacedStation& station : stations_) positions.push_back(station.position);
  graph_.exclude_nearer(positions, spacing_.nearest_m, first);
  if (spacing_.least_m) {
    for (std::size_t k = least_m_.size(); k < stations_.size(); ++k)
      least_m_.push_back(spacing_.least_m(stations_[k], matrix_.column(k)));
    graph_.exclude_nearer(
        positions, least_m_, [&](std::size_t i, std::size_t j) { return !spacing_.sees(positions[i], positions[j]); },
        first);
  }
  if (past_stairs_) leave_out_ties(links_from(first));
  return count == stations.size();
}

void CandidateTable::take_least_overlaps(double errors) {
  if (errors_ == 0) sampled_ = graph_;
  errors_ = errors;
  bring_back_ties();
  lower_overlaps(0);
  if (past_stairs_) leave_out_ties({});
}

void CandidateTable::lower_overlaps(std::size_t first) {
  const double errors = errors_ * std::sqrt(unsampled_);
  for (std::size_t i = first; i < std::min(sampled_.size(), around_.candidates()); ++i)
    for (const StationGraph::Overlap& other : sampled_.overlaps(i)) {
      const std::size_t j = other.candidate;
      if (j >= i) break;
      if (known_.contains({j, i})) continue;
      const std::size_t fewer = std::min(around_.column(i).size(), around_.column(j).size());
      graph_.set_overlap(
          i, j, static_cast<float>(least_share(static_cast<double>(other.share), static_cast<double>(fewer), errors)));
    }
}

std::vector<CandidateTable::Pair> CandidateTable::links_from(std::size_t first) const {
  std::vector<Pair> links;
  for (std::size_t i = first; i < graph_.size(); ++i)
    for (const StationGraph::Overlap& other : graph_.overlaps(i)) {
      if (other.candidate >= i) break;
      if (static_cast<double>(other.share) >= link_) links.emplace_back(other.candidate, i);
    }
  return links;
}

void CandidateTable::keep_to_stairs(PastStairs past_stairs, double link) {
  count_all_links();
  past_stairs_ = std::move(past_stairs), link_ = link;
  leave_out_ties(links_from(0));
}

void CandidateTable::count_all_links() {
  bring_back_ties();
  ties_.clear();
  past_stairs_ = nullptr;
}

void CandidateTable::bring_back_ties() {
  for (const auto& [pair, share] : ties_) graph_.set_overlap(pair.first, pair.second, share);
}

void CandidateTable::leave_out_ties(std::vector<Pair> further) {
  const std::vector<std::uint8_t> past = past_stairs_(stations_, further);
  for (std::size_t k = 0; k < further.size(); ++k)
    if (past[k] != 0) ties_.emplace(further[k], 0.0F);
  for (auto& [pair, share] : ties_) {
    share = graph_.overlap(pair.first, pair.second);
    if (static_cast<double>(share) >= link_) graph_.set_overlap(pair.first, pair.second, 0);
  }
  const std::vector<std::size_t> part = linked_parts(graph_, link_).of;
  for (const auto& [pair, share] : ties_)
    if (part[pair.first] != part[pair.second]) graph_.set_overlap(pair.first, pair.second, share);
}

void CandidateTable::take_in(std::span<const std::size_t> chosen, const ScanOverlapMatrix& overlap) {
  bring_back_ties();
  std::vector<Pair> taken;
  for (std::size_t a = 0; a < chosen.size(); ++a)
    for (std::size_t b = a + 1; b < chosen.size(); ++b) {
      const auto share = static_cast<float>(overlap(a, b));
      if (share == 0 && graph_.overlap(chosen[a], chosen[b]) == 0) continue;
      graph_.set_overlap(chosen[a], chosen[b], share);
      known_.insert(std::minmax(chosen[a], chosen[b]));
      if (static_cast<double>(share) >= link_) taken.push_back(std::minmax(chosen[a], chosen[b]));
    }
  if (past_stairs_) leave_out_ties(std::move(taken));
}

double CandidateTable::overlap_error(std::span<const std::size_t> network, double share) const {
  std::size_t fewest = around_.elements();
  for (const std::size_t k : network)
    if (k < around_.candidates()) fewest = std::min(fewest, around_.column(k).size());
  return fewest > 0 ? std::sqrt(unsampled_ * share * (1 - share) / static_cast<double>(fewest)) : 0;
}

std::size_t CandidateTable::nearest(const PlacedStation& station) const {
  const auto found =
      std::ranges::min_element(stations_, {}, [&](const PlacedStation& known) { return apart_m(known, station); });
  return static_cast<std::size_t>(found - stations_.begin());
}

bool CandidateTable::spaced(std::span<const PlacedStation> stations) const {
  std::vector<double> least(stations.size(), 0);
  for (std::size_t i = 0; i < stations.size() && spacing_.least_m; ++i) least[i] = least_m_[nearest(stations[i])];
  for (std::size_t i = 0; i < stations.size(); ++i)
    for (std::size_t j = i + 1; j < stations.size(); ++j) {
      const double metres = apart_m(stations[i], stations[j]);
      if (metres < spacing_.nearest_m) return false;
      if (metres < std::min(least[i], least[j]) && spacing_.sees(stations[i].position, stations[j].position))
        return false;
    }
  return true;
}

Components linked_parts(const StationGraph& graph, double least) {
  return components_along(graph.size(), [&](std::size_t k, const auto& visit) {
    for (const StationGraph::Overlap& other : graph.overlaps(k))
      if (static_cast<double>(other.share) >= least) visit(other.candidate);
  });
}

std::vector<PlacedStation> positions_around(const PlacementOracle& site, std::span<const PlacedStation> stations,
                                            std::size_t each, double radius_m) {
  // Sunflower seeds: each is turned on by the golden angle and has an equal share of the disc (Vogel: A Better Way to
  // Construct the Sunflower Head, 1979).
  const double golden = 2 * std::numbers::pi * (2 - std::numbers::phi);
  std::vector<PlacedStation> found;
  for (const PlacedStation& station : stations) {
    const bool narrow = !site.at_brink || site.at_brink(station.ground);
    for (std::size_t k = 0; k < each; ++k) {
      const double share = (static_cast<double>(k) + 0.5) / static_cast<double>(each);
      const double away = radius_m * std::sqrt(share), turn = golden * static_cast<double>(k);
      const auto uv = site.project(station.ground + Vec3{away * std::cos(turn), away * std::sin(turn), 0});
      if (!uv) continue;
      PlacedStation placed = place_station(site, *uv, site.height_m);
      placed.setup = station.setup;
      // Excludes the floor below, where a station would see everything else.
      if (placed.status == StationStatus::ok && std::abs(placed.ground.z - station.ground.z) <= radius_m &&
          (narrow || !site.at_brink(placed.ground)))
        found.push_back(placed);
    }
  }
  return found;
}

std::vector<PlacedStation> positions_along(const PlacementOracle& site, std::span<const Vec3> way, double apart_m) {
  std::vector<PlacedStation> found, sides;
  std::optional<PlacedStation> before;  // the position before, if it was allowed
  bool barred = false;                  // since it
  double since_m = apart_m;             // from the last one taken
  const auto visit = [&](const Vec3& ground) {
    const auto uv = site.project(ground);
    const PlacedStation here = uv ? place_station(site, *uv, site.height_m) : PlacedStation{};
    if (!uv || here.status != StationStatus::ok || std::abs(here.ground.z - ground.z) > kStep_m) {
      if (before) sides.push_back(*std::exchange(before, std::nullopt));
      barred = true;
      return;
    }
    if (barred || since_m >= apart_m) {
      (barred ? sides : found).push_back(here);
      since_m = 0;
    }
    before = here, barred = false;
  };
  for (std::size_t k = 0; k + 1 < way.size(); ++k) {
    const Vec3 leg = way[k + 1] - way[k];
    const auto steps = static_cast<std::size_t>(std::ceil(std::sqrt(dot(leg, leg)) / kStep_m));
    for (std::size_t step = 0; step < steps; ++step, since_m += kStep_m)
      visit(way[k] + leg * (static_cast<double>(step) / static_cast<double>(steps)));
  }
  // The shortest way passes along a jamb; scans from the middle see more of both sides.
  const std::vector<PlacedStation> around = positions_around(site, sides, kBySide, kBySide_m);
  found.insert(found.end(), sides.begin(), sides.end());
  found.insert(found.end(), around.begin(), around.end());
  return found;
}

}  // namespace vantage
