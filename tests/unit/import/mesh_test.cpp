// SPDX-License-Identifier: Apache-2.0
// Small models by hand, through the importer of meshes into a scene.
#include <algorithm>
#include <cstring>

#include "import_fixture.hpp"
#include "mesh_samples.hpp"
#include "random_meshes.hpp"
#include "scene/positions.hpp"
#include "scene/scene_data.hpp"
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
  EXPECT_EQ(mesh_named(scene, "bare").diffuse, 0.5);  // has no material, and takes the default of scenes
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

// The settings that leave nothing to recognise.
SceneOptions with_axes(Unit unit, UpAxis up) {
  SceneOptions options;
  options.unit = unit, options.up = up;
  return options;
}

double area_of(const Scene& scene) {
  double area = 0;
  for (const auto& [name, measures] : measures_of(scene, true)) area += measures.area_m2;
  return area;
}

void expect_note(const Scene& scene, const std::string& words) {
  EXPECT_TRUE(std::ranges::any_of(scene.notes(), [&](const std::string& note) {
    return note.find(words) != note.npos;
  })) << words;
}

std::string strip_ply(const std::string& list) {
  return "ply\nformat ascii 1.0\nelement vertex 6\nproperty float x\nproperty float y\nproperty float z\n"
         "element tristrips 1\nproperty list int int vertex_indices\nend_header\n"
         "0 0 0\n1 0 0\n0 1 0\n1 1 0\n0 2 0\n1 2 0\n" +
         list + "\n";
}

TEST_F(MeshImportTest, PlyStripsMakeTrianglesThatWindAlike) {
  const SceneOptions axes = with_axes(Unit::metre, UpAxis::z);
  for (const auto& [list, triangles] :
       {std::pair{"6 0 1 2 3 4 5", 4}, std::pair{"9 0 1 2 3 -1 2 3 4 5", 4}, std::pair{"8 0 1 2 -1 3 4 4 5", 1}}) {
    const Scene scene =
        Scene::load(write(std::string("strip") + std::to_string(list[0]) + ".ply", strip_ply(list)), axes);
    EXPECT_EQ(scene.triangle_count(), static_cast<std::uint32_t>(triangles)) << list;
    for (std::uint32_t t = 0; t < scene.triangle_count(); ++t) {
      const auto [a, b, c] = corners_of(scene.data(), t);
      EXPECT_GT(cross(b - a, c - a).z, 0) << list << ", triangle " << t;
    }
  }
}

TEST_F(MeshImportTest, PlyMayNameItsPropertiesInCapitals) {
  const Scene scene = Scene::load(
      write("capitals.ply",
            "ply\nformat ascii 1.0\nelement vertex 3\nproperty float X\nproperty float Y\nproperty float Z\n"
            "element face 1\nproperty list uchar int Vertex_Indices\nend_header\n0 0 0\n3 0 0\n0 2 0\n3 0 1 2\n"),
      with_axes(Unit::metre, UpAxis::z));
  expect_bounds(scene, {0, 0, 0}, {3, 2, 0});
}

TEST_F(MeshImportTest, PlyMayBeginItsDataWithTheByteOfALineEnd) {
  const auto number = [](float value) { return std::string(reinterpret_cast<const char*>(&value), sizeof value); };
  std::uint32_t bits = 0x3F80000A;  // just above 1
  float first = 0;
  std::memcpy(&first, &bits, sizeof first);
  for (const std::string end : {"\n", "\r\n", "\r"}) {
    std::string ply;
    for (const char* line :
         {"ply", "format binary_little_endian 1.0", "element vertex 3", "property float x", "property float y",
          "property float z", "element face 1", "property list uchar int vertex_indices", "end_header"})
      ply += line + end;
    for (const float value : {first, 0.0F, 0.0F, 3.0F, 0.0F, 0.0F, 2.0F, 2.0F, 0.0F}) ply += number(value);
    ply += '\3';
    for (const int v : {0, 1, 2}) ply += std::string{static_cast<char>(v), 0, 0, 0};
    expect_bounds(Scene::load(write("a.ply", ply), with_axes(Unit::metre, UpAxis::z)),
                  {static_cast<double>(first), 0, 0}, {3, 2, 0});
  }
}

// A roof of two quads in an X3D scene; `outer` has an @ where it stands.
std::string x3d_with(std::string outer, const std::string& head = "") {
  outer.replace(outer.find('@'), 1,
                "<Shape><IndexedFaceSet coordIndex='0 1 2 3 -1'><Coordinate point='0 0 0, 0 0 2, 3 0 2, 3 0 0'/>"
                "</IndexedFaceSet></Shape>");
  return "<?xml version='1.0'?><X3D version='3.3'>" + head + "<Scene>" + outer + "</Scene></X3D>";
}

