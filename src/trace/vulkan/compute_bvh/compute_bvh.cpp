// SPDX-License-Identifier: Apache-2.0
#include "trace/vulkan/compute_bvh/compute_bvh.hpp"

#include <optional>
#include <utility>
#include <vector>

#include "embedded_shaders.hpp"
#include "trace/vulkan/compute_bvh/bvh.hpp"
#include "trace/vulkan/compute_bvh/moving_bvh.hpp"

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
  // Decides the first steps down the tree, common to all rays of a tile, only once.
  std::optional<TilePass> tile_pass() const override {
    return TilePass{shaders::tile_starts, tile_starts * sizeof(TileStart)};
  }

  // The first move reads the tree back; scenes that do not move need no memory on the host.
  bool move(Commands& commands, const SceneData& scene, std::span<const KeptRun> moved) override {
    if (moved.empty()) return true;
    if (!moving_) {
      std::vector<BvhNode> nodes(nodes_.size() / sizeof(BvhNode));
      std::vector<BvhTriangle> triangles(triangles_.size() / sizeof(BvhTriangle));
      commands.download(nodes_, nodes.data(), std::span(nodes).size_bytes());
      commands.download(triangles_, triangles.data(), std::span(triangles).size_bytes());
      moving_.emplace(std::move(nodes), triangles);
    }
    const std::optional<MovingBvh::Change> change = moving_->move(scene.positions, scene.triangles, moved);
    if (!change) return false;
    commands.scatter<BvhNode>(nodes_, change->nodes, change->node_at);
    commands.scatter<BvhTriangle>(triangles_, change->triangles, change->triangle_at);
    moving_->take(*change);
    return true;
  }

 private:
  Buffer nodes_, triangles_, placements_;
  std::optional<MovingBvh> moving_;
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
