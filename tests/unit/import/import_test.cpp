// SPDX-License-Identifier: Apache-2.0
// The library's handling of importers, played by scripts: errors, and the cache.
#include "import/import.hpp"

#include <cstdlib>
#include <fstream>
#include <iterator>
#include <thread>

#include "import_fixture.hpp"
#include "support/glb_builder.hpp"

namespace vantage::test {
namespace {

constexpr const char* kObj = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";

class ImporterTest : public ImportTest {
 protected:
  ImporterTest() { write("importers/scene.glb", glb("triangle")); }

  static std::string glb(const std::string& name) {
    GlbBuilder builder;
    builder.triangle(name);
    return builder.glb();
  }
  // As the bytes of the GLB.
  std::string import(const std::filesystem::path& file, const importers::Limits& limits = {}) const {
    const auto bytes = importers::as_glb(file, *importers::recognise(file).format, limits);
    return {bytes.begin(), bytes.end()};
  }
  std::vector<std::filesystem::path> entries() const {
    std::vector<std::filesystem::path> out;
    if (std::filesystem::exists(cache()))
      for (const auto& entry : std::filesystem::directory_iterator(cache())) out.push_back(entry.path());
    return out;
  }
  void use_copier() const { use_script("cat $(dirname $0)/scene.glb"); }

