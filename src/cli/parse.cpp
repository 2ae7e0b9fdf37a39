// SPDX-License-Identifier: Apache-2.0
#include "cli/parse.hpp"

#include <algorithm>

#include "vantage/error.hpp"

namespace vantage::cli {
namespace {

[[noreturn]] void refuse(const std::string& what, std::string_view text, const std::string& why) {
  throw Error(Errc::invalid_argument, what + ": '" + std::string(text) + "' " + why);
}

StationText parse_named_station(std::string_view text, const std::string& what) {
  std::optional<double> x, y, z, ground, u, v, heading, tilt, step, zenith_step, horizontal, vertical, zenith_start;
  StationText station;
  const std::initializer_list<std::pair<const char*, std::optional<double>*>> names{
      {"x", &x},
      {"y", &y},
      {"z", &z},
      {"ground", &ground},
      {"u", &u},
      {"v", &v},
      {"heading", &heading},
      {"tilt", &tilt},
      {"step", &step},
      {"zenith-step", &zenith_step},
      {"horizontal", &horizontal},
      {"vertical", &vertical},
      {"zenith-start", &zenith_start},
      {"nearest", &station.view.nearest_m},
      {"farthest", &station.view.farthest_m}};
  for (const auto part : split(text, ',')) {
    const std::size_t equals = part.find('=');
    const std::string_view name = trimmed_text(part.substr(0, equals));
    if ((name == "scanner" || name == "name") && equals != std::string_view::npos) {
      (name == "name" ? station.name : station.scanner) = trimmed_text(part.substr(equals + 1));
      continue;
    }
    const auto known = std::find_if(names.begin(), names.end(), [&](const auto& one) { return one.first == name; });
    if (equals == std::string_view::npos || known == names.end())
      refuse(what, text,
             "is no station: '" + std::string(part) +
                 "' is none of x=, y=, z=, ground=, u=, v=, heading=, tilt=, step=, "
                 "zenith-step=, horizontal=, vertical=, zenith-start=, nearest=, farthest=, scanner=, name=");
    if (*known->second) refuse(what, text, "says " + std::string(name) + " twice");
    *known->second = parse_number(part.substr(equals + 1), what);
  }
  if (heading) station.setup.heading = Angle::degrees(*heading);
  if (tilt) station.setup.tilt = Angle::degrees(*tilt);
  const auto angle = [](std::optional<double> degrees) {
    return degrees ? std::optional(Angle::degrees(*degrees)) : std::nullopt;
  };
  station.step = angle(step), station.view.zenith_step = angle(zenith_step);
  station.view.horizontal = angle(horizontal), station.view.vertical = angle(vertical);
  station.view.zenith_start = angle(zenith_start);
  if (u && v && !x && !y && !z && !ground) {
    station.uv = Uv{*u, *v};
    return station;
  }
  if (!x || !y || u || v || (z && ground))
    refuse(what, text, "is no station: give x=,y=; x=,y=,z= of the scanner's head; x=,y=,ground=; or u=,v=");
  if (z)
    station.position = Vec3{*x, *y, *z};
  else if (ground)
    station.ground = Vec3{*x, *y, *ground};
  else
    station.xy = std::array{*x, *y};
  return station;
}

}  // namespace

StationText parse_station(std::string_view text, const std::string& what) {
  if (text.find('=') != std::string_view::npos) return parse_named_station(text, what);
  if (text.find(';') != std::string_view::npos)
    refuse(what, text, "is no station: numbers have commas between them and decimal points, as 5.2,3.6,1.85");
  if (const auto parts = split(text, ',').size(); parts != 2 && parts != 3)
    refuse(what, text, "is no station: give X,Y,Z of the scanner's head or u,v on the search area");
  const auto values = parse_numbers(text, what, 2, 3);
  if (values.size() == 2) return {.pair = std::array{values[0], values[1]}};
  return {.position = Vec3{values[0], values[1], values[2]}};
}

}  // namespace vantage::cli
