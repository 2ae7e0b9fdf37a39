// SPDX-License-Identifier: Apache-2.0
#include "scene/shared_meshes.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <iterator>
#include <map>
#include <utility>

#include "core/parallel.hpp"
#include "scene/local_from_mesh.hpp"
#include "scene/positions.hpp"
#include "scene/sound_triangle.hpp"

namespace vantage {
namespace {

glm::dvec3 survey(const MeshPlace& place, const Float3& p) { return to_glm(place(p)); }

// Returns true if a ray keeps most of its precision when it is moved into the mesh's frame and back. The axes must have
// similar lengths, and must not lie nearly in one plane.
bool moves_rays(const MeshPlace& place) {
  constexpr double kMostCondition = 24;  // 3 for equal, perpendicular axes; some 23 if one is 16 times the others
  constexpr double kLeastScale = 1e-6, kMostScale = 1e4;
  const double size = std::sqrt(dot(place.x, place.x) + dot(place.y, place.y) + dot(place.z, place.z));
  return size >= kLeastScale && size <= kMostScale && condition(place.x, place.y, place.z) <= kMostCondition;
}

// Appends attributes of a placed mesh's vertices. The array gets as long as the positions once one mesh has that
// attribute.
template <class T, class Value>
void append(std::vector<T>& values, bool any, std::size_t before, std::size_t count, T fallback, const Value& value) {
  if (!any && values.empty()) return;
  values.resize(before, fallback);
  for (std::size_t v = 0; v < count; ++v) values.push_back(any ? value(v) : fallback);
}

void append_vertices(RawScene& raw, const SharedMesh& mesh, const MeshPlace& place) {
  const std::size_t before = raw.positions.size(), count = mesh.positions.size();
  raw.positions.resize(before + count);
  parallel::for_all(tbb::blocked_range<std::size_t>(0, count, 4096), [&](const auto& range) {
    for (std::size_t v = range.begin(); v < range.end(); ++v)
      raw.positions[before + v] = survey(place, mesh.positions[v]);
  });
  append(raw.normals, !mesh.normals.empty(), before, count, Float3{},
         [&](std::size_t v) { return placed_normal(place, mesh.normals[v]); });
  append(raw.texcoords, !mesh.texcoords.empty(), before, count, Float2{},
         [&](std::size_t v) { return mesh.texcoords[v]; });
  append(raw.colours, !mesh.colours.empty(), before, count, std::uint32_t{0xFFFFFFFF},
         [&](std::size_t v) { return mesh.colours[v]; });
}

void append_triangles(std::vector<Triangle>& out, const SharedMesh& mesh, bool mirrored, std::size_t first_vertex) {
  const auto v = static_cast<std::uint32_t>(first_vertex);
  for (const Triangle& t : mesh.triangles) out.push_back(turned({t[0] + v, t[1] + v, t[2] + v}, mirrored));
}

// Keeps the marked triangles and their vertices. Returns how many triangles the mesh loses.
std::size_t keep(SharedMesh& mesh, const std::vector<std::uint8_t>& kept) {
  std::vector<std::uint32_t> place(mesh.positions.size(), 0);
  std::size_t out = 0;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    if (kept[t]) mesh.triangles[out++] = mesh.triangles[t];
  const std::size_t lost = mesh.triangles.size() - out;
  mesh.triangles.resize(out);
  for (const Triangle& t : mesh.triangles)
    for (const std::uint32_t v : t) place[v] = 1;
  std::vector<std::uint32_t> used;
  for (std::uint32_t v = 0; v < place.size(); ++v)
    if (place[v]) place[v] = static_cast<std::uint32_t>(used.size()), used.push_back(v);
  if (used.size() == place.size()) return lost;
  for (Triangle& t : mesh.triangles)
    for (std::uint32_t& v : t) v = place[v];
  const auto compact = [&](auto& values) {
    if (values.empty()) return;
    for (std::size_t k = 0; k < used.size(); ++k) values[k] = values[used[k]];
    values.resize(used.size());
  };
  compact(mesh.positions), compact(mesh.normals), compact(mesh.texcoords), compact(mesh.colours);
  return lost;
}

}  // namespace

MeshPlace place_of(const glm::dmat4& m) {
  MeshPlace place;
  place.x = to_vec3(glm::dvec3(m[0]));
  place.y = to_vec3(glm::dvec3(m[1]));
  place.z = to_vec3(glm::dvec3(m[2]));
  place.origin = to_vec3(glm::dvec3(m[3]));
  // Normals map by the inverse transpose. The cofactors, signed by the determinant, equal it up to a factor, and stay
  // defined if the matrix flattens space.
  place.mirrored = dot(place.x, cross(place.y, place.z)) < 0;
  const double sign = place.mirrored ? -1 : 1;
  place.normal_x = cross(place.y, place.z) * sign;
  place.normal_y = cross(place.z, place.x) * sign;
  place.normal_z = cross(place.x, place.y) * sign;
  return place;
}

MeshPlace reinterpreted(const MeshPlace& place, Unit unit, UpAxis up) {
  const auto turned = [&](const Vec3& v, double scale) { return to_vec3(with_up(up, to_glm(v)) * scale); };
  const double metres = metres_in(unit);
  return {turned(place.x, metres),   turned(place.y, metres),   turned(place.z, metres),   turned(place.origin, metres),
          turned(place.normal_x, 1), turned(place.normal_y, 1), turned(place.normal_z, 1), place.mirrored};
}

Box placed_bounds(const MeshPlace& place, const std::vector<Float3>& positions, const Vec3& origin) {
  return parallel::reduce(
      tbb::blocked_range<std::size_t>(0, positions.size(), 4096), Box{},
      [&](const auto& part, Box box) {
        for (std::size_t v = part.begin(); v < part.end(); ++v)
          box.extend(widen(placed_position(place, positions[v], origin)));
        return box;
      },
      united);
}

std::vector<PlacedRun> placed_runs(const RawScene& raw) {
  std::vector<PlacedRun> runs;
  auto next = static_cast<std::uint32_t>(raw.triangles.size());
  for (std::size_t m = 0; m < raw.placed.size(); ++m)
    for (const PlacedShared& placed : raw.placed[m]) {
      runs.push_back({m, next, &placed.place, &raw.shared[placed.mesh]});
      next += runs.back().count();
    }
  return runs;
}

std::size_t run_of(std::span<const PlacedRun> runs, std::uint32_t triangle) {
  const auto after = std::ranges::upper_bound(runs, triangle, {}, &PlacedRun::first);
  return static_cast<std::size_t>(after - runs.begin()) - 1;
}

void store_placed(RawScene& raw, const std::vector<std::uint8_t>& stored) {
  if (std::ranges::count(stored, 0) == std::ssize(stored)) return;
  std::vector<Triangle> triangles;
  auto store = stored.begin();
  for (std::size_t m = 0; m < raw.placed.size(); ++m) {
    MeshRange& range = raw.ranges[m];
    const auto first = raw.triangles.begin() + range.first_triangle;
    range.first_triangle = static_cast<std::uint32_t>(triangles.size());
    triangles.insert(triangles.end(), first, first + range.triangle_count);
    std::vector<PlacedShared> left;
    for (const PlacedShared& placed : raw.placed[m]) {
      if (*store++ == 0) {
        left.push_back(placed);
        continue;
      }
      const SharedMesh& mesh = raw.shared[placed.mesh];
      append_triangles(triangles, mesh, placed.place.mirrored, raw.positions.size());
      append_vertices(raw, mesh, placed.place);
    }
    raw.placed[m] = std::move(left);
    range.triangle_count = static_cast<std::uint32_t>(triangles.size()) - range.first_triangle;
  }
  raw.triangles = std::move(triangles);
}

void take_out(RawScene& raw, const std::vector<std::uint8_t>& runs,
              const std::vector<std::vector<std::uint8_t>>& taken) {
  // `rest` holds for each mesh the mesh without the taken triangles. It gets the mesh's own number if no run keeps the
  // whole mesh.
  const std::size_t count = raw.shared.size();
  std::vector<std::uint32_t> rest(count), part(count);
  std::vector<std::uint8_t> whole(count, 0);
  auto run = runs.begin();
  for (const auto& range : raw.placed)
    for (const PlacedShared& placed : range)
      if (*run++ == 0) whole[placed.mesh] = 1;
  std::vector<SharedMesh> parts;
  for (std::uint32_t m = 0; m < count; ++m) {
    if (taken[m].empty()) continue;
    std::vector<std::uint8_t> left;
    for (const std::uint8_t t : taken[m]) left.push_back(t == 0);
    part[m] = static_cast<std::uint32_t>(parts.size());
    keep(parts.emplace_back(raw.shared[m]), taken[m]);
    rest[m] = whole[m] ? static_cast<std::uint32_t>(raw.shared.size()) : m;
    if (whole[m]) raw.shared.push_back(SharedMesh(raw.shared[m]));
    keep(raw.shared[rest[m]], left);
  }
  // The taken triangles form a separate mesh until they are stored.
  const std::size_t left = raw.shared.size();
  raw.shared.insert(raw.shared.end(), std::move_iterator(parts.begin()), std::move_iterator(parts.end()));
  std::vector<std::uint8_t> stored;
  run = runs.begin();
  for (auto& range : raw.placed) {
    std::vector<PlacedShared> placements;
    const auto add = [&](std::size_t mesh, const MeshPlace& place, bool stores) {
      if (raw.shared[mesh].triangles.empty()) return;
      placements.push_back({static_cast<std::uint32_t>(mesh), place});
      stored.push_back(stores);
    };
    for (const PlacedShared& placed : range) {
      const bool of_run = *run++ != 0;
      if (of_run) add(left + part[placed.mesh], placed.place, true);
      add(of_run ? rest[placed.mesh] : placed.mesh, placed.place, false);
    }
    range = std::move(placements);
  }
  store_placed(raw, stored);
  raw.shared.resize(left);
}

RawScene excerpt(const RawScene& raw, std::size_t most) {
  RawScene part;
  part.positions = raw.positions;
  part.triangles = raw.triangles;
  part.ranges = raw.ranges;
  part.meshes = raw.meshes;
  part.shared = raw.shared;
  part.placed = raw.placed;
  std::size_t triangles = 0;
  std::vector<std::uint8_t> stored;
  for (const PlacedRun& run : placed_runs(raw)) stored.push_back((triangles += run.count()) <= most);
  store_placed(part, stored);
  part.shared.clear(), part.placed.clear();
  return part;
}

std::vector<std::vector<const MeshPlace*>> SharedCleaner::places() const {
  std::vector<std::vector<const MeshPlace*>> of(raw_.shared.size());
  for (const auto& range : raw_.placed)
    for (const PlacedShared& placed : range) of[placed.mesh].push_back(&placed.place);
  return of;
}

void SharedCleaner::drop_not_finite() {
  const auto finite = [](const Float3& p) { return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z); };
  std::vector<Box> boxes(raw_.shared.size());
  const auto of = places();
  for (std::size_t m = 0; m < raw_.shared.size(); ++m) {
    const SharedMesh& mesh = raw_.shared[m];
    std::vector<std::uint8_t> kept(mesh.triangles.size());
    for (std::size_t t = 0; t < kept.size(); ++t)
      kept[t] = std::ranges::all_of(mesh.triangles[t], [&](std::uint32_t v) { return finite(mesh.positions[v]); });
    done_.not_finite += keep(raw_.shared[m], kept) * of[m].size();
    for (const Float3& p : mesh.positions) boxes[m].extend(widen(p));
  }
  std::vector<std::uint8_t> stored;
  for (const PlacedRun& run : placed_runs(raw_)) {
    const Box& box = boxes[static_cast<std::size_t>(run.shared - raw_.shared.data())];
    bool stands = !box.empty() && !moves_rays(*run.place);
    for (int corner = 0; corner < 8 && !box.empty(); ++corner)
      stands = stands ||
               !sound(survey(*run.place, narrow({corner & 1 ? box.max.x : box.min.x, corner & 2 ? box.max.y : box.min.y,
                                                 corner & 4 ? box.max.z : box.min.z})));
    stored.push_back(stands);
  }
  store_placed(raw_, stored);
}

