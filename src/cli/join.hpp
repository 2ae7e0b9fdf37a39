// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "ranks/ranks.hpp"

namespace vantage::cli {

// Joins the job that this process was started in; null where it stands alone. Throws Error invalid_argument where it
// was started as one of several and cannot be.
std::unique_ptr<ranks::Ranks> join_ranks();

}  // namespace vantage::cli
