// SPDX-License-Identifier: Apache-2.0
#include "scene/gltf/scene_files.hpp"

#include <algorithm>
#include <system_error>

#include "core/read_file.hpp"
#include "vantage/error.hpp"

namespace vantage::gltf {
namespace {

namespace fs = std::filesystem;

fs::path without_links(const fs::path& path, const std::string& what) {
  std::error_code failure;
  fs::path resolved = fs::absolute(path, failure);
  if (!failure) resolved = fs::weakly_canonical(resolved, failure);
  if (failure) throw Error(Errc::io, what + " cannot be read: " + path.string() + ": " + failure.message());
  return resolved;
}

bool lies_below(const fs::path& folder, const fs::path& file) {
  return std::mismatch(folder.begin(), folder.end(), file.begin(), file.end()).first == folder.end();
}

}  // namespace

fs::path locate(const fs::path& folder, const std::string& name, bool allow_outside, const std::string& what) {
  if (allow_outside) return folder / name;
  const fs::path home = without_links(folder.empty() ? "." : folder, what), file = without_links(home / name, what);
  if (!lies_below(home, file))
    throw Error(Errc::malformed_file, what + " lies outside the scene's folder: \"" + name + "\" leads to " +
                                          file.string() + ", and only files below " + home.string() +
                                          " are read; move it there, or allow it with the setting allow-outside");
  return file;
}

std::vector<std::uint8_t> read_file(const fs::path& path, const std::string& what, LoadBudget& budget) {
  RegularFile file(path, what);
  budget.keep(file.size(), "reading " + path.string());
  std::vector<std::uint8_t> bytes(file.size());
  file.read(bytes.data());
  return bytes;
}

}  // namespace vantage::gltf
