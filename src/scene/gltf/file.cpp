// SPDX-License-Identifier: Apache-2.0
#include "scene/gltf/file.hpp"

#include <algorithm>
#include <array>
#include <cstring>
#include <limits>
#include <string_view>

#include "core/utf8.hpp"
#include "scene/gltf/scene_files.hpp"

namespace vantage::gltf {
namespace {

using nlohmann::json;

constexpr std::uint32_t kGlbMagic = 0x46546C67, kTileMagic = 0x6D643362, kJsonChunk = 0x4E4F534A,
                        kBinaryChunk = 0x004E4942;
constexpr int kDeepestJson = 128;  // readers recurse; real files nest about ten levels

// Extensions that a file may require. Those that change positions are implemented; the others only change how surfaces
// look or behave, or carry information that a survey does not need. A name ending in _ stands for all with that prefix.
constexpr std::string_view kUnderstood[] = {"KHR_mesh_quantization",
                                            "EXT_mesh_gpu_instancing",
                                            "KHR_texture_transform",
                                            "KHR_node_visibility",
                                            "KHR_mesh_primitive_restart",
                                            "EXT_mesh_primitive_restart",
                                            "KHR_accessor_float64",
                                            "MSFT_lod",
                                            "CESIUM_RTC"};
constexpr std::string_view kWithoutEffect[] = {"KHR_materials_",
                                               "KHR_texture_",
                                               "EXT_texture_",
                                               "KHR_lights_",
                                               "EXT_lights_",
                                               "KHR_audio_",
                                               "KHR_node_selectability",
                                               "KHR_node_hoverability",
                                               "KHR_interactivity",
                                               "KHR_physics_rigid_bodies",
                                               "KHR_implicit_shapes",
                                               "KHR_collision_shapes",
                                               "KHR_animation_pointer",
                                               "KHR_techniques_webgl",
                                               "KHR_xmp",
                                               "KHR_xmp_json_ld",
                                               "EXT_structural_metadata",
                                               "EXT_feature_metadata",
                                               "EXT_mesh_features",
                                               "EXT_instance_features",
                                               "EXT_mesh_manifold",
                                               "EXT_mesh_primitive_edge_visibility",
                                               "EXT_textureInfo_constant_lod",
                                               "ADOBE_materials_",
                                               "AGI_articulations",
                                               "AGI_stk_metadata",
                                               "BENTLEY_materials_",
                                               "CESIUM_primitive_outline",
                                               "FB_geometry_metadata",
                                               "GODOT_single_root",
                                               "GRIFFEL_bim_data",
                                               "MSFT_packing_",
                                               "MSFT_texture_dds",
                                               "NV_materials_",
                                               "OMI_",
                                               "VRMC_"};

bool has_no_effect(std::string_view name) {
  return std::ranges::any_of(kWithoutEffect, [&](std::string_view known) {
    return known.ends_with('_') ? name.starts_with(known) : name == known;
  });
}

std::uint32_t little_endian(Bytes bytes, std::size_t offset) {
  return static_cast<std::uint32_t>(bytes[offset]) | static_cast<std::uint32_t>(bytes[offset + 1]) << 8 |
         static_cast<std::uint32_t>(bytes[offset + 2]) << 16 | static_cast<std::uint32_t>(bytes[offset + 3]) << 24;
}

// Outline of a JSON text before parsing; brackets and commas inside strings do not count.
struct Outline {
  int deepest = 0;  // nesting of arrays and objects
  std::uint64_t containers = 0, values = 0, members = 0, strings = 0;

