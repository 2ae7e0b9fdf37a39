// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace vantage {

// Well-known text (version 1, as GDAL writes it, in one line) of a code of the EPSG registry; empty if PROJ knows none.
std::string epsg_text(int code);

}  // namespace vantage
