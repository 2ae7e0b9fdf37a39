// SPDX-License-Identifier: Apache-2.0
// The pages that every E57 file consists of (ASTM E2807, 6.2): 1020 bytes of content, then their CRC-32C. Content has
// two addresses: logical, where pages had no checksums, and physical, in the file.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string_view>

#include "core/atomic_file.hpp"

namespace vantage {

class E57PagedFile {
 public:
  static constexpr std::size_t kPageBytes = 1024, kContentBytes = kPageBytes - 4;

  // Leaves the first page for the header, which is known last. Throws Error io, as everything here.
  explicit E57PagedFile(const std::filesystem::path& file);

  void write(std::string_view bytes);
  // Zeros up to a multiple of four bytes, as sections and packets want it.
  void align();
  // Begins a new page, of which the first bytes may be overwritten until the next call.
  void begin_patchable_page();
  // Overwrites the first bytes of that page. REQUIRES: bytes fit into it.
  void patch(std::string_view bytes);

  std::uint64_t logical() const { return logical_of(page_, used_); }
  std::uint64_t physical() const { return page_ * kPageBytes + used_; }

  // Fills the last page, puts the header (at most a page) on the first, and gives the file its name.
  void close(std::string_view header);
  // Length of the file once closed, if nothing more is written.
  std::uint64_t physical_length() const { return (page_ + (used_ > 0 ? 1 : 0)) * kPageBytes; }

 private:
  using Content = std::array<char, kContentBytes>;
  static std::uint64_t logical_of(std::uint64_t page, std::size_t used) { return page * kContentBytes + used; }
  void fill_page();
  static std::array<char, kPageBytes> with_checksum(const Content& content);

  AtomicFile file_;
  std::uint64_t page_ = 1;  // the one being filled
  std::size_t used_ = 0;    // of it; below kContentBytes
  Content content_{};
  std::uint64_t patchable_page_ = 0;
  Content patchable_{};  // its content once written
};

}  // namespace vantage
