// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "ranks/ranks.hpp"

namespace vantage::cli {

// Joins the job of this process; null if it is not part of one. Throws Error invalid_argument if it was started in a
// job but cannot join it.
std::unique_ptr<ranks::Ranks> join_ranks();

}  // namespace vantage::cli
