// SPDX-License-Identifier: Apache-2.0
// Transforms from the survey frame to WGS 84 by PROJ (PROJ contributors: PROJ coordinate transformation software
// library, 2022).
#include <proj.h>

#include <cmath>
#include <memory>

#include "core/text.hpp"
#include "formats/station_files.hpp"
#include "vantage/error.hpp"

namespace vantage {
namespace {

struct Destroy {
  void operator()(PJ_CONTEXT* context) const { proj_context_destroy(context); }
  void operator()(PJ* operation) const { proj_destroy(operation); }
};
using Operation = std::unique_ptr<PJ, Destroy>;
using Context = std::unique_ptr<PJ_CONTEXT, Destroy>;

// A separate context, since PROJ's default is shared by all threads. No network: results must not depend on it.
Context make_context() {
  Context context(proj_context_create());
  proj_context_set_enable_network(context.get(), 0);
  proj_log_level(context.get(), PJ_LOG_NONE);
  return context;
}

}  // namespace

std::vector<GeodeticPoint> to_wgs84(const std::string& crs, std::span<const Vec3> points) {
  if (crs.empty())
    throw Error(Errc::invalid_argument, "longitude and latitude need the coordinate system of the site, as EPSG:25832");
  const Context context = make_context();
  const auto refuse = [&] {
    const int error = proj_context_errno(context.get());
    throw Error(Errc::invalid_argument, "PROJ finds no way from the site's coordinate system to WGS 84" +
                                            (error ? std::string(": ") + proj_errno_string(error) : "") +
                                            "; the system is " + crs.substr(0, 200));
  };
  const Operation found(proj_create_crs_to_crs(context.get(), crs.c_str(), "EPSG:4326", nullptr));
  if (!found) refuse();
  // Longitude first, whatever the definitions say.
  const Operation operation(proj_normalize_for_visualization(context.get(), found.get()));
  if (!operation) refuse();
  std::vector<GeodeticPoint> result;
  for (const Vec3& p : points) {
    // Height stays out of it: the frame's vertical datum is seldom known.
    const PJ_COORD to = proj_trans(operation.get(), PJ_FWD, proj_coord(p.x, p.y, 0, HUGE_VAL));
    if (!std::isfinite(to.lp.lam) || !std::isfinite(to.lp.phi) || std::abs(to.lp.phi) > 90)
      throw Error(Errc::invalid_argument, "the site's coordinate system has no place for " + fixed(p.x, 3) + "," +
                                              fixed(p.y, 3) + "; is it the site's?");
    result.push_back({to.lp.lam, to.lp.phi, p.z});
  }
  return result;
}

}  // namespace vantage
