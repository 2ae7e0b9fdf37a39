// SPDX-License-Identifier: Apache-2.0
// Makes a scene from arrays, evaluates a station in it, moves one of its meshes and evaluates it again:
//   example_own_scene
#include <cstdio>
#include <string>
#include <vantage/vantage.hpp>

namespace {

// A closed box between two corners.
vantage::SceneMesh box(const std::string& name, const vantage::Vec3& low, const vantage::Vec3& high,
                       vantage::Role role) {
  vantage::SceneMesh mesh{.name = name, .role = role};
  for (int i = 0; i < 8; ++i)
    mesh.positions.push_back({i & 1 ? high.x : low.x, i & 2 ? high.y : low.y, i & 4 ? high.z : low.z});
  mesh.triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                    {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  return mesh;
}

double coverage_of(const vantage::Scene& scene) {
  vantage::Scanner scanner;
  scanner.azimuth_step = scanner.zenith_step = vantage::Angle::degrees(0.25);
  vantage::Simulator simulator(scene, scanner, {.user_size_m = 0.1, .point_spacing_m = 0.05});
  const vantage::Network network{{.position = {0, 0, 1.6}}};
  return vantage::coverage(simulator.evaluate(network), simulator.goal_density());
}

}  // namespace

int main() {
  try {
    vantage::SceneBuilder builder;
    builder.add(box("floor", {-6, -5, -0.2}, {6, 5, 0}, vantage::Role::blocking));
    builder.add(box("wall", {-6, 4, 0.001}, {6, 4.2, 3}, vantage::Role::surveyed));
    const std::size_t crate = builder.add(box("crate", {-1, 2, 0.001}, {1, 3, 2.2}, vantage::Role::blocking));

    std::printf("crate before the wall: coverage %.3f\n", coverage_of(builder.build()));
    builder.move(crate, {.translation = {0, -4, 0.01}});
    const vantage::Scene moved = builder.build();
    std::printf("crate out of the way: coverage %.3f%s\n", coverage_of(moved),
                builder.rebuilt_all() ? "" : ", the other meshes kept");
    return 0;
  } catch (const vantage::Error& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}
