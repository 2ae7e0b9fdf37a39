// SPDX-License-Identifier: Apache-2.0
#include "module.hpp"

#include <pybind11/numpy.h>

#include "options.hpp"

namespace vantage::python {

void add_errors(py::module_& m) {
  static PyObject* error = PyErr_NewExceptionWithDoc(
      "vantage.Error",
      "Error of vantage: str(error) says what is wrong, where, and what to do.\n\nAttributes:\n    code: "
      "'invalid_argument', 'io', 'malformed_file', 'no_suitable_device', 'out_of_memory' or\n        "
      "'device_failure'.\n    details: a tuple of further lines, e.g. why each device was refused.",
      PyExc_RuntimeError, nullptr);
  py::dict members;
  members["code"] = type_text<Errc>(), members["details"] = type_text<Tuple<std::string>>();
  py::handle(error).attr("__annotations__") = members;
  m.add_object("Error", error);
  py::register_exception_translator([](std::exception_ptr thrown) {
    try {
      if (thrown) std::rethrow_exception(thrown);
    } catch (const Error& e) {
      const py::object raised = py::handle(error)(e.what());
      raised.attr("code") = e.code();
      raised.attr("details") = Tuple<std::string>{{e.details().begin(), e.details().end()}};
      PyErr_SetObject(error, raised.ptr());
    }
  });
}

}  // namespace vantage::python

PYBIND11_MODULE(_core, m) {
  using namespace vantage::python;
  // pybind11 imports numpy when the first array is made. Two objectives that make one at once would deadlock: one waits
  // for the import, the other for the interpreter's lock.
  py::detail::npy_api::get();
  // Everything belongs to the package, whose `__init__.py` re-exports it; messages, signatures and pickles name the
  // package.
  const py::object name = m.attr("__name__");
  m.attr("__name__") = "vantage";
  add_errors(m);
  add_scenes(m);
  add_scanners(m);
  add_placement(m);
  add_targets(m);
  add_visits(m);
  add_evaluations(m);
  add_simulators(m);
  add_sites(m);
  add_on_site(m);
  add_rays(m);
  add_missed(m);
  add_candidates(m);
  add_problems(m);
  add_plans(m);
  add_next(m);
  m.attr("__name__") = name;

  m.attr("__version__") = vantage::version();
  py::dict options;
  for (const auto& [call, each] : all_options()) options[py::str(call)] = each;
  m.attr("_options") = options;
}
