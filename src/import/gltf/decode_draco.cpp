// SPDX-License-Identifier: Apache-2.0
#include <draco/compression/decode.h>

#include "import/gltf/decode.hpp"
#include "import/program.hpp"

namespace vantage::importer {
namespace {

constexpr int kByte = 5120, kUnsignedByte = 5121, kShort = 5122, kUnsignedShort = 5123, kUnsignedInt = 5125,
              kFloat = 5126;

template <class T>
std::string values_of(const draco::Mesh& mesh, const draco::PointAttribute& attribute) {
  const int components = attribute.num_components();
  std::vector<T> row(static_cast<std::size_t>(components));
  std::string out;
  out.reserve(mesh.num_points() * row.size() * sizeof(T));
  for (draco::PointIndex point(0); point < mesh.num_points(); ++point) {
    if (!attribute.ConvertValue<T>(attribute.mapped_index(point), static_cast<std::int8_t>(components), row.data()))
      throw Refused("an attribute packed by Draco is not of the type that its accessor states");
    out.append(reinterpret_cast<const char*>(row.data()), row.size() * sizeof(T));
    out.resize((out.size() + 3) / 4 * 4);  // rows begin at multiples of 4
  }
  return out;
}

std::string values_of(const draco::Mesh& mesh, const draco::PointAttribute& attribute, int type) {
  switch (type) {
    case kByte: return values_of<std::int8_t>(mesh, attribute);
    case kUnsignedByte: return values_of<std::uint8_t>(mesh, attribute);
    case kShort: return values_of<std::int16_t>(mesh, attribute);
    case kUnsignedShort: return values_of<std::uint16_t>(mesh, attribute);
    case kUnsignedInt: return values_of<std::uint32_t>(mesh, attribute);
    case kFloat: return values_of<float>(mesh, attribute);
    default: throw Refused("an accessor has the component type " + std::to_string(type) + ", which glTF does not have");
  }
}

}  // namespace

DracoMesh decode_draco(std::string_view packed, const std::map<std::string, std::uint32_t>& wanted,
                       const std::map<std::string, int>& types) {
  draco::DecoderBuffer buffer;
  buffer.Init(packed.data(), packed.size());
  draco::Decoder decoder;
  auto result = decoder.DecodeMeshFromBuffer(&buffer);
  if (!result.ok()) throw Refused("its Draco data cannot be unpacked: " + result.status().error_msg_string());
  const draco::Mesh& mesh = *result.value();
  DracoMesh out;
  out.points = mesh.num_points();
  out.indices.reserve(3 * std::size_t{mesh.num_faces()});
  for (draco::FaceIndex face(0); face < mesh.num_faces(); ++face)
    for (const draco::PointIndex& point : mesh.face(face)) out.indices.push_back(point.value());
  for (const auto& [name, number] : wanted) {
    const draco::PointAttribute* attribute = mesh.GetAttributeByUniqueId(number);
    if (!attribute) throw Refused("its Draco data lacks the attribute " + name);
    out.attributes[name] = {types.at(name), attribute->num_components(), values_of(mesh, *attribute, types.at(name))};
  }
  return out;
}

}  // namespace vantage::importer
