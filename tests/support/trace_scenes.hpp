// SPDX-License-Identifier: Apache-2.0
// Small scenes in the local frame, for the trace tests.
#pragma once

#include <cmath>
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
    const auto count = static_cast<std::uint32_t>(corners.size() / 3);
    add_range(role, diffuse, count);
    runs_.push_back({next_ - count, count, static_cast<std::uint32_t>(scene_.triangles.size())});
    store(corners);
    for (const Float3& corner : corners) scene_.local_bounds.extend(widen(corner));
    return *this;
  }
  // A mesh of separate triangles in its own frame, which is stored once, at each of the places.
  SceneBuilder& placed(Role role, const std::vector<Float3>& corners, const std::vector<MeshPlace>& places,
                       double diffuse = 0.5) {
    const auto count = static_cast<std::uint32_t>(corners.size() / 3);
    for (const MeshPlace& place : places) {
      add_range(role, diffuse, count);
      const auto number = static_cast<std::uint32_t>(scene_.places.size());
      runs_.push_back({next_ - count, count, static_cast<std::uint32_t>(shared_.size()), number});  // until finish()
      scene_.places.push_back(place);
      for (const Float3& corner : corners) scene_.local_bounds.extend(widen(scene_.placed(place, corner)));
    }
    shared_.push_back(corners);
    return *this;
  }
  // Gives every corner so far the normal of its triangle, moved by at most `most` along each axis.
  SceneBuilder& leaning_normals(RandomStream& random, double most) {
    scene_.normals.resize(scene_.positions.size());
    for (const auto& triangle : scene_.triangles) {
      const auto at = [&](std::size_t k) { return widen(scene_.positions[triangle[k]]); };
      const Vec3 normal = cross(at(1) - at(0), at(2) - at(0));
      for (const std::uint32_t corner : triangle) {
        const auto lean = [&] { return most * (2 * random.uniform() - 1); };
        const Vec3 moved = normal * (1 / std::sqrt(dot(normal, normal))) + Vec3{lean(), lean(), lean()};
        scene_.normals[corner] = narrow(moved * (1 / std::sqrt(dot(moved, moved))));
      }
    }
    return *this;
  }
  std::shared_ptr<const SceneData> finish() {
    std::vector<std::uint32_t> first_stored;
    for (const std::vector<Float3>& corners : shared_) {
      first_stored.push_back(static_cast<std::uint32_t>(scene_.triangles.size()));
      store(corners);
    }
    for (MeshInstance& run : runs_)
      if (run.place != MeshInstance::kNoPlace) run.first_stored = first_stored[run.first_stored];
    if (!shared_.empty()) scene_.set_instances(std::move(runs_));
    scene_.materials.emplace_back();
    return std::make_shared<const SceneData>(std::move(scene_));
  }

 private:
  void add_range(Role role, double diffuse, std::uint32_t count) {
    scene_.ranges.push_back({next_, count, 0});
    scene_.meshes.push_back({"mesh", role, diffuse, count});
    next_ += count;
  }
  void store(const std::vector<Float3>& corners) {
    for (std::uint32_t k = 0; k < corners.size(); ++k) {
      if (k % 3 == 0) {
        const auto base = static_cast<std::uint32_t>(scene_.positions.size());
        scene_.triangles.push_back({base, base + 1, base + 2});
      }
      scene_.positions.push_back(corners[k]);
    }
  }

  SceneData scene_;
  std::uint32_t next_ = 0;  // number of the next triangle
  std::vector<MeshInstance> runs_;
  std::vector<std::vector<Float3>> shared_;
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
