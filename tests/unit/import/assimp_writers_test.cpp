// SPDX-License-Identifier: Apache-2.0
// What assimp writes is read as what it was given.
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
  EXPECT_NEAR(wanted.volume_m3, 12 + 2.5, 1e-6);
  struct Writer {
    const char *id, *extension;
    double metres;  // in the unit that it states
  };
  // Its FBX states centimetres, whatever it was given.
  for (const Writer& writer :
       {Writer{"collada", "dae", 1}, Writer{"x3d", "x3d", 1}, Writer{"obj", "obj", 1}, Writer{"objnomtl", "obj", 1},
        Writer{"stl", "stl", 1}, Writer{"stlb", "stl", 1}, Writer{"ply", "ply", 1}, Writer{"plyb", "ply", 1},
        Writer{"3ds", "3ds", 1}, Writer{"fbx", "fbx", 0.01}, Writer{"fbxa", "fbx", 0.01}, Writer{"gltf2", "gltf", 1},
        Writer{"glb2", "glb", 1}}) {
    SCOPED_TRACE(writer.id);
    Assimp::Exporter exporter;
    const auto file = write(std::string(writer.id) + "/model." + writer.extension, "");
    ASSERT_EQ(exporter.Export(given, writer.id, file.string()), aiReturn_SUCCESS) << exporter.GetErrorString();
    try {
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
