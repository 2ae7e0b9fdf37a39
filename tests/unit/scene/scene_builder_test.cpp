// SPDX-License-Identifier: Apache-2.0
// Scenes from arrays and from memory equal those from files, and changed scenes equal newly built ones.
#include "vantage/scene_builder.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "scene/scene_data.hpp"
#include "support/glb_builder.hpp"
#include "support/temporary_folder.hpp"
#include "vantage/error.hpp"

namespace vantage {
namespace {

// A closed box with float corners.
SceneMesh box(const std::string& name, const Vec3& low, const Vec3& size, std::optional<Role> role = {}) {
  SceneMesh mesh{.name = name, .role = role};
  for (int i = 0; i < 8; ++i)
    mesh.positions.push_back(
        {low.x + (i & 1 ? size.x : 0), low.y + (i & 2 ? size.y : 0), low.z + (i & 4 ? size.z : 0)});
  mesh.triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                    {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  return mesh;
}

std::vector<SceneMesh> room() {
  std::vector<SceneMesh> meshes{box("floor", {-8, -8, -0.25}, {16, 16, 0.25}), box("crate", {1, 2, 0.5}, {1, 1, 1}),
                                box("shelf", {-3, 2, 0.125}, {2, 0.5, 2})};
  meshes[1].diffuse = 0.25, meshes[1].weight = 7;
  meshes[2].colour = {0.5F, 0.25F, 0.125F, 1};
  return meshes;
}

Scene built(const std::vector<SceneMesh>& meshes) {
  SceneBuilder builder;
  for (const SceneMesh& mesh : meshes) builder.add(mesh);
  return builder.build();
}

// The same meshes as a glTF file, Y up.
test::GlbBuilder as_gltf(const std::vector<SceneMesh>& meshes) {
  test::GlbBuilder glb;
  for (const SceneMesh& mesh : meshes) {
    std::vector<float> positions;
    for (const Vec3& p : mesh.positions)
      for (const double v : {p.x, p.z, -p.y}) positions.push_back(static_cast<float>(v));
    std::vector<std::uint32_t> indices;
    for (const auto& t : mesh.triangles) indices.insert(indices.end(), t.begin(), t.end());
    const int points = glb.positions(positions), corners = glb.accessor(indices, 5125, "SCALAR");
    const int material = static_cast<int>(glb.json["materials"].size());
    const auto& c = mesh.colour;
    glb.json["materials"].push_back({{"pbrMetallicRoughness", {{"baseColorFactor", {c[0], c[1], c[2], c[3]}}}}});
    nlohmann::json marks{{"diffuse", mesh.diffuse}, {"weight", mesh.weight}};
    if (mesh.detail_m > 0) marks["detail_mm"] = 1e3 * mesh.detail_m;
    if (mesh.accuracy_m > 0) marks["accuracy_mm"] = 1e3 * mesh.accuracy_m;
    if (mesh.role == Role::surveyed) marks["role"] = "surveyed";
    if (mesh.role == Role::search) marks["role"] = "search";
    const int shape = glb.mesh({{"attributes", {{"POSITION", points}}}, {"indices", corners}, {"material", material}});
    glb.node({{"name", mesh.name}, {"mesh", shape}, {"extras", {{"vantage", marks}}}});
  }
  return glb;
}

std::vector<std::uint8_t> bytes_of(const test::GlbBuilder& glb) {
  const std::string text = glb.glb();
  return {text.begin(), text.end()};
}

template <class Body>
std::string refusal(Body&& body, Errc code = Errc::invalid_argument) {
  try {
    body();
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), code) << error.what();
    return error.what();
  }
  ADD_FAILURE() << "no error";
  return {};
}

TEST(SceneBuilder, MakesWhatAFileOfTheSameMakes) {
  std::vector<SceneMesh> meshes = room();
  meshes[0].station_area = true, meshes[1].door = true;
  meshes[1].detail_m = 0.008, meshes[2].accuracy_m = 0.003;
  const SceneOptions patterns{.doors = {"crate"}, .station_area = {"floor"}};
  const test::TemporaryFolder folder;
  for (const bool marked : {false, true}) {
    if (marked) {
      meshes[2].role = Role::surveyed;
      meshes.push_back(box("where to stand", {-8, -8, 0}, {16, 16, 0.125}, Role::search));
    }
    as_gltf(meshes).write_glb(folder / "scene.glb");
    const Scene loaded = Scene::load(folder / "scene.glb", patterns), made = built(meshes);
    EXPECT_EQ(made.data().origin, loaded.data().origin);
    EXPECT_EQ(made.data().positions, loaded.data().positions);
    EXPECT_EQ(made.data().triangles, loaded.data().triangles);
    EXPECT_EQ(made.data().search_positions, loaded.data().search_positions);
    EXPECT_EQ(made.data().search_triangles, loaded.data().search_triangles);
    EXPECT_EQ(made.fingerprint(), loaded.fingerprint()) << marked;
    EXPECT_EQ(made.has_search_area(), marked);
    ASSERT_EQ(made.meshes().size(), loaded.meshes().size());
    for (std::size_t m = 0; m < made.meshes().size(); ++m) {
      EXPECT_EQ(made.meshes()[m].name, loaded.meshes()[m].name);
      EXPECT_EQ(made.meshes()[m].role, loaded.meshes()[m].role);
      EXPECT_EQ(made.meshes()[m].weight, loaded.meshes()[m].weight);
      EXPECT_EQ(made.meshes()[m].door, m == 1);
      EXPECT_EQ(made.meshes()[m].station_area, m == 0);
      EXPECT_EQ(made.meshes()[m].detail_m, m == 1 ? 0.008 : 0);
      EXPECT_EQ(made.meshes()[m].accuracy_m, m == 2 ? 0.003 : 0);
    }
  }
}

TEST(SceneBuilder, AMovedMeshIsAsOneBuiltThere) {
  std::vector<SceneMesh> meshes = room();
  SceneBuilder builder;
  for (const SceneMesh& mesh : meshes) builder.add(mesh);
  const std::uint64_t at_first = builder.build().fingerprint();
  EXPECT_TRUE(builder.rebuilt_all());

  const double half = std::sqrt(0.5);
  for (const Pose& pose :
       {Pose{{0.5, -1, 0.25}}, Pose{{-2, 0.1, 1}, {0, 0, half, half}}, Pose{{0, 0, 0.7}, {0.1, 0.2, 0.3, 2}}}) {
    builder.move(1, pose);
    const Scene moved = builder.build();
    EXPECT_FALSE(builder.rebuilt_all());
    meshes[1].pose = pose;
    const Scene anew = built(meshes);
    EXPECT_EQ(moved.fingerprint(), anew.fingerprint());
    EXPECT_NE(moved.fingerprint(), at_first);
    EXPECT_EQ(moved.bounds().min, anew.bounds().min);
    EXPECT_EQ(moved.bounds().max, anew.bounds().max);
  }
  builder.move(1, {});
  EXPECT_EQ(builder.build().fingerprint(), at_first);
  EXPECT_FALSE(builder.rebuilt_all());
}

TEST(SceneBuilder, APoseTurnsThenMoves) {
  SceneBuilder builder;
  SceneMesh mesh = box("long", {0, 0, 0}, {4, 1, 2});
  mesh.pose = {{10, 20, 30}, {0, 0, std::sqrt(0.5), std::sqrt(0.5)}};  // a quarter from +X towards +Y
  builder.add(mesh);
  const Box bounds = builder.build().bounds();
  EXPECT_NEAR(bounds.min.x, 9, 1e-6);
  EXPECT_NEAR(bounds.max.x, 10, 1e-6);
  EXPECT_NEAR(bounds.min.y, 20, 1e-6);
  EXPECT_NEAR(bounds.max.y, 24, 1e-6);
  EXPECT_NEAR(bounds.min.z, 30, 1e-6);
  EXPECT_NEAR(bounds.max.z, 32, 1e-6);
}

TEST(SceneBuilder, AReplacedMeshIsAsOneBuiltInItsPlace) {
  std::vector<SceneMesh> meshes = room();
  SceneBuilder builder;
  for (const SceneMesh& mesh : meshes) builder.add(mesh);
  builder.build();
  for (const std::size_t m : {std::size_t{0}, std::size_t{1}, std::size_t{2}}) {
    SceneMesh other = box("other", {-4 + 3.0 * static_cast<double>(m), -3, 1}, {1, 1, 1});
    other.triangles.resize(7 + m);
    other.positions.push_back({1e6, 0, 0});  // used by no triangle
    other.diffuse = 0.75, other.colour = {0, 1, 0, 1};
    other.door = true, other.detail_m = 0.02;
    if (m == 0) other = box("floor", {-8, -8, -0.5}, {16, 16, 0.25});
    builder.replace(m, other);
    const Scene replaced = builder.build();
    EXPECT_FALSE(builder.rebuilt_all()) << m;
    meshes[m] = other;
    EXPECT_EQ(replaced.fingerprint(), built(meshes).fingerprint()) << m;
    EXPECT_EQ(replaced.meshes()[m].name, other.name);
  }
}

// A change that affects other meshes rebuilds everything; the scene is right either way.
TEST(SceneBuilder, BuildsEverythingWhereAChangeReachesOthers) {
  struct Change {
    const char* what;
    void (*make)(SceneBuilder&, std::vector<SceneMesh>&);
  };
  const Change changes[] = {{"on the floor, which is of another role",
                             [](SceneBuilder& b, std::vector<SceneMesh>& m) {
                               b.move(1, m[1].pose = Pose{{0, 0, -0.5}});
                             }},
                            {"the very same triangles as another",
                             [](SceneBuilder& b, std::vector<SceneMesh>& m) { b.replace(3, m[3] = m[2]); }},
                            {"a triangle without area",
                             [](SceneBuilder& b, std::vector<SceneMesh>& m) {
                               m[1].triangles[0] = {0, 0, 1};
                               b.replace(1, m[1]);
                             }},
                            {"not a number",
                             [](SceneBuilder& b, std::vector<SceneMesh>& m) {
                               m[1].positions[3].x = std::numeric_limits<double>::quiet_NaN();
                               b.replace(1, m[1]);
                             }},
                            {"another role",
                             [](SceneBuilder& b, std::vector<SceneMesh>& m) {
                               m[1].role = Role::blocking;
                               b.replace(1, m[1]);
                             }},
                            {"a mesh more", [](SceneBuilder& b, std::vector<SceneMesh>& m) {
                               m.push_back(box("more", {4, 4, 1}, {1, 1, 1})), b.add(m.back());
                             }}};
  for (const Change& change : changes) {
    std::vector<SceneMesh> meshes = room();
    meshes[1].role = meshes[2].role = Role::surveyed;  // the floor blocks
    meshes.push_back(box("box", {4, -4, 0.25}, {1, 1, 1}, Role::surveyed));
    SceneBuilder builder;
    for (const SceneMesh& mesh : meshes) builder.add(mesh);
    builder.build();
    change.make(builder, meshes);
    const Scene scene = builder.build();
    EXPECT_TRUE(builder.rebuilt_all()) << change.what;
    EXPECT_EQ(scene.fingerprint(), built(meshes).fingerprint()) << change.what;
  }
}

TEST(SceneBuilder, BuildsEverythingForAnotherOrigin) {
  std::vector<SceneMesh> meshes{box("near", {40, 0, 0}, {1, 1, 1}), box("far", {55, 0, 0}, {1, 1, 1})};
  SceneBuilder builder;
  for (const SceneMesh& mesh : meshes) builder.add(mesh);
  const Scene before = builder.build();
  builder.move(1, meshes[1].pose = Pose{{10, 0, 0}});
  const Scene after = builder.build();
  EXPECT_NE(before.data().origin, after.data().origin);
  EXPECT_TRUE(builder.rebuilt_all());
  EXPECT_EQ(after.fingerprint(), built(meshes).fingerprint());
}

TEST(SceneBuilder, ScenesStayAsTheyWereMade) {
  SceneBuilder builder;
  for (const SceneMesh& mesh : room()) builder.add(mesh);
  const Scene first = builder.build();
  const std::uint64_t before = first.fingerprint();
  builder.move(1, {{1, 1, 1}});
  EXPECT_NE(builder.build().fingerprint(), before);
  EXPECT_EQ(first.fingerprint(), before);
}

TEST(SceneBuilder, RefusesWhatIsOutOfRange) {
  SceneBuilder builder;
  EXPECT_NE(refusal([&] { builder.build(); }, Errc::malformed_file).find("nothing to survey"), std::string::npos);
  const auto bad = [&](auto&& change) {
    SceneMesh mesh = box("crate", {}, {1, 1, 1});
    change(mesh);
    return refusal([&] { builder.add(mesh); });
  };
  EXPECT_NE(
      bad([](SceneMesh& m) { m.triangles[4][2] = 8; }).find("\"crate\": triangle 4 refers to position 8; there are 8"),
      std::string::npos);
  EXPECT_NE(bad([](SceneMesh& m) { m.diffuse = 1.5; }).find("1.5"), std::string::npos);
  EXPECT_NE(bad([](SceneMesh& m) { m.weight = 256; }).find("256"), std::string::npos);
  EXPECT_NE(bad([](SceneMesh& m) { m.detail_m = -0.5; }).find("the detail must be 0 or more metres; -0.5"),
            std::string::npos);
  EXPECT_NE(bad([](SceneMesh& m) { m.accuracy_m = NAN; }).find("the accuracy"), std::string::npos);
  EXPECT_NE(bad([](SceneMesh& m) { m.colour[1] = -1; }).find("-1"), std::string::npos);
  EXPECT_NE(bad([](SceneMesh& m) { m.pose.rotation = {}; }).find("rotation"), std::string::npos);
  EXPECT_NE(bad([](SceneMesh& m) { m.pose.translation.y = NAN; }).find("translation"), std::string::npos);
  EXPECT_EQ(builder.size(), 0U);
  EXPECT_NE(refusal([&] { builder.move(3, {}); }).find("no mesh 3"), std::string::npos);
  EXPECT_NE(refusal([&] { builder.replace(0, {}); }).find("no mesh 0"), std::string::npos);
}

// Corners of every mesh, triangle by triangle, survey frame.
std::vector<std::vector<Vec3>> corners_of_meshes(const Scene& scene) {
  std::vector<std::vector<Vec3>> all;
  for (const MeshRange& range : scene.data().ranges) {
    std::vector<Vec3>& corners = all.emplace_back();
    for (std::uint32_t t = range.first_triangle; t < range.first_triangle + range.triangle_count; ++t)
      for (const Float3& p : scene.data().corners(t)) corners.push_back(widen(p) + scene.data().origin);
  }
  return all;
}

TEST(WithChanges, GivesTheSceneOfABuilderWhoseMeshesStandThere) {
  std::vector<SceneMesh> meshes = room();
  const Scene before = built(meshes);
  const double s = std::sqrt(0.5);
  const SceneMesh lamp = box("lamp", {-2, -3, 0.5}, {0.5, 0.5, 1}, Role::blocking);
  const Scene after =
      with_changes(before, {.move = {{"cr*", {{0.25, -1, 0.5}, {0, 0, s, s}}}}, .remove = {"shelf"}, .add = {lamp}});
  meshes[1].pose = {{0.25, -1, 0.5}, {0, 0, s, s}};  // a quarter turn about the frame's origin, then moved
  meshes[0].role = meshes[1].role = Role::surveyed;
  const Scene expected = built({meshes[0], meshes[1], lamp});
  ASSERT_EQ(after.meshes().size(), 3U);
  const auto got = corners_of_meshes(after), wanted = corners_of_meshes(expected);
  for (std::size_t m = 0; m < 3; ++m) {
    EXPECT_EQ(after.meshes()[m].name, expected.meshes()[m].name);
    EXPECT_EQ(after.meshes()[m].role, expected.meshes()[m].role);
    EXPECT_EQ(after.meshes()[m].diffuse, expected.meshes()[m].diffuse);
    EXPECT_EQ(after.meshes()[m].weight, expected.meshes()[m].weight);
    ASSERT_EQ(got[m].size(), wanted[m].size());
    for (std::size_t k = 0; k < got[m].size(); ++k) {
      EXPECT_NEAR(got[m][k].x, wanted[m][k].x, 1e-6);
      EXPECT_NEAR(got[m][k].y, wanted[m][k].y, 1e-6);
      EXPECT_NEAR(got[m][k].z, wanted[m][k].z, 1e-6);
    }
  }
  for (const auto& [one, other] :
       {std::pair(after.bounds().min, expected.bounds().min), std::pair(after.bounds().max, expected.bounds().max)}) {
    EXPECT_NEAR(one.x, other.x, 1e-6);
    EXPECT_NEAR(one.y, other.y, 1e-6);
    EXPECT_NEAR(one.z, other.z, 1e-6);
  }
  EXPECT_EQ(before.fingerprint(), built(room()).fingerprint()) << "the first scene stays";
  EXPECT_EQ(corners_of_meshes(with_changes(before, {.move = {{"*", {}}}})), corners_of_meshes(before));
}

// A file whose panes are of glass, with normals: these turn, and glass stays last.
TEST(WithChanges, TurnsNormalsAndKeepsGlassLast) {
  test::GlbBuilder glb = as_gltf(room());
  for (auto& node : glb.json["nodes"])
    if (node["name"] == "shelf") node["extras"]["vantage"]["glass"] = true;
  const std::vector<float> up{0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1, 0};
  const int normals = glb.accessor(up, 5126, "VEC3");
  for (auto& mesh : glb.json["meshes"]) mesh["primitives"][0]["attributes"]["NORMAL"] = normals;
  const Scene scene = load_gltf(bytes_of(glb));
  ASSERT_TRUE(scene.meshes().back().glass);
  const double s = std::sqrt(0.5);
  const SceneMesh lamp = box("lamp", {-2, -3, 0.5}, {0.5, 0.5, 1});
  const Scene after = with_changes(scene, {.move = {{"crate", {{}, {s, 0, 0, s}}}}, .add = {lamp}});  // z to −y
  ASSERT_EQ(after.meshes().size(), 4U);
  EXPECT_EQ(after.meshes()[2].name, "lamp");
  EXPECT_TRUE(after.meshes()[3].glass);
  EXPECT_EQ(after.data().opaque_count(), after.data().triangle_count() - 12);
  const auto normal_of = [&](std::size_t m) {
    return after.data().corner_normals(after.data().ranges[m].first_triangle)[0];
  };
  EXPECT_NEAR(normal_of(0).z, 1, 1e-6);
  EXPECT_NEAR(normal_of(1).y, -1, 1e-6);
  EXPECT_EQ(normal_of(2), Float3());  // it has none
}

TEST(WithChanges, RefusesWhatItCannotDo) {
  const Scene scene = built(room());
  EXPECT_NE(refusal([&] {
              with_changes(scene, {.move = {{"crane", {}}}});
            }).find("no mesh to move matches \"crane\"; meshes are \"floor\", \"crate\", \"shelf\""),
            std::string::npos);
  EXPECT_NE(refusal([&] { with_changes(scene, {.remove = {"crane*"}}); }).find("remove"), std::string::npos);
  EXPECT_NE(refusal([&] {
              with_changes(scene, {.move = {{"crate", {{NAN, 0, 0}}}}});
            }).find("not finite"),
            std::string::npos);
  EXPECT_NE(refusal([&] {
              with_changes(scene, {.move = {{"crate", {{2e6, 0, 0}}}}});
            }).find("\"crate\""),
            std::string::npos);
  EXPECT_NE(refusal([&] {
              with_changes(scene, {.add = {box("area", {}, {1, 1, 1}, Role::search)}});
            }).find("neither surveyed nor blocking"),
            std::string::npos);
  refusal([&] { with_changes(scene, {.remove = {"*"}}); }, Errc::malformed_file);
}

TEST(LoadGltf, IsAsFromAFile) {
  const test::TemporaryFolder folder;
  const test::GlbBuilder glb = as_gltf(room());
  glb.write_glb(folder / "scene.glb");
  EXPECT_EQ(load_gltf(bytes_of(glb)).fingerprint(), Scene::load(folder / "scene.glb").fingerprint());
  const SceneOptions options{.blocking = {"floor"}};
  EXPECT_EQ(load_gltf(bytes_of(glb), options).fingerprint(), Scene::load(folder / "scene.glb", options).fingerprint());
}

TEST(LoadGltf, RefusesWhatItCannotRead) {
  test::GlbBuilder glb = as_gltf(room());
  std::vector<std::uint8_t> bytes = bytes_of(glb);
  bytes.resize(bytes.size() / 2);
  EXPECT_NE(refusal([&] { load_gltf(bytes, {}, "upload 7"); }, Errc::malformed_file).find("upload 7: "),
            std::string::npos);
  refusal([&] { load_gltf({}); }, Errc::malformed_file);
  glb.json["buffers"] = {{{"byteLength", glb.binary.size()}, {"uri", "scene.bin"}}};
  EXPECT_NE(refusal([&] { load_gltf(bytes_of(glb)); }, Errc::malformed_file).find("scene.bin"), std::string::npos);
}

}  // namespace
}  // namespace vantage
