// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "arrays.hpp"
#include "simulator.hpp"

namespace vantage::python {

struct Scan;

/// The type `Scan`.
void add_scans(py::module_& m);
/// Points of simulators in files.
void add_clouds(py::module_& m);

Scan scan(Simulators& self, const Vec3& position, const std::vector<std::string>& outputs, const StationSetup& setup,
          bool grid, std::uint32_t place, const std::optional<BeamOptions>& beam,
          const std::optional<InstrumentErrors>& instrument, Listener progress);

/// The points of a station as a structured array.
py::array scan_array(Simulators& self, const Vec3& position, const std::vector<std::string>& outputs, bool float32,
                     const StationSetup& setup, std::uint32_t place, const std::optional<BeamOptions>& beam,
                     const std::optional<InstrumentErrors>& instrument, Listener progress);

/// Points of a station; with `grid` one element for each ray.
struct Scan : ScanPoints {
  std::uint32_t rows = 0, columns = 0;
  std::uint32_t outputs = 0;  ///< `ScanOutput` bits.
  bool grid = false;
};

}  // namespace vantage::python