TEST_F(MeshImportTest, X3dGroupsOfAllKindsHaveTheirChildren) {
  for (const char* outer :
       {"<Collision>@</Collision>", "<LOD>@<Shape><Box/></Shape></LOD>", "<Anchor><Group>@</Group></Anchor>",
        "<Billboard>@</Billboard>", "<Switch whichChoice='1'><Shape><Box/></Shape>@</Switch>",
        "<StaticGroup>@</StaticGroup>", "<CADAssembly><CADPart><CADFace>@</CADFace></CADPart></CADAssembly>",
        "<Collision>@<Shape containerField='proxy'><Box/></Shape></Collision>",
        "<Switch><Transform DEF='a' translation='0 0 0'>@</Transform></Switch><Group USE='a'/>"}) {
    SCOPED_TRACE(outer);
    const Scene scene = Scene::load(write("a.x3d", x3d_with(outer)));
    EXPECT_EQ(scene.triangle_count(), 2u);
    expect_bounds(scene, {0, -2, 0}, {3, 0, 0});
  }
}

TEST_F(MeshImportTest, X3dTellsItsUnitItsFacesAndWhatItLeavesOut) {
  const Scene scene = Scene::load(
      write("a.x3d", x3d_with("@<Inline url='\"b.x3d\"'/><Switch whichChoice='-1'><Shape><Box/></Shape></Switch>",
                              "<head><unit category='length' name='foot' conversionFactor='0.3048'/></head>")));
  expect_bounds(scene, {0, -2 * 0.3048, 0}, {3 * 0.3048, 0, 0});
  expect_note(scene, "1 Inline");
  expect_note(scene, "1 nodes are hidden");
  std::string turned = x3d_with("@");
  turned.replace(turned.find("coordIndex='0 1 2 3"), 19, "ccw='false' coordIndex='3 2 1 0");
  const Scene clockwise = Scene::load(write("b.x3d", turned));
  const auto [a, b, c] = corners_of(clockwise.data(), 0);
  EXPECT_GT(cross(b - a, c - a).z, 0);
}

TEST_F(MeshImportTest, X3dSolidsAreClosed) {
  struct Case {
    const char* node;
    double volume, within;  // a share
  };
  for (const Case& solid :
       {Case{"<Box size='2 3 4'/>", 24, 1e-9}, Case{"<Cylinder radius='1' height='3'/>", 3 * 3.14159265, 0.01},
        Case{"<Cone bottomRadius='1' height='3'/>", 3.14159265, 0.01}, Case{"<Sphere radius='2'/>", 33.5103216, 0.01},
        Case{"<Extrusion crossSection='1 1 1 -1 -1 -1 -1 1 1 1' spine='0 0 0 0 5 0'/>", 20, 1e-9},
        Case{"<Extrusion crossSection='1 1 1 -1 0 0 -1 -1 -1 1 1 1' spine='0 0 0 4 0 0 8 0 0'/>", 24, 1e-9}}) {
    SCOPED_TRACE(solid.node);
    const Scene scene =
        Scene::load(write("a.x3d", std::string("<X3D><Scene><Shape>") + solid.node + "</Shape></Scene></X3D>"));
    EXPECT_NEAR(measures_of(scene, true)[""].volume_m3, solid.volume, solid.within * solid.volume);
  }
  const std::string open =
      "<X3D><Scene><Shape><Cylinder top='false' bottom='false' radius='1' height='3'/></Shape></Scene></X3D>";
  EXPECT_NEAR(area_of(Scene::load(write("b.x3d", open))), 2 * 3.14159265 * 3, 0.2);
}

TEST_F(MeshImportTest, X3dReadsStripsAndFans) {
  const std::string points = "<Coordinate point='0 0 0 0 0 1 1 0 0 1 0 1'/>";
  for (const char* node : {"TriangleStripSet stripCount='4'", "IndexedTriangleStripSet index='0 1 2 3 -1'",
                           "TriangleSet", "IndexedTriangleSet index='0 1 2 2 1 3'", "TriangleFanSet fanCount='4'",
                           "IndexedTriangleFanSet index='0 1 3 2 -1'", "IndexedQuadSet index='0 1 3 2'"}) {
    SCOPED_TRACE(node);
    const std::string name = std::string(node).substr(0, std::string(node).find(' '));
    const Scene scene = Scene::load(write(
        "a.x3d", "<X3D><Scene><Shape><" + std::string(node) + ">" + points + "</" + name + "></Shape></Scene></X3D>"));
    EXPECT_NEAR(area_of(scene), name == "TriangleSet" ? 0.5 : 1, 1e-9);
    const auto [a, b, c] = corners_of(scene.data(), 0);
    EXPECT_GT(cross(b - a, c - a).z, 0);
  }
}

