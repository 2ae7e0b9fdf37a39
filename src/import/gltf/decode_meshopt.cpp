// SPDX-License-Identifier: Apache-2.0
#include <meshoptimizer.h>

#include "import/gltf/decode.hpp"
#include "import/program.hpp"

namespace vantage::importer {
namespace {

void filter(const std::string& name, std::string& bytes, std::size_t count, std::size_t stride) {
  if (name == "NONE") return;
  // Strides that the filters accept.
  const bool fits = name == "OCTAHEDRAL"    ? stride == 4 || stride == 8
                    : name == "QUATERNION"  ? stride == 8
                    : name == "EXPONENTIAL" ? stride % 4 == 0
                                            : false;
  if (!fits)
    throw Refused("a meshopt filter " + name + " of rows of " + std::to_string(stride) + " bytes is not known");
  // Filters work on four rows at a time.
  bytes.resize((count + 3) / 4 * 4 * stride);
  const std::size_t rows = bytes.size() / stride;
  if (name == "OCTAHEDRAL") meshopt_decodeFilterOct(bytes.data(), rows, stride);
  if (name == "QUATERNION") meshopt_decodeFilterQuat(bytes.data(), rows, stride);
  if (name == "EXPONENTIAL") meshopt_decodeFilterExp(bytes.data(), rows, stride);
  bytes.resize(count * stride);
}

}  // namespace

std::string decode_meshopt(const nlohmann::json& extension, std::string_view packed) {
  const auto count = extension.at("count").get<std::size_t>(), stride = extension.at("byteStride").get<std::size_t>();
  const auto mode = extension.at("mode").get<std::string>();
  const auto* source = reinterpret_cast<const unsigned char*>(packed.data());
  constexpr std::size_t kMostRows = std::size_t{1} << 32, kWidest = 256;
  if (count > kMostRows || stride == 0 || stride > kWidest) throw Refused("a buffer view packed by meshopt is damaged");
  std::string out(count * stride, '\0');
  int failure = -1;
  if (mode == "ATTRIBUTES" && stride % 4 == 0) {
    failure = meshopt_decodeVertexBuffer(out.data(), count, stride, source, packed.size());
  } else if (mode == "TRIANGLES" && count % 3 == 0 && (stride == 2 || stride == 4)) {
    failure = meshopt_decodeIndexBuffer(out.data(), count, stride, source, packed.size());
  } else if (mode == "INDICES" && (stride == 2 || stride == 4)) {
    failure = meshopt_decodeIndexSequence(out.data(), count, stride, source, packed.size());
  }
  if (failure != 0)
    throw Refused("a buffer view packed by meshopt cannot be unpacked: it is damaged, or of a newer version");
  if (mode == "ATTRIBUTES") filter(extension.value("filter", "NONE"), out, count, stride);
  return out;
}

}  // namespace vantage::importer
