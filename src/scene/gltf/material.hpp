// SPDX-License-Identifier: Apache-2.0
// Base colours and their textures.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "scene/gltf/file.hpp"
#include "scene/gltf/node_tree.hpp"
#include "scene/scene_data.hpp"

namespace vantage::gltf {

// The parts of a glTF material that points need.
struct MaterialInfo {
  std::uint32_t index = 0;                       // index into the table's materials
  Marks marks;                                   // of its extras
  bool glass = false;                            // light passes the whole surface
  bool mirror = false;                           // polished metal
  std::optional<double> luminance;               // of the base colour factor, if given and without a texture
  int texcoord_set = -1;                         // of the base colour texture; -1 without one
  double uv_map[2][3] = {{1, 0, 0}, {0, 1, 0}};  // KHR_texture_transform: uv' = map · (u, v, 1)
};

// Reads each material and each image once, on first use; images with equal bytes are shared. An image that cannot be
// read, or does not fit, costs only colour and the holes of a mask: it is left out, with a note.
class MaterialTable {
 public:
  MaterialTable(const File& file, LoadBudget& budget, std::vector<std::string>& notes)
      : file_(file), budget_(budget), notes_(notes) {}
  // Returns a material; -1 is the default one. Throws Error malformed_file.
  const MaterialInfo& get(int material);

  std::vector<Material> materials;
  std::vector<Image> images;
  std::vector<double> cutoffs;  // per material: alpha below which its surface is empty; 0: nowhere

 private:
  // Sets `info.glass`; returns the material's cut-off.
  double read_transparency(int index, const Material& material, MaterialInfo& info) const;
  std::int32_t image(int texture);
  std::int32_t decode(int source, const std::string& texture, std::string& problem);

  const File& file_;
  LoadBudget& budget_;
  std::vector<std::string>& notes_;
  std::map<int, MaterialInfo> read_;
  std::map<int, std::int32_t> read_images_;  // per glTF image; -1: cannot be read
  std::map<std::pair<const std::uint8_t*, std::size_t>, std::int32_t> read_bytes_;  // those of buffer views, likewise
};

}  // namespace vantage::gltf
