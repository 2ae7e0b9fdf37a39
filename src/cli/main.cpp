// SPDX-License-Identifier: Apache-2.0
#include <cstdio>
#include <new>

#include "cli/command.hpp"

int main(int argc, char** argv) {
  try {
    return vantage::cli::run(argc, argv);
  } catch (const std::bad_alloc&) {  // no logger: it needs memory
    std::fputs(
        "vantage: error: this machine has not enough memory for it; coarser voxels (--user-size) or a smaller scene "
        "need less, and a plan goes on from its checkpoint with --resume\n",
        stderr);
    return vantage::cli::exit_failed;
  }
}
