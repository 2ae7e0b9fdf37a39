// SPDX-License-Identifier: Apache-2.0
#include "conformance/brute_force/brute_force.hpp"

#include <algorithm>

#include "embedded_shaders.hpp"

namespace vantage::test {
namespace {

using namespace vulkan;

constexpr std::size_t fan = 8;  // triangles per pack, packs per crate; as in trace.glsl

struct Corners {
  Float3 low, high;
};

class BruteForce final : public Traversal {
 public:
  BruteForce(Device& device, Commands& commands, const TraversalScene& scene) {
    std::vector<Float3> corners;
    std::vector<Corners> boxes;
    std::vector<std::uint32_t> ids;
    // The last crate is filled with copies of the last triangle, which changes no hit.
    const std::size_t n = scene.triangles.size(), crates = (n + fan * fan - 1) / (fan * fan);
    for (std::size_t k = 0; k < crates * fan * fan; ++k) {
      const std::size_t t = std::min(k, n - 1);
      const Float3& first = scene.positions[scene.triangles[t][0]];
      if (k % (fan * fan) == 0) boxes.push_back({first, first});
      if (k % fan == 0) boxes.push_back({first, first});
      for (const std::uint32_t vertex : scene.triangles[t]) {
        corners.push_back(scene.positions[vertex]);
        extend(boxes.back(), corners.back());
        extend(boxes[k / (fan * fan) * (fan + 1)], corners.back());
      }
      ids.push_back(scene.ids[t]);
    }
    ids.push_back(no_primitive);
    corners_ = make_device_buffer<Float3>(device, commands, corners, "corners");
    boxes_ = make_device_buffer<Corners>(device, commands, boxes, "boxes");
    ids_ = make_device_buffer<std::uint32_t>(device, commands, ids, "triangle ids");
  }

  TraceShaders shaders() const override {
    return {shaders::count_brute_force, shaders::scan_brute_force, shaders::sample_probe_brute_force,
            shaders::sample_trace_brute_force};
  }
  Binding binding() const override { return {{corners_.address(), boxes_.address(), ids_.address()}, VK_NULL_HANDLE}; }

 private:
  static void extend(Corners& box, const Float3& p) {
    box.low = {std::min(box.low.x, p.x), std::min(box.low.y, p.y), std::min(box.low.z, p.z)};
    box.high = {std::max(box.high.x, p.x), std::max(box.high.y, p.y), std::max(box.high.z, p.z)};
  }

  Buffer corners_, boxes_, ids_;
};

}  // namespace

const VulkanEngine brute_force_engine{
    static_cast<Engine>(1000),  // engines of the library have an enumerator
    DeviceNeeds::compute,
    [](Device& device, Commands& commands, const TraversalScene& scene) -> std::unique_ptr<Traversal> {
      return std::make_unique<BruteForce>(device, commands, scene);
    }};

}  // namespace vantage::test
