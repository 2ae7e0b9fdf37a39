// SPDX-License-Identifier: Apache-2.0
// A glTF file in memory: its JSON, the structure read by tinygltf, and the bytes of its buffers and images.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <initializer_list>
#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#define TINYGLTF_NO_STB_IMAGE
#define TINYGLTF_NO_STB_IMAGE_WRITE
#define TINYGLTF_NO_EXTERNAL_IMAGE
#include <tiny_gltf.h>

#include "scene/load_budget.hpp"
#include "vantage/error.hpp"

namespace vantage::gltf {

using Bytes = std::span<const std::uint8_t>;

// A parsed file. tinygltf parses scenes, nodes, meshes, accessors and materials; buffers and images are read here, to
// check each and name it in messages. Nothing in `model` is trusted: indices and ranges are checked on use.
class File {
 public:
  // Buffers and images may lie below the file's own folder, or anywhere if `allow_outside`. `budget` must outlive the
  // file. Throws Error: io, malformed_file, out_of_memory if the budget is too small.
  File(const std::filesystem::path& path, bool allow_outside, LoadBudget& budget);
  // Reads from memory, with buffers and images inside; messages begin with `name`. Throws Error: malformed_file,
  // out_of_memory.
  File(std::span<const std::uint8_t> bytes, const std::string& name, LoadBudget& budget);

  const tinygltf::Model& model() const { return model_; }
  const nlohmann::json& document() const { return json_; }
  // Returns a buffer view's bytes. Throws Error malformed_file if it, or its buffer, does not exist or ends too early.
  Bytes view(int index, const std::string& user) const;
  // Returns the encoded bytes of an image, in the file or in `own`. Throws Error: io, malformed_file.
  Bytes image(int index, std::vector<std::uint8_t>& own) const;
  // Returns true if the file lists the extension among those that it uses.
  bool uses(std::string_view extension) const;
  // Returns the number of elements in an array of the document, such as "materials".
  std::size_t count(const char* array) const;
  // Returns a member of an element, e.g. ("nodes", 3, {"extras", "vantage"}); null if absent.
  const nlohmann::json& find(const char* array, int index, std::initializer_list<const char*> path) const;

  // Returns a member of the asset's extras; null if absent.
  const nlohmann::json& asset_extras(const char* key) const;

  // Returns an error in this file: "FILE: what".
  Error malformed(const std::string& what, std::vector<std::string> details = {}) const;

 private:
  void read_bytes();
  Bytes open_container();
  std::size_t skip_tile_header(Bytes all, Bytes& features) const;
  Bytes open_glb(Bytes all);
  void require_utf8(Bytes text) const;
  void parse(Bytes text);
  void check_version() const;
  void check_extensions() const;
  void check_integers() const;
  void load_buffers(Bytes glb_chunk);
  std::uint64_t model_bytes() const;
  void read_structure();
  std::vector<std::uint8_t> read_uri(const std::string& uri, const std::string& what) const;

  std::filesystem::path path_;
  bool allow_outside_;
  bool in_memory_ = false;
  LoadBudget& budget_;
  std::vector<std::uint8_t> bytes_;                     // the whole file; a GLB's buffer 0 stays in here
  std::vector<std::vector<std::uint8_t>> own_buffers_;  // the others
  std::vector<Bytes> buffers_;
  std::uint64_t document_bytes_ = 0;  // upper bound on the size of json_
  nlohmann::json json_;
  tinygltf::Model model_;
};

// Returns "TEXT" in quotes, shortened if long, for messages.
std::string quoted(const std::string& text);

}  // namespace vantage::gltf
