// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vantage/evaluation.hpp"

namespace vantage {

// Fills `Evaluation::through_glass` where glass may part a network: the scene has some, and the scans form several
// components. Otherwise it costs nothing. A stop leaves it empty, and so does a lack of memory: it decides nothing.
void look_through_glass(Evaluation& evaluation, const Simulator& simulator, const Progress& progress);

}  // namespace vantage
