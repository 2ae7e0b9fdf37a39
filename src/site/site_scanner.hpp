// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "vantage/site.hpp"

namespace vantage {

// The scanner that the options describe: the preset, or the built-in figures with lengths times `scale`, and whatever
// is given besides. Throws Error invalid_argument.
Scanner site_scanner(const SiteOptions& options, double scale);
// Where its noise comes from, as the setting takes it.
std::string noise_source(const SiteOptions& options, const Scanner& scanner);
// The place of `scanner` in the list, at whose end it is added if need be. Throws as `Scanner::check`.
std::uint32_t place_in(std::vector<Scanner>& scanners, const Scanner& scanner);

}  // namespace vantage
