// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "import/format.hpp"
#include "vantage/scene.hpp"

namespace vantage {

bool takes_setting(const importers::Format& format, const std::string& name);

// Returns the settings among `options` that the importer of `format` takes, as words NAME=VALUE. Throws Error
// invalid_argument if settings of floor plans are given for another format; messages begin with `name`.
std::vector<std::string> importer_settings(const SceneOptions& options, const importers::Format& format,
                                           const std::string& name);

}  // namespace vantage
