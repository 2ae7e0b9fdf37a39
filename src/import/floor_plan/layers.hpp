// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "import/floor_plan/drawing.hpp"

namespace vantage::floor_plan {

// Converts ASCII, and letters of Latin-1, Latin Extended-A, Greek and Cyrillic.
std::string lower_case(const std::string& text);

// Recognises the kind by words of some fifteen languages in the name of a layer or block (UTF-8).
Kind kind_of(const std::string& name);

// Returns true if a name matches a shell pattern (*, ?), ignoring case.
bool matches(const std::string& name, const std::string& pattern);

// Returns true if a text is the title of a drawing that is no floor plan: an elevation, a section or a roof.
bool names_another_view(const std::string& text);

}  // namespace vantage::floor_plan
