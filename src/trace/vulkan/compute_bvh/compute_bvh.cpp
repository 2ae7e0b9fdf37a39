// SPDX-License-Identifier: Apache-2.0
#include "trace/vulkan/compute_bvh/compute_bvh.hpp"

#include "embedded_shaders.hpp"
#include "trace/vulkan/compute_bvh/bvh.hpp"

namespace vantage::vulkan {
namespace {

class ComputeBvh final : public Traversal, public RayWalk {
 public:
  ComputeBvh(Device& device, Commands& commands, const TraversalScene& scene) {
    const Bvh bvh = build_placed_bvh(scene.positions, scene.triangles, scene.ids, scene.placed);
    nodes_ = make_device_buffer<BvhNode>(device, commands, bvh.nodes, "BVH nodes");
    triangles_ = make_device_buffer<BvhTriangle>(device, commands, bvh.triangles, "BVH triangles");
    if (!bvh.placements.empty())
      placements_ = make_device_buffer<BvhPlacement>(device, commands, bvh.placements, "BVH placements");
  }

  TraceShaders shaders() const override {
    return {shaders::count_compute_bvh, shaders::scan_compute_bvh, shaders::sample_probe_compute_bvh,
            shaders::sample_trace_compute_bvh};
  }
  Binding binding() const override {
    Binding binding;
    binding.arrays[bvh_nodes_array] = nodes_.address();
    binding.arrays[bvh_triangles_array] = triangles_.address();
    binding.arrays[bvh_placements_array] = placements_.address();
    return binding;
  }
  Shader own_rays() const override { return shaders::own_rays_compute_bvh; }
  bool is_watertight() const override { return true; }  // lib/triangle_hit.glsl
  // Decides common steps down the tree once for all rays of a tile.
  std::optional<TilePass> tile_pass() const override {
    return TilePass{shaders::tile_starts, tile_starts * sizeof(TileStart)};
  }

 private:
  Buffer nodes_, triangles_, placements_;
};

}  // namespace

const VulkanEngine compute_bvh_engine{
    Engine::compute_bvh, DeviceNeeds::compute,
    [](Device& device, Commands& commands, const TraversalScene& scene) -> std::unique_ptr<Traversal> {
      return std::make_unique<ComputeBvh>(device, commands, scene);
    },
    true,
    [](Device& device, Commands& commands, const TraversalScene& scene) -> std::unique_ptr<RayWalk> {
      return std::make_unique<ComputeBvh>(device, commands, scene);
    }};

}  // namespace vantage::vulkan
