// SPDX-License-Identifier: Apache-2.0
#include "core/atomic_file.hpp"

#include <fcntl.h>
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

}  // namespace

AtomicFile::AtomicFile(std::filesystem::path file) : file_(std::move(file)) {
  if (!file_.has_filename() || std::filesystem::is_directory(file_))
    throw Error(Errc::io, "cannot write " + file_.string() + ": it names a folder; give a file name");
  static std::atomic<unsigned> serial{0};
  const std::string name = temporary_prefix(file_) + std::to_string(getpid()) + "-" + std::to_string(serial++);
  temporary_ = file_.parent_path() / (name + std::string(kSuffix));
  const int descriptor = open(temporary_.c_str(), O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
  if (descriptor >= 0) stream_ = fdopen(descriptor, "w+b");
  if (!stream_)
    throw Error(Errc::io,
                "cannot write " + file_.string() + ": " + reason(errno) + " (does its folder exist, is it writable?)");
  setvbuf(stream_, nullptr, _IOFBF, std::size_t{1} << 20);
}

AtomicFile::~AtomicFile() {
  if (!stream_) return;
  std::fclose(stream_);
  std::error_code ignored;
  std::filesystem::remove(temporary_, ignored);
}

void AtomicFile::fail(const char* what) const {
  throw Error(Errc::io, std::string("cannot ") + what + " " + file_.string() + ": " + reason(errno));
}

void AtomicFile::write(const void* data, std::size_t bytes) {
  if (bytes > 0 && std::fwrite(data, 1, bytes, stream_) != bytes) fail("write");
}

void AtomicFile::patch(std::size_t offset, const void* data, std::size_t bytes) {
  if (fseeko(stream_, static_cast<off_t>(offset), SEEK_SET) != 0) fail("write");
  write(data, bytes);
  if (fseeko(stream_, 0, SEEK_END) != 0) fail("write");
}

void AtomicFile::commit() {
  if (std::fflush(stream_) != 0 || fsync(fileno(stream_)) != 0) fail("write");
  const bool closed = std::fclose(std::exchange(stream_, nullptr)) == 0;
  if (!closed || std::rename(temporary_.c_str(), file_.c_str()) != 0) {
    const int error = errno;
    std::error_code ignored;
    std::filesystem::remove(temporary_, ignored);
    errno = error;
    fail("write");
  }
}

void AtomicFile::remove_leftovers(const std::filesystem::path& file) {
  const std::string prefix = temporary_prefix(file);
  std::error_code ignored;
  const auto folder = file.has_parent_path() ? file.parent_path() : std::filesystem::path(".");
  for (const auto& entry : std::filesystem::directory_iterator(folder, ignored)) {
    const std::string name = entry.path().filename().string();
    if (name.starts_with(prefix) && name.ends_with(kSuffix)) std::filesystem::remove(entry.path(), ignored);
  }
}

void write_atomically(const std::filesystem::path& file, std::string_view content) {
  AtomicFile out(file);
  out.write(content);
  out.commit();
}

}  // namespace vantage
