// SPDX-License-Identifier: Apache-2.0
/// All of vantage.
#pragma once

#include "vantage/bound.hpp"
#include "vantage/candidates.hpp"
#include "vantage/error.hpp"
#include "vantage/export.hpp"
#include "vantage/image.hpp"
#include "vantage/measure.hpp"
#include "vantage/objective.hpp"
#include "vantage/optimiser.hpp"
#include "vantage/panorama.hpp"
#include "vantage/placement.hpp"
#include "vantage/planner.hpp"
#include "vantage/progress.hpp"
#include "vantage/scanner.hpp"
#include "vantage/scene.hpp"
#include "vantage/simulator.hpp"
#include "vantage/station_files.hpp"
#include "vantage/summary.hpp"
#include "vantage/trace.hpp"
#include "vantage/types.hpp"
#include "vantage/version.hpp"
