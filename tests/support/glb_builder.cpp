// SPDX-License-Identifier: Apache-2.0
#include "support/glb_builder.hpp"

#include <fstream>

#include "support/temporary_folder.hpp"

namespace vantage::test {

int GlbBuilder::view(const void* data, std::size_t bytes, int stride) {
  while (binary.size() % 4 != 0) binary.push_back(0);
  const std::size_t offset = binary.size();
  binary.resize(offset + bytes);
  if (bytes > 0) std::memcpy(binary.data() + offset, data, bytes);
  nlohmann::json view{{"buffer", 0}, {"byteOffset", offset}, {"byteLength", bytes}};
  if (stride > 0) view["byteStride"] = stride;
  json["bufferViews"].push_back(view);
  return static_cast<int>(json["bufferViews"].size()) - 1;
}

int GlbBuilder::accessor(int view, std::size_t count, int component_type, const std::string& type, bool normalized,
                         std::size_t offset) {
  nlohmann::json accessor{{"count", count}, {"componentType", component_type}, {"type", type}};
  if (view >= 0) accessor["bufferView"] = view;
  if (normalized) accessor["normalized"] = true;
  if (offset > 0) accessor["byteOffset"] = offset;
  json["accessors"].push_back(accessor);
  return static_cast<int>(json["accessors"].size()) - 1;
}

int GlbBuilder::mesh(const nlohmann::json& primitive) {
  json["meshes"].push_back({{"primitives", nlohmann::json::array({primitive})}});
  return static_cast<int>(json["meshes"].size()) - 1;
}

int GlbBuilder::node(const nlohmann::json& node) {
  json["nodes"].push_back(node);
  const int index = static_cast<int>(json["nodes"].size()) - 1;
  json["scenes"][0]["nodes"].push_back(index);
  return index;
}

int GlbBuilder::child(int parent, const nlohmann::json& node) {
  json["nodes"].push_back(node);
  const int index = static_cast<int>(json["nodes"].size()) - 1;
  json["nodes"][static_cast<std::size_t>(parent)]["children"].push_back(index);
  return index;
}

int GlbBuilder::triangle(const std::string& name, const nlohmann::json& extras) {
  const int points = positions({0, 0, 0, 1, 0, 0, 0, 1, 0});
  nlohmann::json entry{{"name", name}, {"mesh", mesh({{"attributes", {{"POSITION", points}}}})}};
  if (!extras.is_null()) entry["extras"] = {{"vantage", extras}};
  // separate places, so that none is a duplicate
  entry["translation"] = {0, 0, -1.0 * static_cast<double>(json["nodes"].size())};
  return node(entry);
}

std::string GlbBuilder::glb() const {
  nlohmann::json document = json;
  if (!document.contains("buffers") && !binary.empty())
    document["buffers"] = nlohmann::json::array({{{"byteLength", binary.size()}}});
  std::string text = document.dump();
  while (text.size() % 4 != 0) text += ' ';
  std::string bytes = "glTF";
  const auto word = [&](std::size_t value) {
    for (int i = 0; i < 4; ++i) bytes += static_cast<char>(value >> (8 * i) & 0xFF);
  };
  const std::size_t padded = (binary.size() + 3) / 4 * 4;
  word(2);
  word(12 + 8 + text.size() + (binary.empty() ? 0 : 8 + padded));
  word(text.size());
  bytes += "JSON" + text;
  if (binary.empty()) return bytes;
  word(padded);
  bytes +=
      std::string("BIN\0", 4) + std::string(binary.begin(), binary.end()) + std::string(padded - binary.size(), '\0');
  return bytes;
}

void GlbBuilder::write_glb(const std::filesystem::path& file) const { write_bytes(file, glb()); }

void GlbBuilder::write_gltf_external(const std::filesystem::path& file, const std::string& buffer_name,
                                     const std::string& uri) const {
  nlohmann::json document = json;
  document["buffers"] = nlohmann::json::array({{{"byteLength", binary.size()}, {"uri", uri}}});
  write_bytes(file, document.dump(1));
  write_bytes(file.parent_path() / buffer_name, std::string(binary.begin(), binary.end()));
}

void GlbBuilder::write_gltf_data_uri(const std::filesystem::path& file) const {
  nlohmann::json document = json;
  document["buffers"] = nlohmann::json::array(
      {{{"byteLength", binary.size()}, {"uri", "data:application/octet-stream;base64," + base64(binary)}}});
  write_bytes(file, document.dump());
}

void write_bytes(const std::filesystem::path& file, const std::string& bytes) {
  if (file.has_parent_path()) std::filesystem::create_directories(file.parent_path());
  std::filesystem::remove(file);  // some file systems flush when a file is overwritten, which takes milliseconds
  std::ofstream(file, std::ios::binary) << bytes;
}

std::string base64(const std::vector<std::uint8_t>& bytes) {
  static const char* const kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string out;
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    std::uint32_t group = 0;
    for (std::size_t k = 0; k < 3; ++k) group = group << 8 | (i + k < bytes.size() ? bytes[i + k] : 0U);
    for (std::size_t k = 0; k < 4; ++k) out += i + k > bytes.size() ? '=' : kDigits[group >> (18 - 6 * k) & 63];
  }
  return out;
}

Scene load(const GlbBuilder& builder, const SceneOptions& options) {
  const TemporaryFolder folder;
  builder.write_glb(folder / "scene.glb");
  return Scene::load(folder / "scene.glb", options);
}

}  // namespace vantage::test
