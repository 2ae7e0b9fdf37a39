// SPDX-License-Identifier: Apache-2.0
// A scene's triangles in Embree: one tree of those stored in place, and one tree for each shared mesh, which instances
// place.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "core/embree.hpp"
#include "scene/scene_data.hpp"
#include "scene/scene_difference.hpp"

namespace vantage {

class SceneTree {
 public:
  struct Filters {
    RTCFilterFunctionN intersect = nullptr, occluded = nullptr;
  };
  // Builds a tree over triangles `first` up to `end` of the scene, which is borrowed. Rays may start and end anywhere
  // (RTC_SCENE_FLAG_ROBUST). `what`: for messages. Throws Error: out_of_memory, device_failure.
  SceneTree(RTCDevice device, const SceneData& scene, std::uint32_t first, std::uint32_t end, const Filters& filters,
            const std::string& what);

  // Builds a tree over some runs of triangles of a scene that shares no meshes, by their numbers there (`other` is not
  // used). REQUIRES: at least one triangle.
  SceneTree(RTCDevice device, const SceneData& scene, std::span<const KeptRun> runs, const Filters& filters,
            const std::string& what);

  // Gives the tree's triangles the numbers of a later scene; triangles in no run are gone. REQUIRES: no shared meshes,
  // and a tree from triangle 0 on.
  void renumber(std::vector<KeptRun> numbers) noexcept;

  RTCScene get() const { return tree_.get(); }
  // Returns the tree for point queries: own triangles, and for each instance its box, with the instance's number.
  RTCScene for_points() const { return scene_.shares() ? boxes_.get() : tree_.get(); }
  bool is_box(unsigned geometry) const { return scene_.shares() && geometry == scene_.instances.size() + 1; }
  // Returns the tree of an instance's shared mesh; null if the instance is not in this tree.
  RTCScene mesh(std::size_t instance) const { return meshes_[instance]; }
  static constexpr std::uint32_t kInNone = 0xFFFFFFFFu;
  // Returns the number in the scene of a triangle that Embree names.
  std::uint32_t number(unsigned instance, unsigned primitive) const {
    return !scene_.shares()                      ? first_ + primitive
           : instance == RTC_INVALID_GEOMETRY_ID ? number_of_own(primitive)
                                                 : scene_.instances[instance].first_triangle + primitive;
  }
  // Does the same for a tree over runs, or after renumber(); kInNone: the triangle is gone.
  std::uint32_t number_by_runs(unsigned primitive) const;

 private:
  std::uint32_t number_of_own(std::uint32_t primitive) const;
  void add_triangles(RTCDevice device, RTCScene to, std::uint32_t first, std::uint32_t count, unsigned id,
                     const Filters& filters);
  void add_instances(RTCDevice device, std::uint32_t end, const Filters& filters);
  void add_boxes(RTCDevice device);

  const SceneData& scene_;
  std::uint32_t first_;
  std::vector<KeptRun> numbers_;       // of number_by_runs(), by Embree's
  std::vector<MeshInstance> own_;      // runs of triangles that are stored in place
  std::vector<embree::Scene> shared_;  // of each shared mesh
  std::vector<RTCScene> meshes_;       // one of them for each instance
  embree::Scene tree_, boxes_;
};

}  // namespace vantage
