// SPDX-License-Identifier: Apache-2.0

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include "core/parallel.hpp"
#include "core/rounded.hpp"
#include "scene/cut_coplanar.hpp"
#include "scene/raw_scene.hpp"
#include "scene/shared_meshes.hpp"
#include "scene/sound_triangle.hpp"
#include "vantage/error.hpp"

namespace vantage {

void keep_triangles(RawScene& raw, const std::vector<std::uint8_t>& keep) {
  std::uint32_t out = 0;
  for (MeshRange& range : raw.ranges) {
    const std::uint32_t first = range.first_triangle, end = first + range.triangle_count;
    range.first_triangle = out;
    for (std::uint32_t t = first; t < end; ++t)
      if (keep[t]) raw.triangles[out++] = raw.triangles[t];
    range.triangle_count = out - range.first_triangle;
  }
  raw.triangles.resize(out);
  drop_empty_meshes(raw);
}

namespace {

// Counts triangles, those of shared meshes at each of their places.
std::size_t count_triangles(const RawScene& raw) {
  std::size_t count = raw.triangles.size();
  for (const auto& range : raw.placed)
    for (const PlacedShared& placed : range) count += raw.shared[placed.mesh].triangles.size();
  return count;
}

template <class Keep>
std::size_t drop_unless(RawScene& raw, Keep&& sound_triangle) {
  std::vector<std::uint8_t> keep(raw.triangles.size());
  parallel::for_all(std::size_t{0}, keep.size(),
                    [&](std::size_t t) { keep[t] = sound_triangle(raw.triangles[t]) ? 1 : 0; });
  const auto dropped = static_cast<std::size_t>(std::ranges::count(keep, 0));
  if (dropped > 0) keep_triangles(raw, keep);
  return dropped;
}

std::uint64_t hash(const std::array<Float3, 3>& corners) {
  std::uint64_t h = 0x9E3779B97F4A7C15;
  for (const Float3& p : corners)
    for (const float value : {p.x, p.y, p.z}) {
      h = (h ^ std::bit_cast<std::uint32_t>(value)) * 0xD6E8FEB86659FD93;
      h ^= h >> 32;
    }
  return h;
}

// Drops all but the first of several triangles over the same points. Surveyed ones come before blocking ones, since a
// ray meets them at the same distance and its point counts.
std::size_t drop_duplicates(RawScene& raw, const std::vector<Float3>& positions) {
  struct Entry {
    std::uint64_t hash;
    std::uint32_t triangle;
    std::uint32_t rank;  // 0 surveyed, 1 blocking
  };
  std::vector<Entry> entries(raw.triangles.size());
  parallel::for_all(std::size_t{0}, raw.ranges.size(), [&](std::size_t m) {
    const std::uint32_t rank = raw.meshes[m].role == Role::surveyed ? 0 : 1;
    const std::uint32_t first = raw.ranges[m].first_triangle;
    parallel::for_all(first, first + raw.ranges[m].triangle_count, [&](std::uint32_t t) {
      entries[t] = {hash(sorted_corners(positions, raw.triangles[t])), t, rank};
    });
  });
  parallel::sort(entries, [](const Entry& a, const Entry& b) {
    return a.hash != b.hash ? a.hash < b.hash : a.rank != b.rank ? a.rank < b.rank : a.triangle < b.triangle;
  });
  std::vector<std::uint8_t> keep(raw.triangles.size(), 1);
  std::size_t dropped = 0;
  for (std::size_t i = 0; i < entries.size();) {
    std::size_t end = i + 1;
    while (end < entries.size() && entries[end].hash == entries[i].hash) ++end;
    for (std::size_t j = i + 1; j < end; ++j) {  // runs have length one, except for duplicates and rare collisions
      const auto corners = sorted_corners(positions, raw.triangles[entries[j].triangle]);
      for (std::size_t k = i; k < j; ++k)
        if (keep[entries[k].triangle] && sorted_corners(positions, raw.triangles[entries[k].triangle]) == corners) {
          keep[entries[j].triangle] = 0;
          ++dropped;
          break;
        }
    }
    i = end;
  }
  if (dropped > 0) keep_triangles(raw, keep);
  return dropped;
}

template <class T>
void compact(std::vector<T>& values, const std::vector<std::uint32_t>& kept) {
  if (values.empty()) return;
  for (std::size_t i = 0; i < kept.size(); ++i) values[i] = values[kept[i]];
  values.resize(kept.size());
}

// Renumbers the triangles to the used vertices, and returns these vertices' old numbers, ascending.
std::vector<std::uint32_t> renumber(std::vector<Triangle>& triangles, std::size_t vertices) {
  std::vector<std::uint32_t> place(vertices, 0);
  for (const Triangle& t : triangles)
    for (const std::uint32_t v : t) place[v] = 1;
  std::vector<std::uint32_t> kept;
  for (std::uint32_t v = 0; v < vertices; ++v)
    if (place[v]) {
      place[v] = static_cast<std::uint32_t>(kept.size());
      kept.push_back(v);
    }
  parallel::for_all(std::size_t{0}, triangles.size(), [&](std::size_t t) {
    for (std::uint32_t& v : triangles[t]) v = place[v];
  });
  return kept;
}

void clean_search_area(RawScene& raw) {
  const auto unsound = [&](const Triangle& t) {
    for (const std::uint32_t v : t) {
      if (!sound(raw.search_positions[v])) return true;
      if (!raw.search_uvs.empty() && !(std::isfinite(raw.search_uvs[v].u) && std::isfinite(raw.search_uvs[v].v)))
        return true;
    }
    return !has_area(raw.search_positions[t[0]], raw.search_positions[t[1]], raw.search_positions[t[2]]);
  };
  const std::size_t dropped = std::erase_if(raw.search_triangles, unsound);
  if (dropped > 0)
    raw.notes.push_back("dropped " + std::to_string(dropped) +
                        " triangles of the search area that are not finite or have no area");
  const auto kept = renumber(raw.search_triangles, raw.search_positions.size());
  compact(raw.search_positions, kept);
  compact(raw.search_uvs, kept);
}

double spacing_of_floats_at(double magnitude) {
  const auto value = static_cast<float>(magnitude);
  return static_cast<double>(std::nextafter(value, std::numeric_limits<float>::infinity())) -
         static_cast<double>(value);
}

void note_lost_precision(RawScene& raw, const Box& local) {
  constexpr double kWorthSaying_m = 1e-5;  // a tenth of the finest scanner noise
  const double farthest = std::max({std::abs(local.min.x), std::abs(local.min.y), std::abs(local.min.z),
                                    std::abs(local.max.x), std::abs(local.max.y), std::abs(local.max.z)});
  const double lost = raw.coarsest_input_spacing_m;
  if (lost < kWorthSaying_m || lost < 8 * spacing_of_floats_at(farthest)) return;
  raw.notes.push_back(
      std::string("large coordinates are baked into float32 vertices, which the file resolves only to ") +
      rounded(lost) + " m; export with the offset in a node's translation instead");
}

}  // namespace

void drop_empty_meshes(RawScene& raw) {
  std::size_t out = 0;
  for (std::size_t m = 0; m < raw.ranges.size(); ++m) {
    const bool shares = !raw.placed.empty() && !raw.placed[m].empty();
    if (raw.ranges[m].triangle_count == 0 && !shares) continue;
    raw.ranges[out] = raw.ranges[m];
    if (out != m) raw.meshes[out] = std::move(raw.meshes[m]);
    if (shares && out != m) raw.placed[out] = std::move(raw.placed[m]);
    if (!shares && !raw.placed.empty()) raw.placed[out].clear();
    raw.meshes[out].triangle_count = raw.ranges[out].triangle_count;
    ++out;
  }
  raw.ranges.resize(out);
  raw.meshes.resize(out);
  if (!raw.placed.empty()) raw.placed.resize(out);
}

Vec3 local_origin(const Box& bounds) {
  if (bounds.empty()) return {};
  const Vec3 size = bounds.size();
  const double extent = std::max({size.x, size.y, size.z});
  double unit = extent > 0 ? std::pow(10.0, std::ceil(std::log10(extent))) : 1.0;
  if (!(unit > 1e-9)) unit = 1e-9;
  const auto rounded = [&](double value) { return std::round(value / unit) * unit + 0.0; };
  const Vec3 centre = bounds.centre();
  return {rounded(centre.x), rounded(centre.y), rounded(centre.z)};
}

std::shared_ptr<const SceneData> finish_scene(RawScene&& raw, const std::string& source) {
  const std::size_t given = count_triangles(raw);
  SharedCleaner shared(raw);
  shared.drop_not_finite();
  std::size_t not_finite = drop_unless(raw, [&](const Triangle& t) {
    return sound(raw.positions[t[0]]) && sound(raw.positions[t[1]]) && sound(raw.positions[t[2]]);
  });
  Box bounds;
  shared.extend(bounds);
  for (const Triangle& t : raw.triangles)
    for (const std::uint32_t v : t) bounds.extend(to_vec3(raw.positions[v]));

  auto data = std::make_shared<SceneData>();
  data->origin = local_origin(bounds);
  data->positions.resize(raw.positions.size());
  parallel::for_all(std::size_t{0}, raw.positions.size(), [&](std::size_t v) {
    if (!sound(raw.positions[v])) return;  // unused by now
    data->positions[v] = without_minus_zero(to_float3(raw.positions[v] - to_glm(data->origin)));
  });
  raw.positions = {};
  const auto has_area_in_float = [&](const Triangle& t) {
    return has_area(to_glm(data->positions[t[0]]), to_glm(data->positions[t[1]]), to_glm(data->positions[t[2]]));
  };
  shared.drop_without_area(data->origin);
  std::size_t flat = drop_unless(raw, has_area_in_float);
  shared.drop_duplicates();
  std::size_t duplicates = drop_duplicates(raw, data->positions);
  const CoplanarCut cut = cut_coplanar(raw, data->positions, data->origin);
  if (cut.blocking > 0) drop_unless(raw, has_area_in_float);

  not_finite += shared.done().not_finite, flat += shared.done().without_area, duplicates += shared.done().duplicates;
  if (!raw.placed.empty()) drop_empty_meshes(raw);

  if (not_finite > 0)
    raw.notes.push_back("dropped " + std::to_string(not_finite) +
                        " triangles with a vertex that is not finite or beyond 1e9 m");
  if (flat > 0) raw.notes.push_back("dropped " + std::to_string(flat) + " triangles without area");
  if (duplicates > 0)
    raw.notes.push_back("dropped " + std::to_string(duplicates) + " exact duplicates of other triangles");
  if (cut.blocking > 0)
    raw.notes.push_back("cut away what of " + std::to_string(cut.blocking) +
                        " blocking triangles lies in one plane with " + std::to_string(cut.surveyed) +
                        " surveyed ones, behind these");
  const std::size_t left = count_triangles(raw);
  if (left == 0 || std::ranges::none_of(raw.meshes, [](const MeshInfo& mesh) { return mesh.role == Role::surveyed; }))
    throw Error(Errc::malformed_file,
                source + ": nothing to survey: " +
                    (given == 0  ? std::string("the scene has no triangles of surveyed or blocking meshes")
                     : left == 0 ? "all " + std::to_string(given) + " triangles are without area or not finite"
                                 : "all " + std::to_string(left) + " triangles only block; mark meshes as surveyed"),
                raw.notes);

  const auto kept = renumber(raw.triangles, data->positions.size());
  if (kept.size() != data->positions.size()) {
    compact(data->positions, kept);
    compact(raw.normals, kept);
    compact(raw.texcoords, kept);
    compact(raw.colours, kept);
  }
  for (const Float3& p : data->positions) data->local_bounds.extend(to_vec3(to_glm(p)));
  data->normals = std::move(raw.normals);
  data->texcoords = std::move(raw.texcoords);
  data->colours = std::move(raw.colours);
  data->triangles = std::move(raw.triangles);
  if (!raw.placed.empty()) append_shared(*data, raw);
  note_lost_precision(raw, data->local_bounds);
  clean_search_area(raw);

  data->ranges = std::move(raw.ranges);
  data->meshes = std::move(raw.meshes);
  data->materials = std::move(raw.materials);
  if (data->materials.empty()) data->materials.emplace_back();
  data->images = std::move(raw.images);
  data->search_positions.reserve(raw.search_positions.size());
  for (const glm::dvec3& p : raw.search_positions) data->search_positions.push_back(to_vec3(p));
  data->search_uvs = std::move(raw.search_uvs);
  data->search_triangles = std::move(raw.search_triangles);
  data->notes = std::move(raw.notes);
  data->rooms = std::move(raw.rooms);
  data->defaults_json = std::move(raw.defaults_json);
  data->options = std::move(raw.options);
  return data;
}

}  // namespace vantage
