// SPDX-License-Identifier: Apache-2.0
#include "candidates/floor_units.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

#include "candidates/rooms.hpp"
#include "core/disjoint_sets.hpp"

namespace vantage {
namespace {

// The extent of a chart in (u, v), and its floor in plan. Charts that overlap there, as a marked area's may, are one.
struct Chart {
  Uv min, max;
  double area_m2 = 0;
  bool overlaps(const Chart& other) const {
    return min.u < other.max.u && other.min.u < max.u && min.v < other.max.v && other.min.v < max.v;
  }
};

// Joined triangles, as they share corners in (u, v).
std::vector<Chart> charts_of(const SearchMesh& mesh) {
  DisjointSets joined(mesh.positions.size());
  std::map<std::pair<double, double>, std::uint32_t> first_at;
  for (std::uint32_t k = 0; k < joined.size(); ++k)
    joined.join(k, first_at.emplace(std::pair{mesh.uvs[k].u, mesh.uvs[k].v}, k).first->second);
  for (const auto& t : mesh.triangles)
    for (const std::uint32_t corner : {t[1], t[2]}) joined.join(corner, t[0]);
  constexpr double kFar = std::numeric_limits<double>::infinity();
  std::vector<std::size_t> number(mesh.positions.size(), mesh.positions.size());
  std::vector<Chart> charts;
  for (const auto& t : mesh.triangles) {
    std::size_t& k = number[joined.find(t[0])];
    if (k == mesh.positions.size()) k = charts.size(), charts.push_back({{kFar, kFar}, {-kFar, -kFar}});
    Chart& chart = charts[k];
    for (const std::uint32_t corner : t) {
      const Uv& uv = mesh.uvs[corner];
      chart.min = {std::min(chart.min.u, uv.u), std::min(chart.min.v, uv.v)};
      chart.max = {std::max(chart.max.u, uv.u), std::max(chart.max.v, uv.v)};
    }
    const Vec3 &a = mesh.positions[t[0]], &b = mesh.positions[t[1]], &c = mesh.positions[t[2]];
    chart.area_m2 += std::abs(cross(b - a, c - a).z) / 2;
  }
  return charts;
}

}  // namespace

FloorUnits::FloorUnits(const Scene& scene, const SearchArea& area, double least_m2)
    : all_rooms_(scene.rooms().begin(), scene.rooms().end()) {
  const std::vector<RoomShare> shares = shares_by_room(all_rooms_, area);
  for (std::size_t k = 0; k < shares.size(); ++k)
    if (shares[k].ground_m2 >= least_m2) rooms_.push_back(k);
  std::vector<Chart> charts = charts_of(area.mesh());
  std::erase_if(charts, [&](const Chart& chart) { return chart.area_m2 < least_m2; });
  // A marked area may have any (u, v); then its charts tell no station apart.
  for (std::size_t i = 0; i < charts.size(); ++i)
    for (std::size_t j = i + 1; j < charts.size(); ++j)
      if (charts[i].overlaps(charts[j])) return;
  if (charts.size() < 2) return;
  for (const Chart& chart : charts) charts_.push_back({chart.min, chart.max});
}

std::vector<std::vector<std::size_t>> FloorUnits::stations_in(std::span<const PlacedStation> stations) const {
  std::vector<std::vector<std::size_t>> in_rooms = stations_in_rooms(all_rooms_, stations), in;
  for (const std::size_t room : rooms_) in.push_back(std::move(in_rooms[room]));
  for (const auto& [min, max] : charts_) {
    std::vector<std::size_t>& here = in.emplace_back();
    for (std::size_t k = 0; k < stations.size(); ++k)
      if (const Uv& uv = stations[k].uv; uv.u >= min.u && uv.u <= max.u && uv.v >= min.v && uv.v <= max.v)
        here.push_back(k);
  }
  return in;
}

}  // namespace vantage
