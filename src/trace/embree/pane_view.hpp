// SPDX-License-Identifier: Apache-2.0
// Faces of glass as seen from one head. Decides without a tree which rays certainly pass a face, and which certainly
// pass none.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "scene/scene_data.hpp"
#include "trace/embree/hits.hpp"
#include "trace/embree/planes.hpp"

namespace vantage {

class PaneView {
 public:
  // Most faces of a view; with more, a tree finds the faces of a ray faster.
  static constexpr std::size_t kMostFaces = 2048;

  // Shares ownership of both. REQUIRES: the scene has glass.
  PaneView(std::shared_ptr<const SceneData> scene, std::shared_ptr<const Planes> planes, const Float3& head);

  // Crossings of each hit's ray before `end`, sorted by distance and triangle as in RayCaster::crossings().
  struct Crossings {
    static constexpr std::uint32_t kMost = 8, kUnsure = kMost + 1;
    std::uint32_t count[Hits::kCapacity];  // number, or kUnsure: ask RayCaster
    float t[Hits::kCapacity][kMost];
    std::uint32_t triangle[Hits::kCapacity][kMost];
  };
  // Returns false if certainly no ray has a crossing. `end` has whole vectors, as hits do.
  bool find(const Hits& hits, const float* end, Crossings& found) const;

 private:
  struct Face {
    float x[3], y[3], z[3], doubt[3];  // edges, as DrawnTriangle has them; the first is the band's of a flat one
    Planes::Seen plane;
    std::uint32_t triangle;
    bool flat, certain;
  };
  std::shared_ptr<const SceneData> scene_;
  std::shared_ptr<const Planes> planes_;
  Float3 head_;
  std::vector<Face> faces_;
  // Directions to the middles of the faces, with bounds around these, in whole vectors.
  std::vector<float> x_, y_, z_, cosine_, sine_, nearest_;
};

}  // namespace vantage