void SharedCleaner::extend(Box& bounds) const {
  for (const auto& range : raw_.placed)
    for (const PlacedShared& placed : range) {
      const std::vector<Float3>& positions = raw_.shared[placed.mesh].positions;
      bounds = parallel::reduce(
          tbb::blocked_range<std::size_t>(0, positions.size(), 4096), bounds,
          [&](const auto& part, Box box) {
            for (std::size_t v = part.begin(); v < part.end(); ++v) box.extend(placed.place(positions[v]));
            return box;
          },
          united);
    }
}

void SharedCleaner::drop_without_area(const Vec3& origin) {
  const auto of = places();
  for (std::size_t m = 0; m < raw_.shared.size(); ++m) {
    const SharedMesh& mesh = raw_.shared[m];
    std::vector<std::uint8_t> kept(mesh.triangles.size(), 1);
    parallel::for_all(tbb::blocked_range<std::size_t>(0, kept.size(), 1024), [&](const auto& part) {
      for (const MeshPlace* place : of[m])
        for (std::size_t t = part.begin(); t < part.end(); ++t) {
          const auto corner = [&](std::size_t k) {
            return to_glm(placed_position(*place, mesh.positions[mesh.triangles[t][k]], origin));
          };
          if (!has_area(corner(0), corner(1), corner(2))) kept[t] = 0;
        }
    });
    done_.without_area += keep(raw_.shared[m], kept) * of[m].size();
  }
}

