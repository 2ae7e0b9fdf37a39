// SPDX-License-Identifier: Apache-2.0
// Recognises whether a file follows glTF: metres and Y up. Many exporters write another unit, or do not turn the axes.
// Evidence comes from the sizes of things by their names, stairs, the height of a storey, flat surfaces, and what
// stands above what. With little evidence, glTF's rule applies.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "scene/raw_scene.hpp"
#include "vantage/scene.hpp"

namespace vantage {

// Faces across an axis at one coordinate.
struct FlatLevel {
  double at = 0, area = 0;
  bool forward = true;  // facing along the axis
};

// A thing named by its node.
struct NamedBox {
  std::string name;
  Box box;
};

// Data about a scene before its unit and axes are known, in the file's own axes and lengths.
struct SceneEvidence {
  Box bounds;
  std::vector<NamedBox> nodes;
  std::array<std::vector<FlatLevel>, 3> levels;  // per axis, ascending; both sides separate
  double area = 0;                               // of all triangles
  Vec3 open;                                     // sum of normals times areas; 0 for closed bodies
};

struct Recognised {
  Unit unit = Unit::metre;
  UpAxis up = UpAxis::y;
  std::string note;  // one line; empty if nothing contradicts glTF's rule
};

// `raw`: read by glTF's rule, in the survey frame.
SceneEvidence gather_evidence(const RawScene& raw, const std::vector<NamedBox>& nodes);

// Values given by the options are not examined. Conservative: another unit needs two signs that contradict metres, or
// one if the scene would measure kilometres. Z up needs two signs, one of them more than proportions.
Recognised recognise(const SceneEvidence& evidence, const std::optional<Unit>& unit, const std::optional<UpAxis>& up);

// Converts a scene read as metres with Y up to the survey frame, by its true unit and axis.
void reinterpret_axes(RawScene& raw, Unit unit, UpAxis up);

}  // namespace vantage
