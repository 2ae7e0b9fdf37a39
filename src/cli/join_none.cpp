// SPDX-License-Identifier: Apache-2.0
// Replaces ranks in builds without MPI. Under an MPI launcher each process would plan everything, and all would write
// the same files.
#include <cstdlib>
#include <string_view>

#include "cli/join.hpp"
#include "vantage/error.hpp"

namespace vantage::cli {

std::unique_ptr<ranks::Ranks> join_ranks() {
  for (const char* name : {"OMPI_COMM_WORLD_SIZE", "PMI_SIZE"}) {
    const char* const size = std::getenv(name);
    if (size && std::string_view(size) != "1")
      throw Error(Errc::invalid_argument, "started as one of " + std::string(size) +
                                              " ranks, but vantage was built without MPI: build it with "
                                              "-DVANTAGE_MPI=ON");
  }
  return nullptr;
}

}  // namespace vantage::cli
