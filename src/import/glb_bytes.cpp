// SPDX-License-Identifier: Apache-2.0
#include "import/glb_bytes.hpp"

#include <algorithm>
#include <array>
#include <limits>

#include "core/glb_head.hpp"
#include "core/json_text.hpp"

namespace vantage::importer {
namespace {

using nlohmann::json;

constexpr int kUnsignedByte = 5121, kUnsignedInt = 5125, kFloat = 5126;

}  // namespace

json& Buffer::add(const void* data, std::size_t bytes, std::size_t count, int component, const char* type) {
  const std::size_t offset = bytes_.size();
  bytes_.append(static_cast<const char*>(data), bytes);
  bytes_.resize((bytes_.size() + 3) / 4 * 4);
  views_.push_back({{"buffer", 0}, {"byteOffset", offset}, {"byteLength", bytes}});
  accessors_.push_back(
      {{"bufferView", views_.size() - 1}, {"componentType", component}, {"count", count}, {"type", type}});
  return accessors_.back();
}

int Buffer::add_positions(std::span<const float> xyz) {
  std::array<float, 3> low, high;
  low.fill(std::numeric_limits<float>::max());
  high.fill(std::numeric_limits<float>::lowest());
  for (std::size_t i = 0; i < xyz.size(); ++i) {
    low[i % 3] = std::min(low[i % 3], xyz[i]);
    high[i % 3] = std::max(high[i % 3], xyz[i]);
  }
  json& accessor = add(xyz.data(), xyz.size_bytes(), xyz.size() / 3, kFloat, "VEC3");
  accessor["min"] = low;
  accessor["max"] = high;
  return last();
}

int Buffer::add_normals(std::span<const float> xyz) {
  add(xyz.data(), xyz.size_bytes(), xyz.size() / 3, kFloat, "VEC3");
  return last();
}

int Buffer::add_colours(std::span<const std::uint8_t> rgba) {
  add(rgba.data(), rgba.size_bytes(), rgba.size() / 4, kUnsignedByte, "VEC4")["normalized"] = true;
  return last();
}

int Buffer::add_indices(std::span<const std::uint32_t> indices) {
  add(indices.data(), indices.size_bytes(), indices.size(), kUnsignedInt, "SCALAR");
  return last();
}

std::string Buffer::finish(json document) const {
  document["accessors"] = accessors_;
  document["bufferViews"] = views_;
  return glb_bytes(std::move(document), bytes_);
}

std::string glb_bytes(json document, const std::string& binary) {
  document["buffers"] = json::array({{{"byteLength", binary.size()}}});
  std::string out = glb_head(json_text(document), binary.size());
  return out += binary;
}

}  // namespace vantage::importer
