// SPDX-License-Identifier: Apache-2.0
#include "conformance/sites.hpp"

#include <cmath>
#include <map>
#include <numbers>
#include <tuple>
#include <utility>

#include "scan/limit_model.hpp"
#include "scan/noise_model.hpp"
#include "scan/pattern.hpp"
#include "scene/positions.hpp"
#include "scene/shared_meshes.hpp"
#include "support/box.hpp"
#include "support/temporary_folder.hpp"
#include "vantage/built_in_scenes.hpp"

namespace vantage::test {
namespace {

using std::numbers::pi;

// Adds meshes to a scene in the survey frame. Only curved parts have normals.
class Builder {
 public:
  using Normals = std::vector<Float3>;

  void add(const std::string& name, Role role, double diffuse, const std::vector<Vec3>& positions,
           const std::vector<Triangle>& triangles, Normals normals = {}, std::uint32_t weight = 1) {
    normals.resize(positions.size());
    const auto base = static_cast<std::uint32_t>(raw_.positions.size());
    raw_.ranges.push_back(
        {static_cast<std::uint32_t>(raw_.triangles.size()), static_cast<std::uint32_t>(triangles.size()), 0});
    raw_.meshes.push_back({name, role, diffuse, static_cast<std::uint32_t>(triangles.size()), weight});
    for (const Vec3& p : positions) raw_.positions.push_back(to_glm(p));
    raw_.normals.insert(raw_.normals.end(), normals.begin(), normals.end());
    for (const Triangle& t : triangles) raw_.triangles.push_back({t[0] + base, t[1] + base, t[2] + base});
  }

  void box(const std::string& name, Role role, const Vec3& low, const Vec3& high, std::uint32_t weight = 1) {
    add(name, role, 0.6, box_corners(low, high), box_triangles, {}, weight);
  }

  // A grid of columns × rows quads over at(u, v), u and v in [0, 1].
  template <class At>
  void sheet(const std::string& name, Role role, double diffuse, int columns, int rows, const At& at) {
    std::vector<Vec3> p;
    Normals n;
    for (int j = 0; j <= rows; ++j) {
      for (int i = 0; i <= columns; ++i) {
        const auto [position, normal] = at(static_cast<double>(i) / columns, static_cast<double>(j) / rows);
        p.push_back(position);
        n.push_back({static_cast<float>(normal.x), static_cast<float>(normal.y), static_cast<float>(normal.z)});
      }
    }
    std::vector<Triangle> t;
    const auto index = [&](int i, int j) { return static_cast<std::uint32_t>(j * (columns + 1) + i); };
    for (int j = 0; j < rows; ++j) {
      for (int i = 0; i < columns; ++i) {
        t.push_back({index(i, j), index(i + 1, j), index(i + 1, j + 1)});
        t.push_back({index(i, j), index(i + 1, j + 1), index(i, j + 1)});
      }
    }
    add(name, role, diffuse, p, t, n);
  }

  // Makes the last mesh one of glass.
  void make_glass() { raw_.meshes.back().glass = true; }
  template <class At>
  void glass(const std::string& name, const At& at) {
    sheet(name, Role::blocking, 0.5, 1, 1, at);
    make_glass();
  }

  // All that was added, as one mesh.
  SharedMesh mesh() const {
    SharedMesh mesh;
    mesh.normals = raw_.normals;
    mesh.triangles = raw_.triangles;
    for (const glm::dvec3& p : raw_.positions) mesh.positions.push_back(to_float3(p));
    return mesh;
  }
  // Places a mesh, which is stored once for all that add it.
  void shared(const std::string& name, double diffuse, const SharedMesh& mesh, const std::vector<MeshPlace>& places) {
    if (raw_.shared.empty()) raw_.shared.push_back(mesh);
    raw_.ranges.push_back({static_cast<std::uint32_t>(raw_.triangles.size()), 0, 0});
    raw_.meshes.push_back({name, Role::surveyed, diffuse});
    raw_.placed.resize(raw_.ranges.size());
    for (const MeshPlace& place : places) raw_.placed.back().push_back({0, place});
  }

  std::shared_ptr<const SceneData> finish() {
    if (!raw_.placed.empty()) raw_.placed.resize(raw_.ranges.size());
    return finish_scene(std::move(raw_), "the site");
  }

