// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "generate/model.hpp"
#include "generate/sites/site.hpp"

namespace vantage::sites {

// The site as a modeller hands it over: without roles and parameters.
built_in::Model model_of(const Site& site);

}  // namespace vantage::sites
