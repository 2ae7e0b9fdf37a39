// SPDX-License-Identifier: Apache-2.0
#include "generate/glb_writer.hpp"

#include <algorithm>
#include <cstring>
#include <limits>
#include <stdexcept>

#include "core/atomic_file.hpp"
#include "core/glb_head.hpp"
#include "core/json_text.hpp"
#include "vantage/error.hpp"

namespace vantage::built_in {
namespace {

using nlohmann::json;

constexpr int kFloat = 5126, kUnsignedShort = 5123, kUnsignedInt = 5125;

// Collects the binary chunk and its views and accessors.
class Buffer {
 public:
  template <class T>
  int add(const std::vector<T>& values, std::size_t count, int component_type, const char* type) {
    while (bytes_.size() % 4 != 0) bytes_.push_back(0);
    const std::size_t offset = bytes_.size(), size = values.size() * sizeof(T);
    bytes_.resize(offset + size);
    std::memcpy(bytes_.data() + offset, values.data(), size);
    views_.push_back({{"buffer", 0}, {"byteOffset", offset}, {"byteLength", size}});
    accessors_.push_back(
        {{"bufferView", views_.size() - 1}, {"componentType", component_type}, {"count", count}, {"type", type}});
    return static_cast<int>(accessors_.size()) - 1;
  }
  json& accessor(int index) { return accessors_[static_cast<std::size_t>(index)]; }
  std::vector<std::uint8_t> bytes_;
  json views_ = json::array(), accessors_ = json::array();
};

std::vector<float> turned(const std::vector<Float3>& values) {  // Z up to Y up
  std::vector<float> out;
  out.reserve(3 * values.size());
  for (const Float3& p : values) out.insert(out.end(), {p.x, p.z, 0.0F - p.y});
  return out;
}

int add_positions(Buffer& buffer, const std::vector<Float3>& positions) {
  const std::vector<float> values = turned(positions);
  const int index = buffer.add(values, positions.size(), kFloat, "VEC3");
  float low[3], high[3];
  for (std::size_t c = 0; c < 3; ++c) {
    low[c] = high[c] = values[c];
    for (std::size_t i = c; i < values.size(); i += 3) {
      low[c] = std::min(low[c], values[i]);
      high[c] = std::max(high[c], values[i]);
    }
  }
  buffer.accessor(index)["min"] = low;
  buffer.accessor(index)["max"] = high;
  return index;
}

int add_indices(Buffer& buffer, const Mesh& mesh) {
  if (mesh.positions.size() > std::numeric_limits<std::uint16_t>::max())
    return buffer.add(mesh.indices, mesh.indices.size(), kUnsignedInt, "SCALAR");
  const std::vector<std::uint16_t> narrow(mesh.indices.begin(), mesh.indices.end());
  return buffer.add(narrow, narrow.size(), kUnsignedShort, "SCALAR");
}

const char* role_name(Role role) {
  switch (role) {
    case Role::surveyed: return "surveyed";
    case Role::blocking: return "blocking";
    case Role::search: return "search";
    case Role::ignore: return "ignore";
  }
  return "ignore";
}

}  // namespace

void write_glb(const Model& model, const std::filesystem::path& file) {
  Buffer buffer;
  json nodes = json::array(), meshes = json::array(), materials = json::array(), roots = json::array();
  std::vector<std::array<float, 3>> colours;
  for (const Part& part : model.parts) {
    auto colour = std::ranges::find(colours, part.colour);
    if (colour == colours.end()) {
      colours.push_back(part.colour);
      colour = colours.end() - 1;
      materials.push_back(
          {{"pbrMetallicRoughness",
            {{"baseColorFactor", {part.colour[0], part.colour[1], part.colour[2], 1.0F}}, {"metallicFactor", 0.0}}},
           {"doubleSided", true}});
    }
    json attributes{{"POSITION", add_positions(buffer, part.mesh.positions)}};
    if (!part.mesh.normals.empty())
      attributes["NORMAL"] = buffer.add(turned(part.mesh.normals), part.mesh.normals.size(), kFloat, "VEC3");
    if (!part.mesh.uvs.empty())
      attributes["TEXCOORD_0"] = buffer.add(part.mesh.uvs, part.mesh.uvs.size(), kFloat, "VEC2");
    const int indices = add_indices(buffer, part.mesh);
    roots.push_back(nodes.size());
    nodes.push_back({{"name", part.name}, {"mesh", meshes.size()}});
    if (part.role) {
      json marks{{"role", role_name(*part.role)}};
      if (part.diffuse) marks["diffuse"] = *part.diffuse;
      nodes.back()["extras"] = {{"vantage", marks}};
    }
    meshes.push_back(
        {{"primitives", {{{"attributes", attributes}, {"indices", indices}, {"material", colour - colours.begin()}}}}});
  }
  while (buffer.bytes_.size() % 4 != 0) buffer.bytes_.push_back(0);
  json asset{{"version", "2.0"}, {"generator", "vantage"}};
  if (!model.defaults.is_null()) asset["extras"] = {{"vantage", model.defaults}};
  const json document{{"asset", asset},
                      {"scene", 0},
                      {"scenes", {{{"nodes", roots}}}},
                      {"nodes", nodes},
                      {"meshes", meshes},
                      {"materials", materials},
                      {"accessors", buffer.accessors_},
                      {"bufferViews", buffer.views_},
                      {"buffers", {{{"byteLength", buffer.bytes_.size()}}}}};
  const std::string head = [&] {
    try {
      return glb_head(json_text(document), buffer.bytes_.size());
    } catch (const std::length_error& bytes) {
      throw Error(Errc::invalid_argument, std::string("the scene would take ") + bytes.what() +
                                              " bytes; a GLB holds at most 4 GiB: ask for fewer triangles");
    }
  }();
  AtomicFile out(file);
  out.write(head);
  out.write(buffer.bytes_.data(), buffer.bytes_.size());
  out.commit();
}

}  // namespace vantage::built_in
