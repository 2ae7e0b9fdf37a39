// SPDX-License-Identifier: Apache-2.0
#include "scene/scene_difference.hpp"

#include <algorithm>
#include <cstring>
#include <string>
#include <tuple>
#include <unordered_map>

#include "core/parallel.hpp"

namespace vantage {
namespace {

// Returns true if two meshes have the same role and, triangle by triangle, the same corners. Indices may differ by a
// constant, as after a change of meshes before them; a mesh that is stored in another way counts as another.
bool alike(const SceneData& before, std::size_t b, const SceneData& after, std::size_t a) {
  const MeshInfo &was = before.meshes[b], &is = after.meshes[a];
  const MeshRange &from = before.ranges[b], &to = after.ranges[a];
  if (was.role != is.role || was.glass != is.glass || from.triangle_count != to.triangle_count) return false;
  if (from.triangle_count == 0) return true;
  const auto old = std::span(before.triangles).subspan(from.first_triangle, from.triangle_count);
  const auto now = std::span(after.triangles).subspan(to.first_triangle, to.triangle_count);
  const std::uint32_t shift = now[0][0] - old[0][0];  // wraps around if it is negative
  struct Indices {
    bool shifted = true;
    std::uint32_t low = 0xFFFFFFFFu, high = 0;
  };
  const Indices all = parallel::reduce(
      tbb::blocked_range<std::size_t>(0, old.size(), 1 << 14), Indices{},
      [&](const tbb::blocked_range<std::size_t>& range, Indices own) {
        std::uint32_t other = 0;
        for (std::size_t t = range.begin(); t != range.end(); ++t)
          for (std::size_t k = 0; k < 3; ++k) {
            other |= now[t][k] - old[t][k] - shift;
            own.low = std::min(own.low, old[t][k]), own.high = std::max(own.high, old[t][k]);
          }
        own.shifted &= other == 0;
        return own;
      },
      [](const Indices& x, const Indices& y) {
        return Indices{x.shifted && y.shifted, std::min(x.low, y.low), std::max(x.high, y.high)};
      });
  return all.shifted && std::memcmp(&before.positions[all.low], &after.positions[all.low + shift],
                                    (std::size_t{all.high} - all.low + 1) * sizeof(Float3)) == 0;
}

// Returns the key by which meshes that may be alike are found.
std::string key_of(const SceneData& scene, std::size_t mesh) {
  return std::to_string(scene.ranges[mesh].triangle_count) + ' ' + scene.meshes[mesh].name;
}

}  // namespace

bool SceneDifference::shifted() const {
  return std::ranges::any_of(kept, [](const KeptRun& run) { return run.first != run.other; });
}

std::optional<SceneDifference> difference(const SceneData& before, const SceneData& after) {
  if (before.shares() || after.shares() || before.origin != after.origin) return std::nullopt;
  const std::size_t many = before.meshes.size(), now = after.meshes.size();
  SceneDifference found;
  found.mesh_before.assign(now, SceneDifference::kNew);
  std::size_t first = 0;
  while (first < many && first < now && alike(before, first, after, first))
    found.mesh_before[first] = static_cast<std::uint32_t>(first), ++first;
  std::size_t end = many, end_now = now;
  while (end > first && end_now > first && alike(before, end - 1, after, end_now - 1))
    --end, --end_now, found.mesh_before[end_now] = static_cast<std::uint32_t>(end);
  std::unordered_map<std::string, std::vector<std::size_t>> by_key;
  for (std::size_t b = first; b < end; ++b) by_key[key_of(before, b)].push_back(b);
  std::size_t next = first;
  for (std::size_t a = first; a < end_now && next < end; ++a) {
    const auto same_key = by_key.find(key_of(after, a));
    if (same_key == by_key.end()) continue;
    for (const std::size_t b : same_key->second) {
      if (b < next || !alike(before, b, after, a)) continue;
      found.mesh_before[a] = static_cast<std::uint32_t>(b);
      next = b + 1;
      break;
    }
  }
  std::vector<bool> stays(many);
  for (std::size_t a = 0; a < now; ++a) {
    const std::uint32_t b = found.mesh_before[a];
    if (b == SceneDifference::kNew) continue;
    stays[b] = true;
    const MeshRange& from = before.ranges[b];
    if (from.triangle_count == 0) continue;
    KeptRun run{from.first_triangle, from.triangle_count, after.ranges[a].first_triangle};
    if (!found.kept.empty()) {
      KeptRun& last = found.kept.back();
      if (last.first + last.count == run.first && last.other + last.count == run.other) {
        last.count += run.count;
        continue;
      }
    }
    found.kept.push_back(run);
  }
  for (std::size_t b = 0; b < many; ++b)
    if (!stays[b]) found.gone.push_back(static_cast<std::uint32_t>(b));
  return found;
}

std::vector<KeptRun> not_kept(std::span<const KeptRun> kept, std::uint32_t end) {
  std::vector<KeptRun> rest;
  std::uint32_t next = 0;
  for (const KeptRun& run : kept) {
    const std::uint32_t from = std::min(run.other, end);
    if (from > next) rest.push_back({next, from - next, 0});
    next = std::max(next, run.other + run.count);
  }
  if (next < end) rest.push_back({next, end - next, 0});
  return rest;
}

std::vector<KeptRun> joined(std::span<const KeptRun> first, std::span<const KeptRun> then) {
  std::vector<KeptRun> both;
  std::size_t k = 0;
  for (const KeptRun& run : first) {  // both ascend in the numbers between
    const std::uint32_t last = run.other + run.count;
    while (k < then.size() && then[k].first + then[k].count <= run.other) ++k;
    for (std::size_t j = k; j < then.size() && then[j].first < last; ++j) {
      const std::uint32_t from = std::max(run.other, then[j].first), to = std::min(last, then[j].first + then[j].count);
      both.push_back({run.first + (from - run.other), to - from, then[j].other + (from - then[j].first)});
    }
  }
  return both;
}

}  // namespace vantage