  // Upper bound on the memory of the parsed document. A value is a slot of an array that may have grown to twice its
  // size. A member is a node of a map, with a name. Containers and strings are separate allocations.
  std::uint64_t bytes(std::size_t text) const {
    return 24 * values + 64 * containers + 96 * members + 48 * strings + text;
  }
};

Outline outline_of(Bytes text) {
  Outline outline;
  int depth = 0;
  bool in_string = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const std::uint8_t c = text[i];
    if (in_string) {
      if (c == '\\') ++i;
      if (c == '"') in_string = false;
      continue;
    }
    switch (c) {
      case '"':
        in_string = true;
        ++outline.strings;
        break;
      case '{':
      case '[':
        outline.deepest = std::max(outline.deepest, ++depth);
        ++outline.containers, ++outline.values;
        break;
      case '}':
      case ']': --depth; break;
      case ',': ++outline.values; break;
      case ':': ++outline.members; break;
      default: break;
    }
  }
  return outline;
}

// Returns a copy without the parts that only this program reads; tinygltf would make an object of over a hundred bytes
// from each number in them.
json without_extras(const json& element) {
  const auto part = [](const json& value) { return value.is_structured() ? without_extras(value) : value; };
  if (element.is_array()) {
    json copy = json::array();
    copy.get_ref<json::array_t&>().reserve(element.size());
    for (const json& value : element) copy.push_back(part(value));
    return copy;
  }
  json copy = json::object();
  for (const auto& [key, value] : element.get_ref<const json::object_t&>())
    if (key != "extras" && key != "extensions") copy[key] = part(value);
  return copy;
}

std::string percent_decoded(const std::string& uri) {
  const auto digit = [](char c) {
    return c >= '0' && c <= '9'   ? c - '0'
           : c >= 'a' && c <= 'f' ? c - 'a' + 10
           : c >= 'A' && c <= 'F' ? c - 'A' + 10
                                  : -1;
  };
  std::string out;
  for (std::size_t i = 0; i < uri.size(); ++i) {
    if (uri[i] == '%' && i + 2 < uri.size() && digit(uri[i + 1]) >= 0 && digit(uri[i + 2]) >= 0) {
      out += static_cast<char>(digit(uri[i + 1]) * 16 + digit(uri[i + 2]));
      i += 2;
    } else {
      out += uri[i];
    }
  }
  return out;
}

// tinygltf silently replaces negative, fractional or too large integers by a default; each is an error here.
void check_members(const File& file, const json& object, const std::string& where,
                   std::initializer_list<const char*> names) {
  for (const char* name : names) {
    const auto it = object.find(name);
    if (it == object.end()) continue;
    if (!it->is_number_unsigned() ||
        it->get<std::uint64_t>() > static_cast<std::uint64_t>(std::numeric_limits<int>::max()))
      throw file.malformed(where + ": " + name + " is " + quoted(it->dump()) + ", not an index or a size");
  }
}

}  // namespace

std::string quoted(const std::string& text) {
  constexpr std::size_t kLongest = 60;
  return text.size() <= kLongest ? "\"" + text + "\"" : "\"" + text.substr(0, kLongest) + "…\"";
}

File::File(const std::filesystem::path& path, bool allow_outside, LoadBudget& budget)
    : path_(path),
      allow_outside_(allow_outside),
      budget_(budget),
      bytes_(read_file(path, "the scene cannot be read", budget)) {
  read_bytes();
}

File::File(std::span<const std::uint8_t> bytes, const std::string& name, LoadBudget& budget)
    : path_(name), allow_outside_(false), in_memory_(true), budget_(budget) {
  budget_.keep(bytes.size(), "a copy of the file");
  bytes_.assign(bytes.begin(), bytes.end());
  read_bytes();
}

void File::read_bytes() {
  const Bytes glb_chunk = open_container();
  check_version();
  check_extensions();
  check_integers();
  load_buffers(glb_chunk);
  read_structure();
}

Error File::malformed(const std::string& what, std::vector<std::string> details) const {
  return Error(Errc::malformed_file, path_.string() + ": " + what, std::move(details));
}

