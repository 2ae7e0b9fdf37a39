// SPDX-License-Identifier: Apache-2.0
// Common end of the importers in C++: progress, result, errors and exit codes.
#pragma once

#include <functional>
#include <stdexcept>
#include <string>

namespace vantage::importer {

// Thrown if the model cannot become a scene; the message says why.
struct Refused : std::runtime_error {
  using std::runtime_error::runtime_error;
};

// Reports the share of work done on standard error; writes seldom, however often it is called.
void tell_progress(double done);

// Writes the result of `convert` to standard output. Returns an exit code of sysexits.h: 0; 65 if the model is at
// fault, or 71 if memory is short, each with a line on standard error that says so.
int run(const std::function<std::string()>& convert);

}  // namespace vantage::importer
