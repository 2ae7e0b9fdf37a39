// SPDX-License-Identifier: Apache-2.0
// Stations that people move by hand, and their evaluation: the editor without its page.
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <mutex>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <string>
#include <thread>
#include <vector>

#include "edit/traced_stations.hpp"
#include "report/coverage_cells.hpp"
#include "vantage/attainable.hpp"
#include "vantage/candidates.hpp"
#include "vantage/evaluation.hpp"
#include "vantage/site.hpp"
#include "vantage/taken_scans.hpp"

namespace vantage {

struct EditStation {
  std::uint32_t id = 0;  // unique during the session
  PlacedStation placed;
  bool locked = false;    // neither moved nor removed, by hand or by search; so is what was taken (placed.existing)
  std::string name = {};  // the user's; empty: numbered
};

struct EditOptions {
  double link = default_link;         // least scan overlap of a link
  std::uint64_t voxels = 40'000;      // of the sample on which every change is evaluated
  std::uint64_t link_voxels = 4'000;  // of all surfaces, for scan overlaps until every ray is requested
  std::size_t cells = 20'000;         // of the coloured surface, at most
  double improve_seconds = 10;        // of one short search
  // Size of the sample on which the session looks at attainable coverage when it begins; 0: it does not.
  std::uint64_t attainable_voxels = CandidateConfig().sample_voxels;
  std::uint64_t registration_voxels = 20'000;  // of the sample by which the registration error is estimated
  RegistrationOptions registration = {};
  OnSiteOptions on_site = {};
  double taken_within_m = 1;                 // a scan this near to a planned station is that station
  double tolerance_m = default_tolerance_m;  // of points of scans from the model
};

// Borrows all arguments. Every call is safe from any thread. Long work runs on a thread of its own, and changes are
// refused meanwhile.
class EditSession {
 public:
  // Called with the present stations after every change; after a drag only once.
  using Keep = std::function<void(const std::vector<EditStation>&)>;
  // Writes the results of an exact evaluation with its field, and returns a sentence that says where; called on the
  // session's own thread.
  using Save = std::function<std::string(const Evaluation&, const Progress&)>;

  EditSession(Site& site, const std::vector<EditStation>& stations, const EditOptions& options, Keep keep, Save save);
  ~EditSession();  // stops running work
  EditSession(const EditSession&) = delete;
  EditSession& operator=(const EditSession&) = delete;

  // Returns `site_json` and the ground where stations may stand, which a page fetches once.
  nlohmann::ordered_json site() const;
  // version, network (as in a report), ids, locked, coverage and only (colours of cells), hidden (cells of which no
  // position captures anything; null: not known), busy{what, done}, undo, redo, exact, message.
  nlohmann::ordered_json state() const;
  std::uint64_t version() const { return version_; }

  // {"do": …}: "move" {"id", "to": [x, y, z], "begin", "end"} to the ground above or below a point of the survey frame
  // (`begin` false continues a drag, `end` true ends it), "add" {"to"}, "remove" {"id"}, "rename" {"id", "name"},
  // "lock" {"id", "locked"}, "undo", "redo", "exact", "improve", "save", "stop". A station that is put where none may
  // stand goes to the nearest place that may hold it, and the message says so. Throws Error invalid_argument, and
  // changes nothing, if the request is impossible.
  void change(const nlohmann::json& request);

  // Makes scans that were taken existing stations: the planned ones that they are of, which move to where they were
  // really taken, or new ones. Their real points count in place of simulated ones, except with every ray. There is no
  // undo. `scans`: fitted to the model. False, and nothing is done, while long work runs.
  bool take(std::span<const TakenScan> scans);
  // Shows a sentence.
  void tell(const std::string& message);

 private:
  using Stations = std::vector<EditStation>;
  // Work that a change of the stations leaves to do.
  struct Changed {
    enum Needs { nothing, names, figures } needs = figures;
    bool quick = false;  // leaves out what takes longer than a drag allows
    bool keep = true;    // false: during a drag
  };
  // Commands of `change()`. Those that start long work change no station, and return nothing.
  using Command = std::optional<Changed> (EditSession::*)(const nlohmann::json& request);
  std::optional<Changed> move_station(const nlohmann::json& request);
  std::optional<Changed> add_station(const nlohmann::json& request);
  std::optional<Changed> remove_station(const nlohmann::json& request);
  std::optional<Changed> lock_station(const nlohmann::json& request);
  std::optional<Changed> rename_station(const nlohmann::json& request);
  std::optional<Changed> undo(const nlohmann::json& request);
  std::optional<Changed> redo(const nlohmann::json& request);
  std::optional<Changed> start_exact(const nlohmann::json& request);
  std::optional<Changed> start_improving(const nlohmann::json& request);
  std::optional<Changed> start_saving(const nlohmann::json& request);
  EditStation& with_id(const nlohmann::json& request);
  // The station on the ground at `to`, or where it may stand near there; empty if there is no ground. `exactly`: only
  // the former. Adds a sentence to the message if it is not where it was put.
  std::optional<PlacedStation> put(const nlohmann::json& to, const std::string& name, bool exactly);
  std::vector<std::string> names() const;
  Network network() const;
  std::vector<PlacedStation> placed() const;
  std::string take(const TakenScan& scan);
  void remember();
  void step(std::vector<Stations>& from, std::vector<Stations>& to);
  // `quick`: leaves out what takes longer than a drag allows.
  void measure(bool quick = false);
  std::optional<Estimate> captured() const;
  std::optional<Estimate> registered(const Network& network) const;
  bool look(const Progress& progress);
  bool mend(const Progress& progress);
  void start(const std::string& what, std::function<void(const Progress&)> work);
  void trace_exactly(const Progress& progress, const std::function<std::string(const Evaluation&)>& then);
  void improve(const Progress& progress);

  Site& site_;
  Simulator &simulator_, &surroundings_;
  const EditOptions options_;
  const Keep keep_;
  const Save save_;
  CoverageCells cells_;
  std::optional<OnSite> on_site_;
  std::vector<PlacedStation> places_;  // where stations are tried that mend links; made when needed

  mutable std::mutex mutex_;  // guards all below
  Stations stations_;
  std::vector<Stations> undo_, redo_;
  std::uint32_t next_id_ = 1;
  std::atomic<std::uint64_t> version_ = 1;
  TracedStations surveyed_, around_;
  Evaluation evaluation_;
  CellColours colours_;
  std::optional<AttainableCounts> attainable_;  // empty: not looked at, or stopped
  std::vector<std::uint8_t> hidden_;            // by cell, as in the report
  std::string busy_, message_;
  double done_ = 0;
  std::stop_source stop_job_;
  std::jthread job_;
};

}  // namespace vantage
