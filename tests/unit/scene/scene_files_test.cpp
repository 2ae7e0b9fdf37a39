// SPDX-License-Identifier: Apache-2.0
// A scene may refer to files below its own folder, by whatever path, and to others only on request.
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <filesystem>
#include <string>

#include "scene/scene_data.hpp"
#include "support/glb_builder.hpp"
#include "support/temporary_folder.hpp"
#include "vantage/error.hpp"
#include "vantage/scene.hpp"

namespace vantage {
namespace {

namespace fs = std::filesystem;

// site/ with a scene of one triangle, whose buffer each test places; beside it are files that it must not read.
class SceneFiles : public testing::Test {
 protected:
  SceneFiles() {
    builder_.triangle("triangle");
    for (const char* sub : {"site/parts", "site-secret", "other"}) fs::create_directories(folder_ / sub);
    const std::string bytes(builder_.binary.begin(), builder_.binary.end());
    for (const char* file : {"site/a.bin", "site/parts/b.bin", "site-secret/a.bin", "other/a.bin", "a.bin"})
      test::write_bytes(folder_ / file, bytes);
  }

  Scene load(const std::string& uri, bool allow_outside = false) const {
    test::GlbBuilder builder = builder_;
    builder.json["buffers"] = {{{"byteLength", builder.binary.size()}, {"uri", uri}}};
    test::write_bytes(scene_, builder.json.dump());
    return Scene::load(scene_, {.allow_outside = allow_outside});
  }

  // Expects one error of that code with these words.
  void refuses(const std::string& uri, Errc code, std::initializer_list<std::string> words,
               bool allow_outside = false) const {
    try {
      load(uri, allow_outside);
      ADD_FAILURE() << uri << " was read";
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), code) << error.what();
      for (const std::string& word : words)
        EXPECT_NE(std::string(error.what()).find(word), std::string::npos) << word << " in: " << error.what();
    }
  }

  // Expects a read only on request; otherwise a message with the name, where it leads and what to do.
  void lies_outside(const std::string& uri, const std::string& name, const fs::path& leads_to) const {
    refuses(uri, Errc::malformed_file,
            {scene_.string(), "buffer 0", '"' + name + '"', fs::canonical(leads_to).string(),
             fs::canonical(folder_ / "site").string(), "setting allow-outside"});
    EXPECT_EQ(load(uri, true).triangle_count(), 1u) << uri;
  }

  test::TemporaryFolder folder_;
  const fs::path scene_ = folder_ / "site/scene.gltf";
  test::GlbBuilder builder_;
};

TEST_F(SceneFiles, BelowTheFolderAreReadWhateverWayLeadsThere) {
  fs::create_symlink("parts/b.bin", folder_ / "site/link.bin");
  fs::create_directory_symlink(folder_ / "site/parts", folder_ / "other/back");
  fs::create_directory_symlink("../other", folder_ / "site/way");
  const std::string home = fs::canonical(folder_ / "site");
  for (const std::string& uri :
       {std::string("a.bin"), std::string("./parts/../a.bin"), std::string("parts/b.bin"), std::string("parts%2Fb.bin"),
        std::string("link.bin"), std::string("../site/a.bin"), home + "/a.bin", std::string("way/back/b.bin")})
    EXPECT_EQ(load(uri).triangle_count(), 1u) << uri;
}

TEST_F(SceneFiles, OutsideAreReadOnlyWhereAllowed) {
  lies_outside("../a.bin", "../a.bin", folder_ / "a.bin");
  lies_outside("parts/../../other/a.bin", "parts/../../other/a.bin", folder_ / "other/a.bin");
  lies_outside("%2e%2e%2Fa.bin", "../a.bin", folder_ / "a.bin");
  lies_outside("%2E%2e/other/%61.bin", "../other/a.bin", folder_ / "other/a.bin");
  lies_outside("../site-secret/a.bin", "../site-secret/a.bin", folder_ / "site-secret/a.bin");
  lies_outside((folder_ / "a.bin").string(), (folder_ / "a.bin").string(), folder_ / "a.bin");
}

