// SPDX-License-Identifier: Apache-2.0
#include "trace/vulkan/device_memory.hpp"

#include <algorithm>
#include <bit>

#include "shared/bvh_types.h"
#include "shared/ray_query_types.h"
#include "shared/trace_types.h"
#include "shared/voxel_types.h"
#include "trace/vulkan/count_schedule.hpp"
#include "trace/vulkan/pair_schedule.hpp"

namespace vantage::vulkan {
namespace {

constexpr double kBytesOfWord = 4, kBytesOfVertex = 12, kBytesOfTriangle = 12;
constexpr double kMostStaging = 1 << 25;  // commands.cpp
// Per triangle, measured (docs/evidence/reliability.md): nodes of our tree, most of whose leaves hold two triangles;
// bytes of a driver's structure; bytes of scratch to build it. lavapipe's scratch is negligible, others' is a guess.
constexpr double kTreeNodes = 0.6, kBytesOfStructure = 112, kBytesOfScratch = 64;

// Returns the bytes of the engine's trees. Glass has a tree of our own on every engine.
double tree(const DeviceLoad& load) {
  constexpr double kBytesOfTree = kTreeNodes * sizeof(BvhNode) + sizeof(BvhTriangle);
  if (load.engine == Engine::compute_bvh)
    return load.triangles * kBytesOfTree + load.runs * (sizeof(BvhPlacement) + sizeof(BvhNode) + sizeof(BvhTriangle));
  return load.triangles * (kBytesOfWord + kBytesOfStructure) + load.runs * (sizeof(QueryInstance) + kBytesOfStructure) +
         load.glass * kBytesOfTree;
}

double places(const DeviceLoad& load) { return load.runs * (sizeof(TriangleRun) + sizeof(MeshTransform)); }

double build_only(const DeviceLoad& load) {
  if (load.engine == Engine::compute_bvh) return 0;
  return load.vertices * kBytesOfVertex + load.triangles * (kBytesOfTriangle + (load.software ? 0 : kBytesOfScratch));
}

double grid(const DeviceLoad& load) {
  const auto slots = std::bit_ceil(static_cast<std::uint64_t>(std::max(2 * load.bricks, 2.0)));
  return load.bricks * sizeof(VoxelBrick) + static_cast<double>(slots) * sizeof(BrickSlot);
}

// Returns the bytes of corners, for a sample; with shading, also of normals and per-triangle data.
double surfaces(const DeviceLoad& load) {
  const double neighbours = load.engine == Engine::compute_bvh ? 3 * kBytesOfWord : 0;
  const double corners = load.vertices * kBytesOfVertex + load.triangles * (kBytesOfTriangle + neighbours);
  if (!load.shaded) return corners;
  return corners + load.vertices * (load.normals ? kBytesOfVertex : 0) +
         (load.runs > 0 ? load.runs : load.triangles) * 2 * kBytesOfWord;
}

double tiles(const DeviceLoad& load) {
  if (load.rows == 0 || load.columns == 0) return 0;
  const CountSchedule schedule(1, load.rows, load.columns, tile_side);
  const double starts = load.engine == Engine::compute_bvh ? tile_starts * sizeof(TileStart) : 0;
  return static_cast<double>(schedule.list_words()) * (kBytesOfWord + starts) +
         double{CountSchedule::kStationsPerSubmission} * schedule.tiles() * kBytesOfWord;
}

double lists(const DeviceLoad& load) {
  const SampleRoom room = sample_room(load.software, 0);
  return static_cast<double>(room.pairs) * sizeof(SamplePair) + static_cast<double>(room.rays) * sizeof(SampleRay) +
         static_cast<double>(room.parts) * (kBytesOfWord + sizeof(SampleItem));
}

}  // namespace

double device_bytes(const DeviceLoad& load) {
  const double mask_words = load.stations > 32 ? 2 : 1;
  const double counts = load.voxels * kBytesOfWord * (1 + mask_words);
  const double largest_upload = std::max(
      {load.triangles * sizeof(BvhTriangle), load.vertices * kBytesOfVertex, load.bricks * sizeof(VoxelBrick)});
  const double kept = tree(load) + std::min(largest_upload, kMostStaging);
  return kept +
         std::max(build_only(load), grid(load) + places(load) + surfaces(load) + counts + tiles(load) + lists(load));
}

}  // namespace vantage::vulkan
