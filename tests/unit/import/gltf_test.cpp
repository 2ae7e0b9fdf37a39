// SPDX-License-Identifier: Apache-2.0
// Compressed glTF gives the scene that it has been packed from.
#include <draco/compression/encode.h>
#include <meshoptimizer.h>
#include <zlib.h>

#include <algorithm>
#include <random>

#include "import_fixture.hpp"
#include "support/glb_builder.hpp"
#include "vantage/scene.hpp"

namespace vantage::test {
namespace {

const std::vector<float> kPoints{0, 0, 0, 4, 0, 0, 4, 3, 0, 0, 3, 0, 2, 4, 0};
const std::vector<std::uint32_t> kIndices{0, 1, 2, 0, 2, 3, 3, 2, 4};

// A wall and, by a plain accessor, a floor.
GlbBuilder plain() {
  GlbBuilder builder;
  const int points = builder.positions(kPoints), indices = builder.accessor(kIndices, 5125, "SCALAR");
  builder.node({{"name", "wall"},
                {"mesh", builder.mesh({{"attributes", {{"POSITION", points}}}, {"indices", indices}})},
                {"translation", {1, 2, 3}}});
  builder.triangle("floor");
  return builder;
}

// The wall's buffer views are 0 and 1, its accessors 0 and 1.
GlbBuilder packed_by_meshopt(const char* extension) {
  GlbBuilder builder = plain();
  const auto pack = [&](std::size_t view, std::size_t count, std::size_t stride, const char* mode,
                        const std::vector<unsigned char>& bytes) {
    const auto placed = builder.json["bufferViews"][static_cast<std::size_t>(builder.view(bytes.data(), bytes.size()))];
    builder.json["bufferViews"].erase(builder.json["bufferViews"].size() - 1);
    builder.json["bufferViews"][view]["buffer"] = 1;
    builder.json["bufferViews"][view]["extensions"][extension] = {{"buffer", 0},
                                                                  {"byteOffset", placed["byteOffset"]},
                                                                  {"byteLength", bytes.size()},
                                                                  {"count", count},
                                                                  {"byteStride", stride},
                                                                  {"mode", mode}};
  };
  const std::size_t points = kPoints.size() / 3;
  std::vector<unsigned char> bytes(meshopt_encodeVertexBufferBound(points, 12));
  bytes.resize(meshopt_encodeVertexBuffer(bytes.data(), bytes.size(), kPoints.data(), points, 12));
  pack(0, points, 12, "ATTRIBUTES", bytes);
  bytes.resize(meshopt_encodeIndexBufferBound(kIndices.size(), points));
  bytes.resize(meshopt_encodeIndexBuffer(bytes.data(), bytes.size(), kIndices.data(), kIndices.size()));
  pack(1, kIndices.size(), 4, "TRIANGLES", bytes);
  builder.json["extensionsUsed"] = builder.json["extensionsRequired"] = {extension};
  builder.json["buffers"] = {{{"byteLength", builder.binary.size()}},
                             {{"byteLength", 96}, {"extensions", {{extension, {{"fallback", true}}}}}}};
  return builder;
}

GlbBuilder packed_by_draco(bool with_fallback) {
  draco::Mesh mesh;
  mesh.SetNumFaces(kIndices.size() / 3);
  for (std::uint32_t f = 0; f < kIndices.size() / 3; ++f) {
    draco::Mesh::Face face;
    for (std::uint32_t c = 0; c < 3; ++c) face[c] = draco::PointIndex(kIndices[3 * f + c]);
    mesh.SetFace(draco::FaceIndex(f), face);
  }
  const auto points = static_cast<std::uint32_t>(kPoints.size() / 3);
  mesh.set_num_points(points);
  draco::GeometryAttribute shape;
  shape.Init(draco::GeometryAttribute::POSITION, nullptr, 3, draco::DT_FLOAT32, false, 12, 0);
  const int id = mesh.AddAttribute(shape, true, points);
  for (std::uint32_t v = 0; v < points; ++v)
    mesh.attribute(id)->SetAttributeValue(draco::AttributeValueIndex(v), &kPoints[3 * v]);
  draco::Encoder encoder;
  encoder.SetEncodingMethod(draco::MESH_SEQUENTIAL_ENCODING);  // keeps the order
  draco::EncoderBuffer buffer;
  EXPECT_TRUE(encoder.EncodeMeshToBuffer(mesh, &buffer).ok());

  GlbBuilder builder = plain();
  const int view = builder.view(buffer.data(), buffer.size());
  builder.json["meshes"][0]["primitives"][0]["extensions"]["KHR_draco_mesh_compression"] = {
      {"bufferView", view}, {"attributes", {{"POSITION", mesh.attribute(id)->unique_id()}}}};
  builder.json["extensionsUsed"] = {"KHR_draco_mesh_compression"};
  if (!with_fallback) {
    builder.json["extensionsRequired"] = {"KHR_draco_mesh_compression"};
    for (std::size_t a : {0, 1}) builder.json["accessors"][a].erase("bufferView");
  }
  return builder;
}

std::string gzipped(const std::string& bytes) {
  z_stream stream{};
  deflateInit2(&stream, Z_BEST_COMPRESSION, Z_DEFLATED, 16 + MAX_WBITS, 9, Z_DEFAULT_STRATEGY);
  std::string out(deflateBound(&stream, bytes.size()), '\0');
  stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(bytes.data()));
  stream.avail_in = static_cast<uInt>(bytes.size());
  stream.next_out = reinterpret_cast<Bytef*>(out.data());
  stream.avail_out = static_cast<uInt>(out.size());
  EXPECT_EQ(deflate(&stream, Z_FINISH), Z_STREAM_END);
  out.resize(stream.total_out);
  deflateEnd(&stream);
  return out;
}

class CompressedGltfTest : public ImportTest {
 protected:
  const std::uint64_t wanted_ = load(plain()).fingerprint();
};

TEST_F(CompressedGltfTest, MeshoptimizerIsUnpacked) {
  for (const char* extension : {"EXT_meshopt_compression", "KHR_meshopt_compression"})
    EXPECT_EQ(Scene::load(write("packed.glb", packed_by_meshopt(extension).glb())).fingerprint(), wanted_) << extension;
}

TEST_F(CompressedGltfTest, DracoIsUnpacked) {
  EXPECT_EQ(Scene::load(write("packed.glb", packed_by_draco(false).glb())).fingerprint(), wanted_);
}

TEST_F(CompressedGltfTest, DracoThatCannotBeReadGivesWayToItsFallback) {
  EXPECT_EQ(Scene::load(write("packed.glb", packed_by_draco(true).glb())).fingerprint(), wanted_);
  const auto damaged = [](bool with_fallback) {
    GlbBuilder builder = packed_by_draco(with_fallback);
    builder.binary[builder.json["bufferViews"].back()["byteOffset"].get<std::size_t>()] ^=
        0xFF;  // Draco's first letter
    return builder.glb();
  };
  EXPECT_EQ(Scene::load(write("damaged.glb", damaged(true))).fingerprint(), wanted_);
  const auto file = write("lost.glb", damaged(false));
  expect_error(Errc::malformed_file, "lost.glb: mesh 0 primitive 0: its Draco data cannot be unpacked",
               [&] { Scene::load(file); });
}

TEST_F(CompressedGltfTest, GzipIsUnpacked) {
  EXPECT_EQ(Scene::load(write("site.glb.gz", gzipped(plain().glb()))).fingerprint(), wanted_);
  EXPECT_EQ(Scene::load(write("twice.glb.gz", gzipped(packed_by_draco(false).glb()))).fingerprint(), wanted_);
  const auto other = write("site.obj.gz", gzipped("v 0 0 0\n"));
  expect_error(Errc::malformed_file, "this gzip file holds no glTF", [&] { Scene::load(other); });
  const auto cut = write("cut.glb.gz", gzipped(plain().glb()).substr(0, 100));
  expect_error(Errc::malformed_file, "damaged or cut off", [&] { Scene::load(cut); });
}

TEST_F(CompressedGltfTest, BuffersMayLieInFilesBelowTheFolder) {
  GlbBuilder packed = packed_by_draco(false);
  packed.write_gltf_external(folder_ / "packed.gltf", "parts of it.bin", "parts%20of%20it.bin");
  EXPECT_EQ(Scene::load(folder_ / "packed.gltf").fingerprint(), wanted_);
  write("below/packed.gltf", "");
  packed.write_gltf_external(folder_ / "below/packed.gltf", "../parts.bin", "../parts.bin");
  expect_error(Errc::malformed_file, "only files below its own folder are read",
               [&] { Scene::load(folder_ / "below/packed.gltf"); });
}

TEST_F(CompressedGltfTest, DamagedOnesGiveASceneOrOneError) {
  const std::string sound[] = {packed_by_meshopt("EXT_meshopt_compression").glb(), packed_by_draco(false).glb(),
                               gzipped(plain().glb())};
  std::mt19937 random(20'26);
  int refused = 0;
  for (int k = 0; k < 60; ++k) {
    std::string bytes = sound[k % 3];
    for (std::uint32_t flips = 1 + random() % 4; flips > 0; --flips)
      bytes[random() % bytes.size()] ^= static_cast<char>(1U << (random() % 8));
    const auto file = write(std::to_string(k) + ".glb", bytes);
    try {
      load_within(file, 2);
    } catch (const Error& error) {
      ++refused;
      EXPECT_EQ(std::string(error.what()).find(file.string()), 0u) << error.what();
    }
  }
  EXPECT_GT(refused, 0);
}

}  // namespace
}  // namespace vantage::test
