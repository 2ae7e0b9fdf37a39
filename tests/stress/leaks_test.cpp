// SPDX-License-Identifier: Apache-2.0
#include "stress/leaks.hpp"

#include "stress/engine_suite.hpp"

namespace vantage::test {
namespace {

using Leakage = EngineSuite;

// compute_bvh must be watertight. Embree's and the driver's leaks are bounded, so that a change for the worse shows.
TEST_P(Leakage, RaysAtEdgesAndVerticesStayInside) {
  const bool tight = GetParam().engine == Engine::compute_bvh;
  for (const ClosedMesh& mesh : closed_meshes()) {
    const Leaks leaks = count_leaks(GetParam(), mesh, 100'000);
    const double most = mesh.name.starts_with("shaft") ? 0.04 : 0.01;  // walls seen at a small angle leak most
    const auto bound = [&](std::uint64_t rays) { return tight ? 0.0 : most * static_cast<double>(rays); };
    EXPECT_GT(leaks.edge_rays, 40'000u);
    EXPECT_GT(leaks.vertex_rays, 40'000u);
    EXPECT_LE(static_cast<double>(leaks.edge_escapes), bound(leaks.edge_rays)) << mesh.name;
    EXPECT_LE(static_cast<double>(leaks.vertex_escapes), bound(leaks.vertex_rays)) << mesh.name;
  }
}
VANTAGE_EVERY_ENGINE(Leakage);

}  // namespace
}  // namespace vantage::test
