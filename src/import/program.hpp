// SPDX-License-Identifier: Apache-2.0
// Common end of importers written in C++.
#pragma once

#include <functional>
#include <stdexcept>
#include <string>

namespace vantage::importer {

// The model cannot become a scene; the message says why.
struct Refused : std::runtime_error {
  using std::runtime_error::runtime_error;
};

// Says on standard error how much of the work is done, a share; seldom, however often it is called.
void tell_progress(double done);

// Writes the result of `convert` to standard output. Returns the exit code, of sysexits.h: 0; 65 if the model is at
// fault, or 71 if memory is short, each with a line on standard error that says so.
int run(const std::function<std::string()>& convert);

}  // namespace vantage::importer
