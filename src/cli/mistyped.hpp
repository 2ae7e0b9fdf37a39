// SPDX-License-Identifier: Apache-2.0
// Messages about unknown words on the command line.
#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

namespace vantage::cli {

// Long names of a command's options, as "--stations".
std::vector<std::string> option_names(const CLI::App& command);

// Message about the first unparsed word: no such option or command, and the nearest known one. REQUIRES: a parse that
// left words over.
std::string explain_leftover(const CLI::App& app);

}  // namespace vantage::cli
