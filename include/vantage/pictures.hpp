// SPDX-License-Identifier: Apache-2.0
/// Pictures of results: fronts, plan views, maps of what is missed and of registration errors.
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "vantage/evaluation.hpp"
#include "vantage/missed.hpp"
#include "vantage/planner.hpp"
#include "vantage/registration.hpp"
#include "vantage/site.hpp"

namespace vantage {

/// Draws the front, as .png or .svg by extension, as all pictures. Throws Error: io, invalid_argument (another
/// extension).
void draw_front(const std::filesystem::path& file, const PlanResult& result);
/// Draws the hypervolume of the search against its evaluations.
void draw_hypervolume(const std::filesystem::path& file, const PlanResult& result);
/// Draws the front at five moments of the search, with the search's own values (figure 9 of the method).
void draw_history_fronts(const std::filesystem::path& file, const PlanResult& result);
/// Draws the site in plan view: shaded relief, search area, stations with the height of their ground, and links. A link
/// is as wide as its overlap is large, on one scale in all pictures; those below `link_overlap` are not drawn. A site
/// with stations under a roof, or with several floors, is cut 1.2 m above the floor, and cut parts are filled. Several
/// floors stand side by side, and each again on its own page, PLAN-level-1.png and so on, from the lowest. `names`: of
/// the stations, if they have names; otherwise "S1", "S2", …, and "K1", … for existing ones. `errors`: predicted ones
/// of the stations, if known: a standard ellipse (one sigma, of the head in x and y) around each. `targets`: their
/// marks. Returns the files that it wrote.
std::vector<std::filesystem::path> draw_plan_view(const std::filesystem::path& file, Site& site,
                                                  std::span<const PlacedStation> stations, const StationLinks& links,
                                                  const std::string& title, std::span<const std::string> names = {},
                                                  std::span<const StationError> errors = {},
                                                  std::span<const Target> targets = {});

/// Draws every voxel of `missed` in plan view, in the colour of its reason: a map for each floor, cut as by
/// `draw_plan_view`. If voxels lie above each other, one missed for want of a station shows first, then one seen badly,
/// then a captured one, then a hidden one, since most of these are undersides.
void draw_missed(const std::filesystem::path& file, Site& site, const MissedVoxels& missed,
                 std::span<const PlacedStation> stations, const std::string& title);
/// Draws the predicted registration error on the surface in plan view (`write_registration_ply()`): a map for each
/// floor as by `draw_missed`, with unseen parts in grey.
void draw_registration(const std::filesystem::path& file, Site& site, const VoxelField& field,
                       const RegistrationError& error, std::span<const PlacedStation> stations,
                       const std::string& title);

}  // namespace vantage
