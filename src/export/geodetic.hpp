// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace vantage {

// Well-known text (version 1, as GDAL writes it, in one line) of an EPSG code; empty if PROJ does not know it.
std::string epsg_text(int code);

}  // namespace vantage
