// SPDX-License-Identifier: Apache-2.0
#include "import/glb_bytes.hpp"

#include <algorithm>
#include <array>
#include <limits>
#include <stdexcept>

namespace vantage::importer {
namespace {

using nlohmann::json;

constexpr int kUnsignedByte = 5121, kUnsignedInt = 5125, kFloat = 5126;
constexpr std::uint32_t kMagic = 0x46546C67, kJson = 0x4E4F534A, kBinary = 0x004E4942;

void append_word(std::string& out, std::size_t value) {
  for (int shift = 0; shift < 32; shift += 8) out += static_cast<char>((value >> shift) & 0xFF);
}

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
  std::string text = document.dump(-1, ' ', false, json::error_handler_t::replace);
  text.resize((text.size() + 3) / 4 * 4, ' ');
  const std::size_t total = 12 + 8 + text.size() + 8 + binary.size();
  if (total > std::numeric_limits<std::uint32_t>::max()) throw std::length_error("GLB");
  std::string out;
  out.reserve(total);
  for (const std::size_t word : {std::size_t{kMagic}, std::size_t{2}, total, text.size(), std::size_t{kJson}})
    append_word(out, word);
  out += text;
  append_word(out, binary.size());
  append_word(out, kBinary);
  return out += binary;
}

}  // namespace vantage::importer
