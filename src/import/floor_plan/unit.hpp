// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "import/floor_plan/drawing.hpp"
#include "import/floor_plan/walls.hpp"

namespace vantage::floor_plan {

struct Scale {
  double metres = 0;       // in one unit of the drawing
  std::string note;        // the unit, and how it was found
  bool sure = true;        // false if only the header gives it
  std::string sizes = {};  // the drawing's size in each unit, if not sure
};

// `unit` is the user's, one of m, cm, mm, in and ft; empty: by the file's header, else by the width of doors. Throws
// Refused, with a question, if neither decides or both disagree.
Scale scale_of(const Drawing& drawing, const std::string& unit);

// Throws Refused, with a question, if another unit than the one that only the header gives makes walls as thick as
// walls and rooms as large as rooms. `faces` are in the header's unit.
void doubt_unit(const Scale& scale, const std::vector<WallFace>& faces);

}  // namespace vantage::floor_plan