 private:
  RawScene raw_;
};

// A tank that needs fewer points, a boiler, a tilted pipe and a cabinet of the largest weight, on uneven ground, behind
// a blocking fence; before them two panes of glass, one slanted, and a solid one.
std::shared_ptr<const SceneData> boiler_house() {
  Builder b;
  b.sheet("ground", Role::blocking, 0.3, 24, 24, [](double u, double v) {
    const double x = 16 * u - 8, y = 16 * v - 8;
    return std::pair(Vec3{x, y, 0.13 * std::sin(0.7 * x) * std::cos(0.9 * y) - 0.2}, Vec3{});
  });
  b.sheet("boiler", Role::surveyed, 0.8, 28, 14, [](double u, double v) {
    const Vec3 n{std::sin(pi * v) * std::cos(2 * pi * u), std::sin(pi * v) * std::sin(2 * pi * u), std::cos(pi * v)};
    return std::pair(Vec3{1.7, 0.4, 1.31} + n * 1.1, n);
  });
  b.sheet("tank", Role::surveyed, 0.24, 20, 3, [](double u, double v) {
    const Vec3 n{std::cos(2 * pi * u), std::sin(2 * pi * u), 0};
    return std::pair(Vec3{-2.1, 1.2, 0.1 + 2.3 * v} + n * 0.83, n);
  });
  b.sheet("pipe", Role::surveyed, 0.5, 10, 6, [](double u, double v) {
    const Vec3 n{0, std::cos(2 * pi * u), std::sin(2 * pi * u)};
    return std::pair(Vec3{-3 + 6.1 * v, -1.4 + 0.7 * v, 2.07 + 0.31 * v} + n * 0.11, n);
  });
  b.box("cabinet", Role::surveyed, {-0.63, -2.71, 0.02}, {0.42, -2.04, 1.57}, 255);
  b.box("fence", Role::blocking, {3.2, -3.1, 0}, {3.25, 3.3, 1.1});
  b.glass("pane", [](double u, double v) { return std::pair(Vec3{4.1, 4 * u - 1.7, 3 * v}, Vec3{}); });
  b.glass("slanted pane", [](double u, double v) { return std::pair(Vec3{u - 1.3, 1.1 * u - 0.3, 2.8 * v}, Vec3{}); });
  b.box("block", Role::blocking, {-3.62, -3.4, 0.2}, {-3.6, -1.2, 2.6});
  b.make_glass();
  return b.finish();
}

// A pump on a wavy floor, stored once and placed upright, turned, tilted and larger, and mirrored; and a second mesh
// among them that is stored where it stands.
std::shared_ptr<const SceneData> pump_hall() {
  Builder b;
  b.sheet("floor", Role::surveyed, 0.4, 12, 12, [](double u, double v) {
    const double x = 14 * u - 7, y = 14 * v - 7;
    return std::pair(Vec3{x, y, 0.09 * std::sin(0.8 * x) * std::cos(0.6 * y) - 0.15}, Vec3{});
  });
  Builder pump;
  pump.sheet("pump", Role::surveyed, 0.7, 18, 9, [](double u, double v) {
    const Vec3 n{std::sin(pi * v) * std::cos(2 * pi * u), std::sin(pi * v) * std::sin(2 * pi * u), std::cos(pi * v)};
    return std::pair(Vec3{0.2, 0.1, 0.83} + Vec3{0.9 * n.x, 0.55 * n.y, 0.7 * n.z}, n);
  });
  pump.box("base", Role::surveyed, {-0.7, -0.5, 0.03}, {0.9, 0.6, 0.21});
  const auto place = [](double x, double y, double z, double turn, double tilt, const glm::dvec3& scale) {
    const glm::dquat turned = glm::angleAxis(turn, glm::dvec3(0, 0, 1)) * glm::angleAxis(tilt, glm::dvec3(1, 0, 0));
    glm::dmat4 matrix(glm::mat3_cast(turned));
    for (int c = 0; c < 3; ++c) matrix[c] = matrix[c] * scale[c];
    matrix[3] = glm::dvec4(x, y, z, 1);
    return place_of(matrix);
  };
  b.shared("pumps", 0.7, pump.mesh(),
           {place(2.6, 0.4, 0.02, 0, 0, {1, 1, 1}), place(-2.31, 1.17, 0.1, pi / 2, 0, {1, 1, 1}),
            place(0.43, 3.3, 0.4, 0.77, 0.31, {1.3, 0.8, 1.1}), place(-0.8, -3.4, 0.05, 2.1, 0, {-1, 1, 1})});
  b.box("cabinet", Role::surveyed, {-4.63, -2.71, 0.22}, {-4.02, -1.04, 1.57}, 255);
  b.shared("pump in the corner", 0.5, pump.mesh(), {place(4.9, -4.2, 0.11, 4, 0, {0.9, 0.9, 0.9})});
  return b.finish();
}

std::shared_ptr<const SceneData> built_in(const std::string& name) {
  const TemporaryFolder folder;
  const auto file = folder / "scene.glb";
  write_built_in_scene(name, 0, file);
  return std::make_shared<const SceneData>(Scene::load(file).data());
}

// Each mesh has other limits, some of which a scanner a few metres away meets and some not.
LimitModel some_limits(SceneData scene, Scanner scanner) {
  scanner.beam_divergence = Angle::radians(5e-4);
  scanner.exit_diameter_m = 0.006;
  scanner.detection_range_m = 6;
  scanner.detection_reflectivity = 0.5;
  scanner.dropout = 0.07;
  for (std::size_t m = 0; m < scene.meshes.size(); ++m) {
    scene.meshes[m].detail_m = m % 2 == 0 ? 0.0083 : 0.0099;
    scene.meshes[m].accuracy_m = m % 3 == 0 ? 0.0004 : 0;
  }
  return make_limit_model(scene, scanner, {.max_incidence = Angle::degrees(50), .seed = 4711});
}

TestSite make_site(const std::string& name, std::shared_ptr<const SceneData> scene, double user_size_m,
                   double step_degrees, const std::vector<Vec3>& heads) {
  TestSite site;
  site.name = name;
  site.scene = std::move(scene);
  VoxelGrid grid = VoxelGrid::build(*site.scene, user_size_m);
  std::vector<double> spacings_m;
  for (const MeshInfo& mesh : site.scene->meshes) spacings_m.push_back(mesh.name == "tank" ? 0.031 : 0.01);
  grid.set_point_weights(*point_weights(*site.scene, grid, spacings_m, {}));
  site.grid = std::make_shared<const VoxelGrid>(std::move(grid));
  Scanner scanner;
  scanner.azimuth_step = scanner.zenith_step = Angle::degrees(step_degrees);
  scanner.heading = Angle::degrees(17);
  scanner.min_range_m = 0.4;
  scanner.max_range_m = 60;
  scanner.noise = rtc360_noise();
  site.pattern = std::make_shared<const RayPattern>(make_pattern(scanner));
  site.noise = std::make_shared<const NoiseModel>(make_noise_model(scanner, 4711));
  LimitModel limits = some_limits(*site.scene, scanner);
  limits.noise = site.noise;  // engines keep one table, and the noise of these sites is that of every echo
  site.limits = std::make_shared<const LimitModel>(std::move(limits));
  scanner.noise = {};
  site.no_noise = std::make_shared<const NoiseModel>(make_noise_model(scanner, 4711));
  for (const Vec3& head : heads) {
    const Vec3 local = head - site.scene->origin;
    site.stations.push_back({{static_cast<float>(local.x), static_cast<float>(local.y), static_cast<float>(local.z)},
                             static_cast<std::uint32_t>(site.stations.size())});
  }
  return site;
}

}  // namespace

const std::vector<ReferenceHit>& TestSite::reference(std::size_t station, bool noisy, bool limited) const {
  static std::map<std::tuple<std::string, std::size_t, bool, bool>, std::vector<ReferenceHit>> made;
  std::vector<ReferenceHit>& hits = made[{name, station, noisy, limited}];
  if (hits.empty()) hits = ReferenceTracer(trace_scene(noisy, limited)).scan(stations[station]);
  return hits;
}

const std::vector<TestSite>& sites() {
  static const std::vector<TestSite> made = [] {
    std::vector<TestSite> all;
    all.push_back(make_site("three-walls", built_in("three-walls"), 0.1, 0.5,
                            {{0, 0, 1.5}, {1.3, -2.1, 1.7}, {4.1, 12.3, 2.3}, {-3.7, 6.2, 0.9}}));
    all.push_back(make_site("four-walls", built_in("four-walls"), 0.1, 0.5,
                            {{0.21, -8.07, 1.5}, {8.11, 0.4, 1.5}, {1.1, 0.7, 1.5}, {-8.3, -8.2, 1.5}}));
    all.push_back(make_site("boiler-house", boiler_house(), 0.06, 0.6,
                            {{0.11, -0.52, 1.61}, {4.92, 0.31, 1.83}, {-4.3, -3.2, 1.4}, {1.7, 0.4, 1.31}}));
    all.push_back(make_site("pump-hall", pump_hall(), 0.12, 0.6,
                            {{0.13, 0.22, 1.63}, {-5.1, 4.7, 1.81}, {5.2, 1.2, 1.44}, {2.7, 0.52, 0.86}}));
    return all;
  }();
  return made;
}

}  // namespace vantage::test
