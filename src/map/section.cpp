// SPDX-License-Identifier: Apache-2.0
#include "map/section.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>
#include <unordered_map>
#include <unordered_set>

#include "core/disjoint_sets.hpp"
#include "core/first_numbers.hpp"

namespace vantage {
namespace {

// Gives equal points one number, whatever face they belong to. Points of different frames are never equal.
std::vector<std::uint32_t> welded(const SceneData& scene) {
  std::vector<std::uint32_t> frame(scene.shares() ? scene.positions.size() : 0, 0);
  for (const MeshInstance& instance : scene.instances)
    if (instance.place != MeshInstance::kNoPlace && frame[scene.triangles[instance.first_stored][0]] == 0)
      for (std::uint32_t t = 0; t < instance.triangle_count; ++t)
        for (const std::uint32_t v : scene.triangles[instance.first_stored + t]) frame[v] = instance.first_stored + 1;
  std::vector<std::uint32_t> order = first_numbers<std::uint32_t>(scene.positions.size()), number(order.size());
  const auto key = [&](std::uint32_t v) {
    const Float3& p = scene.positions[v];
    return std::tuple(p.x, p.y, p.z, frame.empty() ? 0 : frame[v]);
  };
  std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) { return key(a) < key(b); });
  for (std::size_t k = 0; k < order.size(); ++k)
    number[order[k]] = k > 0 && key(order[k]) == key(order[k - 1]) ? number[order[k - 1]] : order[k];
  return number;
}

// A segment of the cut with the solid to its left in plan view.
struct Cut {
  MapPoint from, to;
  std::uint64_t surface;
};

// Number of the surface of a triangle, by those of stored points.
std::uint64_t surface_of(const SceneData& scene, std::span<const std::uint32_t> surfaces, std::uint32_t triangle) {
  const std::uint64_t place = scene.shares() ? scene.instance_of(triangle).place : MeshInstance::kNoPlace;
  return place << 32 | surfaces[scene.attributes(triangle)[0]];
}

// Calls found(triangle, from, to) for each triangle that crosses the height, with what is solid to the left.
template <class Found>
void for_each_cut(const SceneData& scene, double z, Found&& found) {
  for (std::uint32_t t = 0; t < scene.triangle_count(); ++t) {
    const auto corners = scene.corners(t);
    std::array<Vec3, 3> p;
    for (std::size_t k = 0; k < 3; ++k) p[k] = widen(corners[k]) + scene.origin;
    // a corner in the plane counts as above: each surface is crossed evenly
    std::array<Vec3, 2> ends;
    std::size_t count = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3 &a = p[k], &b = p[(k + 1) % 3];
      if ((a.z >= z) == (b.z >= z)) continue;
      // from the lower end, so that both triangles at an edge find the same point
      const Vec3 &low = a.z < b.z ? a : b, &high = a.z < b.z ? b : a;
      ends[count++] = low + (high - low) * ((z - low.z) / (high.z - low.z));
    }
    if (count != 2) continue;
    const Vec3 n = cross(p[1] - p[0], p[2] - p[0]);
    // up × n runs along the cut with the inside to its left
    const bool along = (ends[1].x - ends[0].x) * -n.y + (ends[1].y - ends[0].y) * n.x >= 0;
    found(t, along ? ends[0] : ends[1], along ? ends[1] : ends[0]);
  }
}

struct Crossing {
  std::uint64_t surface;
  double column;
  int winding;  // added to the right of it
};

// Sorts the crossings of a row by their columns, without surfaces that do not close along it.
void keep_closed(std::vector<Crossing>& row) {
  std::sort(row.begin(), row.end(), [](const Crossing& a, const Crossing& b) {
    return a.surface != b.surface ? a.surface < b.surface : a.column < b.column;
  });
  std::size_t kept = 0;
  for (std::size_t first = 0; first < row.size();) {
    std::size_t last = first;
    int sum = 0;
    while (last < row.size() && row[last].surface == row[first].surface) sum += row[last++].winding;
    if (sum == 0)
      for (std::size_t k = first; k < last; ++k) row[kept++] = row[k];
    first = last;
  }
  row.resize(kept);
  std::sort(row.begin(), row.end(), [](const Crossing& a, const Crossing& b) { return a.column < b.column; });
}

