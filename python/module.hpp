// SPDX-License-Identifier: Apache-2.0
// Parts of the module `vantage`, in the order of their making: a later one uses types of earlier ones.
#pragma once

#include <pybind11/pybind11.h>

namespace vantage::python {

void add_errors(pybind11::module_& m);
void add_scenes(pybind11::module_& m);
void add_scanners(pybind11::module_& m);
void add_placement(pybind11::module_& m);
void add_targets(pybind11::module_& m);
void add_visits(pybind11::module_& m);
void add_evaluations(pybind11::module_& m);
void add_simulators(pybind11::module_& m);
void add_sites(pybind11::module_& m);
void add_on_site(pybind11::module_& m);
void add_rays(pybind11::module_& m);
void add_missed(pybind11::module_& m);
void add_candidates(pybind11::module_& m);
void add_problems(pybind11::module_& m);
void add_plans(pybind11::module_& m);
void add_next(pybind11::module_& m);

}  // namespace vantage::python
