// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include "evaluation.hpp"
#include "module.hpp"
#include "pickle.hpp"
#include "settings.hpp"
#include "site.hpp"

namespace vantage::python {
namespace {

/// A result, and the site that it was planned on.
struct Plan {
  PlanResult result;
  std::shared_ptr<GuardedSite> site;
};
/// Known values of one measure of a network.
struct MeasuredValue {
  double searched, standard_error, exact;
  double best_known() const { return exact == exact ? exact : searched; }
};
/// A network of a front; shares the result.
struct Entry {
  std::shared_ptr<const Plan> plan;
  std::size_t index = 0;
  const PlanEntry& get() const { return plan->result.front[index]; }
};
/// `PlanProgress` that outlives the call.
struct Watched : PlanProgress {
  explicit Watched(const PlanProgress& now) : PlanProgress(now), points(now.front.begin(), now.front.end()) {
    front = {};
  }
  std::vector<ParetoPoint> points;
};

py::array_t<double> table_of(const std::vector<std::vector<double>>& rows) {
  const std::size_t width = rows.empty() ? 0 : rows.front().size();
  std::vector<double> flat;
  for (const auto& row : rows) flat.insert(flat.end(), row.begin(), row.end());
  return adopt<double>(std::move(flat), {static_cast<py::ssize_t>(rows.size()), static_cast<py::ssize_t>(width)});
}

py::array_t<double> scaled_front(const Watched& now) {
  std::vector<std::vector<double>> rows;
  for (const ParetoPoint& point : now.points) rows.push_back(point.f);
  return table_of(rows);
}

using GivenProblem = Typed<"Union[None, str, vantage.SurveyProblem]">;

// Takes the settings of a question and of a search, or `problem` in place of the former.
std::shared_ptr<Plan> plan_site(const std::shared_ptr<GuardedSite>& guarded, const GivenProblem& problem,
                                std::vector<Vec3> start, std::optional<std::filesystem::path> checkpoint,
                                std::vector<Target> existing_targets,
                                Typed<"Optional[Callable[[vantage.PlanProgress], Any]]"> progress,
                                const py::kwargs& given) {
  refuse_unknown(given, "Site.plan", question_settings(), plan_settings());
  SurveyQuestion question;
  PlanConfig config;
  std::size_t asked = read_settings(question_settings(), question, given);
  asked += existing_targets.empty() ? 0 : 1;
  question.existing_targets = std::move(existing_targets);
  // A problem by its name is a setting of the question.
  const bool named = py::isinstance<py::str>(problem);
  if (named) question.problem = problem.cast<std::string>(), ++asked;
  read_settings(plan_settings(), config, given);
  config.start = std::move(start);
  if (checkpoint) config.checkpoint = std::move(*checkpoint);
  const bool whole = !problem.is_none() && !named;
  if (whole && asked > 0)
    throw py::type_error(
        "Site.plan: a problem contains the whole question; give either a problem or settings of a question");
  const std::optional<SurveyProblem> own = whole ? std::optional(problem.cast<SurveyProblem>()) : std::nullopt;
  const auto lock = guarded->taken();
  LongCall call(std::move(progress));
  PlanResult result = call.run([&] {
    const SurveyProblem asked_for = [&] {
      const std::unique_lock settling(guarded->settled);
      SurveyProblem made = own ? *own : survey_problem(guarded->site, question);
      equip(guarded->site, made);
      return made;
    }();
    return plan(guarded->site, asked_for, config,
                {.report = [&](const PlanProgress& now) { call.report([&] { return Watched(now); }); },
                 .stop = call.stop(),
                 .abort = call.abort()});
  });
  return std::make_shared<Plan>(Plan{.result = std::move(result), .site = guarded});
}

void add_progress(py::module_& m) {
  py::class_<Watched>(m, "PlanProgress", "Progress of a search.")
      .def_property_readonly(
          "phase",
          [](const Watched& now) {
            return Typed<"Literal['look', 'choose', 'search', 'confirm']", py::str>(now.phase);
          },
          "'look' (at attainable coverage), 'choose', 'search' or 'confirm'.")
      .def_readonly("iteration", &Watched::iteration, "Number of the iteration, out of `iterations`.")
      .def_readonly("iterations", &Watched::iterations, "The requested number.")
      .def_readonly("evaluations", &Watched::evaluations, "Networks that were evaluated.")
      .def_readonly("evaluations_per_second", &Watched::evaluations_per_second, "Speed of evaluation.")
      .def_readonly("hypervolume", &Watched::hypervolume, "Hypervolume of the present front.")
      .def_readonly("seconds_left", &Watched::seconds_left, "Time left; negative: not known yet.")
      .def_readonly("whole_seconds_left", &Watched::whole_seconds_left,
                    "Time of all the rest, given once by searches for the fewest stations; else None.")
      .def_readonly("attainable", &Watched::attainable, "Attainable coverage, given once, when it is known; else None.")
      .def_property_readonly(
          "front", &scaled_front,
          "Values that the optimiser minimises for each network of the front, 0 best: (k, objectives).");
}

void add_entries(py::module_& m) {
  py::class_<MeasuredValue>(m, "MeasuredValue", "Known values of one measure of a network.")
      .def_readonly("searched", &MeasuredValue::searched, "Value in the search; NaN if it kept none.")
      .def_readonly("standard_error", &MeasuredValue::standard_error, "Standard error of `searched`; 0 when exact.")
      .def_readonly("exact", &MeasuredValue::exact, "Value by every ray; NaN unless confirmed.")
      .def_property_readonly("best_known", &MeasuredValue::best_known, "The exact value, if there is one.");
  py::class_<Entry> type(m, "PlanEntry", "One network of a front.");
  type.def_property_readonly(
          "x",
          [](const Entry& e) {
            return py::array_t<double>(static_cast<py::ssize_t>(e.get().x.size()), e.get().x.data());
          },
          "Decision vector: u1, v1, ..., uN, vN, then heights, scanners and alpha if they are searched.")
      .def_property_readonly(
          "stations", [](const Entry& e) { return e.get().stations; }, "Its stations.")
      .def_property_readonly(
          "heads", [](const Entry& e) { return heads_of(e.get().stations); },
          "Their heads, survey frame: (n, 3), metres.")
      .def_property_readonly(
          "values",
          [](const Entry& e) {
            const PlanEntry& entry = e.get();
            std::map<std::string, MeasuredValue> values;
            for (const auto& [name, seen] : entry.searched)
              values[name] = {seen.value, seen.standard_error, entry.exact ? entry.value(name) : std::nan("")};
            return values;
          },
          "MeasuredValue by the names of the plan's measures.")
      .def(
          "value", [](const Entry& e, const std::string& name) { return e.get().value(name); }, py::arg("name"),
          "values[name].best_known. Raises Error invalid_argument for a name that the plan did not measure.")
      .def_property_readonly(
          "confirmed", [](const Entry& e) { return e.get().exact; }, "Whether the exact values were computed.")
      .def_property_readonly(
          "dominated", [](const Entry& e) { return e.get().dominated; },
          "Whether another one is better, once every ray is traced.")
      .def_property_readonly(
          "missed", [](const Entry& e) { return e.get().violation; }, "Violation of requirements; 0: all are met.")
      .def_property_readonly(
          "overlap_matrix", [](const Entry& e) { return matrix_of(e.get().overlap_matrix); },
          "Equation 11 by every ray: (n, n); (0, 0) unless confirmed.")
      .def_property_readonly(
          "scan_overlap_matrix", [](const Entry& e) { return matrix_of(e.get().scan_overlap_matrix); },
          "Scan overlaps over all surfaces: (n, n); (0, 0) unless a measure needs them.")
      .def_property_readonly(
          "registration", [](const Entry& e) { return e.get().registration; },
          "Predicted error by every ray; None unless confirmed and a measure needs it.")
      .def_property_readonly(
          "targets", [](const Entry& e) { return e.get().targets; },
          "Targets that tie its scans together, given and proposed; `registration` is with them. Of the answer only.")
      .def_property_readonly(
          "without_targets_m", [](const Entry& e) { return e.get().without_targets_m; },
          "Root mean square registration error without its targets; None unless targets were looked for.")
      .def_property_readonly(
          "data", [](const Entry& e) { return data_of(e.get()); }, kData)
      .def_property_readonly(
          "visit", [](const Entry& e) { return e.get().visit; }, "The round on site; None if it was not computed.")
      .def("__repr__", [](const Entry& e) {
        std::string text;
        for (const auto& [name, value] : e.get().values)
          text += ", " + name + " " + std::string(py::str(py::float_(value.value)));
        return "<vantage.PlanEntry of " + std::to_string(e.get().stations.size()) + " stations" + text + ">";
      });
  refuse_pickle(type, "a PlanEntry refers to its PlanResult and is not pickled; take its stations and values");
}

Typed<"List[Dict[str, Any]]", py::list> history_of(const Plan& plan) {
  py::list lines;
  for (const PlanIteration& iteration : plan.result.history) {
    py::dict line;
    line["iteration"] = iteration.iteration;
    line["evaluations"] = iteration.evaluations;
    line["hypervolume"] = iteration.hypervolume;
    line["seconds"] = iteration.seconds;
    line["front"] = table_of(iteration.front);
    lines.append(line);
  }
  return lines;
}

void write_plan_report(const Plan& plan, const std::filesystem::path& file, const std::optional<std::string>& title,
                       Listener progress) {
  const auto lock = plan.site->taken();
  Site& site = plan.site->site;
  const PlanEntry& chosen = plan.result.front.at(answer(plan.result));
  LongCall call(std::move(progress));
  call.run([&] {
    VoxelField counted;
    const bool kept = !chosen.field.count.empty();
    if (!kept) site.simulator().evaluate(to_network(chosen.stations), {.field = &counted}, call.progress(0, 0.3));
    const VoxelField& field = kept ? chosen.field : counted;
    if (call.stop().stop_requested()) return 0;
    const MissedVoxels missed = missed_voxels(site, field, {}, call.progress(0.3, 0.6));
    if (!call.stop().stop_requested())
      write_report(file, plan.result, site, {.title = title.value_or(""), .field = &field, .missed = &missed},
                   call.progress(0.6, 1));
    return 0;
  });
}

std::vector<std::string> write_folder(const Plan& plan, const std::filesystem::path& folder,
                                      const std::optional<std::string>& title, bool reports,
                                      std::optional<double> max_seconds, bool doubles, Listener progress) {
  const auto lock = plan.site->taken();
  LongCall call(std::move(progress));
  return call.run([&] {
    return write_plan(folder, plan.result, plan.site->site,
                      {.report = {.title = title.value_or("")},
                       .reports = reports,
                       .ply = doubles ? PlyCoordinates::doubles : PlyCoordinates::floats,
                       .max_seconds = max_seconds},
                      {.report = [&](const FolderProgress& now) { call.report([&] { return now.whole; }); },
                       .stop = call.stop()})
        .left_out;
  });
}

void add_results(py::module_& m) {
  py::class_<Plan, std::shared_ptr<Plan>> type(m, "PlanResult", "Result of a search.");
  type.def_property_readonly(
          "front",
          [](const std::shared_ptr<Plan>& plan) {
            std::vector<Entry> entries;
            for (std::size_t k = 0; k < plan->result.front.size(); ++k) entries.push_back({plan, k});
            return entries;
          },
          "Its networks, sorted by the objectives in order, best first; one if there is one objective.")
      .def_property_readonly(
          "answer",
          [](const std::shared_ptr<Plan>& plan) {
            return Entry{plan, answer(plan->result)};
          },
          "The answer: the network nearest to the best values among those that meet all requirements.")
      .def_property_readonly(
          "met", [](const Plan& plan) { return met(plan.result); }, "Whether the answer meets all requirements.")
      .def_property_readonly(
          "what_would_help", [](const Plan& plan) { return what_would_help(plan.result); },
          "Advice if it does not, a sentence each.")
      .def_property_readonly(
          "measures",
          [](const Plan& plan) {
            std::vector<std::string> names;
            for (const Objective& measure : plan.result.measures) names.push_back(measure.name);
            return names;
          },
          "Names of the measures of every network.")
      .def_property_readonly(
          "scanners", [](const Plan& plan) { return plan.result.scanners; },
          "Copies of the scanners, indexed by `StationSetup.scanner`.")
      .def_property_readonly(
          "history", &history_of,
          "A dict for each iteration: iteration, evaluations, hypervolume, seconds, front (k, objectives).")
      .def_property_readonly(
          "hypervolume", [](const Plan& plan) { return plan.result.hypervolume; }, "Hypervolume of the search.")
      .def_property_readonly(
          "exact_hypervolume", [](const Plan& plan) { return plan.result.exact_hypervolume; },
          "Hypervolume by every ray.")
      .def_property_readonly(
          "evaluations", [](const Plan& plan) { return plan.result.evaluations; }, "Networks that were evaluated.")
      .def_property_readonly(
          "stop_reason", [](const Plan& plan) { return to_string(plan.result.stop_reason); }, "Why the search ended.")
      .def_property_readonly(
          "seconds", [](const Plan& plan) { return plan.result.seconds; }, "Time of the call.")
      .def_property_readonly(
          "site", [](const Plan& plan) { return plan.site; }, "The site that it was planned on.")
      .def_property_readonly(
          "summary", [](const Plan& plan) { return summary_text(plan.result); },
          "Summary of the answer in plain words.")
      .def(
          "to_dict",
          [](const Plan& plan) {
            const auto lock = plan.site->taken();
            return from_json(front_json(plan.result, plan.site->site.simulator()));
          },
          "Content of front.json: the front, every parameter, engine, seed and version. Entries count from 1.")
      .def(
          "write", &write_folder, py::arg("folder"), py::kw_only(), py::arg("title") = py::none(),
          py::arg("reports") = true, py::arg("max_seconds") = py::none(), py::arg("doubles") = false,
          py::arg("progress") = py::none(),
          "Writes the result folder, all that `vantage plan` writes of a plan: tables, drawings, pictures, captured\n"
          "and missed surface, reports (docs/files.md). Counts the answer with every ray, unless its points were kept. "
          "Returns the names of\nfiles that were left out since `max_seconds` were over, or progress returned False. "
          "title: of the reports; None: the\nsite's name. doubles: as for `write_point_cloud`. Raises Error: io, "
          "invalid_argument.")
      .def("write_report", &write_plan_report, py::arg("file"), py::kw_only(), py::arg("title") = py::none(),
           py::arg("progress") = py::none(),
           "Writes report.html or report.pdf by the file's extension, with the surfaces that the answer captures and "
           "misses. title: None: the site's name.\nRaises Error: io, invalid_argument (another extension, a build that "
           "writes no reports).")
      .def("__repr__", [](const Plan& plan) {
        return "<vantage.PlanResult of " + std::to_string(plan.result.front.size()) + " networks, " +
               std::to_string(plan.result.evaluations) + " evaluations, " + to_string(plan.result.stop_reason) + ">";
      });
  refuse_pickle(type, "a PlanResult refers to its site, which owns a device, and is not pickled; take to_dict()");
}

}  // namespace

void add_plans(py::module_& m) {
  add_progress(m);
  add_entries(m);
  add_results(m);
  const py::object site = m.attr("Site");
  site.attr("plan") = py::cpp_function(
      &plan_site, py::name("plan"), py::is_method(site), py::arg("problem") = py::none(), py::kw_only(),
      py::arg("start") = std::vector<Vec3>{}, py::arg("checkpoint") = py::none(),
      py::arg("existing_targets") = std::vector<Target>{}, py::arg("progress") = py::none(),
      ("Plans a survey like the program: by default, the connected stations that pay, or with `capture` "
       "the fewest that capture so much. The same site,\nproblem and settings give the same result except for "
       "seconds.\n\nproblem: its name, or a SurveyProblem in place of the settings of a question. "
       "start: heads (x, y, z) of an initial\nnetwork; empty: chosen. checkpoint: a file to write "
       "regularly and when the search ends; `resume=True` goes on\nfrom it. existing_targets: Targets "
       "and control points that are there (`read_targets_csv`). progress: called with a "
       "PlanProgress between evaluations. If it returns False, the search ends, and its\nresults are "
       "confirmed and returned. Ctrl-C, or an exception of progress or of an objective, ends the call "
       "with\nthat exception; a checkpoint is written before.\nRaises Error: invalid_argument, "
       "malformed_file (a damaged checkpoint)." +
       settings_doc("Site.plan", question_settings(), plan_settings()))
          .c_str());
}

}  // namespace vantage::python
