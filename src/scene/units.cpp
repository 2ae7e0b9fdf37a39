// SPDX-License-Identifier: Apache-2.0
#include "vantage/error.hpp"
#include "vantage/scene.hpp"

namespace vantage {

double metres_in(Unit unit) noexcept {
  switch (unit) {
    case Unit::metre: return 1;
    case Unit::centimetre: return 0.01;
    case Unit::millimetre: return 0.001;
    case Unit::inch: return 0.0254;
    case Unit::foot: return 0.3048;
  }
  return 1;
}

const char* to_string(Unit unit) noexcept {
  switch (unit) {
    case Unit::metre: return "m";
    case Unit::centimetre: return "cm";
    case Unit::millimetre: return "mm";
    case Unit::inch: return "in";
    case Unit::foot: return "ft";
  }
  return "m";
}

Unit unit_from_string(const std::string& text) {
  for (const Unit unit : {Unit::metre, Unit::centimetre, Unit::millimetre, Unit::inch, Unit::foot})
    if (text == to_string(unit)) return unit;
  throw Error(Errc::invalid_argument, "\"" + text + "\" is no unit of length; use m, cm, mm, in or ft");
}

const char* to_string(UpAxis up) noexcept { return up == UpAxis::x ? "x" : up == UpAxis::y ? "y" : "z"; }

UpAxis up_axis_from_string(const std::string& text) {
  for (const UpAxis up : {UpAxis::x, UpAxis::y, UpAxis::z})
    if (text == to_string(up)) return up;
  throw Error(Errc::invalid_argument, "\"" + text + "\" is no axis that can point up; use x, y or z");
}

const char* to_string(SharedMeshes shared) noexcept {
  return shared == SharedMeshes::automatic ? "auto" : shared == SharedMeshes::always ? "always" : "never";
}

SharedMeshes shared_meshes_from_string(const std::string& text) {
  for (const SharedMeshes shared : {SharedMeshes::automatic, SharedMeshes::always, SharedMeshes::never})
    if (text == to_string(shared)) return shared;
  throw Error(Errc::invalid_argument, "\"" + text + "\" does not say when to share meshes; use auto, always or never");
}

}  // namespace vantage
