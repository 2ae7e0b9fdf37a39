// SPDX-License-Identifier: Apache-2.0
#include "import/cloud/byte_file.hpp"

#include <algorithm>

#include "import/program.hpp"

namespace vantage::importer {
namespace {

constexpr std::size_t kBlock = std::size_t{1} << 20, kLongestLine = std::size_t{1} << 16;
constexpr std::size_t kMostOpen = 16;

// Returns the open files, in the order in which they were opened.
std::vector<ByteFile*>& open_files() {
  static std::vector<ByteFile*> files;
  return files;
}

}  // namespace

std::optional<double> number_of(std::string_view text) {
  if (text.starts_with('+')) text.remove_prefix(1);
  double value = 0;
  const auto [end, failure] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (failure != std::errc() || end != text.data() + text.size()) return {};
  return value;
}

ByteFile::ByteFile(const std::filesystem::path& file) : path_(file) {
  std::error_code failure;
  size_ = std::filesystem::file_size(file, failure);
  if (failure) throw Refused("it cannot be read");
  open();
}

ByteFile::~ByteFile() { std::erase(open_files(), this); }

void ByteFile::open() {
  if (stream_.is_open()) return;
  std::vector<ByteFile*>& files = open_files();
  if (files.size() >= kMostOpen) {
    files.front()->rest();
    files.erase(files.begin());
  }
  stream_.clear();
  stream_.open(path_, std::ios::binary);
  if (!stream_) throw Refused("it cannot be read");
  files.push_back(this);
  stream_.seekg(static_cast<std::streamoff>(std::min(begin_ + end_, size_)));
}

void ByteFile::rest() {
  stream_.close();
  begin_ += at_, at_ = end_ = 0;
  buffer_ = {};
}

void ByteFile::seek(std::uint64_t place) {
  stream_.clear();
  if (stream_.is_open()) stream_.seekg(static_cast<std::streamoff>(std::min(place, size_)));
  begin_ = place;
  at_ = end_ = 0;
}

bool ByteFile::fill(std::size_t bytes) {
  if (end_ - at_ >= bytes) return true;
  open();
  std::copy(buffer_.begin() + static_cast<std::ptrdiff_t>(at_), buffer_.begin() + static_cast<std::ptrdiff_t>(end_),
            buffer_.begin());
  begin_ += at_, end_ -= at_, at_ = 0;
  buffer_.resize(std::max({buffer_.size(), kBlock, bytes}));
  stream_.read(buffer_.data() + end_, static_cast<std::streamsize>(buffer_.size() - end_));
  end_ += static_cast<std::size_t>(stream_.gcount());
  return end_ >= bytes;
}

const char* ByteFile::take(std::size_t bytes) {
  if (bytes > left() || !fill(bytes))
    throw Refused("it ends at byte " + std::to_string(size_) + ", in the middle of its data; copy or export it again");
  at_ += bytes;
  return buffer_.data() + (at_ - bytes);
}

std::optional<std::string_view> ByteFile::line() {
  fill(kLongestLine);
  if (at_ == end_) return {};
  const char* first = buffer_.data() + at_;
  const std::size_t have = end_ - at_;
  const auto* end = static_cast<const char*>(std::memchr(first, '\n', have));
  if (!end && have >= kLongestLine)
    throw Refused("the line at byte " + std::to_string(place()) + " is longer than " + std::to_string(kLongestLine) +
                  " bytes; export it again");
  const std::size_t length = end ? static_cast<std::size_t>(end - first) : have;
  at_ += std::min(length + 1, have);
  std::string_view text(first, length);
  while (!text.empty() && (text.back() == '\r' || text.back() == ' ')) text.remove_suffix(1);
  return text;
}

}  // namespace vantage::importer
