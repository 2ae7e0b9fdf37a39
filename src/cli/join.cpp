// SPDX-License-Identifier: Apache-2.0
#include "cli/join.hpp"

namespace vantage::cli {

std::unique_ptr<ranks::Ranks> join_ranks() { return ranks::join(); }

}  // namespace vantage::cli