// Returns where the GLB of a tile of 3D Tiles 1.0 (b3dm) begins, and leaves the JSON of the first table in `features`.
// A tile is a header of 28 bytes, four tables whose lengths the header states, and a GLB.
std::size_t File::skip_tile_header(Bytes all, Bytes& features) const {
  constexpr std::size_t kHeader = 28;
  if (all.size() < kHeader)
    throw malformed("the tile's header is cut off after " + std::to_string(all.size()) + " bytes");
  std::size_t at = kHeader;
  for (std::size_t table = 0; table < 4; ++table) {
    const std::size_t size = little_endian(all, 12 + 4 * table);
    if (size > all.size() - at)
      throw malformed("table " + std::to_string(table) + " of the tile announces " + std::to_string(size) + " bytes, " +
                      std::to_string(all.size() - at) + " are left");
    if (table == 0) features = all.subspan(at, size);
    at += size;
  }
  return at;
}

Bytes File::open_container() {
  Bytes all = bytes_, features;
  if (all.size() >= 4 && little_endian(all, 0) == kTileMagic) all = all.subspan(skip_tile_header(all, features));
  const Bytes binary = open_glb(all);
  if (features.empty()) return binary;
  const json table = json::parse(features.begin(), features.end(), nullptr, false);
  if (table.is_object() && table.contains("RTC_CENTER") && !json_.contains("extensions"))
    json_["extensions"] = {{"CESIUM_RTC", {{"center", table["RTC_CENTER"]}}}};
  return binary;
}

Bytes File::open_glb(Bytes all) {
  if (all.size() < 4 || little_endian(all, 0) != kGlbMagic) {
    parse(all);
    return {};
  }
  if (all.size() < 12) throw malformed("the GLB header is cut off after " + std::to_string(all.size()) + " bytes");
  if (const auto version = little_endian(all, 4); version != 2)
    throw malformed("this is GLB version " + std::to_string(version) + "; export it as glTF 2.0");
  const std::size_t length = little_endian(all, 8);
  if (length > all.size())
    throw malformed("the file is truncated: its header announces " + std::to_string(length) + " bytes, it has " +
                    std::to_string(all.size()) + "; copy or export it again");
  Bytes text, binary;
  bool has_text = false, has_binary = false;
  for (std::size_t at = 12; at + 8 <= length;) {
    const std::size_t size = little_endian(all, at);
    const std::uint32_t type = little_endian(all, at + 4);
    at += 8;
    if (size > length - at)
      throw malformed("the GLB chunk at byte " + std::to_string(at - 8) + " announces " + std::to_string(size) +
                      " bytes, " + std::to_string(length - at) + " are left");
    if (type == kJsonChunk && !has_text) {
      text = all.subspan(at, size);
      has_text = true;
    } else if (type == kBinaryChunk && !has_binary) {
      binary = all.subspan(at, size);
      has_binary = true;
    }
    at += size;
  }
  if (!has_text) throw malformed("the GLB has no JSON chunk");
  parse(text);
  return binary;
}

// Throws if the text is no UTF-8, such as names in Latin-1; the message shows the place and the words around it.
void File::require_utf8(Bytes text) const {
  const std::string_view all(reinterpret_cast<const char*>(text.data()), text.size());
  for (std::size_t at = 0; at < all.size();) {
    const std::size_t size = utf8_character(all, at);
    if (size == 0) {
      constexpr std::size_t kAround = 40;
      const std::size_t begin = all.find_last_of("\"{},\n", at), end = all.find_first_of("\"{},\n", at);
      const std::size_t from = std::max(at - std::min(at, kAround), begin == all.npos ? 0 : begin + 1);
      const std::size_t to = std::min(at + kAround, std::min(end, all.size()));
      throw malformed("its text is not UTF-8 in line " +
                      std::to_string(1 + std::ranges::count(all.substr(0, at), '\n')) + " of its JSON, at " +
                      quoted(to_utf8(all.substr(from, to - from))) +
                      " (Latin-1, perhaps); export it as glTF has it, in UTF-8");
    }
    at += size;
  }
}

