// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "generate/model.hpp"

namespace vantage::built_in {

// Writes a GLB, Y up, one node per part, with role and diffuse coefficient in the nodes' extras. The same model gives
// the same bytes. Throws Error io.
void write_glb(const Model& model, const std::filesystem::path& file);

}  // namespace vantage::built_in
