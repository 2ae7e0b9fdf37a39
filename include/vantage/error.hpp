// SPDX-License-Identifier: Apache-2.0
/// The one exception type of vantage.
#pragma once

#include <memory>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

namespace vantage {

/// Kind of failure that an `Error` reports.
enum class Errc {
  invalid_argument,    ///< A value from the caller is out of its range.
  io,                  ///< A file cannot be read or written.
  malformed_file,      ///< A file was read, but its content is not valid.
  no_suitable_device,  ///< No device, or no suitable one; `details()` lists why each was refused.
  out_of_memory,       ///< The host or the device has not enough memory.
  device_failure,      ///< The device failed or was lost; the object that threw is unusable afterwards.
};

/// Every error that vantage raises. The message says what, where and what to do. Expected outcomes (no ground under a
/// (u, v), a clash, a cancelled run) are values, never errors.
class Error : public std::runtime_error {
 public:
  /// `what`: the message; `details`: further lines.
  Error(Errc code, const std::string& what, std::vector<std::string> details = {})
      : std::runtime_error(what),
        code_(code),
        details_(std::make_shared<const std::vector<std::string>>(std::move(details))) {}

  Errc code() const noexcept { return code_; }  ///< Kind of failure.
  /// Further lines, e.g. why each device was refused.
  std::span<const std::string> details() const noexcept { return *details_; }

 private:
  Errc code_;
  std::shared_ptr<const std::vector<std::string>> details_;  // shared: copying an exception must not throw
};

}  // namespace vantage