void File::parse(Bytes text) {
  const Outline outline = outline_of(text);
  if (outline.deepest > kDeepestJson)
    throw malformed("the JSON nests " + std::to_string(outline.deepest) + " levels deep; at most " +
                    std::to_string(kDeepestJson) + " are read");
  document_bytes_ = outline.bytes(text.size());
  budget_.keep(document_bytes_, "the JSON");
  require_utf8(text);
  try {
    json_ = json::parse(text.begin(), text.end());
  } catch (const json::exception& problem) {
    throw malformed("neither a GLB nor a glTF JSON text: " + std::string(problem.what()));
  }
  if (!json_.is_object()) throw malformed("the JSON is not an object, so not a glTF");
}

void File::check_version() const {
  const auto asset = json_.find("asset");
  if (asset == json_.end() || !asset->is_object() || !asset->contains("version") || !(*asset)["version"].is_string())
    throw malformed("there is no asset.version, so this is not a glTF");
  const auto version = (*asset)["version"].get<std::string>();
  if (!version.starts_with("2.")) throw malformed("this is glTF " + quoted(version) + "; export it as glTF 2.0");
}

void File::check_extensions() const {
  const auto required = json_.find("extensionsRequired");
  if (required == json_.end()) return;
  if (!required->is_array()) throw malformed("extensionsRequired is not an array");
  for (const json& entry : *required) {
    if (!entry.is_string()) throw malformed("extensionsRequired holds " + quoted(entry.dump()) + ", not a name");
    const auto name = entry.get<std::string>();
    if (name == "KHR_draco_mesh_compression" || name == "EXT_meshopt_compression" || name == "KHR_meshopt_compression")
      throw malformed("its meshes are compressed with " + name +
                      ", which vantage does not read; export without mesh compression, or decompress it (e.g. with "
                      "gltf-transform)");
    if (std::ranges::find(kUnderstood, name) == std::end(kUnderstood) && !has_no_effect(name))
      throw malformed("it requires the extension " + quoted(name) + ", which vantage does not know; export without it");
  }
}

