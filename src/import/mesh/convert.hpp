// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <stdexcept>
#include <string>

namespace vantage::import_mesh {

// The model cannot become a scene; the message says why.
struct Refused : std::runtime_error {
  using std::runtime_error::runtime_error;
};

// The bytes of a GLB with the model's nodes, names, transforms, meshes and materials. `format` is
// the extension that files of its format have, without the point. Throws Refused.
std::string convert(const std::filesystem::path& file, const std::string& format);

}  // namespace vantage::import_mesh
