// SPDX-License-Identifier: Apache-2.0
// Small scenes in the local frame, for the trace tests.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "core/philox.hpp"
#include "scan/noise_model.hpp"
#include "scan/pattern.hpp"
#include "scene/scene_data.hpp"
#include "trace/tracer.hpp"

namespace vantage::test {

class SceneBuilder {
 public:
  // A mesh of separate triangles, three corners each.
  SceneBuilder& mesh(Role role, const std::vector<Float3>& corners, double diffuse = 0.5) {
    const auto first = static_cast<std::uint32_t>(scene_.triangles.size()),
               count = static_cast<std::uint32_t>(corners.size() / 3);
    scene_.ranges.push_back({first, count, 0});
    scene_.meshes.push_back({"mesh", role, diffuse, count});
    for (std::uint32_t k = 0; k < corners.size(); ++k) {
      if (k % 3 == 0) {
        const auto base = static_cast<std::uint32_t>(scene_.positions.size());
        scene_.triangles.push_back({base, base + 1, base + 2});
      }
      scene_.positions.push_back(corners[k]);
      scene_.local_bounds.extend({corners[k].x, corners[k].y, corners[k].z});
    }
    return *this;
  }
  std::shared_ptr<const SceneData> finish() {
    scene_.materials.emplace_back();
    return std::make_shared<const SceneData>(std::move(scene_));
  }

 private:
  SceneData scene_;
};

// Two triangles over the parallelogram at `corner`, spanned by `u` and `v`.
inline std::vector<Float3> quad(const Float3& corner, const Float3& u, const Float3& v) {
  const auto at = [&](float a, float b) {
    return Float3{corner.x + a * u.x + b * v.x, corner.y + a * u.y + b * v.y, corner.z + a * u.z + b * v.z};
  };
  return {at(0, 0), at(1, 0), at(1, 1), at(0, 0), at(1, 1), at(0, 1)};
}

inline float between(RandomStream& random, double low, double high) {
  return static_cast<float>(low + (high - low) * random.uniform());
}

inline TraceScene trace_scene(std::shared_ptr<const SceneData> scene, const Scanner& scanner, double user_size_m,
                              std::uint64_t seed = 1) {
  TraceScene result;
  result.grid = std::make_shared<const VoxelGrid>(VoxelGrid::build(*scene, user_size_m));
  result.scanners.push_back({std::make_shared<const RayPattern>(make_pattern(scanner)),
                             std::make_shared<const NoiseModel>(make_noise_model(scanner, seed))});
  result.scene = std::move(scene);
  return result;
}

}  // namespace vantage::test
