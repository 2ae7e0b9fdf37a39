// SPDX-License-Identifier: Apache-2.0
#include "core/read_file.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <system_error>

#include "vantage/error.hpp"

namespace vantage {
namespace {

struct Descriptor {
  int number;
  ~Descriptor() {
    if (number >= 0) ::close(number);
  }
};

}  // namespace

std::string read_file(const std::filesystem::path& file) {
  const auto fail = [&](const char* what) {
    throw Error(Errc::io, file.string() + ": cannot be " + what + ": " + std::generic_category().message(errno));
  };
  const Descriptor in{::open(file.c_str(), O_RDONLY | O_CLOEXEC)};
  if (in.number < 0) fail("opened");
  std::string bytes;
  std::array<char, 1 << 16> piece;
  for (;;) {
    const ssize_t n = ::read(in.number, piece.data(), piece.size());
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) fail("read");
    if (n == 0) return bytes;
    bytes.append(piece.data(), static_cast<std::size_t>(n));
  }
}

}  // namespace vantage
