// SPDX-License-Identifier: Apache-2.0
#include <cstdlib>

#include "program.hpp"
#include "vantage/scene.hpp"

namespace vantage::test {
namespace {

class ImportCommandTest : public ProgramTest {
 protected:
  ImportCommandTest() {
    setenv("XDG_CACHE_HOME", path("cache").c_str(), 1);
    write("site.obj", "o wall\nv 0 0 0\nv 4 0 0\nv 4 3 0\nv 0 3 0\nf 1 2 3 4\no floor\nv 0 0 4\nf 1 2 5\n");
  }
  ~ImportCommandTest() override { unsetenv("XDG_CACHE_HOME"); }
};

TEST_F(ImportCommandTest, WritesAGlb) {
  const auto json = json_of({"import", path("site.obj"), "-o", path("site.glb")});
  EXPECT_EQ(json["format"], "OBJ");
  EXPECT_EQ(json["triangles"], 3);
  EXPECT_EQ(json["meshes"], 2);
  const Scene scene = Scene::load(path("site.glb"));
  EXPECT_EQ(scene.triangle_count(), 3u);
  EXPECT_EQ(scene.meshes()[0].name, "wall");
  EXPECT_EQ(scene.bounds().max.z, 3);  // Y up in both
}

TEST_F(ImportCommandTest, OtherCommandsTakeModelsAsTheyAre) {
  const auto json = json_of({"scan", path("site.obj"), "--station", "2,-2,1.5", "--step", "2", "--engine", "embree"});
  EXPECT_GT(json["points"].get<int>(), 0);
}

TEST_F(ImportCommandTest, SaysWhatItWants) {
  expect_refused(run_program({"import", path("site.obj")}), 2, "no file to write");
  expect_refused(run_program({"import"}), 2, "no model given");
  expect_refused(run_program({"import", scene_, "-o", path("out.glb")}), 2, "is glTF already");
  write("cloud.xyz", "1 2 3\n4 5 6\n");
  expect_refused(run_program({"import", path("cloud.xyz"), "-o", path("out.glb")}), 1, "a table of numbers");
  expect_refused(run_program({"import", path("none.obj"), "-o", path("out.glb")}), 1, "none.obj");
}

}  // namespace
}  // namespace vantage::test
