// SPDX-License-Identifier: Apache-2.0
// Whether a file keeps to what glTF says, metres and Y up. Exporters often write another unit, or turn nothing. What is
// known of a scene speaks for one or the other: the sizes of things by their names, stairs, the height of a storey,
// what lies flat and what stands above what. Where little speaks, glTF's word holds.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "scene/raw_scene.hpp"
#include "vantage/scene.hpp"

namespace vantage {

// Faces across an axis that lie at one coordinate.
struct FlatLevel {
  double at = 0, area = 0;
  bool forward = true;  // facing the way the axis points
};

// A thing by its node's name.
struct NamedBox {
  std::string name;
  Box box;
};

// What is known of a scene before its unit and its axes are: the file's own axes and lengths.
struct SceneEvidence {
  Box bounds;
  std::vector<NamedBox> nodes;
  std::array<std::vector<FlatLevel>, 3> levels;  // of each axis, ascending; both sides apart
  double area = 0;                               // of all triangles
  Vec3 open;                                     // the sum of their normals times areas; 0 for closed bodies
};

struct Recognised {
  Unit unit = Unit::metre;
  UpAxis up = UpAxis::y;
  std::string note;  // one line; empty where nothing speaks against glTF's word
};

// `raw` as it was read by glTF's word, in the survey frame.
SceneEvidence gather_evidence(const RawScene& raw, const std::vector<NamedBox>& nodes);

// What the options settle is not asked. Conservative: another unit needs two signs that metres contradict, or one where
// the scene would measure kilometres; Z up needs two, of which one is more than its proportions.
Recognised recognise(const SceneEvidence& evidence, const std::optional<Unit>& unit, const std::optional<UpAxis>& up);

// Puts a scene that was read as metres with Y up into the survey frame as it is meant.
void reinterpret_axes(RawScene& raw, Unit unit, UpAxis up);

}  // namespace vantage
