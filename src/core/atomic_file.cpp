// SPDX-License-Identifier: Apache-2.0
#include "core/atomic_file.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <string>
#include <system_error>
#include <utility>

#include "vantage/error.hpp"

namespace vantage {
namespace {

std::string reason(int error) { return std::generic_category().message(error); }

std::string temporary_prefix(const std::filesystem::path& file) {
  return std::string(1, '.').append(file.filename().string()).append(1, '.');
}

constexpr std::string_view kSuffix = ".partial";
constexpr std::size_t kBuffer = std::size_t{1} << 20;

// `offset` < 0: the current position. Returns false, with errno, unless all bytes were written.
bool write_all(int descriptor, const char* data, std::size_t bytes, off_t offset = -1) {
  while (bytes > 0) {
    const ssize_t n = offset < 0 ? ::write(descriptor, data, bytes) : ::pwrite(descriptor, data, bytes, offset);
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) {
      if (n == 0) errno = ENOSPC;
      return false;
    }
    data += n, bytes -= static_cast<std::size_t>(n);
    if (offset >= 0) offset += n;
  }
  return true;
}

// Returns true if no process writes the file any more; a writer holds a lock on it.
bool abandoned(const std::filesystem::path& temporary) {
  // Follows no link, as it may lead to a file that only looks alike.
  const int descriptor = ::open(temporary.c_str(), O_RDWR | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK);
  if (descriptor < 0) return false;
  const bool free = ::flock(descriptor, LOCK_EX | LOCK_NB) == 0;
  ::close(descriptor);
  return free;
}

// Returns true for what no file may replace: a device, a pipe, a socket, or a link to an open one, as /dev/stdout is.
bool leads_elsewhere(const std::filesystem::path& file) {
  std::error_code none;
  switch (std::filesystem::symlink_status(file, none).type()) {
    case std::filesystem::file_type::block:
    case std::filesystem::file_type::character:
    case std::filesystem::file_type::fifo:
    case std::filesystem::file_type::socket: return true;
    case std::filesystem::file_type::symlink:
      return std::filesystem::read_symlink(file, none).string().starts_with("/proc/");
    default: return false;
  }
}

void remove_temporaries(const std::filesystem::path& folder, const std::string& prefix) {
  std::error_code ignored;
  for (const auto& entry : std::filesystem::directory_iterator(folder, ignored)) {
    const std::string name = entry.path().filename().string();
    if (name.starts_with(prefix) && name.ends_with(kSuffix) && abandoned(entry.path()))
      std::filesystem::remove(entry.path(), ignored);
  }
}

}  // namespace

AtomicFile::AtomicFile(std::filesystem::path file, unsigned mode) : file_(std::move(file)) {
  std::error_code unknown;
  if (!file_.has_filename() || std::filesystem::is_directory(file_, unknown))
    throw Error(Errc::io, "cannot write " + file_.string() + ": it names a folder; give a file name");
  if (leads_elsewhere(file_))
    throw Error(Errc::io, "cannot write " + file_.string() +
                              ": it is a device, a pipe or a socket, whose place a file would take; give a file name");
  static std::atomic<unsigned> serial{0};
  const std::string name = temporary_prefix(file_) + std::to_string(getpid()) + "-" + std::to_string(serial++);
  temporary_ = file_.parent_path() / (name + std::string(kSuffix));
  descriptor_ = ::open(temporary_.c_str(), O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC, mode);
  if (descriptor_ < 0)
    throw Error(Errc::io,
                "cannot write " + file_.string() + ": " + reason(errno) + " (does its folder exist, is it writable?)");
  ::flock(descriptor_, LOCK_EX | LOCK_NB);  // a file system without locks only loses the clean-up
}

AtomicFile::~AtomicFile() {
  if (descriptor_ < 0) return;
  ::close(descriptor_);
  std::error_code ignored;
  std::filesystem::remove(temporary_, ignored);
}

void AtomicFile::fail(const char* what) const {
  throw Error(Errc::io, std::string("cannot ") + what + " " + file_.string() + ": " + reason(errno));
}

void AtomicFile::flush() {
  if (!write_all(descriptor_, buffer_.data(), buffer_.size())) fail("write");
  buffer_.clear();
}

void AtomicFile::write(const void* data, std::size_t bytes) {
  const auto* begin = static_cast<const char*>(data);
  if (buffer_.size() + bytes > kBuffer) {
    flush();
    if (bytes > kBuffer) {
      if (!write_all(descriptor_, begin, bytes)) fail("write");
      return;
    }
  }
  buffer_.append(begin, bytes);
}

void AtomicFile::patch(std::size_t offset, const void* data, std::size_t bytes) {
  flush();
  if (!write_all(descriptor_, static_cast<const char*>(data), bytes, static_cast<off_t>(offset))) fail("write");
}

void AtomicFile::settle() {
  flush();
  if (::fsync(descriptor_) != 0) fail("write");
  settled_ = true;
}

void AtomicFile::commit() {
  if (!settled_) settle();
  const bool closed = ::close(std::exchange(descriptor_, -1)) == 0;
  if (!closed || ::rename(temporary_.c_str(), file_.c_str()) != 0) {
    const int error = errno;
    std::error_code ignored;
    std::filesystem::remove(temporary_, ignored);
    errno = error;
    fail("write");
  }
}

void AtomicFile::remove_leftovers(const std::filesystem::path& file) {
  remove_temporaries(file.has_parent_path() ? file.parent_path() : ".", temporary_prefix(file));
}

void AtomicFile::remove_leftovers_in(const std::filesystem::path& folder) { remove_temporaries(folder, "."); }

void remove_earlier(const std::filesystem::path& folder, std::initializer_list<const char*> names) {
  std::error_code ignored;
  for (const char* name : names) std::filesystem::remove(folder / name, ignored);
}

void write_atomically(const std::filesystem::path& file, std::string_view content) {
  AtomicFile out(file);
  out.write(content);
  out.commit();
}

}  // namespace vantage