void File::check_integers() const {
  const auto each = [&](const json& parent, const char* array, const std::string& where, auto&& check) {
    const auto it = parent.find(array);
    if (it == parent.end()) return;
    if (!it->is_array()) throw malformed(where + array + " is not an array");
    for (std::size_t i = 0; i < it->size(); ++i) {
      const std::string element = where + array + " " + std::to_string(i);
      if (!(*it)[i].is_object()) throw malformed(element + " is not an object");
      check((*it)[i], element);
    }
  };
  const auto indices = [&](const json& object, const char* name, const std::string& where) {
    const auto it = object.find(name);
    if (it == object.end()) return;
    if (!it->is_array()) throw malformed(where + ": " + name + " is not an array");
    for (const json& index : *it)
      if (!index.is_number_unsigned() ||
          index.get<std::uint64_t>() > static_cast<std::uint64_t>(std::numeric_limits<int>::max()))
        throw malformed(where + ": " + name + " holds " + quoted(index.dump()) + ", not an index");
  };
  each(json_, "accessors", "", [&](const json& accessor, const std::string& where) {
    check_members(*this, accessor, where, {"bufferView", "byteOffset", "componentType", "count"});
    if (accessor.contains("bufferView") && accessor["bufferView"].get<std::size_t>() >= count("bufferViews"))
      throw malformed("accessor" + where.substr(where.find(' ')) + " refers to buffer view " +
                      accessor["bufferView"].dump() + "; there are " + std::to_string(count("bufferViews")));
    const auto sparse = accessor.find("sparse");
    if (sparse == accessor.end()) return;
    if (!sparse->is_object()) throw malformed(where + ": sparse is not an object");
    check_members(*this, *sparse, where + " sparse", {"count"});
    for (const char* part : {"indices", "values"}) {
      if (!sparse->contains(part) || !(*sparse)[part].is_object()) throw malformed(where + ": sparse has no " + part);
      check_members(*this, (*sparse)[part], where + " sparse " + part, {"bufferView", "byteOffset", "componentType"});
    }
  });
  each(json_, "buffers", "", [](const json&, const std::string&) {});
  each(json_, "images", "",
       [&](const json& image, const std::string& where) { check_members(*this, image, where, {"bufferView"}); });
  each(json_, "bufferViews", "", [&](const json& view, const std::string& where) {
    for (const char* name : {"byteOffset", "byteLength"})
      if (view.contains(name) && !view[name].is_number_unsigned())
        throw malformed(where + ": " + name + " is " + quoted(view[name].dump()) + ", not a size");
    check_members(*this, view, where, {"buffer", "byteStride"});
  });
  each(json_, "meshes", "", [&](const json& mesh, const std::string& where) {
    each(mesh, "primitives", where + " ", [&](const json& primitive, const std::string& primitive_where) {
      check_members(*this, primitive, primitive_where, {"indices", "material", "mode"});
      const auto attributes = primitive.find("attributes");
      if (attributes == primitive.end()) return;
      if (!attributes->is_object()) throw malformed(primitive_where + ": attributes is not an object");
      for (const auto& [name, value] : attributes->items())
        check_members(*this, *attributes, primitive_where, {name.c_str()});
    });
  });
  each(json_, "nodes", "", [&](const json& node, const std::string& where) {
    check_members(*this, node, where, {"mesh"});
    indices(node, "children", where);
    for (const char* name : {"matrix", "translation", "rotation", "scale"}) {
      const auto it = node.find(name);
      if (it == node.end()) continue;
      const std::size_t size = name[0] == 'm' ? 16 : name[0] == 'r' ? 4 : 3;
      if (!it->is_array() || it->size() != size ||
          !std::ranges::all_of(*it, [](const json& value) { return value.is_number(); }))
        throw malformed(where + ": " + name + " is not an array of " + std::to_string(size) + " numbers");
    }
  });
  each(json_, "scenes", "", [&](const json& scene, const std::string& where) { indices(scene, "nodes", where); });
  each(json_, "materials", "", [](const json&, const std::string&) {});
  each(json_, "textures", "", [&](const json& texture, const std::string& where) {
    check_members(*this, texture, where, {"source", "sampler"});
  });
  each(json_, "samplers", "", [](const json&, const std::string&) {});
  check_members(*this, json_, "the file", {"scene"});
}

std::vector<std::uint8_t> File::read_uri(const std::string& uri, const std::string& what) const {
  if (uri.starts_with("data:")) {
    budget_.keep(uri.size(), "the data URI of " + what);
    budget_.require(4 * uri.size(), "decoding the data URI of " + what);
    // tinygltf knows few media types and no parameters.
    constexpr std::string_view kKnown = "data:application/octet-stream;base64,";
    const std::size_t comma = uri.find(',');
    if (comma == std::string::npos || !std::string_view(uri).substr(0, comma).ends_with(";base64"))
      throw malformed(what + " has a data URI that is not base64: " + quoted(uri));
    std::vector<std::uint8_t> bytes;
    std::string type;
    if (comma + 1 < uri.size() &&
        !tinygltf::DecodeDataURI(&bytes, type, std::string(kKnown) + uri.substr(comma + 1), 0, false))
      throw malformed(what + " has a data URI that is not base64: " + quoted(uri));
    return bytes;
  }
  if (uri.starts_with("file:"))
    throw malformed(what + " lies at " + quoted(uri) + "; name the file relative to the scene's folder instead");
  if (uri.find("://") != std::string::npos)
    throw malformed(what + " lies at " + quoted(uri) + "; only files are read: download it first");
  if (in_memory_)
    throw malformed(what + " lies in the file " + quoted(uri) +
                    ", which glTF in memory cannot name; put it into the bytes");
  const std::string name = percent_decoded(uri), user = path_.string() + ": " + what;
  if (name.find('\0') != std::string::npos) throw malformed(what + ": " + quoted(uri) + " is no file name");
  return read_file(locate(path_.parent_path(), name, allow_outside_, user), user + " is missing", budget_);
}

