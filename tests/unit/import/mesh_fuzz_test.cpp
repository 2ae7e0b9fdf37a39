// SPDX-License-Identifier: Apache-2.0
// Damaged models give a scene or one error, and never end the program.
#include <random>

#include "import_fixture.hpp"
#include "mesh_samples.hpp"
#include "vantage/scene.hpp"

namespace vantage::test {
namespace {

struct Model {
  const char* name;
  std::string content;
};

std::string damaged(std::string content, std::mt19937& random) {
  if (random() % 3 == 0) return content.substr(0, random() % content.size());
  for (std::uint32_t flips = 1 + random() % 8; flips > 0; --flips)
    content[random() % content.size()] ^= static_cast<char>(1U << (random() % 8));
  return content;
}

class DamagedModel : public ImportTest, public testing::WithParamInterface<Model> {};

TEST_P(DamagedModel, GivesASceneOrOneError) {
  constexpr int kTries = 25;
  std::mt19937 random(20'26);
  int refused = 0;
  for (int k = 0; k < kTries; ++k) {
    const auto file = write(std::to_string(k) + GetParam().name, damaged(GetParam().content, random));
    try {
      load_within(file, 1);
    } catch (const Error& error) {
      ++refused;
      EXPECT_EQ(std::string(error.what()).find(file.string()), 0u) << error.what();
      EXPECT_TRUE(error.code() == Errc::malformed_file || error.code() == Errc::out_of_memory) << error.what();
    }
  }
  EXPECT_GT(refused, 0);
}

INSTANTIATE_TEST_SUITE_P(Formats, DamagedModel,
                         testing::Values(Model{".obj", kRoomObj}, Model{".stl", kTriangleStl},
                                         Model{".ply", kTrianglePly}, Model{".x3d", kTriangleX3d},
                                         Model{".dae", kPostsDae}, Model{".fbx", kPostFbx}, Model{".dxf", kWallDxf},
                                         Model{".3ds", triangle_3ds()}),
                         [](const auto& sample) { return std::string(sample.param.name + 1); });

}  // namespace
}  // namespace vantage::test
