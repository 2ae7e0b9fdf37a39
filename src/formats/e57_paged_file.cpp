// SPDX-License-Identifier: Apache-2.0
#include "formats/e57_paged_file.hpp"

#include <algorithm>
#include <cassert>

#include "core/crc32c.hpp"

namespace vantage {

E57PagedFile::E57PagedFile(const std::filesystem::path& file) : file_(file) {
  const auto first = with_checksum(Content{});
  file_.write(first.data(), first.size());
}

std::array<char, E57PagedFile::kPageBytes> E57PagedFile::with_checksum(const Content& content) {
  std::array<char, kPageBytes> page{};
  std::copy(content.begin(), content.end(), page.begin());
  const std::uint32_t crc = crc32c(content.data(), content.size());
  // The one number of the format that is big-endian.
  for (std::size_t k = 0; k < 4; ++k) page[kContentBytes + k] = static_cast<char>(crc >> (24 - 8 * k));
  return page;
}

void E57PagedFile::fill_page() {
  std::fill(content_.begin() + static_cast<std::ptrdiff_t>(used_), content_.end(), '\0');
  const auto page = with_checksum(content_);
  file_.write(page.data(), page.size());
  if (page_ == patchable_page_) patchable_ = content_;
  ++page_, used_ = 0;
}

void E57PagedFile::write(std::string_view bytes) {
  while (!bytes.empty()) {
    const std::size_t n = std::min(bytes.size(), kContentBytes - used_);
    std::copy_n(bytes.begin(), n, content_.begin() + static_cast<std::ptrdiff_t>(used_));
    bytes.remove_prefix(n);
    used_ += n;
    if (used_ == kContentBytes) fill_page();
  }
}

void E57PagedFile::align() {
  constexpr std::string_view kZeros("\0\0\0", 3);
  write(kZeros.substr(0, (4 - logical() % 4) % 4));
}

void E57PagedFile::begin_patchable_page() {
  if (used_ > 0) fill_page();
  patchable_page_ = page_;
}

void E57PagedFile::patch(std::string_view bytes) {
  assert(patchable_page_ > 0 && bytes.size() <= kContentBytes);
  if (patchable_page_ == page_) {
    assert(bytes.size() <= used_);
    std::copy(bytes.begin(), bytes.end(), content_.begin());
    return;
  }
  std::copy(bytes.begin(), bytes.end(), patchable_.begin());
  const auto page = with_checksum(patchable_);
  file_.patch(patchable_page_ * kPageBytes, page.data(), page.size());
}

void E57PagedFile::close(std::string_view header) {
  assert(header.size() <= kContentBytes);
  if (used_ > 0) fill_page();
  Content content{};
  std::copy(header.begin(), header.end(), content.begin());
  const auto page = with_checksum(content);
  file_.patch(0, page.data(), page.size());
  file_.commit();
}

}  // namespace vantage
