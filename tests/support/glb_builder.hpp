// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <cstring>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "vantage/scene.hpp"

namespace vantage::test {

// Builds small glTF files, valid or not: `json` is the whole document and may be changed freely before writing.
class GlbBuilder {
 public:
  GlbBuilder() {
    json = {{"asset", {{"version", "2.0"}}}, {"scene", 0}, {"scenes", {{{"nodes", nlohmann::json::array()}}}}};
    for (const char* array : {"nodes", "meshes", "accessors", "bufferViews"}) json[array] = nlohmann::json::array();
  }

  // Each returns the new element's index.
  int view(const void* data, std::size_t bytes, int stride = 0);
  int accessor(int view, std::size_t count, int component_type, const std::string& type, bool normalized = false,
               std::size_t offset = 0);
  template <class T>
  int accessor(const std::vector<T>& values, int component_type, const std::string& type, bool normalized = false) {
    const std::size_t components = type == "SCALAR" ? 1 : static_cast<std::size_t>(type.back() - '0');
    return accessor(view(values.data(), values.size() * sizeof(T)), values.size() / components, component_type, type,
                    normalized);
  }
  int positions(const std::vector<float>& xyz) { return accessor(xyz, 5126, "VEC3"); }
  int mesh(const nlohmann::json& primitive);
  int node(const nlohmann::json& node);  // a root of scene 0
  int child(int parent, const nlohmann::json& node);

  // One triangle (0,0,0) (1,0,0) (0,1,0) in glTF axes under a node of that name; returns the node.
  int triangle(const std::string& name, const nlohmann::json& extras = nullptr);

  std::string glb() const;  // the bytes
  void write_glb(const std::filesystem::path& file) const;
  void write_gltf_external(const std::filesystem::path& file, const std::string& buffer_name,
                           const std::string& uri) const;
  void write_gltf_data_uri(const std::filesystem::path& file) const;

  nlohmann::json json;
  std::vector<std::uint8_t> binary;
};

void write_bytes(const std::filesystem::path& file, const std::string& bytes);
std::string base64(const std::vector<std::uint8_t>& bytes);

// Writes it to a file, loads that and removes it.
Scene load(const GlbBuilder& builder, const SceneOptions& options = {});

}  // namespace vantage::test
