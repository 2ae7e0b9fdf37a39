// SPDX-License-Identifier: Apache-2.0
// What somebody may have meant by a name that does not exist.
#pragma once

#include <span>
#include <string>
#include <string_view>

namespace vantage {

// How many letters must be put in, left out, replaced, or swapped with their neighbour to make one text of the other
// (Damerau: A technique for computer detection and correction of spelling errors, 1964; each pair swapped once, as in
// the optimal string alignment). Letters count alike in both cases, and `-` as `_`.
std::size_t edit_distance(std::string_view a, std::string_view b);

// The nearest of `names`, the first of equals; empty where none is near: one mistake for three letters of the longer,
// and one in a short name. A name that begins or ends with what was typed, three letters at least, counts as near.
std::string closest_name(std::string_view typed, std::span<const std::string> names);

// "; did you mean NAME?", or nothing where no name is near.
std::string did_you_mean(std::string_view typed, std::span<const std::string> names);

}  // namespace vantage
