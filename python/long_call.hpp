// SPDX-License-Identifier: Apache-2.0
// Calls that take long: other Python threads run meanwhile. Between chunks of work, signals are handled and the
// caller's function gets the progress.
#pragma once

#include <exception>
#include <stop_token>
#include <utility>

#include "casters.hpp"

namespace vantage::python {

class LongCall {
 public:
  /// `heard`: called with the progress; None: no one is. If it returns False, the work stops, and its result says so.
  /// If it raises, or a signal's handler does (Ctrl-C), the work stops and the call raises that.
  explicit LongCall(py::object heard) : heard_(std::move(heard)) {}

  std::stop_token stop() const { return stop_.get_token(); }
  /// Requested in the second case only: the call then has no result.
  std::stop_token abort() const { return abort_.get_token(); }
  /// Progress of a part of the work, from one share of it to another.
  Progress progress(double from = 0, double to = 1) {
    return {.report = [=, this](double done) { report([=] { return from + done * (to - from); }); }, .stop = stop()};
  }

  /// `told()` makes the report, only if there is a listener.
  template <class Told>
  void report(const Told& told) {
    if (raised_) return;
    const py::gil_scoped_acquire lock;
    try {
      if (PyErr_CheckSignals() != 0) throw py::error_already_set();
      if (!heard_.is_none() && heard_(told()).is(py::bool_(false))) stop_.request_stop();
    } catch (...) {
      raised_ = std::current_exception();
      stop_.request_stop();
      abort_.request_stop();
    }
  }

  /// Does the work without the interpreter's lock.
  template <class Work>
  auto run(const Work& work) {
    try {
      auto result = [&] {
        const py::gil_scoped_release unlocked;
        return work();
      }();
      if (raised_) std::rethrow_exception(raised_);
      return result;
    } catch (...) {
      if (raised_) std::rethrow_exception(raised_);
      throw;
    }
  }

 private:
  py::object heard_;
  std::stop_source stop_, abort_;
  std::exception_ptr raised_;
};

}  // namespace vantage::python
