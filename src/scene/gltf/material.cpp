// SPDX-License-Identifier: Apache-2.0
#include "scene/gltf/material.hpp"

#include <algorithm>
#include <cmath>
#include <string_view>

#include "image/decode.hpp"
#include "scene/told_by_name.hpp"

namespace vantage::gltf {
namespace {

using nlohmann::json;

double number_in(const json& object, const char* name, double fallback) {
  const auto it = object.find(name);
  return it != object.end() && it->is_number() ? it->get<double>() : fallback;
}

// Returns n numbers, or the fallback if the member is absent or of another type.
template <std::size_t N>
std::array<double, N> numbers(const json& object, const char* name, std::array<double, N> fallback) {
  const auto it = object.find(name);
  if (it == object.end() || !it->is_array() || it->size() != N ||
      !std::ranges::all_of(*it, [](const json& v) { return v.is_number(); }))
    return fallback;
  for (std::size_t i = 0; i < N; ++i) fallback[i] = (*it)[i].get<double>();
  return fallback;
}

void read_uv_map(const json& transform, MaterialInfo& info) {
  const auto offset = numbers<2>(transform, "offset", {0, 0});
  const auto scale = numbers<2>(transform, "scale", {1, 1});
  const double angle = number_in(transform, "rotation", 0), c = std::cos(angle), s = std::sin(angle);
  // translation · rotation · scale, as the extension defines
  info.uv_map[0][0] = c * scale[0];
  info.uv_map[0][1] = s * scale[1];
  info.uv_map[0][2] = offset[0];
  info.uv_map[1][0] = -s * scale[0];
  info.uv_map[1][1] = c * scale[1];
  info.uv_map[1][2] = offset[1];
  if (const auto set = transform.find("texCoord"); set != transform.end() && set->is_number_unsigned())
    info.texcoord_set = static_cast<int>(std::min<std::uint64_t>(set->get<std::uint64_t>(), 1000));
}

}  // namespace

const MaterialInfo& MaterialTable::get(int index) {
  if (const auto it = read_.find(index); it != read_.end()) return it->second;
  MaterialInfo info;
  Material material;
  if (index >= 0) {
    if (const std::size_t count = file_.count("materials"); static_cast<std::size_t>(index) >= count)
      throw file_.malformed("a primitive refers to material " + std::to_string(index) + "; there are " +
                            std::to_string(count));
    info.marks = read_marks(file_, "materials", index, "material " + std::to_string(index));
    const auto* const name = file_.find("materials", index, {"name"}).get_ptr<const std::string*>();
    material.water = name && is_water(*name);
    const json& pbr = file_.find("materials", index, {"pbrMetallicRoughness"});
    // Detects polished metal. Without a roughness factor a material is rough; with a texture it is rough in places.
    constexpr double kMetallic = 0.9, kSmooth = 0.05;
    info.mirror = pbr.is_object() && !pbr.contains("metallicRoughnessTexture") &&
                  number_in(pbr, "metallicFactor", 1) >= kMetallic && number_in(pbr, "roughnessFactor", 1) <= kSmooth;
    const auto factor = numbers<4>(pbr, "baseColorFactor", {-1, 1, 1, 1});
    if (factor[0] >= 0)
      for (std::size_t c = 0; c < 4; ++c) material.base_colour[c] = static_cast<float>(std::clamp(factor[c], 0.0, 1.0));
    const json& texture = file_.find("materials", index, {"pbrMetallicRoughness", "baseColorTexture"});
    if (const auto texture_index = texture.find("index");
        texture_index != texture.end() && texture_index->is_number_unsigned()) {
      const int number_of_texture = texture_index->get<int>();
      material.image = image(number_of_texture);
      info.texcoord_set = static_cast<int>(std::clamp(number_in(texture, "texCoord", 0), 0.0, 1000.0));
      const json& transform = file_.find(
          "materials", index, {"pbrMetallicRoughness", "baseColorTexture", "extensions", "KHR_texture_transform"});
      if (transform.is_object()) read_uv_map(transform, info);
      const auto& textures = file_.model().textures;
      if (number_of_texture >= 0 && static_cast<std::size_t>(number_of_texture) < textures.size()) {
        const int sampler = textures[static_cast<std::size_t>(number_of_texture)].sampler;
        if (sampler >= 0 && static_cast<std::size_t>(sampler) < file_.model().samplers.size()) {
          const auto& wrap = file_.model().samplers[static_cast<std::size_t>(sampler)];
          material.repeat_u = wrap.wrapS != TINYGLTF_TEXTURE_WRAP_CLAMP_TO_EDGE;
          material.repeat_v = wrap.wrapT != TINYGLTF_TEXTURE_WRAP_CLAMP_TO_EDGE;
        }
      }
    } else if (factor[0] >= 0) {
      // Luminance of linear RGB, ITU-R BT.709.
      info.luminance = std::clamp(0.2126 * static_cast<double>(material.base_colour[0]) +
                                      0.7152 * static_cast<double>(material.base_colour[1]) +
                                      0.0722 * static_cast<double>(material.base_colour[2]),
                                  0.0, 1.0);
    }
    if (material.image < 0) info.texcoord_set = -1;
  }
  info.index = static_cast<std::uint32_t>(materials.size());
  cutoffs.push_back(index >= 0 ? read_transparency(index, material, info) : 0);
  materials.push_back(material);
  return read_.emplace(index, info).first->second;
}

// Blended surfaces have no cut-off of their own. With a texture they are mostly leaves, and are cut at one half as
// usual in practice. If alpha stays below that, light passes the whole surface.
double MaterialTable::read_transparency(int index, const Material& material, MaterialInfo& info) const {
  constexpr double kHalf = 0.5, kTransmits = 0.1;
  const json& transmission = file_.find("materials", index, {"extensions", "KHR_materials_transmission"});
  info.glass = transmission.is_object() && number_in(transmission, "transmissionFactor", 0) >= kTransmits;
  if (info.glass) return 0;
  // Compared as text: comparing JSON with a literal allocates in code that must not throw.
  const auto* const named = file_.find("materials", index, {"alphaMode"}).get_ptr<const std::string*>();
  const std::string_view mode = named ? *named : std::string_view();
  if (mode == "MASK") {
    const bool unread =
        material.image < 0 && file_.find("materials", index, {"pbrMetallicRoughness", "baseColorTexture"}).is_object();
    if (unread) return 0;
    const json& cutoff = file_.find("materials", index, {"alphaCutoff"});
    return cutoff.is_number() ? std::clamp(cutoff.get<double>(), 0.0, 1.0) : kHalf;
  }
  if (mode != "BLEND") return 0;
  double most = 1;
  if (material.image >= 0) {
    const std::vector<std::uint8_t>& rgba = images[static_cast<std::size_t>(material.image)].rgba;
    std::uint8_t found = 0;
    for (std::size_t k = 3; k < rgba.size(); k += 4) found = std::max(found, rgba[k]);
    most = found / 255.0;
  }
  info.glass = most * static_cast<double>(material.base_colour[3]) <= kHalf;
  return info.glass || material.image < 0 ? 0 : kHalf;
}

std::int32_t MaterialTable::image(int texture) {
  const auto& textures = file_.model().textures;
  if (texture < 0 || static_cast<std::size_t>(texture) >= textures.size()) {
    notes_.push_back("texture " + std::to_string(texture) +
                     " does not exist; its material keeps its plain colour and is opaque");
    return -1;
  }
  const int source = textures[static_cast<std::size_t>(texture)].source;
  if (const auto it = read_images_.find(source); it != read_images_.end()) return it->second;
  std::int32_t place = -1;
  std::string problem = "its format is not PNG or JPEG";
  if (source >= 0) {
    try {
      place = decode(source, "texture " + std::to_string(texture), problem);
    } catch (const Error& error) {
      problem = error.what();
    }
  }
  if (place < 0)
    notes_.push_back("texture " + std::to_string(texture) +
                     " cannot be read, its material keeps its plain colour and is opaque: " + problem);
  read_images_.emplace(source, place);
  return place;
}

std::int32_t MaterialTable::decode(int source, const std::string& texture, std::string& problem) {
  std::vector<std::uint8_t> own;
  const Bytes bytes = file_.image(source, own);
  if (own.empty())
    if (const auto it = read_bytes_.find({bytes.data(), bytes.size()}); it != read_bytes_.end()) {
      problem = "it has the bytes of another that cannot be read";
      return it->second;
    }
  const ImageHeader header = read_image_header(bytes);
  const std::string what = "decoding " + texture + ", of " + std::to_string(header.width) + " × " +
                           std::to_string(header.height) + " pixels,";
  budget_.require(header.decoding_bytes, what);
  const std::uint64_t pixels = std::uint64_t{4} * header.width * header.height;
  if (pixels > budget_.left() / 2) {
    problem = "it would take more than half of the memory that is left for the scene";
    return -1;
  }
  budget_.keep(pixels, what);
  Image decoded = decode_image(bytes, problem);
  std::int32_t place = -1;
  if (decoded.width > 0) {
    place = static_cast<std::int32_t>(images.size());
    images.push_back(std::move(decoded));
  }
  if (own.empty()) read_bytes_.emplace(std::pair{bytes.data(), bytes.size()}, place);
  return place;
}

}  // namespace vantage::gltf