TEST_F(MeshImportTest, StlMayHaveAnEmptySolidBeforeOthers) {
  const Scene scene = Scene::load(write("a.stl", "solid none\nendsolid none\n" + std::string(kTriangleStl)));
  EXPECT_EQ(scene.triangle_count(), 1u);
  EXPECT_EQ(scene.meshes()[0].name, "a");
  expect_error(Errc::malformed_file, "no triangle",
               [&] { Scene::load(write("b.stl", "solid facet\nendsolid facet\n")); });
}

TEST_F(MeshImportTest, StlMayBeInCapitalsOrInOneLine) {
  std::string capitals, line;
  for (const char c : std::string(kTriangleStl) + kTriangleStl) {
    capitals += c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c;
    line += c == '\n' ? ' ' : c;
  }
  const Scene one = Scene::load(write("a.stl", kTriangleStl));
  for (const std::string& text : {capitals, line}) {
    const Scene scene = Scene::load(write("b.stl", text));
    EXPECT_EQ(scene.triangle_count(), 1u) << text;  // the second is a duplicate
    EXPECT_EQ(scene.meshes()[0].name.size(), 1u) << text;
    expect_bounds(scene, one.bounds().min, one.bounds().max);
  }
}

TEST_F(MeshImportTest, ObjMayReopenAnObject) {
  const Scene scene = Scene::load(write("a.obj",
                                        "v 0 0 0\nv 1 0 0\nv 1 0 1\nv 0 0 1\nv 0 2 0\nv 1 2 0\nv 1 2 1\n"
                                        "o floor\nf 1 3 2\no roof\nf 5 7 6\no floor\nf 1 4 3\n"),
                                  with_axes(Unit::metre, UpAxis::y));
  ASSERT_EQ(scene.meshes().size(), 2u);
  EXPECT_EQ(mesh_named(scene, "floor").triangle_count, 2u);
  EXPECT_EQ(mesh_named(scene, "roof").triangle_count, 1u);
}

TEST_F(MeshImportTest, TextsAtNationalCoordinatesAreReadInDouble) {
  const SceneOptions axes = with_axes(Unit::metre, UpAxis::z);
  const std::string corners[] = {"500000.123456 5621391.654321 87.000001", "500004.123456 5621391.654321 87.000001",
                                 "500004.123456 5621394.654321 87.000001"};
  const Vec3 min{500000.123456, 5621391.654321, 87.000001}, max{500004.123456, 5621394.654321, 87.000001};
  std::string obj = "v 0 0 0\n", stl = "solid a\nfacet normal 0 0 1\nouter loop\n", points, ply;
  for (const std::string& corner : corners) {
    obj += "v " + corner + "\n", stl += "vertex " + corner + "\n", points += corner + " ", ply += corner + "\n";
  }
  ply =
      "ply\nformat ascii 1.0\nelement vertex 3\nproperty double x\nproperty double y\nproperty double z\n"
      "element face 1\nproperty list uchar int vertex_index\nend_header\n" +
      ply + "3 0 1 2\n";
  std::string x3d = kTriangleX3d;
  x3d.replace(x3d.find("0 0 0 0 0 1 1 0 0"), 17, points);
  for (const auto& [name, text] :
       {std::pair{"a.obj", obj + "f 2 3 4\n"}, std::pair{"a.stl", stl + "endloop\nendfacet\nendsolid a\n"},
        std::pair{"a.ply", ply}, std::pair{"a.x3d", x3d}}) {
    SCOPED_TRACE(name);
    const Scene scene = Scene::load(write(name, text), axes);
    const Box box = scene.bounds();
    for (const auto& [is, wanted] : {std::pair{box.min, min}, std::pair{box.max, max}}) {
      EXPECT_NEAR(is.x, wanted.x, 1e-6);
      EXPECT_NEAR(is.y, wanted.y, 1e-6);
      EXPECT_NEAR(is.z, wanted.z, 1e-6);
    }
    for (const std::string& note : scene.notes()) EXPECT_EQ(note.find("float"), note.npos) << note;
  }
}

// A site's grid puts a model some times its size away from 0.
TEST_F(MeshImportTest, TextsOnASitesGridAreReadInDouble) {
  std::string obj;
  const double x[] = {1000.123456, 1028.654321, 1028.654321}, y[] = {2000.123456, 2000.123456, 2018.654321};
  for (int k = 0; k < 3; ++k) obj += "v " + std::to_string(x[k]) + " " + std::to_string(y[k]) + " 412.5\n";
  const Scene scene = Scene::load(write("grid.obj", obj + "f 1 2 3\n"), with_axes(Unit::metre, UpAxis::z));
  EXPECT_NEAR(scene.bounds().min.x, x[0], 2e-6);
  EXPECT_NEAR(scene.bounds().max.y, y[2], 2e-6);
  for (const std::string& note : scene.notes()) EXPECT_EQ(note.find("float"), note.npos) << note;
}