// Adds the surfaces that would fill a place of the row.
void add_around(const std::vector<Crossing>& row, double column, std::unordered_set<std::uint64_t>& around) {
  std::unordered_map<std::uint64_t, int> windings;
  int all = 0;
  for (const Crossing& crossing : row) {
    if (crossing.column > column) break;
    windings[crossing.surface] += crossing.winding, all += crossing.winding;
  }
  if (all <= 0) return;
  for (const auto& [surface, winding] : windings)
    if (winding > 0) around.insert(surface);
}

// Fills a row of pixels with `kind` by the crossings of its middle line.
void fill_row(const std::vector<Crossing>& row, std::uint8_t kind, std::uint8_t* solid, std::size_t columns) {
  int winding = 0;
  for (std::size_t k = 0; k + 1 < row.size(); ++k) {
    winding += row[k].winding;
    if (winding <= 0) continue;
    const auto [x0, x1] = pixels_between(row[k].column, row[k + 1].column, columns);
    for (std::size_t x = x0; x < x1; ++x) solid[x] = kind;
  }
}

}  // namespace

// Which surface each point belongs to: those that triangles connect.
std::vector<std::uint32_t> surfaces_of(const SceneData& scene) {
  std::vector<std::uint32_t> surfaces = welded(scene);
  DisjointSets joined(surfaces.size());
  for (std::uint32_t v = 0; v < surfaces.size(); ++v) joined.join(v, surfaces[v]);
  for (const Triangle& t : scene.triangles)
    for (const std::size_t k : {1u, 2u}) joined.join(t[0], t[k]);
  for (std::uint32_t v = 0; v < surfaces.size(); ++v) surfaces[v] = joined.find(v);
  return surfaces;
}

Section section_at(const SceneData& scene, const MapWindow& window, double z, std::span<const Vec3> free) {
  return section_at(scene, surfaces_of(scene), window, z, free);
}

Section section_at(const SceneData& scene, std::span<const std::uint32_t> surfaces, const MapWindow& window, double z,
                   std::span<const Vec3> free) {
  Section section;
  section.solid.assign(window.columns * window.rows, 0);
  // Glass first, so that what it touches is drawn over it.
  const std::uint32_t opaque = scene.opaque_count();
  for (const bool glass : {true, false}) {
    if (glass && opaque == scene.triangle_count()) continue;
    std::vector<std::vector<Crossing>> rows(window.rows);
    std::vector<Cut> cuts;
    for_each_cut(scene, z, [&](std::uint32_t t, const Vec3& from, const Vec3& to) {
      if ((t >= opaque) == glass) cuts.push_back({window.at(from), window.at(to), surface_of(scene, surfaces, t)});
    });
    for (const Cut& cut : cuts) {
      (glass ? section.glass_outlines : section.outlines).push_back({cut.from, cut.to});
      // Rows count downward: the solid lies to the left of the cut, so to the right of a downward one.
      const double top = std::min(cut.from.y, cut.to.y), bottom = std::max(cut.from.y, cut.to.y);
      const auto first =
          static_cast<std::size_t>(std::clamp(std::ceil(top - 0.5), 0.0, static_cast<double>(window.rows)));
      for (std::size_t y = first; y < window.rows && static_cast<double>(y) + 0.5 < bottom; ++y) {
        const double share = (static_cast<double>(y) + 0.5 - cut.from.y) / (cut.to.y - cut.from.y);
        rows[y].push_back({cut.surface, cut.from.x + share * (cut.to.x - cut.from.x), cut.to.y > cut.from.y ? 1 : -1});
      }
    }
    if (cuts.empty()) continue;
    for (std::vector<Crossing>& row : rows) keep_closed(row);
    std::unordered_set<std::uint64_t> around;
    for (const Vec3& place : free) {
      const MapPoint at = window.at(place);
      if (at.y >= 0 && at.y < static_cast<double>(window.rows))
        add_around(rows[static_cast<std::size_t>(at.y)], at.x, around);
    }
    if (!around.empty())
      for (std::vector<Crossing>& row : rows)
        std::erase_if(row, [&](const Crossing& crossing) { return around.contains(crossing.surface); });
    for (std::size_t y = 0; y < window.rows; ++y)
      fill_row(rows[y], glass ? 2 : 1, section.solid.data() + y * window.columns, window.columns);
  }
  return section;
}

std::vector<std::array<Vec3, 2>> section_lines(const SceneData& scene, double z) {
  std::vector<std::array<Vec3, 2>> lines;
  for_each_cut(scene, z, [&](std::uint32_t, const Vec3& from, const Vec3& to) { lines.push_back({from, to}); });
  return lines;
}

}  // namespace vantage