  const std::filesystem::path model_ = write("model.obj", kObj);
};

TEST_F(ImporterTest, GetsFormatAndFile) {
  use_script("test \"$1\" = obj && test \"$2\" = " + model_.string() + " && cat $(dirname $0)/scene.glb");
  EXPECT_EQ(import(model_), glb("triangle"));
}

TEST_F(ImporterTest, GlbIsKeptByContent) {
  use_copier();
  EXPECT_EQ(import(model_), glb("triangle"));
  ASSERT_EQ(entries().size(), 1u);
  std::ofstream(entries().front(), std::ios::binary) << glb("kept");
  EXPECT_EQ(import(model_), glb("kept"));
  EXPECT_EQ(import(write("copy/other_name.obj", kObj)), glb("kept"));
  EXPECT_EQ(import(write("model.obj", std::string(kObj) + "f 3 2 1\n")), glb("triangle"));
  EXPECT_EQ(entries().size(), 2u);
}

TEST_F(ImporterTest, TablesOfMaterialsCountAsContent) {
  use_copier();
  const auto model = write("model.obj", std::string("mtllib my colours.mtl\r\n") + kObj);
  write("my colours.mtl", "newmtl red\n");
  import(model);
  import(model);
  EXPECT_EQ(entries().size(), 1u);
  write("my colours.mtl", "newmtl blue\n");
  import(model);
  EXPECT_EQ(entries().size(), 2u);
}

TEST_F(ImporterTest, BrokenEntryIsMadeAnew) {
  use_copier();
  import(model_);
  const auto entry = entries().front();
  for (const std::string& broken : {std::string(), std::string("text"), glb("triangle").substr(0, 100)}) {
    std::ofstream(entry, std::ios::binary) << broken;
    EXPECT_EQ(import(model_), glb("triangle"));
  }
  std::ifstream stream(entry, std::ios::binary);
  EXPECT_EQ(std::string(std::istreambuf_iterator<char>(stream), {}), glb("triangle"));
}

TEST_F(ImporterTest, WorksWithoutACache) {
  use_copier();
  write("cache", "a file where the folder should be");
  EXPECT_EQ(import(model_), glb("triangle"));
  setenv("XDG_CACHE_HOME", "relative", 1);
  setenv("HOME", "", 1);
  EXPECT_EQ(import(model_), glb("triangle"));
}

TEST_F(ImporterTest, SeveralAtATimeDoNotDisturbEachOther) {
  use_copier();
  std::vector<std::string> results(8);
  std::vector<std::thread> threads;
  for (auto& result : results) threads.emplace_back([&] { result = import(model_); });
  for (auto& thread : threads) thread.join();
  for (const auto& result : results) EXPECT_EQ(result, glb("triangle"));
  EXPECT_EQ(entries().size(), 1u);
}

TEST_F(ImporterTest, FailuresAreOneClearError) {
  const auto failing = [&](const std::string& script, Errc code, const std::string& words,
                           const importers::Limits& limits = {}) {
    use_script(script);
    const std::string message = expect_error(code, words, [&] { import(model_, limits); });
    EXPECT_EQ(message.find(model_.string()), 0u) << message;
    EXPECT_TRUE(entries().empty());
  };
  failing("kill -SEGV $$", Errc::malformed_file, "the importer of OBJ crashed (signal 11)");
  failing("echo 'it holds ink' >&2; exit 65", Errc::malformed_file, "model.obj: it holds ink");
  failing("kill -INT $$", Errc::io, "was stopped (signal 2)");
  failing("exit 3", Errc::malformed_file, "failed (exit code 3)");
  failing("exit 71", Errc::out_of_memory, "needs more memory than the 3.0 GiB", {.memory = std::uint64_t{3} << 30});
  failing("echo 'reader is not installed' >&2; exit 69", Errc::io, "reader is not installed");
  failing("echo 'libassimp.so.5: cannot open shared object file' >&2; exit 127", Errc::io,
          "cannot be started: libassimp.so.5: cannot open shared object file; install vantage again");
  failing("echo no GLB", Errc::malformed_file, "gave no GLB");
  failing("head -c 200 $(dirname $0)/scene.glb", Errc::malformed_file, "gave no GLB");
  failing("sleep 60", Errc::malformed_file, "took more than 1 s", {.wall_s = 1});
  failing("while :; do :; done", Errc::malformed_file, "took more than 1 s of computing", {.cpu_s = 1});
  failing("cat $(dirname $0)/scene.glb", Errc::malformed_file, "would take more than", {.output = 100});
}

TEST_F(ImporterTest, OneThatMayNotRunIsToldFromADamagedFile) {
  use_script("exit 0");
  std::filesystem::permissions(folder_.path() / "importers/vantage-import-mesh", std::filesystem::perms::owner_read);
  expect_error(Errc::io, "cannot be started; install vantage again", [&] { import(model_); });
}

TEST_F(ImporterTest, MissingOneIsNamedWithWhatBringsIt) {
  setenv("VANTAGE_IMPORTERS", folder_.path().c_str(), 1);
  expect_error(Errc::io,
               "this is OBJ, which vantage-import-mesh turns into glTF, and that is not installed; install "
               "libassimp-dev",
               [&] { import(model_); });
  const auto building = write("a.ifc", "ISO-10303-21;\nFILE_SCHEMA(('IFC4'));");
  expect_error(Errc::io, "setup.sh --ifc", [&] { import(building); });
  const auto cloud = write("a.las", "LASF");
  expect_error(
      Errc::io,
      "this is LAS, which vantage-import-cloud turns into glTF, and that is not installed; install libexpat1-dev",
      [&] { import(cloud); });
}

TEST_F(ImporterTest, SceneTakesItsNotesAndItsErrors) {
  GlbBuilder builder;
  builder.triangle("wall");
  builder.json["asset"]["extras"] = {{"notes", {"2 lamps are left out"}}};
  write("importers/scene.glb", builder.glb());
  use_copier();
  const Scene scene = Scene::load(write("model.stl", kObj));
  ASSERT_GE(scene.notes().size(), 2u);
  EXPECT_EQ(scene.notes()[0], "it is named as STL, but holds OBJ, and is read as that");
  EXPECT_EQ(scene.notes()[1], "2 lamps are left out");
  expect_error(Errc::invalid_argument, "matches no node", [&] { Scene::load(model_, {.surveyed = {"roof*"}}); });
}

}  // namespace
}  // namespace vantage::test
