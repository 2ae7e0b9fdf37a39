// SPDX-License-Identifier: Apache-2.0
// The library's handling of importers, played by scripts: errors, and the cache.
#include "import/import.hpp"

#include <linux/landlock.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <chrono>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <stop_token>
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
  void use_copier() const { use_script("exec cat ${0%/*}/scene.glb"); }

  const std::filesystem::path model_ = write("model.obj", kObj);
};

TEST_F(ImporterTest, GetsFormatAndFile) {
  use_script("test \"$1\" = obj && test \"$2\" = " + model_.string() + " && exec cat ${0%/*}/scene.glb");
  EXPECT_EQ(import(model_), glb("triangle"));
}

TEST_F(ImporterTest, GlbIsKeptByContent) {
  use_copier();
  EXPECT_EQ(import(model_), glb("triangle"));
  ASSERT_EQ(entries().size(), 1u);
  write("importers/scene.glb", glb("another"));
  EXPECT_EQ(import(model_), glb("triangle"));
  EXPECT_EQ(import(write("copy/other_name.obj", kObj)), glb("triangle"));
  EXPECT_EQ(import(write("model.obj", std::string(kObj) + "f 3 2 1\n")), glb("another"));
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
  const auto content = [&] {
    std::ifstream stream(entry, std::ios::binary);
    return std::string(std::istreambuf_iterator<char>(stream), {});
  };
  const std::string whole = content();
  EXPECT_EQ(whole.find(glb("triangle")), 0u);
  std::string changed = whole;
  changed[glb("triangle").size() - 1] ^= 1;
  for (const std::string& broken :
       {std::string(), std::string("text"), whole.substr(0, 100), glb("kept"), changed,
        whole.substr(0, whole.size() - 1), glb("kept") + whole.substr(glb("triangle").size())}) {
    std::ofstream(entry, std::ios::binary) << broken;
    EXPECT_EQ(import(model_), glb("triangle"));
    EXPECT_EQ(content(), whole);
  }
}

TEST_F(ImporterTest, EntriesAreForTheirUserAlone) {
  use_copier();
  import(model_);
  using std::filesystem::perms;
  EXPECT_EQ(std::filesystem::status(entries().front()).permissions(), perms::owner_read | perms::owner_write);
}

// Each would hold up the program itself, which reads a model for its key.
TEST_F(ImporterTest, WhatAModelNamesIsReadWithinBounds) {
  use_copier();
  const auto begin = std::chrono::steady_clock::now();
  const auto sparse = folder_.path() / "sparse.mtl";
  std::ofstream(sparse) << "newmtl a\n";
  std::filesystem::resize_file(sparse, std::uintmax_t{1} << 40);
  std::string twice;
  for (int k = 0; k < 20'000; ++k) twice += "mtllib table.mtl\n";
  write("table.mtl", std::string(1 << 20, '#'));
  for (const std::string& tables :
       {std::string("mtllib /dev/zero\n"), std::string("mtllib ../../../../../../dev/zero\n"), twice,
        std::string("mtllib sparse.mtl\n"), "mtllib " + std::string(50'000'000, 'a') + "\n"})
    EXPECT_EQ(import(write("model.obj", kObj + tables)), glb("triangle"));
  EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::seconds(60));
}

TEST_F(ImporterTest, ReadingForTheKeyIsStopped) {
  use_copier();
  std::stop_source stop;
  stop.request_stop();
  EXPECT_TRUE(
      importers::as_glb(model_, *importers::recognise(model_).format, {}, {}, {.stop = stop.get_token()}).empty());
}

TEST_F(ImporterTest, ReadsItsModelAndTheTablesItNamesAlone) {
  const bool landlock = syscall(SYS_landlock_create_ruleset, nullptr, 0, LANDLOCK_CREATE_RULESET_VERSION) > 0;
  write("key", "secret");
  write("colours.mtl", "newmtl red\n");
  write("others/far.mtl", "newmtl blue\n");
  std::filesystem::create_symlink(folder_ / "others/far.mtl", folder_ / "near.mtl");
  const auto model = write("site/model.obj", std::string("mtllib colours.mtl\nmtllib ../key\nmtllib far.mtl\n") + kObj);
  write("site/colours.mtl", "newmtl red\n");
  write("site/other.obj", "other");
  std::filesystem::create_symlink(folder_ / "others/far.mtl", folder_ / "site/far.mtl");
  for (const auto& [file, may] : {std::pair{"site/model.obj", true},
                                  {"site/colours.mtl", true},
                                  {"site/other.obj", false},
                                  {"site/far.mtl", false},
                                  {"key", false}}) {
    use_script("read line <" + (folder_ / file).string() + " && exec cat ${0%/*}/scene.glb; exit 3");
    if (may || !landlock)
      EXPECT_EQ(import(model), glb("triangle")) << file;
    else
      expect_error(Errc::malformed_file, "exit code", [&] { import(model); });
    std::filesystem::remove_all(cache());
  }
}

TEST_F(ImporterTest, WhatIsNoFileInAFolderIsNamed) {
  const auto scans = folder_.path() / "scans";
  write("scans/a.xyz", "0 0 0\n1 0 0\n0 1 0\n");
  const auto refused = [&](const std::string& words) {
    expect_error(Errc::io, words, [&] { importers::files_of(scans); });
    std::filesystem::remove(scans / "b.xyz");
  };
  std::filesystem::create_symlink("/dev/zero", scans / "b.xyz");
  refused("b.xyz: this is a link to /dev/zero, which is a device");
  std::filesystem::create_symlink("gone.xyz", scans / "b.xyz");
  refused("b.xyz: this is a link to gone.xyz, where there is nothing");
  std::filesystem::create_directory(scans / "b.xyz");
  refused("b.xyz: this is a folder");
  ASSERT_EQ(mkfifo((scans / "b.xyz").c_str(), 0600), 0);
  refused("b.xyz: this is a pipe");
  EXPECT_EQ(importers::files_of(scans).size(), 1u);
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
  failing("exec head -c 200 ${0%/*}/scene.glb", Errc::malformed_file, "gave no GLB");
  failing("exec sleep 60", Errc::malformed_file, "took more than 1 s", {.wall_s = 1});
  failing("while :; do :; done", Errc::malformed_file, "took more than 1 s of computing", {.cpu_s = 1});
  failing("exec cat ${0%/*}/scene.glb", Errc::malformed_file, "would take more than", {.output = 100});
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
