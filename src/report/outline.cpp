// SPDX-License-Identifier: Apache-2.0
#include "report/outline.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

namespace vantage {

std::vector<std::pair<Vec3, Vec3>> outline(const SearchMesh& mesh) {
  constexpr double kSamePlace = 1e-3;  // metres: far below what a picture shows
  std::map<std::array<long long, 3>, std::uint32_t> place;
  std::vector<std::uint32_t> welded;
  for (const Vec3& p : mesh.positions) {
    const std::array<long long, 3> key{std::llround(p.x / kSamePlace), std::llround(p.y / kSamePlace), std::llround(p.z / kSamePlace)};
    welded.push_back(place.try_emplace(key, static_cast<std::uint32_t>(welded.size())).first->second);
  }
  std::vector<std::pair<std::uint32_t, std::uint32_t>> edges;
  for (const auto& t : mesh.triangles) {
    for (std::size_t k = 0; k < 3; ++k) {
      const auto edge = std::minmax({welded[t[k]], welded[t[(k + 1) % 3]]});
      if (edge.first != edge.second) edges.emplace_back(edge.first, edge.second);
    }
  }
  std::sort(edges.begin(), edges.end());
  std::vector<std::pair<Vec3, Vec3>> lines;
  for (std::size_t i = 0; i < edges.size();) {
    std::size_t j = i;
    while (j < edges.size() && edges[j] == edges[i]) ++j;
    if (j - i == 1) lines.emplace_back(mesh.positions[edges[i].first], mesh.positions[edges[i].second]);
    i = j;
  }
  return lines;
}

}  // namespace vantage
