// SPDX-License-Identifier: Apache-2.0
// What importers written in C++ have in common: how they end.
#pragma once

#include <functional>
#include <stdexcept>
#include <string>

namespace vantage::importer {

// The model cannot become a scene; the message says why.
struct Refused : std::runtime_error {
  using std::runtime_error::runtime_error;
};

// Writes what `convert` returns to standard output. The result is the exit code, of sysexits.h: 0, or 65 where the
// model is at fault and 71 where memory is short, with a line on standard error that says so.
int run(const std::function<std::string()>& convert);

}  // namespace vantage::importer
