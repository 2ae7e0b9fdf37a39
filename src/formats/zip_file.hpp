// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <utility>

namespace vantage {

// A ZIP archive of files by their paths in it, deflated, all of 1980-01-01. Throws Error io.
std::string zip_archive(std::span<const std::pair<std::string, std::string>> files);

}  // namespace vantage
