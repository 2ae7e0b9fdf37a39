// SPDX-License-Identifier: Apache-2.0
// Makes lists of triangles, one per voxel or cell of voxels, by walking over the triangles.
#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <string>

#include "core/parallel.hpp"
#include "scene/scene_data.hpp"
#include "vantage/error.hpp"
#include "voxel/voxel_triangles.hpp"

namespace vantage {

// Calls visit(t) once per surveyed triangle, from several threads at once.
template <class Visit>
void for_each_surveyed(const SceneData& scene, const Visit& visit) {
  for (std::size_t m = 0; m < scene.ranges.size(); ++m) {
    if (scene.meshes[m].role != Role::surveyed) continue;
    const std::uint32_t begin = scene.ranges[m].first_triangle, end = begin + scene.ranges[m].triangle_count;
    parallel::for_all(tbb::blocked_range<std::uint32_t>(begin, end),
                      [&](const tbb::blocked_range<std::uint32_t>& range) {
                        for (std::uint32_t t = range.begin(); t != range.end(); ++t) visit(t);
                      });
  }
}

// Throws Error out_of_memory if lists would hold more pairs than their offsets can count.
inline void require_listable(std::uint64_t pairs) {
  if (pairs > 0xFFFFFFFFu)
    throw Error(Errc::out_of_memory,
                "the sampled voxels touch " + std::to_string(pairs) +
                    " triangles in all, more than can be listed; use a smaller sample or smaller voxels");
}

// Makes `lists` lists from finder.for_each(found), which calls found(number of the list, triangle) once per pair, from
// several threads at once, and the same pairs each time. Each list ascends. Throws as `require_listable`.
template <class Finder>
VoxelTriangles triangle_lists(const Finder& finder, std::size_t lists) {
  VoxelTriangles result;
  result.offset.assign(lists + 1, 0);
  finder.for_each([&](std::uint32_t number, std::uint32_t) {
    std::atomic_ref<std::uint32_t>(result.offset[number + 1]).fetch_add(1, std::memory_order_relaxed);
  });
  std::uint64_t total = 0;
  for (std::uint32_t& count : result.offset) {
    total += count;
    count = static_cast<std::uint32_t>(total);
  }
  require_listable(total);
  result.triangle.resize(total);
  std::vector<std::uint32_t> next(result.offset.begin(), result.offset.end() - 1);
  finder.for_each([&](std::uint32_t number, std::uint32_t triangle) {
    result.triangle[std::atomic_ref<std::uint32_t>(next[number]).fetch_add(1, std::memory_order_relaxed)] = triangle;
  });
  parallel::for_all(tbb::blocked_range<std::size_t>(0, lists), [&](const tbb::blocked_range<std::size_t>& range) {
    for (std::size_t i = range.begin(); i != range.end(); ++i)
      std::sort(result.triangle.begin() + result.offset[i], result.triangle.begin() + result.offset[i + 1]);
  });
  return result;
}

}  // namespace vantage
