// SPDX-License-Identifier: Apache-2.0
// The seam between Vulkan engines: how one of them builds, binds and walks a structure over the triangles of a scene.
// VulkanTracer does all the rest, alike for every engine. docs/contributing.md tells how to add one.
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <span>

#include "scene/scene_data.hpp"
#include "shared/trace_types.h"
#include "trace/vulkan/commands.hpp"
#include "vantage/trace.hpp"

namespace vantage::vulkan {

// What a structure is built over. Borrowed for the call.
struct TraversalScene {
  std::span<const Float3> positions;
  std::span<const Triangle> triangles;
  std::span<const std::uint32_t> ids;  // of the triangles, for Hit::id: numbers, with surveyed_bit where they count
  bool sort = true;                    // as TraceScene::sort_triangles
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

  // What its trace() reads.
  struct Binding {
    std::array<VkDeviceAddress, traversal_arrays> arrays{};  // TraceParameters::traversal
    VkAccelerationStructureKHR structure = VK_NULL_HANDLE;   // at binding 1, where there is one
  };
  virtual Binding binding() const = 0;

  // Whether no ray passes between two triangles that share an edge, on any device.
  virtual bool is_watertight() const { return false; }

  // A kernel that goes before an exact count with skipping: a thread a listed tile, told a TilePush. It leaves so many
  // bytes a tile at TilePush::starts, where trace() finds them again as Starts.
  struct TilePass {
    Shader shader;
    std::uint32_t bytes_per_tile = 0;
  };
  virtual std::optional<TilePass> tile_pass() const { return std::nullopt; }
};

// An engine, as make_tracer.cpp lists it.
struct VulkanEngine {
  Engine engine;
  Needs needs;
  std::unique_ptr<Traversal> (*build)(Device& device, Commands& commands, const TraversalScene& scene);
};

}  // namespace vantage::vulkan
