// SPDX-License-Identifier: Apache-2.0
#include "disk/disk_faults.hpp"

#include <dlfcn.h>
#include <fcntl.h>
#include <signal.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <cstdarg>
#include <cstdio>
#include <cstdlib>
#include <sstream>
#include <string_view>

namespace vantage::test {
namespace {

DiskFault fault;
std::string sign;
std::atomic<int> calls{0};
std::array<std::atomic<bool>, 4096> watched{};  // descriptors of files below

template <class Function>
Function real(const char* name) {
  return reinterpret_cast<Function>(dlsym(RTLD_NEXT, name));
}

bool below(const char* path) { return !fault.below.empty() && std::string_view(path).starts_with(fault.below); }
bool below(int descriptor) {
  return descriptor >= 0 && descriptor < static_cast<int>(watched.size()) && watched[static_cast<unsigned>(descriptor)];
}

void leave_sign(const std::string& text) {
  const int descriptor = real<int (*)(const char*, int, ...)>("open")(sign.c_str(), O_CREAT | O_WRONLY, 0600);
  static_cast<void>(real<ssize_t (*)(int, const void*, size_t)>("write")(descriptor, text.data(), text.size()));
  ::close(descriptor);
}

// Counts a call; returns whether it must fail.
bool reached() {
  const int n = ++calls;
  if (fault.nth == 0 || n < fault.nth || (n > fault.nth && !fault.stays)) return false;
  if (!sign.empty()) leave_sign("reached");
  return true;
}

int fail() {
  if (fault.error == 0) raise(SIGKILL);
  errno = fault.error;
  return -1;
}

[[maybe_unused]] const bool from_environment = [] {
  const char* text = std::getenv(kDiskFaultVariable);
  if (!text) return false;
  std::istringstream in(text);
  in >> fault.nth >> fault.error >> fault.stays >> sign >> fault.below;
  return true;
}();

// Without a fault, the program reports its number of calls.
struct Count {
  ~Count() {
    if (fault.nth == 0 && !sign.empty()) leave_sign(std::to_string(calls));
  }
} const count;

}  // namespace

void set_disk_fault(const DiskFault& asked) { fault = asked, calls = 0; }
int disk_calls() { return calls; }

}  // namespace vantage::test

// NOLINTBEGIN: names of the C library
using namespace vantage::test;
extern "C" {

int open(const char* path, int flags, ...) {
  mode_t mode = 0;
  if (flags & (O_CREAT | O_TMPFILE)) {
    va_list more;
    va_start(more, flags);
    mode = va_arg(more, mode_t);
    va_end(more);
  }
  const bool counted = below(path) && (flags & O_ACCMODE) != O_RDONLY;
  if (counted && reached()) return fail();
  const int descriptor = real<int (*)(const char*, int, ...)>("open")(path, flags, mode);
  if (descriptor >= 0 && descriptor < static_cast<int>(watched.size()))
    watched[static_cast<unsigned>(descriptor)] = counted;
  return descriptor;
}

ssize_t write(int descriptor, const void* data, size_t bytes) {
  static const auto next = real<ssize_t (*)(int, const void*, size_t)>("write");
  if (!below(descriptor) || !reached()) return next(descriptor, data, bytes);
  if (fault.error == 0) static_cast<void>(next(descriptor, data, bytes / 2));
  return fail();
}

ssize_t pwrite(int descriptor, const void* data, size_t bytes, off_t offset) {
  static const auto next = real<ssize_t (*)(int, const void*, size_t, off_t)>("pwrite");
  return below(descriptor) && reached() ? fail() : next(descriptor, data, bytes, offset);
}

int fsync(int descriptor) {
  static const auto next = real<int (*)(int)>("fsync");
  if (!below(descriptor)) return next(descriptor);
  return reached() ? fail() : 0;  // not passed on: nothing here cuts the power, and hundreds of them take minutes
}

int rename(const char* from, const char* to) noexcept {
  static const auto next = real<int (*)(const char*, const char*)>("rename");
  return below(to) && reached() ? fail() : next(from, to);
}

int mkdir(const char* path, mode_t mode) noexcept {
  static const auto next = real<int (*)(const char*, mode_t)>("mkdir");
  return below(path) && reached() ? fail() : next(path, mode);
}

int close(int descriptor) {
  static const auto next = real<int (*)(int)>("close");
  if (descriptor >= 0 && descriptor < static_cast<int>(watched.size()))
    watched[static_cast<unsigned>(descriptor)] = false;
  return next(descriptor);
}

}  // extern "C"
// NOLINTEND
