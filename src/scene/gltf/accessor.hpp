// SPDX-License-Identifier: Apache-2.0
// Checked reading of glTF accessors: every range is verified once, on construction, before a byte is read.
#pragma once

#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <string>
#include <vector>

#include "scene/gltf/file.hpp"

namespace vantage::gltf {

// Most elements of an accessor without a buffer view, since nothing in the file bounds their number.
inline constexpr std::size_t kLargestWithoutBuffer = std::size_t{1} << 26;

// An index that ends a strip or a fan and begins a new one.
inline constexpr std::uint32_t kRestart = 0xFFFFFFFF;

class Accessor {
 public:
  // Messages name the reader by `user`, e.g. "mesh 3 POSITION". `components`: allowed sizes, e.g. {3, 4}. Throws Error
  // malformed_file: no such accessor, wrong type, or out of its buffer's range.
  Accessor(const File& file, int index, const std::string& user, std::initializer_list<int> components);

  std::size_t count() const { return count_; }
  int components() const { return components_; }
  bool is_float() const;

  // Reads `n` elements from `first` as doubles, components() each. Integers are unchanged, or scaled to [0, 1] or [-1,
  // 1] if the accessor is normalized. REQUIRES: first + n <= count(). Safe from several threads.
  void read(std::size_t first, std::size_t n, double* out) const;
  // Returns all elements as unsigned integers. With `restart`, the largest value of its type becomes kRestart. Throws
  // Error malformed_file unless the accessor holds unsigned scalars below `limit`.
  std::vector<std::uint32_t> read_indices(std::size_t limit, bool restart = false) const;

  // Number and user of the accessor, for messages.
  const std::string& name() const { return name_; }

 private:
  void check_range(Bytes view, std::size_t offset, std::size_t stride, std::size_t count, std::size_t size,
                   const std::string& what) const;
  void read_sparse(const tinygltf::Accessor& accessor);

  const File& file_;
  std::string name_;
  int component_type_ = 0, components_ = 0;
  bool normalized_ = false;
  std::size_t count_ = 0, element_size_ = 0, stride_ = 0;
  const std::uint8_t* data_ = nullptr;           // null: zeros
  std::vector<std::uint32_t> sparse_elements_;   // ascending
  const std::uint8_t* sparse_values_ = nullptr;  // packed
};

}  // namespace vantage::gltf
