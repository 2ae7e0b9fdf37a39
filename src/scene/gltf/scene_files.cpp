// SPDX-License-Identifier: Apache-2.0
#include "scene/gltf/scene_files.hpp"

#include <algorithm>
#include <fstream>
#include <system_error>

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
                                          " are read; move it there, or allow it with --allow-outside "
                                          "(SceneOptions::allow_outside)");
  return file;
}

std::vector<std::uint8_t> read_file(const fs::path& path, const std::string& what) {
  std::error_code failure;
  const auto status = fs::status(path, failure);
  if (!fs::exists(status)) throw Error(Errc::io, what + ": there is no file " + path.string());
  if (!fs::is_regular_file(status)) throw Error(Errc::io, what + ": " + path.string() + " is not a regular file");
  const auto size = fs::file_size(path, failure);
  std::ifstream stream(path, std::ios::binary);
  if (failure || !stream) throw Error(Errc::io, what + ": " + path.string() + " cannot be opened for reading");
  std::vector<std::uint8_t> bytes(size);
  stream.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(size));
  if (static_cast<std::uintmax_t>(stream.gcount()) != size)
    throw Error(Errc::io, what + ": " + path.string() + " could be read only up to byte " +
                              std::to_string(stream.gcount()) + " of " + std::to_string(size));
  return bytes;
}

}  // namespace vantage::gltf
