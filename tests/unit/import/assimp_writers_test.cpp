// SPDX-License-Identifier: Apache-2.0
// Models that assimp writes are read as the models it was given.
#include <assimp/cexport.h>
#include <assimp/scene.h>

#include <assimp/Exporter.hpp>
#include <assimp/Importer.hpp>
#include <cstring>

#include "import_fixture.hpp"
#include "random_meshes.hpp"

namespace vantage::test {
namespace {

using AssimpWritersTest = ImportTest;

// A wedge and, beside it, a box; metres, Y up.
constexpr const char* kWedgeAndBox =
    "o wedge\nv 0 0 0\nv 4 0 0\nv 4 0 -3\nv 0 0 -3\nv 0 2 0\nv 0 2 -3\n"
    "f 1 4 3 2\nf 1 5 6 4\nf 1 2 5\nf 4 6 3\nf 2 3 6 5\n"
    "o box\nv 6 0 0\nv 7 0 0\nv 7 0 -1\nv 6 0 -1\nv 6 2.5 0\nv 7 2.5 0\nv 7 2.5 -1\nv 6 2.5 -1\n"
    "f 7 10 9 8\nf 11 12 13 14\nf 7 8 12 11\nf 8 9 13 12\nf 9 10 14 13\nf 10 7 11 14\n";

TEST_F(AssimpWritersTest, EveryFormatIsReadAsItWasGiven) {
  Assimp::Importer importer;
  const aiScene* given = importer.ReadFileFromMemory(kWedgeAndBox, std::strlen(kWedgeAndBox), 0, "obj");
  ASSERT_NE(given, nullptr) << importer.GetErrorString();
  SceneOptions axes;
  axes.doors = {"closed"};
  axes.unit = Unit::metre, axes.up = UpAxis::y;
  const Measures wanted = measures_of(Scene::load(write("given.obj", kWedgeAndBox), axes), true)[""];
  // Closed solids with no ground around them are taken for spaces that one stands in: their faces are turned.
  EXPECT_NEAR(wanted.volume_m3, -(12 + 2.5), 1e-6);
  struct Writer {
    const char *id, *extension;
    double metres = 1;      // in the unit that it states
    UpAxis up = UpAxis::y;  // by the rule of the format
  };
  // Its FBX states centimetres, whatever it was given; its 3DS has Y up, where 3DS has Z up. It cannot read the binary
  // FBX that it writes.
  for (const Writer& writer : {Writer{"collada", "dae"}, Writer{"x3d", "x3d"}, Writer{"obj", "obj"},
                               Writer{"objnomtl", "obj"}, Writer{"stl", "stl"}, Writer{"stlb", "stl"},
                               Writer{"ply", "ply"}, Writer{"plyb", "ply"}, Writer{"3ds", "3ds", 1, UpAxis::z},
                               Writer{"fbxa", "fbx", 0.01}, Writer{"gltf2", "gltf"}, Writer{"glb2", "glb"}}) {
    SCOPED_TRACE(writer.id);
    Assimp::Exporter exporter;
    const auto file = write(std::string(writer.id) + "/model." + writer.extension, "");
    ASSERT_EQ(exporter.Export(given, writer.id, file.string()), aiReturn_SUCCESS) << exporter.GetErrorString();
    try {
      axes.up = writer.up;
      const Measures is = measures_of(Scene::load(file, axes), true)[""];
      const double length = writer.metres, square = length * length;
      EXPECT_NEAR(is.area_m2, wanted.area_m2 * square, 1e-4 * square);
      EXPECT_NEAR(is.volume_m3, wanted.volume_m3 * square * length, 1e-4 * square * length);
      EXPECT_NEAR(is.bounds.size().x, wanted.bounds.size().x * length, 1e-5);
      EXPECT_NEAR(is.bounds.size().z, wanted.bounds.size().z * length, 1e-5);
    } catch (const Error& error) {
      ADD_FAILURE() << error.what();
    }
  }
}

}  // namespace
}  // namespace vantage::test
