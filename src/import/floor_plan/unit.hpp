// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "import/floor_plan/drawing.hpp"

namespace vantage::floor_plan {

struct Scale {
  double metres = 0;  // in one unit of the drawing
  std::string note;   // the unit, and what tells it
};

// `unit` is the user's, one of m, cm, mm, in and ft; empty: by the file's header, else by the width of doors. Throws
// Refused, with a question, if none decides or both contradict.
Scale scale_of(const Drawing& drawing, const std::string& unit);

}  // namespace vantage::floor_plan
