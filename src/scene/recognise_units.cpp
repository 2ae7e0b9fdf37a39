// SPDX-License-Identifier: Apache-2.0
#include "scene/recognise_units.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdio>
#include <map>
#include <string_view>
#include <utility>

#include "core/glm.hpp"
#include "scene/sound_triangle.hpp"

namespace vantage {
namespace {

constexpr int kX = 0, kY = 1, kZ = 2;
constexpr std::array<Unit, 5> kUnits{Unit::metre, Unit::foot, Unit::inch, Unit::centimetre, Unit::millimetre};

double along(const Vec3& v, int axis) { return axis == kX ? v.x : axis == kY ? v.y : v.z; }

// From the survey frame, by glTF's rule, back to the file's axes.
Vec3 file_from_survey(const glm::dvec3& p) { return {p.x, p.z, -p.y}; }

// --- names ---

// Lower-case words of a name, plurals without s: "Kitchen_Table.003" and "kitchenTable" are kitchen, table.
std::vector<std::string> words_of(const std::string& name) {
  std::vector<std::string> words;
  bool inside = false, lower_before = false;
  for (const char c : name) {
    const auto letter = static_cast<unsigned char>(c);
    if (!std::isalpha(letter)) {
      inside = false;
      continue;
    }
    if (!inside || (std::isupper(letter) && lower_before)) words.emplace_back();
    inside = true;
    lower_before = std::islower(letter) != 0;
    words.back() += static_cast<char>(std::tolower(letter));
  }
  for (std::string& word : words)
    if (word.size() > 3 && word.back() == 's' && word[word.size() - 2] != 's') word.pop_back();
  return words;
}

bool one_of(const std::string& word, std::initializer_list<std::string_view> list) {
  return std::ranges::find(list, word) != list.end();
}

bool has_word(const std::vector<std::string>& words, std::initializer_list<std::string_view> list) {
  return std::ranges::any_of(words, [&](const std::string& word) { return one_of(word, list); });
}

// Sizes of well-known things, in metres. Our own figures, wide on purpose: units differ by a factor of 2.5 or more.
struct KnownThing {
  std::string_view word;
  bool upright;  // the range is for its height, else for its longest side
  double least_m, most_m;
};
constexpr KnownThing kKnown[] = {
    {"door", true, 1.8, 2.6},     {"chair", true, 0.7, 1.3},    {"stool", true, 0.4, 0.9},
    {"desk", true, 0.65, 1.3},    {"table", true, 0.35, 1.1},   {"bed", false, 1.7, 2.4},
    {"sofa", false, 1.2, 3.3},    {"couch", false, 1.2, 3.3},   {"car", false, 3.0, 5.5},
    {"person", true, 1.4, 2.1},   {"human", true, 1.4, 2.1},    {"fridge", true, 0.8, 2.1},
    {"counter", true, 0.8, 1.2},  {"wardrobe", true, 1.4, 2.6}, {"refrigerator", true, 0.8, 2.1},
    {"toilet", true, 0.35, 0.95}, {"bathtub", false, 1.4, 2.0}, {"washbasin", true, 0.6, 1.0},
    {"bench", false, 0.9, 2.6},   {"pallet", false, 0.8, 1.3},  {"bus", false, 6, 19},
    {"cupboard", true, 0.5, 2.8}, {"cabinet", true, 0.5, 2.8},  {"shelf", true, 0.5, 2.8},
    {"bookcase", true, 0.5, 2.8}, {"window", true, 0.3, 3.2},   {"truck", false, 4, 18},
    {"van", false, 3.5, 7.5},     {"tree", true, 1.5, 30},      {"house", false, 4, 60},
    {"building", false, 4, 150},  {"column", true, 2, 15},      {"pump", false, 0.2, 4},
    {"room", false, 1.5, 40},     {"kerb", true, 0.05, 0.4},    {"curb", true, 0.05, 0.4},
};
constexpr double kSharp = 3.5;  // a range up to this width separates neighbouring units and counts full, a wider one
                                // half

// Names of parts say nothing about the whole.
bool is_fitting(const std::string& word) {
  return one_of(word, {"handle", "knob",   "frame",   "leg",    "wheel", "hinge",  "glass", "lock",   "light", "lamp",
                       "sill",   "drawer", "cushion", "pillow", "light", "mirror", "leaf",  "branch", "top",   "mat"});
}

// --- levels ---

struct Run {
  double pitch = 0;
  int count = 0;
};

constexpr int kFewestSteps = 5;
constexpr double kSameArea = 0.02, kSamePitch = 0.02;

// Runs of faces of equal area at equal distances: treads of a stair along its height, risers along its length; also
// rows of windows.
std::vector<Run> equal_runs(const std::vector<FlatLevel>& levels, bool forward) {
  constexpr std::size_t kMostLevels = 4000;
  std::vector<FlatLevel> by_area;
  for (const FlatLevel& level : levels)
    if (level.forward == forward) by_area.push_back(level);
  std::ranges::sort(by_area, [](const FlatLevel& a, const FlatLevel& b) { return a.area > b.area; });
  if (by_area.size() > kMostLevels) by_area.resize(kMostLevels);
  std::vector<Run> runs;
  for (std::size_t i = 0; i < by_area.size();) {
    std::size_t end = i + 1;
    while (end < by_area.size() && by_area[end].area >= by_area[i].area * (1 - kSameArea)) ++end;
    std::vector<double> at;
    for (std::size_t k = i; k < end; ++k) at.push_back(by_area[k].at);
    std::ranges::sort(at);
    for (std::size_t k = 0; k + 1 < at.size();) {
      const double pitch = at[k + 1] - at[k];
      std::size_t last = k + 1;
      while (last + 1 < at.size() && std::abs(at[last + 1] - at[last] - pitch) <= kSamePitch * pitch) ++last;
      if (static_cast<int>(last - k) >= kFewestSteps) runs.push_back({pitch, static_cast<int>(last - k)});
      k = last;
    }
    i = end;
  }
  return runs;
}

struct Stair {
  double rise = 0, going = 0;
  int count = 0;
};

// Finds a run along `up` and one of equal length along another axis, with pitches in the ratio of going to rise.
std::optional<Stair> find_stair(const std::array<std::vector<Run>, 3>& runs, int up) {
  constexpr double kLeastRatio = 1.15, kMostRatio = 2.3;
  std::optional<Stair> best;
  for (int other = 0; other < 3; ++other) {
    if (other == up) continue;
    for (const Run& rises : runs[static_cast<std::size_t>(up)])
      for (const Run& goings : runs[static_cast<std::size_t>(other)]) {
        const double ratio = goings.pitch / rises.pitch;
        if (ratio < kLeastRatio || ratio > kMostRatio || std::abs(rises.count - goings.count) > 2) continue;
        if (!best || rises.count > best->count) best = Stair{rises.pitch, goings.pitch, rises.count};
      }
  }
  return best;
}

// Free height between the two largest faces that face each other along an axis, such as floor and ceiling.
struct Storey {
  double height = 0, area = 0;
};
Storey find_storey(const std::vector<FlatLevel>& levels) {
  constexpr double kLarge = 0.3, kFits = 0.5;
  double most = 0;
  for (const FlatLevel& level : levels) most = std::max(most, level.area);
  Storey best;
  for (std::size_t i = 0; i < levels.size(); ++i) {
    if (!levels[i].forward || levels[i].area < kLarge * most) continue;
    for (std::size_t k = i + 1; k < levels.size(); ++k) {
      if (levels[k].forward && levels[k].area >= kFits * levels[i].area) break;  // another floor: no ceiling between
      if (levels[k].forward || levels[k].area < kFits * levels[i].area) continue;
      const double area = std::min(levels[i].area, levels[k].area);
      if (levels[k].at > levels[i].at && area > best.area) best = {levels[k].at - levels[i].at, area};
      break;
    }
  }
  return best;
}

// --- signs ---

// Evidence for one choice: its votes, and their description.
struct Case {
  double votes = 0;
  std::vector<std::string> signs;
  void add(double weight, const std::string& sign) {
    votes += weight;
    if (std::ranges::find(signs, sign) == signs.end()) signs.push_back(sign);
  }
  std::string text() const {
    constexpr std::size_t kMost = 4;
    std::string out;
    const std::size_t shown = std::min(signs.size(), kMost);
    for (std::size_t i = 0; i < shown; ++i) out += (i == 0 ? "" : i + 1 == signs.size() ? " and " : ", ") + signs[i];
    return out + (shown < signs.size() ? " and more" : "");
  }
};

struct UpCases {
  Case y, z;
  bool more_than_proportions = false;  // for z: evidence beyond proportions
};

void add_names(const SceneEvidence& evidence, UpCases& cases) {
  int flat[3] = {}, tall[3] = {};
  double low[3] = {}, high[3] = {};
  int lows = 0, highs = 0;
  for (const NamedBox& node : evidence.nodes) {
    const Vec3 size = node.box.size();
    double sides[3] = {size.x, size.y, size.z};
    std::ranges::sort(sides);
    const auto words = words_of(node.name);
    if (words.empty() || is_fitting(words.back())) continue;
    const bool above = has_word(words, {"roof", "ceiling", "crown", "chimney"});
    const bool below =
        has_word(words, {"floor", "ground", "road", "pavement", "foundation", "terrain", "garden", "lawn"});
    const bool lying = above || below || has_word(words, {"slab", "deck", "platform", "sidewalk"});
    const bool standing =
        has_word(words, {"column", "pillar", "post", "pole", "trunk", "person", "human", "door", "tree"});
    for (int axis = 0; axis < 3; ++axis) {
      if (lying && sides[0] < 0.4 * sides[1] && along(size, axis) == sides[0]) ++flat[axis];
      if (standing && !lying && sides[2] > 1.5 * sides[1] && along(size, axis) == sides[2]) ++tall[axis];
      if (above != below) (above ? high : low)[axis] += along(node.box.centre(), axis);
    }
    if (above != below) ++(above ? highs : lows);
  }
  const auto mostly = [](const int* counts, int axis) {
    return counts[axis] > 0 && counts[axis] >= 3 * (counts[kX] + counts[kY] + counts[kZ] - counts[axis]);
  };
  for (const int axis : {kY, kZ}) {
    Case& found = axis == kY ? cases.y : cases.z;
    const auto add = [&](const std::string& sign) {
      found.add(1, sign);
      cases.more_than_proportions |= axis == kZ;
    };
    if (mostly(flat, axis)) add("floors and roofs lie flat");
    if (mostly(tall, axis)) add("columns, doors or trees stand");
    if (lows > 0 && highs > 0) {
      const auto rise = [&](int a) { return high[a] / highs - low[a] / lows; };
      const double here = rise(axis), other = std::abs(rise(axis == kY ? kZ : kY));
      const double extent = along(evidence.bounds.size(), axis);
      if (here > 0.15 * extent && here > 1.5 * other) add("roofs are above floors");
    }
  }
}

UpCases up_cases(const SceneEvidence& evidence, const std::array<std::vector<Run>, 3>& runs) {
  UpCases cases;
  add_names(evidence, cases);
  const bool stair_y = find_stair(runs, kY).has_value(), stair_z = find_stair(runs, kZ).has_value();
  if (stair_y != stair_z) (stair_y ? cases.y : cases.z).add(1, "a stair climbs");
  const Vec3 size = evidence.bounds.size();
  const Storey storey_y = find_storey(evidence.levels[kY]), storey_z = find_storey(evidence.levels[kZ]);
  const auto low = [](const Storey& storey, double a, double b) {
    return storey.height > 0 && storey.height < 0.5 * std::min(a, b) && storey.area > 0.25 * a * b;
  };
  const bool room_y = low(storey_y, size.x, size.z) && storey_y.area > 2 * storey_z.area;
  const bool room_z = low(storey_z, size.x, size.y) && storey_z.area > 2 * storey_y.area;
  if (room_y) cases.y.add(1, "floor and ceiling face each other");
  if (room_z) cases.z.add(1, "floor and ceiling face each other");
  cases.more_than_proportions |= room_z || (stair_z && !stair_y);
  if (size.y < 0.5 * std::min(size.x, size.z)) cases.y.add(0.5, "the scene is flat");
  if (size.z < 0.5 * std::min(size.x, size.y)) cases.z.add(0.5, "the scene is flat");
  double across[3] = {};
  for (int axis = 0; axis < 3; ++axis)
    for (const FlatLevel& level : evidence.levels[static_cast<std::size_t>(axis)]) across[axis] += level.area;
  if (across[kY] > 1.5 * std::max(across[kX], across[kZ])) cases.y.add(0.5, "most faces lie flat");
  if (across[kZ] > 1.5 * std::max(across[kX], across[kY])) cases.z.add(0.5, "most faces lie flat");
  return cases;
}

// Share of faces at whole-number coordinates, by area across an axis. In drawings on a grid, most are multiples of 8 in
// inches, and of 10 in parts of a metre.
struct DrawingGrid {
  double eights = 0, tens = 0;
};
DrawingGrid drawing_grid(const SceneEvidence& evidence) {
  constexpr double kWhole = 1e-3;
  constexpr std::size_t kFewest = 30;  // different coordinates; fewer may be coincidence
  double all = 0, eights = 0, tens = 0;
  std::size_t whole = 0;
  for (const auto& levels : evidence.levels)
    for (const FlatLevel& level : levels) {
      all += level.area;
      const double nearest = std::round(level.at);
      if (nearest == 0 || std::abs(level.at - nearest) > kWhole) continue;
      ++whole;
      if (std::fmod(nearest, 8) == 0) eights += level.area;
      if (std::fmod(nearest, 10) == 0) tens += level.area;
    }
  return whole < kFewest ? DrawingGrid{} : DrawingGrid{eights / all, tens / all};
}

Case unit_case(const SceneEvidence& evidence, const std::array<std::vector<Run>, 3>& runs, int up, double metres) {
  Case found;
  std::map<std::string_view, std::pair<int, int>> things;  // number that fit, and total
  for (const NamedBox& node : evidence.nodes) {
    const auto words = words_of(node.name);
    if (words.empty() || is_fitting(words.back())) continue;
    const Vec3 size = node.box.size();
    for (const KnownThing& thing : kKnown) {
      if (!has_word(words, {thing.word})) continue;
      const double length = metres * (thing.upright ? along(size, up) : std::max({size.x, size.y, size.z}));
      auto& [fit, all] = things[thing.word];
      fit += length >= thing.least_m && length <= thing.most_m;
      ++all;
    }
  }
  for (const KnownThing& thing : kKnown) {
    const auto at = things.find(thing.word);
    if (at == things.end() || 2 * at->second.first < at->second.second || at->second.first == 0) continue;
    const bool sharp = thing.most_m <= kSharp * thing.least_m;
    found.add(sharp ? 1 : 0.5, "\"" + std::string(thing.word) + "\"");
  }
  const auto within = [&](double length, double least, double most) {
    return length * metres >= least && length * metres <= most;
  };
  const auto stair = find_stair(runs, up);
  if (stair && within(stair->rise, 0.14, 0.21) && within(stair->going, 0.2, 0.36))
    found.add(1.5, "the steps of a stair");
  const Storey storey = find_storey(evidence.levels[static_cast<std::size_t>(up)]);
  const Vec3 size = evidence.bounds.size();
  const double wide = up == kY ? size.z : size.y;
  if (within(storey.height, 2.2, 4.5) && storey.area > 0.25 * size.x * wide) found.add(1, "the height of a storey");
  const DrawingGrid grid = drawing_grid(evidence);
  if (metres == metres_in(Unit::inch) && grid.eights > 0.5 && grid.eights > 2 * grid.tens)
    found.add(1, "a drawing grid of 8");
  if ((metres == metres_in(Unit::centimetre) || metres == metres_in(Unit::millimetre)) && grid.tens > 0.5 &&
      grid.tens > 2 * grid.eights)
    found.add(0.5, "a drawing grid of 10");
  return found;
}

std::string rounded(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.3g", value);
  if (value < 1000) return text;
  std::snprintf(text, sizeof text, "%.0f", value);
  return text;
}

std::string plural(Unit unit) {
  switch (unit) {
    case Unit::metre: return "metres";
    case Unit::centimetre: return "centimetres";
    case Unit::millimetre: return "millimetres";
    case Unit::inch: return "inches";
    case Unit::foot: return "feet";
  }
  return {};
}

// Whether the body looks like a machine drawn in CAD: larger in every direction than any building, and closed.
bool like_a_machine(const SceneEvidence& evidence) {
  const Vec3 size = evidence.bounds.size();
  const double least = std::min({size.x, size.y, size.z}), most = std::max({size.x, size.y, size.z});
  const double open = std::sqrt(dot(evidence.open, evidence.open));
  return least > 100 && least > 0.25 * most && most < 20'000 && open < 0.05 * evidence.area;
}

struct UnitChoice {
  Unit unit = Unit::metre;
  std::string text;
};

UnitChoice choose_unit(const SceneEvidence& evidence, const std::array<std::vector<Run>, 3>& runs, int up) {
  constexpr double kAbsurd_m = 3000, kLeast_m = 0.5, kMost_m = 20'000;
  constexpr double kWide_m = 800, kTall_m = 250;  // both exceeded: mountains, which have no flat faces, but no site
  const Vec3 size = evidence.bounds.size();
  const double extent = std::max({size.x, size.y, size.z});
  const std::string as_metres = rounded(size.x) + " x " + rounded(size.y) + " x " + rounded(size.z) + " m";
  const bool absurd = extent > kAbsurd_m || (extent > kWide_m && along(size, up) > kTall_m);
  std::array<Case, kUnits.size()> cases;
  std::size_t best = 0, second = 0;
  for (std::size_t i = 0; i < kUnits.size(); ++i) {
    const double metres = metres_in(kUnits[i]);
    if (i > 0 && (extent * metres < kLeast_m || extent * metres > kMost_m)) continue;
    cases[i] = unit_case(evidence, runs, up, metres);
    if (i == 0) continue;
    if (best == 0 || cases[i].votes > cases[best].votes)
      second = best, best = i;
    else if (second == 0 || cases[i].votes > cases[second].votes)
      second = i;
  }
  const double metre_votes = cases[0].votes, votes = best ? cases[best].votes : 0;
  const double rival = second ? cases[second].votes : 0, needed = absurd ? 1 : 2;
  if (votes >= needed && votes - metre_votes >= needed && votes > rival)
    return {kUnits[best], "lengths are taken as " + plural(kUnits[best]) + ", which " + cases[best].text() +
                              (cases[best].signs.size() == 1 ? " fits" : " fit") + " (in metres it would be " +
                              as_metres + ")"};
  if (votes == 0 && metre_votes == 0 && like_a_machine(evidence))
    return {Unit::millimetre,
            "lengths are taken as millimetres, as those of a machine are (in metres it would be " + as_metres + ")"};
  if (extent > kAbsurd_m) return {Unit::metre, "it is " + as_metres + " large if its lengths are metres, as glTF says"};
  return {};
}

}  // namespace

SceneEvidence gather_evidence(const RawScene& raw, const std::vector<NamedBox>& nodes) {
  constexpr int kBins = 1 << 14;
  constexpr double kFlat = 0.9999, kFarthest = 1e12;
  SceneEvidence evidence;
  const auto within = [&](const Triangle& t, double limit) {
    return std::ranges::all_of(t, [&](std::uint32_t v) {
      const glm::dvec3& p = raw.positions[v];
      return std::abs(p.x) < limit && std::abs(p.y) < limit && std::abs(p.z) < limit;
    });
  };
  // Broken vertices are no evidence. But in a site in millimetres, all vertices may lie as far out as broken ones.
  const bool near = std::ranges::any_of(raw.triangles, [&](const Triangle& t) { return within(t, kFarthest_m); });
  const auto counts = [&](const Triangle& t) { return within(t, near ? kFarthest_m : kFarthest); };
  for (const Triangle& t : raw.triangles)
    if (counts(t))
      for (const std::uint32_t v : t) evidence.bounds.extend(file_from_survey(raw.positions[v]));
  for (const NamedBox& node : nodes) {
    NamedBox turned{node.name, {}};
    if (!node.box.empty())
      for (const Vec3& corner : {node.box.min, node.box.max}) turned.box.extend(file_from_survey(to_glm(corner)));
    evidence.nodes.push_back(std::move(turned));
  }
  const Vec3 size = evidence.bounds.size();
  struct Bin {
    double area = 0, moment = 0;
  };
  std::array<std::vector<Bin>, 6> bins;  // axis and side
  for (auto& side : bins) side.resize(kBins);
  for (const Triangle& t : raw.triangles) {
    if (!counts(t)) continue;
    const Vec3 a = file_from_survey(raw.positions[t[0]]), b = file_from_survey(raw.positions[t[1]]),
               c = file_from_survey(raw.positions[t[2]]);
    const Vec3 normal = cross(b - a, c - a) * 0.5;
    const double area = std::sqrt(dot(normal, normal));
    evidence.area += area;
    evidence.open = evidence.open + normal;
    for (int axis = 0; axis < 3; ++axis) {
      if (!(std::abs(along(normal, axis)) > kFlat * area) || !(along(size, axis) > 0)) continue;
      const double at = (along(a, axis) + along(b, axis) + along(c, axis)) / 3;
      const double share = (at - along(evidence.bounds.min, axis)) / along(size, axis);
      const auto bin = static_cast<std::size_t>(std::clamp(share * kBins, 0.0, kBins - 1.0));
      Bin& hit = bins[static_cast<std::size_t>(2 * axis + (along(normal, axis) > 0))][bin];
      hit.area += area, hit.moment += area * (at - along(evidence.bounds.min, axis));
    }
  }
  for (int axis = 0; axis < 3; ++axis) {
    auto& levels = evidence.levels[static_cast<std::size_t>(axis)];
    const double width = along(size, axis) / kBins;
    for (const bool forward : {false, true}) {
      const std::size_t first = levels.size();
      for (const Bin& bin : bins[static_cast<std::size_t>(2 * axis + forward)]) {
        if (!(bin.area > 0)) continue;
        const double at = bin.moment / bin.area + along(evidence.bounds.min, axis);
        if (levels.size() > first && at - levels.back().at < width) {  // one level on the edge of two bins
          FlatLevel& before = levels.back();
          before.at = (before.at * before.area + at * bin.area) / (before.area + bin.area);
          before.area += bin.area;
        } else {
          levels.push_back({at, bin.area, forward});
        }
      }
    }
    std::ranges::stable_sort(levels, {}, &FlatLevel::at);
  }
  return evidence;
}

Recognised recognise(const SceneEvidence& evidence, const std::optional<Unit>& unit, const std::optional<UpAxis>& up) {
  Recognised out{unit.value_or(Unit::metre), up.value_or(UpAxis::y), {}};
  if (evidence.bounds.empty() || !(evidence.area > 0)) return out;
  std::array<std::vector<Run>, 3> runs;
  for (std::size_t axis = 0; axis < 3; ++axis)
    for (const bool forward : {false, true})
      for (const Run& run : equal_runs(evidence.levels[axis], forward)) runs[axis].push_back(run);
  std::string up_text;
  if (!up) {
    const UpCases cases = up_cases(evidence, runs);
    if (cases.more_than_proportions && cases.z.votes >= 2 && cases.y.votes <= 0.5) {
      out.up = UpAxis::z;
      up_text = "Z is taken as up, for along it " + cases.z.text();
    } else if (cases.z.votes >= 1.5 && cases.z.votes > cases.y.votes) {
      up_text = "Y is taken as up, as glTF says, though along Z " + cases.z.text();
    }
  }
  UnitChoice choice;
  if (!unit) {
    choice = choose_unit(evidence, runs, out.up == UpAxis::z ? kZ : kY);
    out.unit = choice.unit;
  }
  if (!choice.text.empty() && !up_text.empty())
    out.note = choice.text + "; " + up_text + "; if that is wrong, give the setting unit and the setting up";
  else if (!choice.text.empty())
    out.note = choice.text + "; if that is wrong, give the setting unit";
  else if (!up_text.empty())
    out.note = up_text + "; if that is wrong, give the setting up";
  return out;
}

void reinterpret_axes(RawScene& raw, Unit unit, UpAxis up) {
  const double metres = metres_in(unit);
  const bool turn = up == UpAxis::z;
  if (metres == 1 && !turn) return;
  const auto point = [&](const glm::dvec3& p) { return (turn ? glm::dvec3(p.x, p.z, -p.y) : p) * metres; };
  for (glm::dvec3& p : raw.positions) p = point(p);
  for (glm::dvec3& p : raw.search_positions) p = point(p);
  if (turn)
    for (Float3& n : raw.normals) n = without_minus_zero({n.x, n.z, -n.y});
  raw.coarsest_input_spacing_m *= metres;
}

}  // namespace vantage