void SharedCleaner::drop_duplicates() {
  // Drops repeated meshes at one place; surveyed ones are kept first.
  using Key = std::pair<std::uint32_t, std::array<std::uint64_t, 12>>;
  std::map<Key, int> known;
  const auto key = [](const PlacedShared& placed) {
    Key key{placed.mesh, {}};
    std::size_t n = 0;
    for (const Vec3* v : {&placed.place.x, &placed.place.y, &placed.place.z, &placed.place.origin})
      for (const double c : {v->x, v->y, v->z}) key.second[n++] = std::bit_cast<std::uint64_t>(c + 0.0);
    return key;
  };
  for (const bool surveyed : {true, false})
    for (std::size_t m = 0; m < raw_.placed.size(); ++m) {
      if ((raw_.meshes[m].role == Role::surveyed) != surveyed) continue;
      std::erase_if(raw_.placed[m], [&](const PlacedShared& placed) {
        if (known[key(placed)]++ == 0) return false;
        done_.duplicates += raw_.shared[placed.mesh].triangles.size();
        return true;
      });
    }
  const auto of = places();
  for (std::size_t m = 0; m < raw_.shared.size(); ++m) {
    const SharedMesh& mesh = raw_.shared[m];
    std::vector<std::pair<std::array<Float3, 3>, std::uint32_t>> corners(mesh.triangles.size());
    for (std::uint32_t t = 0; t < corners.size(); ++t)
      corners[t] = {sorted_corners(mesh.positions, mesh.triangles[t]), t};
    std::ranges::sort(corners, [](const auto& a, const auto& b) {
      for (std::size_t k = 0; k < 3; ++k)
        if (a.first[k] != b.first[k]) return comes_before(a.first[k], b.first[k]);
      return a.second < b.second;
    });
    std::vector<std::uint8_t> kept(corners.size(), 1);
    for (std::size_t k = 1; k < corners.size(); ++k)
      if (corners[k].first == corners[k - 1].first) kept[corners[k].second] = 0;
    done_.duplicates += keep(raw_.shared[m], kept) * of[m].size();
  }
  for (auto& range : raw_.placed)
    std::erase_if(range, [&](const PlacedShared& placed) { return raw_.shared[placed.mesh].triangles.empty(); });
}