void File::load_buffers(Bytes glb_chunk) {
  const auto list = json_.find("buffers");
  if (list == json_.end()) return;
  own_buffers_.resize(list->size());
  buffers_.resize(list->size());
  for (std::size_t i = 0; i < list->size(); ++i) {
    const json& buffer = (*list)[i];
    const std::string name = "buffer " + std::to_string(i);
    if (!buffer.contains("byteLength") || !buffer["byteLength"].is_number_unsigned())
      throw malformed(name + " has no byteLength");
    const auto length = buffer["byteLength"].get<std::uint64_t>();
    Bytes bytes = glb_chunk;
    if (const auto uri = buffer.find("uri"); uri != buffer.end()) {
      if (!uri->is_string()) throw malformed(name + ": uri is not a string");
      own_buffers_[i] = read_uri(uri->get<std::string>(), name);
      bytes = own_buffers_[i];
    } else if (length > 0 && (i != 0 || glb_chunk.data() == nullptr)) {
      throw malformed(name + " has no uri, and there is no GLB chunk for it");
    }
    if (length > bytes.size())
      throw malformed(name + " is truncated: it announces " + std::to_string(length) + " bytes, " +
                      std::to_string(bytes.size()) + " are there");
    buffers_[i] = bytes.first(length);
  }
}

std::uint64_t File::model_bytes() const {
  // Counts lists twice, as they grow by doubling. A node is also stored with its place and names (node_tree.hpp).
  constexpr std::uint64_t kPlacedNode = 1000;
  std::uint64_t primitives = 0;
  if (const auto meshes = json_.find("meshes"); meshes != json_.end())
    for (const json& mesh : *meshes)
      if (const auto list = mesh.find("primitives"); list != mesh.end()) primitives += list->size();
  return document_bytes_ + (2 * sizeof(tinygltf::Node) + kPlacedNode) * count("nodes") +
         2 * (sizeof(tinygltf::Accessor) * count("accessors") + sizeof(tinygltf::BufferView) * count("bufferViews") +
              sizeof(tinygltf::Mesh) * count("meshes") + sizeof(tinygltf::Primitive) * primitives +
              sizeof(tinygltf::Sampler) * count("samplers") + sizeof(tinygltf::Scene) * count("scenes") +
              sizeof(tinygltf::Texture) * count("textures"));
}

void File::read_structure() {
  budget_.keep(model_bytes(), "its " + std::to_string(count("nodes")) + " nodes, " + std::to_string(count("meshes")) +
                                  " meshes and " + std::to_string(count("accessors")) + " accessors");
  budget_.require(2 * document_bytes_, "reading the JSON");
  std::string text;
  {
    json structure = json::object();
    for (const char* part : {"asset", "accessors", "bufferViews", "extensionsUsed", "meshes", "nodes", "samplers",
                             "scene", "scenes", "textures"})
      if (const auto it = json_.find(part); it != json_.end())
        structure[part] = it->is_structured() ? without_extras(*it) : *it;
    text = structure.dump();
  }
  tinygltf::TinyGLTF loader;
  std::string error, warning;
  bool read = false;
  try {
    read =
        text.size() <= std::numeric_limits<unsigned int>::max() &&
        loader.LoadASCIIFromString(&model_, &error, &warning, text.data(), static_cast<unsigned int>(text.size()), "");
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::exception& problem) {
    error += problem.what();
  }
  while (!error.empty() && error.back() == '\n') error.pop_back();
  // tinygltf converts exceptions of its parser to text.
  if (!read && error.find(std::bad_alloc().what()) != std::string::npos) throw std::bad_alloc();
  if (!read) throw malformed(error.empty() ? "it is not a glTF" : error);
  // tinygltf skips primitives that it cannot read.
  for (std::size_t i = 0; i < model_.meshes.size(); ++i) {
    const auto primitives = json_["meshes"][i].find("primitives");
    if (primitives != json_["meshes"][i].end() && primitives->size() != model_.meshes[i].primitives.size())
      throw malformed("mesh " + std::to_string(i) + " has a primitive without attributes");
  }
}

