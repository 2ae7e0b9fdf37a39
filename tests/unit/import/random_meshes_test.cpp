// SPDX-License-Identifier: Apache-2.0
// Random valid files of meshes are read in full: each solid with its name, place and size, and with its faces outward.
// VANTAGE_SEEDS=first..last chooses the files.
#include "random_meshes.hpp"

#include <cstdio>
#include <cstdlib>

#include "import_fixture.hpp"

namespace vantage::test {
namespace {

using RandomMeshTest = ImportTest;

TEST_F(RandomMeshTest, AreReadAsWhatTheyHold) {
  unsigned long long first = 1, last = 28;  // four of each format
  if (const char* seeds = std::getenv("VANTAGE_SEEDS")) {
    ASSERT_EQ(std::sscanf(seeds, "%llu..%llu", &first, &last), 2) << seeds;
  }
  for (std::uint64_t seed = first; seed <= last; ++seed) {
    const RandomMeshFile made = write_random_mesh(seed, folder_.path());
    SCOPED_TRACE("seed " + std::to_string(seed) + ": " + made.what);
    SceneOptions options = made.options;
    options.doors = {"closed"};  // a door is a solid like others
    std::map<std::string, Measures> read;
    try {
      read = measures_of(Scene::load(made.file, options), made.truth.contains(""));
    } catch (const Error& error) {
      ADD_FAILURE() << error.what();
      continue;
    }
    EXPECT_EQ(read.size(), made.truth.size());
    for (const auto& [name, wanted] : made.truth) {
      SCOPED_TRACE(name);
      const Measures& is = read[name];
      EXPECT_NEAR(is.area_m2, wanted.area_m2, 1e-4 * wanted.area_m2);
      EXPECT_NEAR(is.volume_m3, wanted.volume_m3, 2e-4 * wanted.volume_m3);
      constexpr double kNear_m = 2e-5;  // float32 over a site of 60 m
      for (const auto& [a, b] :
           {std::pair{is.bounds.min, wanted.bounds.min}, std::pair{is.bounds.max, wanted.bounds.max}}) {
        EXPECT_NEAR(a.x, b.x, kNear_m);
        EXPECT_NEAR(a.y, b.y, kNear_m);
        EXPECT_NEAR(a.z, b.z, kNear_m);
      }
    }
  }
}

}  // namespace
}  // namespace vantage::test