void append_shared(SceneData& data, RawScene& raw) {
  std::vector<std::uint32_t> first_stored;
  for (const SharedMesh& mesh : raw.shared) {
    first_stored.push_back(static_cast<std::uint32_t>(data.triangles.size()));
    const std::size_t before = data.positions.size(), count = mesh.positions.size();
    append_triangles(data.triangles, mesh, false, before);
    data.positions.insert(data.positions.end(), mesh.positions.begin(), mesh.positions.end());
    append(data.normals, !mesh.normals.empty(), before, count, Float3{},
           [&](std::size_t v) { return mesh.normals[v]; });
    append(data.texcoords, !mesh.texcoords.empty(), before, count, Float2{},
           [&](std::size_t v) { return mesh.texcoords[v]; });
    append(data.colours, !mesh.colours.empty(), before, count, std::uint32_t{0xFFFFFFFF},
           [&](std::size_t v) { return mesh.colours[v]; });
  }
  std::vector<MeshInstance> instances;
  std::uint32_t next = 0;
  for (std::size_t m = 0; m < raw.ranges.size(); ++m) {
    MeshRange& range = raw.ranges[m];
    const MeshRange own = range;
    range.first_triangle = next;
    if (own.triangle_count > 0) instances.push_back({next, own.triangle_count, own.first_triangle});
    next += own.triangle_count;
    for (const PlacedShared& placed : raw.placed[m]) {
      const auto count = static_cast<std::uint32_t>(raw.shared[placed.mesh].triangles.size());
      const Box bounds = placed_bounds(placed.place, raw.shared[placed.mesh].positions, data.origin);
      const auto place = static_cast<std::uint32_t>(data.places.size());
      instances.push_back({next, count, first_stored[placed.mesh], place, bounds});
      data.local_bounds = united(data.local_bounds, bounds);
      data.places.push_back(placed.place);
      next += count;
    }
    range.triangle_count = raw.meshes[m].triangle_count = next - range.first_triangle;
  }
  raw.shared.clear(), raw.placed.clear();
  data.set_instances(std::move(instances));
}

}  // namespace vantage
