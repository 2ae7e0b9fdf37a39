// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <span>
#include <string>

namespace vantage::importer {

// Returns the bytes of a GLB: a document, to which `buffers` are added, and its binary chunk. Throws std::length_error
// above 4 GiB, the limit of GLB.
std::string glb_bytes(nlohmann::json document, const std::string& binary);

// Collects the binary chunk of a GLB, its views and its accessors.
class Buffer {
 public:
  // Each returns the index of the accessor.
  int add_positions(std::span<const float> xyz);
  int add_normals(std::span<const float> xyz);
  int add_colours(std::span<const std::uint8_t> rgba);
  int add_indices(std::span<const std::uint32_t> indices);

  // Adds the arrays `accessors`, `bufferViews` and `buffers` to the document and returns the file's bytes, as above.
  std::string finish(nlohmann::json document) const;

 private:
  nlohmann::json& add(const void* data, std::size_t bytes, std::size_t count, int component, const char* type);
  int last() const { return static_cast<int>(accessors_.size()) - 1; }

  std::string bytes_;
  nlohmann::json views_ = nlohmann::json::array(), accessors_ = nlohmann::json::array();
};

}  // namespace vantage::importer
