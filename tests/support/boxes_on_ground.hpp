// SPDX-License-Identifier: Apache-2.0
// A site of one mesh at several places.
#pragma once

#include <string>
#include <vector>

#include "support/box.hpp"
#include "support/glb_builder.hpp"

namespace vantage::test {

// Boxes of 1 m: one on the ground, one that touches its side and hovers, one turned by a right angle, one turned askew,
// a mirrored one, and one with legs under the ground.
inline GlbBuilder boxes_on_ground() {
  GlbBuilder builder;
  builder.json["asset"]["extras"]["vantage"] = nlohmann::json::object();
  std::vector<float> corners;
  const auto box = box_corners({-0.5, 0, -0.5}, {0.5, 1, 0.5});
  for (const auto& t : box_triangles)
    for (const std::uint32_t v : t)
      for (const double c : {box[v].x, box[v].y, box[v].z}) corners.push_back(static_cast<float>(c));
  const int mesh = builder.mesh({{"attributes", {{"POSITION", builder.positions(corners)}}}});
  const std::vector<nlohmann::json> places{{{"translation", {0, 0, 0}}},
                                           {{"translation", {1, 0.4, 0.3}}},
                                           {{"translation", {0, 0, 4}}, {"rotation", {0, 0.7071068, 0, 0.7071068}}},
                                           {{"translation", {4, 0, 3}}, {"rotation", {0, 0.2588190, 0, 0.9659258}}},
                                           {{"translation", {-4, 0, -3}}, {"scale", {-1.5, 1, 1}}},
                                           {{"translation", {-6, -0.5, 0}}}};
  for (std::size_t k = 0; k < places.size(); ++k) {
    nlohmann::json node = places[k];
    node["name"] = "box " + std::to_string(k), node["mesh"] = mesh;
    builder.node(node);
  }
  const int ground =
      builder.mesh({{"attributes",
                     {{"POSITION", builder.positions({-8, 0, -8, -8, 0, 9, 9, 0, -8, 9, 0, -8, -8, 0, 9, 9, 0, 9})}}}});
  builder.node({{"name", "ground"}, {"mesh", ground}});
  return builder;
}

}  // namespace vantage::test
