// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

namespace vantage::importer {

// Unpacks a buffer view packed by meshoptimizer, as its extension says. Throws Refused.
std::string decode_meshopt(const nlohmann::json& extension, std::string_view packed);

// An attribute of a primitive packed by Draco.
struct DracoAttribute {
  int component_type = 0;  // number in glTF
  int components = 0;
  std::string values;
};
struct DracoMesh {
  std::size_t points = 0;
  std::vector<std::uint32_t> indices;
  std::map<std::string, DracoAttribute> attributes;
};

// `wanted`: Draco's number of each attribute by its name in glTF; `types`: the component types of their accessors.
// Throws Refused.
DracoMesh decode_draco(std::string_view packed, const std::map<std::string, std::uint32_t>& wanted,
                       const std::map<std::string, int>& types);

}  // namespace vantage::importer
