// SPDX-License-Identifier: Apache-2.0
#include "import/cloud/e57_pages.hpp"

#include <algorithm>

#include "core/crc32c.hpp"
#include "import/program.hpp"

namespace vantage::importer {
namespace {

constexpr std::size_t kHeader = 48, kChecksum = 4;
constexpr std::uint64_t kMostXml = std::uint64_t{1} << 28;

}  // namespace

E57Pages::E57Pages(const std::filesystem::path& file) : file_(file) {
  const std::string header(file_.take(kHeader), kHeader);
  if (!header.starts_with("ASTM-E57")) throw Refused("it does not begin as E57 does; export it again");
  const auto length = value_at<std::uint64_t>(header.data() + 16);
  xml_offset_ = value_at<std::uint64_t>(header.data() + 24);
  xml_length_ = value_at<std::uint64_t>(header.data() + 32);
  page_bytes_ = value_at<std::uint64_t>(header.data() + 40);
  if (page_bytes_ < 64 || page_bytes_ > (std::uint64_t{1} << 20))
    throw Refused("its pages of " + std::to_string(page_bytes_) + " bytes are none of E57's; copy or export it again");
  if (length > file_.size())
    throw Refused("it is truncated: its header announces " + std::to_string(length) + " bytes, it has " +
                  std::to_string(file_.size()) + "; copy or export it again");
  content_ = page_bytes_ - kChecksum;
  pages_ = file_.size() / page_bytes_;
  load(0);  // the checksum of this page covers the header
}

std::uint64_t E57Pages::logical(std::uint64_t physical) const {
  const std::uint64_t page = physical / page_bytes_, within = physical % page_bytes_;
  if (page >= pages_ || within >= content_)
    throw Refused("it refers to byte " + std::to_string(physical) + ", where there is nothing; export it again");
  return page * content_ + within;
}

void E57Pages::load(std::uint64_t page) {
  if (page == loaded_page_) return;
  if (page >= pages_) throw Refused("it ends in the middle of its data; copy or export it again");
  if (file_.place() != page * page_bytes_) file_.seek(page * page_bytes_);
  const char* bytes = file_.take(page_bytes_);
  // The checksum is the only big-endian number of the format.
  if (value_at<std::uint32_t>(bytes + content_, true) != crc32c(bytes, content_))
    throw Refused("page " + std::to_string(page) + " of it is damaged, by its checksum; copy or export it again");
  loaded_.assign(bytes, content_);
  loaded_page_ = page;
}

void E57Pages::read(std::uint64_t logical, char* to, std::size_t bytes) {
  while (bytes > 0) {
    load(logical / content_);
    const std::size_t within = logical % content_, n = std::min<std::size_t>(bytes, content_ - within);
    std::copy_n(loaded_.data() + within, n, to);
    to += n, logical += n, bytes -= n;
  }
}

std::string E57Pages::xml() {
  const std::uint64_t begin = logical(xml_offset_);
  if (xml_length_ > std::min(kMostXml, logical_end() - begin))
    throw Refused("its description of " + std::to_string(xml_length_) + " bytes does not fit into it; export it again");
  std::string text(xml_length_, '\0');
  read(begin, text.data(), text.size());
  return text;
}

}  // namespace vantage::importer
