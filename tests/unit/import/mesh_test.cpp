// SPDX-License-Identifier: Apache-2.0
// Small models by hand, through the importer of meshes into a scene.
#include "import_fixture.hpp"
#include "mesh_samples.hpp"
#include "vantage/scene.hpp"

namespace vantage::test {
namespace {

using MeshImportTest = ImportTest;

// Corners of the scene's box, survey frame.
void expect_bounds(const Scene& scene, const Vec3& min, const Vec3& max) {
  const Box box = scene.bounds();
  for (const auto& [is, wanted] : {std::pair{box.min, min}, std::pair{box.max, max}}) {
    EXPECT_NEAR(is.x, wanted.x, 1e-6);
    EXPECT_NEAR(is.y, wanted.y, 1e-6);
    EXPECT_NEAR(is.z, wanted.z, 1e-6);
  }
}

const MeshInfo& mesh_named(const Scene& scene, const std::string& name) {
  for (const MeshInfo& mesh : scene.meshes())
    if (mesh.name == name) return mesh;
  ADD_FAILURE() << "no mesh " << name;
  return scene.meshes().front();
}

TEST_F(MeshImportTest, ObjKeepsGroupsAndMaterials) {
  write("colours.mtl", "newmtl grey\nKd 0.25 0.25 0.25\nnewmtl pane\nKd 0.5 0.5 0.5\nd 0.3\n");
  // Too few things to tell which way is up.
  const Scene scene = Scene::load(write("room.obj", kRoomObj), {.unit = Unit::metre, .up = UpAxis::y});
  ASSERT_EQ(scene.meshes().size(), 3u);
  EXPECT_NEAR(mesh_named(scene, "wall").diffuse, 0.25, 1e-6);
  EXPECT_NEAR(mesh_named(scene, "window").diffuse, 0.5, 1e-6);
  EXPECT_EQ(mesh_named(scene, "wall").triangle_count, 2u);
  EXPECT_EQ(mesh_named(scene, "bare").diffuse, 0.5);  // has no material, and takes what scenes take
  EXPECT_EQ(scene.triangle_count(), 5u);
  expect_bounds(scene, {0, -2, 0}, {4, 0, 3});
}

TEST_F(MeshImportTest, ObjWithoutFacesIsRefused) {
  const auto lines = write("lines.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nl 1 2 3\n");
  expect_error(Errc::malformed_file, "points or lines alone", [&] { Scene::load(lines); });
  const auto points = write("points.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\n");
  expect_error(Errc::malformed_file, "points.obj: it ", [&] { Scene::load(points); });
}

TEST_F(MeshImportTest, ColladaDeclaresUnitAndAxis) {
  const Scene scene = Scene::load(write("posts.dae", kPostsDae));
  // Two instances of a triangle of 100 x 300 cm, one of them 500 cm farther along x; Z up.
  ASSERT_EQ(scene.meshes().size(), 2u);
  EXPECT_EQ(scene.triangle_count(), 2u);
  EXPECT_NEAR(mesh_named(scene, "post 2").diffuse, 0.5, 1e-6);
  expect_bounds(scene, {0, 0, 0}, {6, 0, 3});
  for (const std::string& note : scene.notes()) EXPECT_EQ(note.find("taken as"), std::string::npos) << note;
}

TEST_F(MeshImportTest, FbxDeclaresUnitAndAxis) {
  // A triangle of 40 x 118 inches, Z up.
  const Scene scene = Scene::load(write("post.fbx", kPostFbx));
  ASSERT_EQ(scene.meshes().size(), 1u);
  EXPECT_EQ(scene.meshes()[0].name, "post");
  expect_bounds(scene, {0, 0, 0}, {40 * 0.0254, 0, 118 * 0.0254});
}

TEST_F(MeshImportTest, DxfDeclaresItsUnit) {
  const Scene scene = Scene::load(write("wall.dxf", kWallDxf));
  expect_bounds(scene, {0, 0, 0}, {4, 0, 2.5});  // of 4000 x 2500 mm, Z up
}

TEST_F(MeshImportTest, StlPlyX3dAnd3dsAreRead) {
  expect_bounds(Scene::load(write("a.stl", kTriangleStl)), {0, -1, 0}, {1, 0, 0});
  const Scene ply = Scene::load(write("a.ply", kTrianglePly));
  expect_bounds(ply, {0, -1, 0}, {1, 0, 0});
  EXPECT_EQ(ply.meshes()[0].name, "a");  // the file's, as a PLY has none
  expect_bounds(Scene::load(write("a.x3d", kTriangleX3d)), {0, -1, 0}, {1, 0, 0});
  expect_bounds(Scene::load(write("a.3ds", triangle_3ds())), {0, 0, 0}, {1, 1, 0});  // Z up
}

TEST_F(MeshImportTest, NamesInLatin1BecomeUtf8) {
  const Scene scene = Scene::load(write("a.obj",
                                        "o K\xFC"
                                        "che\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"));
  EXPECT_EQ(scene.meshes()[0].name,
            "K\xC3\xBC"
            "che");
}

TEST_F(MeshImportTest, WrongExtensionIsReadByContent) {
  const Scene scene = Scene::load(write("a.obj", kTriangleStl));
  EXPECT_EQ(scene.triangle_count(), 1u);
  EXPECT_EQ(scene.notes()[0], "it is named as OBJ, but holds STL, and is read as that");
}

}  // namespace
}  // namespace vantage::test
