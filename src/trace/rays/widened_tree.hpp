// SPDX-License-Identifier: Apache-2.0
// Boxes around a scene's triangles in Embree, for queries that decide hits in double precision. Embree's rays are
// rounded to float, so the boxes are widened by more than all roundings of a ray together.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "core/embree.hpp"
#include "scene/scene_data.hpp"

namespace vantage {

class WidenedTree {
 public:
  // Shares ownership of `scene`. Throws Error: out_of_memory, device_failure.
  explicit WidenedTree(std::shared_ptr<const SceneData> scene);

  // A query along a ray. Embree calls take() with the number of each triangle whose box the ray enters before `reach`.
  class Query {
   public:
    virtual ~Query() = default;
    // Returns the distance, in metres from the ray's origin, beyond which nothing matters any more.
    virtual double take(std::uint32_t triangle) = 0;
  };
  // The relevant part of a ray: within the scene's box and between the ray's own ends. Nothing if it is empty.
  struct Way {
    double begin, end;  // metres from the origin
  };
  std::optional<Way> way_of(const Vec3& origin, const Vec3& unit, double from, double reach) const;
  double size() const { return size_; }  // of the scene, metres

  // REQUIRES: an origin within reach of the scene, local frame; a unit direction; 0 <= from < reach.
  void run(const Vec3& origin, const Vec3& unit, double from, double reach, Query& query) const;

 private:
  // Triangles with boxes of one widening: a run as stored.
  struct Boxes {
    const SceneData* scene;
    std::uint32_t first_stored;
    double widening;
  };

  void add_boxes(RTCScene to, const MeshInstance& run, double widening, unsigned id);
  void add_shared_meshes();

  std::shared_ptr<const SceneData> scene_;
  std::vector<MeshInstance> runs_;  // a geometry or an instance each, with the run's index as its number
  double size_, widening_;          // of the scene, metres
  embree::Device device_;
  std::vector<std::unique_ptr<Boxes>> boxes_;
  std::vector<embree::Scene> shared_;
  embree::Scene tree_;
};

}  // namespace vantage
