// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "import/floor_plan/drawing.hpp"
#include "import/floor_plan/walls.hpp"

namespace vantage::floor_plan {

struct Scale {
  double metres = 0;       // in one unit of the drawing
  std::string note;        // the unit, and what tells it
  bool sure = true;        // false if the header alone tells it
  std::string sizes = {};  // of the drawing, in each unit, if not
};

// `unit` is the user's, one of m, cm, mm, in and ft; empty: by the file's header, else by the width of doors. Throws
// Refused, with a question, if none decides or both contradict.
Scale scale_of(const Drawing& drawing, const std::string& unit);

// Throws Refused, with a question, if walls are as thick as walls and rooms as large as rooms in another unit than the
// one that the header alone tells. `faces` are those of that one.
void doubt_unit(const Scale& scale, const std::vector<WallFace>& faces);

}  // namespace vantage::floor_plan
