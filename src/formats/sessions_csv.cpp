// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <string>

#include "core/atomic_file.hpp"
#include "core/text.hpp"
#include "vantage/export.hpp"
#include "words/csv_cell.hpp"

namespace vantage {

void write_sessions_csv(const std::filesystem::path& file, const Evaluation& evaluation) {
  const std::vector<std::string> names = station_names(evaluation.stations, evaluation.names);
  const std::size_t existing = existing_count(evaluation.stations);
  const std::vector<Session>& sessions = evaluation.visit->sessions;
  const bool batteries = !batteries_of(*evaluation.visit).empty();
  std::string text = "session,day,crew,order,station,name,walk_m,arrive_min,stay_min,leave_min,wait_min,begin,end";
  text += batteries ? ",batteries\n" : "\n";
  for (std::size_t s = 0; s < sessions.size(); ++s) {
    const Session& one = sessions[s];
    std::size_t taken = 0;
    for (const BatteryUse& use : one.batteries) taken += use.batteries;
    for (std::size_t k = 0; k < one.order.size(); ++k) {
      const std::size_t station = existing + one.order[k];
      const double arrive = one.arrive_min[k], stay = one.stay_min[k];
      const double wait = k < one.wait_min.size() ? one.wait_min[k] : 0;
      text += number(s + 1) + "," + number(one.day) + "," + number(one.crew) + "," + number(k + 1) + "," +
              number(station + 1) + "," + csv_cell(names[station]) + "," + fixed(one.legs_m[k], 2) + "," +
              fixed(arrive, 2) + "," + fixed(stay, 2) + "," + fixed(arrive + stay, 2) + "," + fixed(wait, 2) + "," +
              clock_text(one.start_min + arrive) + "," + clock_text(one.start_min + arrive + stay) +
              (batteries ? "," + number(taken) : std::string()) + "\n";
    }
  }
  write_atomically(file, text);
}

}  // namespace vantage
