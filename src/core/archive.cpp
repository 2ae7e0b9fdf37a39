// SPDX-License-Identifier: Apache-2.0
#include "core/archive.hpp"

#include <algorithm>
#include <istream>
#include <optional>

#include "core/crc32c.hpp"

namespace vantage {
namespace {

// Returns nothing if the stream ends early. Reads in pieces, so that a damaged length allocates no more memory than the
// stream can fill.
std::optional<std::string> next_bytes(std::istream& in, std::uint64_t count) {
  constexpr std::uint64_t kPiece = 1 << 20;
  std::string bytes;
  while (bytes.size() < count) {
    const std::size_t begin = bytes.size(), wanted = static_cast<std::size_t>(std::min(kPiece, count - begin));
    bytes.resize(begin + wanted);
    in.read(bytes.data() + begin, static_cast<std::streamsize>(wanted));
    if (static_cast<std::size_t>(in.gcount()) != wanted) return std::nullopt;
  }
  return bytes;
}

template <PlainBytes T>
bool read_number(std::istream& in, T& value, std::string& all) {
  const auto bytes = next_bytes(in, sizeof value);
  if (!bytes) return false;
  std::memcpy(&value, bytes->data(), sizeof value);
  all += *bytes;
  return true;
}

}  // namespace

std::string sealed(const ArchiveFormat& format, std::string_view payload) {
  ArchiveWriter head, sum;
  head.raw(format.version), head.raw(std::uint64_t{payload.size()});
  std::string whole(format.magic);
  whole.append(head.bytes()).append(payload);
  sum.raw(crc32c(whole.data(), whole.size()));
  return whole + sum.bytes();
}

Unsealed unseal(std::istream& in, const ArchiveFormat& format) {
  using State = Unsealed::State;
  auto whole = next_bytes(in, format.magic.size());
  if (!whole || *whole != format.magic) return {.state = State::foreign};
  Unsealed found{.state = State::damaged};
  std::uint64_t size = 0;
  if (!read_number(in, found.version, *whole)) return found;
  if (found.version != format.version) {
    found.state = State::other_version;
    return found;
  }
  if (!read_number(in, size, *whole)) return found;
  auto payload = next_bytes(in, size);
  if (!payload) return found;
  *whole += *payload;
  const std::uint32_t sum = crc32c(whole->data(), whole->size());
  std::uint32_t written = 0;
  if (!read_number(in, written, *whole) || written != sum) return found;
  found.state = State::whole, found.payload = *std::move(payload);
  return found;
}

}  // namespace vantage
