// SPDX-License-Identifier: Apache-2.0
// Interface of a Vulkan engine: builds, binds and walks a structure over a scene's triangles. VulkanTracer does
// everything else, in the same way for all engines. docs/contributing.md says how to add one.
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <span>

#include "scene/scene_data.hpp"
#include "scene/scene_difference.hpp"
#include "shared/trace_types.h"
#include "trace/vulkan/commands.hpp"
#include "trace/vulkan/placed_meshes.hpp"
#include "vantage/trace.hpp"

namespace vantage::vulkan {

// Input of a structure. Borrowed for the call.
struct TraversalScene {
  std::span<const Float3> positions;
  std::span<const Triangle> triangles;  // those that are stored in place
  std::span<const std::uint32_t> ids;   // per triangle, for Hit::id: its number, with surveyed_bit if its points count
  bool sort = true;                     // as TraceScene::sort_triangles
  const PlacedMeshes& placed;           // empty unless the engine has VulkanEngine::places_meshes
  Box bounds = {};                      // of all triangles in place, for a RayWalk
};

// Inputs of shaders that walk a structure.
struct TraversalBinding {
  std::array<VkDeviceAddress, traversal_arrays> arrays{};  // TraceParameters::traversal
  VkAccelerationStructureKHR structure = VK_NULL_HANDLE;   // at binding 1, if any
};

// A structure for a caller's own rays. Ids have no surveyed_bit, and all meshes that nodes share are placed.
class RayWalk {
 public:
  RayWalk() = default;
  virtual ~RayWalk() = default;
  RayWalk(const RayWalk&) = delete;
  RayWalk& operator=(const RayWalk&) = delete;

  virtual Shader own_rays() const = 0;  // own_rays.comp with the engine's own find.glsl
  virtual TraversalBinding binding() const = 0;
};

// Made for one scene on one device.
class Traversal {
 public:
  Traversal() = default;
  virtual ~Traversal() = default;
  Traversal(const Traversal&) = delete;
  Traversal& operator=(const Traversal&) = delete;

  // count.comp, scan.comp, sample_probe.comp and sample_trace.comp, compiled with the engine's own trace.glsl.
  struct TraceShaders {
    Shader count, scan, sample_probe, sample_trace;
  };
  virtual TraceShaders shaders() const = 0;

  using Binding = TraversalBinding;  // of its trace()
  virtual Binding binding() const = 0;

  // Returns true if, on every device, no ray passes between two triangles that share an edge.
  virtual bool is_watertight() const { return false; }

  // A kernel that runs before an exact count with skipping: one thread per listed tile, with a TilePush. It leaves
  // `bytes_per_tile` bytes per tile at TilePush::starts, which trace() receives as Starts.
  struct TilePass {
    Shader shader;
    std::uint32_t bytes_per_tile = 0;
  };
  virtual std::optional<TilePass> tile_pass() const { return std::nullopt; }

  // Takes new positions of the triangles of some runs; the scene is otherwise the one that it was built for, and shares
  // no meshes. Returns false, and changes nothing, if a new structure is better.
  virtual bool move(Commands&, const SceneData& /*scene*/, std::span<const KeptRun> /*moved*/) { return false; }
};

// An engine, as listed in make_tracer.cpp.
struct VulkanEngine {
  Engine engine;
  DeviceNeeds needs;
  std::unique_ptr<Traversal> (*build)(Device& device, Commands& commands, const TraversalScene& scene);
  // True if it stores meshes that nodes share once; other engines get every mesh in place.
  bool places_meshes = false;
  // Null: the engine traces no rays of a caller.
  std::unique_ptr<RayWalk> (*build_walk)(Device& device, Commands& commands, const TraversalScene& scene) = nullptr;
};

}  // namespace vantage::vulkan
