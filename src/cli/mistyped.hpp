// SPDX-License-Identifier: Apache-2.0
// What to say of words on the command line that mean nothing.
#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

namespace vantage::cli {

// Long names of a command's options, as "--stations".
std::vector<std::string> option_names(const CLI::App& command);

// Of the first word that a parse left over: that there is no such option or command, and which may have been meant.
// REQUIRES: a parse that left words over.
std::string explain_leftover(const CLI::App& app);

}  // namespace vantage::cli
