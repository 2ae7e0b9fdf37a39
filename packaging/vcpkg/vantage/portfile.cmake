# SPDX-License-Identifier: Apache-2.0
# An overlay port of the tree it lies in: vcpkg install vantage --overlay-ports=packaging/vcpkg
get_filename_component(SOURCE_PATH "${CMAKE_CURRENT_LIST_DIR}/../../.." ABSOLUTE)
vcpkg_check_features(OUT_FEATURE_OPTIONS features FEATURES tools VANTAGE_BUILD_CLI)
vcpkg_cmake_configure(
  SOURCE_PATH "${SOURCE_PATH}"
  OPTIONS
    ${features}
    -DVANTAGE_BUILD_TESTS=OFF
    -DVANTAGE_BUILD_EXAMPLES=OFF
    -DVANTAGE_INSTALL=ON
    -DVANTAGE_WITH_REPORT=OFF # three.js is no port
    -DVANTAGE_GLSLANG=${CURRENT_HOST_INSTALLED_DIR}/tools/glslang/glslang
  MAYBE_UNUSED_VARIABLES VANTAGE_GLSLANG)
vcpkg_cmake_install()
vcpkg_cmake_config_fixup(CONFIG_PATH lib/cmake/vantage)
vcpkg_fixup_pkgconfig()
if("tools" IN_LIST FEATURES)
  vcpkg_copy_tools(TOOL_NAMES vantage AUTO_CLEAN)
endif()
file(REMOVE_RECURSE "${CURRENT_PACKAGES_DIR}/debug/include" "${CURRENT_PACKAGES_DIR}/debug/share")
vcpkg_install_copyright(FILE_LIST "${SOURCE_PATH}/LICENSE" "${SOURCE_PATH}/packaging/copyright")
file(INSTALL "${CMAKE_CURRENT_LIST_DIR}/usage" DESTINATION "${CURRENT_PACKAGES_DIR}/share/${PORT}")
