// SPDX-License-Identifier: Apache-2.0
#include "import/gltf/unpack.hpp"

#include <algorithm>
#include <utility>

#include "import/glb_bytes.hpp"
#include "import/gltf/decode.hpp"
#include "import/gltf/source.hpp"
#include "import/program.hpp"

namespace vantage::importer {
namespace {

using nlohmann::json;

constexpr const char* kDraco = "KHR_draco_mesh_compression";
constexpr const char* kMeshopt[] = {"EXT_meshopt_compression", "KHR_meshopt_compression"};
constexpr int kIndexType = 5125, kTriangles = 4;

class Unpacker {
 public:
  explicit Unpacker(Source source) : source_(std::move(source)), document_(source_.document) {}

  std::string run() {
    for (json& view : array("bufferViews")) copy_view(view);
    for (json& image : array("images")) take_image(image);
    json& meshes = array("meshes");
    for (std::size_t m = 0; m < meshes.size(); ++m) {
      if (!meshes[m].contains("primitives")) continue;
      json& primitives = meshes[m]["primitives"];
      for (std::size_t p = 0; p < primitives.size(); ++p) {
        try {
          take_primitive(primitives[p]);
        } catch (const Refused& error) {
          throw Refused("mesh " + std::to_string(m) + " primitive " + std::to_string(p) + ": " + error.what());
        }
      }
    }
    for (const char* list : {"extensionsUsed", "extensionsRequired"}) forget_extensions(list);
    return glb_bytes(std::move(document_), binary_);
  }

 private:
  json& array(const char* name) {
    json& found = document_[name];
    if (found.is_null()) found = json::array();
    if (!found.is_array()) throw Refused(std::string(name) + " is not an array");
    return found;
  }

  std::string_view bytes(const json& where) const {
    const auto buffer = where.at("buffer").get<std::size_t>();
    if (buffer >= source_.buffers.size()) throw Refused("a view refers to buffer " + std::to_string(buffer));
    return part_of(source_.buffers[buffer], where.value("byteOffset", std::size_t{0}),
                   where.at("byteLength").get<std::size_t>());
  }

  // Appends bytes to the binary chunk and returns the buffer view of them.
  json placed(std::string_view added) {
    binary_.resize((binary_.size() + 3) / 4 * 4);
    const json view{{"buffer", 0}, {"byteOffset", binary_.size()}, {"byteLength", added.size()}};
    binary_ += added;
    return view;
  }
  std::size_t add_view(std::string_view added) {
    array("bufferViews").push_back(placed(added));
    return document_["bufferViews"].size() - 1;
  }

  void copy_view(json& view) {
    std::string unpacked;
    std::string_view content;
    const json extensions = view.value("extensions", json::object());
    const auto packed = std::ranges::find_if(kMeshopt, [&](const char* name) { return extensions.contains(name); });
    if (packed != std::end(kMeshopt)) {
      unpacked = decode_meshopt(extensions[*packed], bytes(extensions[*packed]));
      content = unpacked;
      view["extensions"].erase(*packed);
    } else {
      content = bytes(view);
    }

    view.update(placed(content));
  }

  // A missing texture costs only its colours, so the name stays for the loader to report.
  void take_image(json& image) {
    if (!image.contains("uri")) return;
    const auto uri = image["uri"].get<std::string>();
    try {
      const std::size_t view = add_view(read_uri(source_, uri));
      image.erase("uri");
      image["bufferView"] = view;
    } catch (const Refused&) {
    }
  }

  void take_primitive(json& primitive) {
    if (!primitive.contains("extensions") || !primitive["extensions"].contains(kDraco)) return;
    const json extension = primitive["extensions"][kDraco];
    primitive["extensions"].erase(kDraco);
    const auto view = extension.at("bufferView").get<std::size_t>();
    if (view >= array("bufferViews").size())
      throw Refused("its Draco data refer to buffer view " + std::to_string(view));
    std::map<std::string, std::uint32_t> wanted;
    std::map<std::string, int> types;
    for (const auto& [name, number] : extension.at("attributes").items()) {
      wanted[name] = number.get<std::uint32_t>();
      types[name] = accessor(primitive.at("attributes").at(name)).at("componentType").get<int>();
    }
    const json& place = document_["bufferViews"][view];
    const std::string packed(
        part_of(binary_, place["byteOffset"].get<std::size_t>(), place["byteLength"].get<std::size_t>()));
    DracoMesh mesh;
    try {
      mesh = decode_draco(packed, wanted, types);
    } catch (const Refused&) {
      // A file may also hold the primitive without Draco, for readers that do not know it.
      if (!has_fallback(primitive)) throw;
      return;
    }
    for (const auto& [name, attribute] : mesh.attributes) {
      json copy = accessor(primitive["attributes"][name]);
      copy["bufferView"] = add_view(attribute.values);
      copy["byteOffset"] = 0;
      copy["count"] = mesh.points;
      const std::size_t row = mesh.points > 0 ? attribute.values.size() / mesh.points : 4;
      document_["bufferViews"].back()["byteStride"] = row;
      primitive["attributes"][name] = add_accessor(std::move(copy));
    }
    const std::string_view indices(reinterpret_cast<const char*>(mesh.indices.data()), 4 * mesh.indices.size());
    primitive["indices"] = add_accessor({{"bufferView", add_view(indices)},
                                         {"componentType", kIndexType},
                                         {"count", mesh.indices.size()},
                                         {"type", "SCALAR"}});
    primitive["mode"] = kTriangles;
  }

  const json& accessor(const json& index) { return array("accessors").at(index.get<std::size_t>()); }
  std::size_t add_accessor(json added) {
    array("accessors").push_back(std::move(added));
    return document_["accessors"].size() - 1;
  }
  bool has_fallback(const json& primitive) {
    for (const auto& [name, index] : primitive.at("attributes").items())
      if (!accessor(index).contains("bufferView")) return false;
    return !primitive.contains("indices") || accessor(primitive["indices"]).contains("bufferView");
  }

  void forget_extensions(const char* list) {
    if (!document_.contains(list)) return;
    json kept = json::array();
    for (const json& name : document_[list])
      if (name != kDraco && name != kMeshopt[0] && name != kMeshopt[1]) kept.push_back(name);
    if (kept.empty())
      document_.erase(list);
    else
      document_[list] = kept;
  }

  Source source_;
  json document_;
  std::string binary_;
};

}  // namespace

std::string unpack(const std::filesystem::path& file) { return Unpacker(read_source(file)).run(); }

}  // namespace vantage::importer
