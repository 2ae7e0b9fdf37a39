// SPDX-License-Identifier: Apache-2.0
// Replaces the editor in builds without its libraries.
#include "cli/command.hpp"
#include "vantage/error.hpp"

namespace vantage::cli {
namespace {

struct NoOptions {
  void add(CLI::App& command) { command.allow_extras(); }
};

int refuse(CLI::App&, NoOptions&, Program&) {
  throw Error(Errc::invalid_argument,
              "edit: vantage was built without Boost.Beast, three.js, meshoptimizer or zlib (Debian: "
              "libboost-dev, libjs-three, libmeshoptimizer-dev, zlib1g-dev)");
}

}  // namespace

void add_edit(CLI::App& app, Program& program) {
  add_command<NoOptions>(app, program, "edit", "Move stations by hand in a browser (not in this build)", refuse);
}

}  // namespace vantage::cli