TEST_F(SceneFiles, LinksAreFollowedBeforeTheyAreJudged) {
  fs::create_symlink("../other/a.bin", folder_ / "site/file.bin");
  fs::create_symlink("file.bin", folder_ / "site/second.bin");
  fs::create_directory_symlink("../other", folder_ / "site/folder");
  for (const char* uri : {"file.bin", "second.bin", "folder/a.bin"}) lies_outside(uri, uri, folder_ / "other/a.bin");
  lies_outside("folder/../a.bin", "folder/../a.bin", folder_ / "a.bin");
  fs::create_symlink("round.bin", folder_ / "site/round.bin");
  refuses("round.bin", Errc::io, {"buffer 0", "round.bin"});
}

// A refusal does not reveal whether the file exists.
TEST_F(SceneFiles, OutsideThatAreNotThereAreRefusedAlike) {
  refuses("../absent.bin", Errc::malformed_file, {"buffer 0", "absent.bin", "setting allow-outside"});
  refuses("../absent.bin", Errc::io, {"there is no file"}, true);
  refuses("/etc/passwd", Errc::malformed_file, {"buffer 0", "/etc/passwd", "setting allow-outside"});
}

TEST_F(SceneFiles, ThatAreNoRegularFilesAreRefusedAtOnce) {
  ASSERT_EQ(mkfifo((folder_ / "site/pipe.bin").c_str(), 0600), 0);
  fs::create_symlink("/dev/zero", folder_ / "site/device.bin");
  refuses("pipe.bin", Errc::io, {"pipe.bin", "not a regular file"});
  refuses("pipe.bin", Errc::io, {"pipe.bin", "not a regular file"}, true);
  refuses("device.bin", Errc::malformed_file, {"/dev/zero", "setting allow-outside"});
  refuses("device.bin", Errc::io, {"device.bin", "not a regular file"}, true);
  refuses("parts", Errc::io, {"not a regular file"});
  refuses("", Errc::io, {"not a regular file"});
  ASSERT_EQ(mkfifo((folder_ / "scene.glb").c_str(), 0600), 0);
  EXPECT_THROW(Scene::load(folder_ / "scene.glb"), Error);
}

TEST_F(SceneFiles, OtherSchemesAndNulAreNoFileNames) {
  const std::string file_uri = "file://" + (folder_ / "site/a.bin").string();
  for (const bool allow_outside : {false, true}) {
    refuses(file_uri, Errc::malformed_file, {"buffer 0", "file://", "relative"}, allow_outside);
    refuses("file:a.bin", Errc::malformed_file, {"buffer 0", "relative"}, allow_outside);
    refuses("https://example.org/a.bin", Errc::malformed_file, {"buffer 0", "download"}, allow_outside);
    refuses("a.bin%00.png", Errc::malformed_file, {"buffer 0", "a.bin%00.png"}, allow_outside);
  }
}

// Treated as any texture that cannot be read. If allowed, it is read and found to be no picture.
TEST_F(SceneFiles, AnImageOutsideCostsOnlyColour) {
  test::GlbBuilder builder = builder_;
  builder.json["images"] = {{{"uri", "../a.bin"}}};
  builder.json["textures"] = {{{"source", 0}}};
  builder.json["materials"] = {{{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}}}};
  builder.json["meshes"][0]["primitives"][0]["material"] = 0;
  builder.write_glb(scene_);
  for (const bool allow_outside : {false, true}) {
    const Scene scene = Scene::load(scene_, {.allow_outside = allow_outside});
    EXPECT_TRUE(scene.data().images.empty());
    ASSERT_EQ(scene.notes().size(), 1u);
    const std::string& note = scene.notes()[0];
    EXPECT_NE(note.find("texture 0"), std::string::npos) << note;
    EXPECT_EQ(note.find("image 0 lies outside") != std::string::npos, !allow_outside) << note;
    EXPECT_EQ(note.find("setting allow-outside") != std::string::npos, !allow_outside) << note;
  }
}

TEST_F(SceneFiles, AreFoundFromASceneNamedWithoutAFolder) {
  load("a.bin");
  const fs::path before = fs::current_path();
  fs::current_path(folder_ / "site");
  EXPECT_EQ(Scene::load("scene.gltf").triangle_count(), 1u);
  fs::current_path(before);
}

}  // namespace
}  // namespace vantage