// Half a metre is lost where no digit is missing in the file.
TEST_F(MeshImportTest, FloatsAtNationalCoordinatesAreTold) {
  const auto bytes = [](auto value) { return std::string(reinterpret_cast<const char*>(&value), sizeof value); };
  for (const float north : {5'621'391.0F, 91.0F}) {
    std::string corners;
    for (const auto& [x, y] : {std::pair{0.0F, 0.0F}, {40.0F, 0.0F}, {40.0F, 30.0F}})
      corners += bytes(500'000 + x) + bytes(north + y) + bytes(87.0F);
    const std::string ply =
        "ply\nformat binary_little_endian 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
        "element face 1\nproperty list uchar int vertex_indices\nend_header\n" +
        corners + '\3' + bytes(0) + bytes(1) + bytes(2);
    const std::string stl =
        std::string(80, ' ') + bytes(std::uint32_t{1}) + std::string(12, '\0') + corners + std::string(2, '\0');
    for (const auto& [name, content] : {std::pair{"a.ply", ply}, {"a.stl", stl}}) {
      const Scene scene = Scene::load(write(name, content), with_axes(Unit::metre, UpAxis::z));
      const std::string wanted = north > 1000 ? "only to 0.5 m" : "only to 0.0312 m";
      EXPECT_TRUE(
          std::ranges::any_of(scene.notes(), [&](const std::string& note) { return note.find(wanted) != note.npos; }))
          << name << " " << north;
    }
  }
}

// Posts of other primitives, over a square of 10 m with a smaller one inside.
std::string dae_with(const std::string& primitive) {
  std::string dae = kPostsDae;
  const auto replace = [&](const std::string& from, const std::string& to) {
    dae.replace(dae.find(from), from.size(), to);
  };
  const std::size_t begin = dae.find("<triangles"), end = dae.find("</triangles>");
  dae.replace(begin, end + 12 - begin, primitive);
  replace("0 0 0 100 0 0 0 0 300", "0 0 0 1000 0 0 1000 1000 0 0 1000 0 400 400 0 600 400 0 600 600 0 400 600 0");
  replace("count=\"3\" stride", "count=\"8\" stride");
  return dae;
}

TEST_F(MeshImportTest, ColladaPolygonsMayHaveHolesAndConcaveOutlines) {
  const std::string input = "<input semantic=\"VERTEX\" source=\"#v\" offset=\"0\"/>";
  struct Case {
    std::string primitive;
    double area_m2;
  };
  for (const Case& made :
       {Case{"<polygons count=\"1\">" + input + "<ph><p>0 1 2 3</p><h>4 7 6 5</h></ph></polygons>", 96},
        Case{"<polygons count=\"1\">" + input + "<ph><p>0 1 2 3</p><h>4 5 6 7</h></ph></polygons>", 96},
        Case{"<polygons count=\"1\">" + input + "<p>0 1 2 6 3</p></polygons>", 80},
        Case{"<polylist count=\"2\">" + input + "<vcount>4 3</vcount><p>0 1 2 3 4 5 6</p></polylist>", 102},
        Case{"<tristrips count=\"1\">" + input + "<p>0 1 3 2</p></tristrips>", 100},
        Case{"<trifans count=\"1\">" + input + "<p>0 1 2 3</p></trifans>", 100}}) {
    SCOPED_TRACE(made.primitive);
    const Scene scene = Scene::load(write("a.dae", dae_with(made.primitive)));
    EXPECT_NEAR(area_of(scene), 2 * made.area_m2, 1e-3);
    const auto [a, b, c] = corners_of(scene.data(), 0);
    EXPECT_GT(cross(b - a, c - a).z, 0);
  }
}

TEST_F(MeshImportTest, ColladaReferencesAndNamesAreThoseOfTheFile) {
  std::string dae = kPostsDae;
  const auto replace_all = [&](const std::string& from, const std::string& to) {
    for (std::size_t at = 0; (at = dae.find(from, at)) != dae.npos; at += to.size()) dae.replace(at, from.size(), to);
  };
  replace_all("geometry id=\"g\"", "geometry id=\"a b\"");
  replace_all("url=\"#g\"", "url=\"#a%20b\"");
  replace_all("name=\"post 1\"", "name=\"post 2\"");
  const Scene scene = Scene::load(write("a.dae", dae));
  ASSERT_EQ(scene.meshes().size(), 2u);
  EXPECT_EQ(scene.meshes()[0].name, "post 2");
  EXPECT_EQ(scene.meshes()[1].name, "post 2");
}

}  // namespace
}  // namespace vantage::test
