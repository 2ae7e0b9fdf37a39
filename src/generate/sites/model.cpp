// SPDX-License-Identifier: Apache-2.0
#include "generate/sites/model.hpp"

namespace vantage::sites {

built_in::Model model_of(const Site& site) {
  built_in::Model model;
  for (const Part& part : site.parts) {
    built_in::Part made{.name = part.name, .role = {}, .colour = part.colour};
    for (const Vec3& p : part.positions)
      made.mesh.positions.push_back({static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z)});
    for (const auto& triangle : part.triangles)
      made.mesh.indices.insert(made.mesh.indices.end(), triangle.begin(), triangle.end());
    model.parts.push_back(std::move(made));
  }
  return model;
}

}  // namespace vantage::sites
