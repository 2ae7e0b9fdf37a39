// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "vantage/site.hpp"

namespace vantage {

// The scanner of the options: the preset, or the built-in figures with lengths times `scale`, and all other given
// values. Throws Error invalid_argument.
Scanner site_scanner(const SiteOptions& options, double scale);
// Source of its noise, in the form of the setting.
std::string noise_source(const SiteOptions& options, const Scanner& scanner);
// Lets a scanner detect every echo.
void detect_every_echo(Scanner& scanner);
// Index of `scanner` in the list; its size if it is new. Throws as `Scanner::check`.
std::uint32_t place_in(std::span<const Scanner> scanners, const Scanner& scanner);

}  // namespace vantage
