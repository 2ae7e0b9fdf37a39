// SPDX-License-Identifier: Apache-2.0
// Decides a file's unit and up axis by what a person could do in the model: the ground in reach, the headroom, the
// openings, the steps. glTF prescribes metres and Y up; many exporters ignore that.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "scene/raw_scene.hpp"
#include "vantage/scene.hpp"

namespace vantage {

// The model in one unit and with one axis up. Lengths in metres.
struct Hypothesis {
  Unit unit = Unit::metre;
  UpAxis up = UpAxis::y;
  Vec3 size;                // survey frame: z is the height
  double floor_m2 = 0;      // level ground with headroom, in parts as large as a room
  double reached = 0;       // largest connected part of it, as a share of the outline seen from above
  double headroom_m = 0;    // median under cover, over all of the model's levels; 0: nothing is covered
  double covered = 0;       // area of those levels as a share of the outline, at most 1
  double rooms = 0;         // share of them with the headroom of a room
  double doors = 0;         // openings as wide and high as doors, on the way
  double flights = 0;       // stairs on the way, in doors' widths
  double upright = 0;       // Columns::upright(), as a share of that with either axis up
  double grid = 0;          // 1 if the model's drawing grid is in this unit
  bool inside_out = false;  // Columns::inside_out()
  double score = 0;
};

constexpr std::size_t kFeatures = 10;
std::array<double, kFeatures> features_of(const Hypothesis& h);

// Returns hypotheses, best first. Given values are not doubted. `raw`: read by glTF's rule, in the survey frame.
std::vector<Hypothesis> weigh_hypotheses(const RawScene& raw, const std::optional<Unit>& unit,
                                         const std::optional<UpAxis>& up);

struct Recognised {
  Unit unit = Unit::metre;
  UpAxis up = UpAxis::y;
  bool inside_out = false;                // true if its faces must be turned
  std::string note = {};                  // one line; empty if glTF's rule holds
  std::string question = {};              // not empty: no hypothesis wins clearly
  std::vector<std::string> choices = {};  // then: what each of the best hypotheses would mean
};

// `keeps_rule`: the file's format prescribes metres and Y up, as glTF does; that reading then needs a smaller lead.
Recognised recognise(const RawScene& raw, const std::optional<Unit>& unit, const std::optional<UpAxis>& up,
                     bool keeps_rule = true);

// Flips every face.
void turn_faces(RawScene& raw);

// Converts a scene read as metres with Y up to the survey frame, by its true unit and axis.
void reinterpret_axes(RawScene& raw, Unit unit, UpAxis up);

}  // namespace vantage