Bytes File::view(int index, const std::string& user) const {
  if (index < 0 || static_cast<std::size_t>(index) >= model_.bufferViews.size())
    throw malformed(user + " refers to buffer view " + std::to_string(index) + "; there are " +
                    std::to_string(model_.bufferViews.size()));
  const tinygltf::BufferView& view = model_.bufferViews[static_cast<std::size_t>(index)];
  const std::string name = "buffer view " + std::to_string(index);
  if (view.buffer < 0 || static_cast<std::size_t>(view.buffer) >= buffers_.size())
    throw malformed(name + " refers to buffer " + std::to_string(view.buffer) + "; there are " +
                    std::to_string(buffers_.size()));
  const Bytes buffer = buffers_[static_cast<std::size_t>(view.buffer)];
  if (view.byteOffset > buffer.size() || view.byteLength > buffer.size() - view.byteOffset)
    throw malformed(name + " spans bytes " + std::to_string(view.byteOffset) + " + " + std::to_string(view.byteLength) +
                    " of buffer " + std::to_string(view.buffer) + ", which has " + std::to_string(buffer.size()));
  return buffer.subspan(view.byteOffset, view.byteLength);
}

Bytes File::image(int index, std::vector<std::uint8_t>& own) const {
  const auto images = json_.find("images");
  const std::string name = "image " + std::to_string(index);
  if (images == json_.end() || index < 0 || static_cast<std::size_t>(index) >= images->size())
    throw malformed("there is no " + name);
  const json& image = (*images)[static_cast<std::size_t>(index)];
  if (const auto view_index = image.find("bufferView"); view_index != image.end())
    return view(view_index->get<int>(), name);
  const auto uri = image.find("uri");
  if (uri == image.end() || !uri->is_string()) throw malformed(name + " has neither uri nor bufferView");
  return own = read_uri(uri->get<std::string>(), name);
}

std::size_t File::count(const char* array) const {
  const auto elements = json_.find(array);
  return elements != json_.end() && elements->is_array() ? elements->size() : 0;
}

bool File::uses(std::string_view extension) const {
  for (const char* list : {"extensionsUsed", "extensionsRequired"})
    if (const auto names = json_.find(list); names != json_.end() && names->is_array())
      for (const json& name : *names)
        if (const auto* text = name.get_ptr<const std::string*>(); text && *text == extension) return true;
  return false;
}

const nlohmann::json& File::find(const char* array, int index, std::initializer_list<const char*> path) const {
  static const json kNone;
  const auto elements = json_.find(array);
  if (elements == json_.end() || !elements->is_array() || index < 0 ||
      static_cast<std::size_t>(index) >= elements->size())
    return kNone;
  const json* at = &(*elements)[static_cast<std::size_t>(index)];
  for (const char* key : path) {
    const auto member = at->find(key);
    if (member == at->end()) return kNone;
    at = &*member;
  }
  return *at;
}

const nlohmann::json& File::asset_extras(const char* key) const {
  static const json kNone;
  const json& asset = json_.at("asset");
  const auto extras = asset.find("extras");
  if (extras == asset.end() || !extras->is_object()) return kNone;
  const auto member = extras->find(key);
  return member == extras->end() ? kNone : *member;
}

}  // namespace vantage::gltf
