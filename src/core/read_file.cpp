// SPDX-License-Identifier: Apache-2.0
#include "core/read_file.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <system_error>

#include "core/free_memory.hpp"
#include "vantage/error.hpp"

namespace vantage {
namespace {

constexpr std::uint64_t kLargest = std::uint64_t{1} << 30;

}  // namespace

RegularFile::RegularFile(const std::filesystem::path& file, const std::string& what)
    : name_(file.string()), prefix_(what.empty() ? "" : what + ": ") {
  // Checked before opening, since opening a device may have effects, and again on the opened file.
  struct stat found {};
  const auto require_regular = [&] {
    if (!S_ISREG(found.st_mode)) throw Error(Errc::io, prefix_ + name_ + " is not a regular file");
  };
  if (::stat(file.c_str(), &found) != 0) {
    if (errno == ENOENT) throw Error(Errc::io, prefix_ + "there is no file " + name_);
    fail("opened");
  }
  require_regular();
  descriptor_.number = ::open(file.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);
  if (descriptor_.number < 0 || ::fstat(descriptor_.number, &found) != 0) fail("opened");
  require_regular();
  size_ = static_cast<std::uint64_t>(found.st_size);
}

RegularFile::Descriptor::~Descriptor() {
  if (number >= 0) ::close(number);
}

void RegularFile::fail(const char* action) const {
  throw Error(Errc::io, prefix_ + name_ + " cannot be " + action + ": " + std::generic_category().message(errno));
}

std::size_t RegularFile::read_next(void* bytes, std::size_t most) {
  ssize_t n = 0;
  do {
    n = ::read(descriptor_.number, bytes, most);
  } while (n < 0 && errno == EINTR);
  if (n < 0) fail("read");
  return static_cast<std::size_t>(n);
}

void RegularFile::read(void* bytes) {
  auto* at = static_cast<char*>(bytes);
  for (std::uint64_t done = 0; done < size_;) {
    const std::size_t n = read_next(at + done, size_ - done);
    if (n == 0)
      throw Error(Errc::io, prefix_ + name_ + " could be read only up to byte " + std::to_string(done) + " of " +
                                std::to_string(size_));
    done += n;
  }
}

std::string read_file(const std::filesystem::path& file) {
  RegularFile in(file);
  if (in.size() > kLargest)
    throw Error(Errc::malformed_file, file.string() + " has " + bytes_text(in.size()) + ", and at most " +
                                          bytes_text(kLargest) + " are read of such a file");
  std::string bytes(in.size(), '\0');
  in.read(bytes.data());
  return bytes;
}

}  // namespace vantage
