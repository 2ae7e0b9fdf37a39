// SPDX-License-Identifier: Apache-2.0
// Suggests an existing name for a misspelt one.
#pragma once

#include <span>
#include <string>
#include <string_view>

namespace vantage {

// Returns the fewest insertions, deletions, replacements and swaps of neighbouring letters that turn one text into the
// other (Damerau: A technique for computer detection and correction of spelling errors, 1964; each pair swapped once,
// as in the optimal string alignment). Ignores case, and takes `-` as `_`.
std::size_t edit_distance(std::string_view a, std::string_view b);

// Returns the nearest of `names`, the first of equals; empty if none is near. Near means one mistake per three letters
// of the longer name, and at most one in a short name. A name that begins or ends with the typed text, of at least
// three letters, counts as near.
std::string closest_name(std::string_view typed, std::span<const std::string> names);

// Returns "; did you mean NAME?", or empty if no name is near.
std::string did_you_mean(std::string_view typed, std::span<const std::string> names);

// Returns the end of a message on a pattern of names (`*`, `?`, `!`, `|`) that matches none of `names`: the same for a
// near one, or "; there are A, B" with the first names and the number of others.
std::string names_there_are(std::string_view pattern, std::span<const std::string> names);

}  // namespace vantage
