// SPDX-License-Identifier: Apache-2.0
#include "conformance/agreement.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace vantage::test {

void compare_with_reference(const SceneData& scene, const std::vector<ReferenceHit>& reference,
                            const Tracer::RawChunk& chunk, std::size_t& undecided) {
  for (std::size_t k = 0; k < reference.size(); ++k) {
    const ReferenceHit& expected = reference[k];
    const bool hit = chunk.primitive[k] != ReferenceHit::none, wanted = expected.triangle != ReferenceHit::none;
    const auto mesh = [&](std::uint32_t triangle) {
      return triangle == ReferenceHit::none ? -1 : static_cast<int>(scene.mesh_of(triangle));
    };
    ASSERT_EQ(hit, std::isfinite(chunk.range[k])) << "ray " << k;
    if (mesh(chunk.primitive[k]) != mesh(expected.triangle) || chunk.voxel[k] != expected.voxel) {
      ++undecided;
      EXPECT_LT(std::min(expected.edge_distance, expected.face_distance), undecided_m)
          << "ray " << k << " at range " << chunk.range[k] << ", " << expected.range;
      continue;
    }
    if (!wanted) continue;
    if (chunk.primitive[k] != expected.triangle) {
      EXPECT_LT(std::min(expected.edge_distance, expected.gap), undecided_m) << "ray " << k;
      continue;
    }
    EXPECT_NEAR(chunk.range[k], expected.range, 2e-5) << "ray " << k;
    EXPECT_NEAR(chunk.position[k].x, expected.point.x, 2e-5) << "ray " << k;
    EXPECT_NEAR(chunk.position[k].y, expected.point.y, 2e-5) << "ray " << k;
    EXPECT_NEAR(chunk.position[k].z, expected.point.z, 2e-5) << "ray " << k;
    // Rounding that moves a ray moves a slanted hit along its surface, by the same over the cosine of incidence.
    const double diffuse = scene.meshes[scene.mesh_of(expected.triangle)].diffuse;
    const double shading = 1e-5 * std::clamp(diffuse / expected.reflectivity, 1.0, 10.0);
    EXPECT_NEAR(chunk.normal[k].x, expected.normal.x, shading) << "ray " << k;
    EXPECT_NEAR(chunk.normal[k].y, expected.normal.y, shading) << "ray " << k;
    EXPECT_NEAR(chunk.normal[k].z, expected.normal.z, shading) << "ray " << k;
    EXPECT_NEAR(chunk.reflectivity[k], expected.reflectivity, shading) << "ray " << k;
    if (testing::Test::HasFailure()) return;
  }
}

}  // namespace vantage::test
