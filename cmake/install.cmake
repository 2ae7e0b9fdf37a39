# Installs the library, its headers and data, the program, and what find_package(vantage) and pkg-config need.
include(CMakePackageConfigHelpers)
include(GNUInstallDirs)

set(VANTAGE_PACKAGE_DIR ${CMAKE_INSTALL_LIBDIR}/cmake/vantage)
# install_part(<target> <export>): a library, its headers, and an export file of its own, so that a program asks for the parts it links.
function(install_part target export)
  install(
    TARGETS ${target}
    EXPORT ${export}
    LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT development
    ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT development
    RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR} COMPONENT development
    FILE_SET HEADERS DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} COMPONENT development)
  install(EXPORT ${export} NAMESPACE vantage:: DESTINATION ${VANTAGE_PACKAGE_DIR} COMPONENT development)
endfunction()
foreach(part IN LISTS VANTAGE_PARTS)
  install_part(vantage_${part} vantage-${part})
endforeach()
install_part(vantage_built_in_scenes vantage-built_in_scenes)
if(VANTAGE_WHOLE)
  install_part(vantage vantage-vantage)
endif()
if(TARGET vantage-cli)
  install(TARGETS vantage-cli RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR} COMPONENT program)
endif()
# Importers are programs that vantage alone starts.
if(TARGET vantage-cli)
  set(VANTAGE_IMPORTERS_DIR ${CMAKE_INSTALL_LIBEXECDIR}/vantage)
  get_property(importers GLOBAL PROPERTY VANTAGE_IMPORTERS)
  foreach(importer IN LISTS importers)
    install(TARGETS ${importer} RUNTIME DESTINATION ${VANTAGE_IMPORTERS_DIR} COMPONENT program)
  endforeach()
  vantage_install_ifc(${VANTAGE_IMPORTERS_DIR} COMPONENT program)
  vantage_install_laz(${VANTAGE_IMPORTERS_DIR} COMPONENT program)
endif()
# The presets are part of the library; the file is an example of their form.
install(FILES ${PROJECT_SOURCE_DIR}/data/scanners.json DESTINATION ${CMAKE_INSTALL_DATADIR}/vantage COMPONENT program)

set(VANTAGE_EMBREE_MAJOR ${embree_VERSION_MAJOR})
configure_package_config_file(${PROJECT_SOURCE_DIR}/cmake/vantageConfig.cmake.in ${PROJECT_BINARY_DIR}/vantageConfig.cmake
                              INSTALL_DESTINATION ${VANTAGE_PACKAGE_DIR})
write_basic_package_version_file(${PROJECT_BINARY_DIR}/vantageConfigVersion.cmake COMPATIBILITY SameMajorVersion)
install(FILES ${PROJECT_BINARY_DIR}/vantageConfig.cmake ${PROJECT_BINARY_DIR}/vantageConfigVersion.cmake
        DESTINATION ${VANTAGE_PACKAGE_DIR} COMPONENT development)

# Paths in the .pc hang on its own place, so that an installed tree can be moved.
file(RELATIVE_PATH VANTAGE_PC_PREFIX ${CMAKE_INSTALL_FULL_LIBDIR}/pkgconfig ${CMAKE_INSTALL_PREFIX})
set(pc_scan_needs "libpng libseccomp libturbojpeg tbb")
set(pc_scan_libraries "-lembree${VANTAGE_EMBREE_MAJOR} -ldl -pthread")
set(pc_plan_needs "vantage-scan cbc clp")
# It names PROJ's shared library alone: `pkg-config --static` would list whatever curl below PROJ was built with.
set(pc_files_needs "vantage-plan cairo minizip")
set(pc_files_libraries "-lproj")
set(pc_report_needs "vantage-files")
# What the report packs its page with; Debian's meshoptimizer has no .pc of its own.
if(VANTAGE_HAVE_REPORT)
  string(APPEND pc_report_needs " zlib")
  set(pc_report_libraries "-lmeshoptimizer")
endif()
foreach(part IN LISTS VANTAGE_PARTS)
  set(VANTAGE_PART ${part})
  set(VANTAGE_PART_NEEDS ${pc_${part}_needs})
  set(VANTAGE_PART_LIBRARIES ${pc_${part}_libraries})
  configure_file(${PROJECT_SOURCE_DIR}/cmake/vantage-part.pc.in ${PROJECT_BINARY_DIR}/vantage-${part}.pc @ONLY)
  install(FILES ${PROJECT_BINARY_DIR}/vantage-${part}.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig COMPONENT development)
endforeach()
if(VANTAGE_WHOLE)
  configure_file(${PROJECT_SOURCE_DIR}/cmake/vantage.pc.in ${PROJECT_BINARY_DIR}/vantage.pc @ONLY)
  install(FILES ${PROJECT_BINARY_DIR}/vantage.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig COMPONENT development)
endif()
