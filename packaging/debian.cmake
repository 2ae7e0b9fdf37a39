# Debian packages by CPack: vantage, libvantage-dev and python3-vantage. packaging/deb.sh builds them.
find_program(dpkg NAMES dpkg)
if(NOT dpkg)
  return()
endif()

# Debian's own form of a changelog; what changed stands in docs/changelog.md.
find_package(Git QUIET)
set(day "")
if(GIT_FOUND)
  execute_process(COMMAND ${GIT_EXECUTABLE} log -1 --format=%cD WORKING_DIRECTORY ${PROJECT_SOURCE_DIR} OUTPUT_VARIABLE day OUTPUT_STRIP_TRAILING_WHITESPACE
                  ERROR_QUIET)
endif()
if(day STREQUAL "")
  string(TIMESTAMP day "%a, %d %b %Y %H:%M:%S +0000" UTC)
endif()
if(NOT CPACK_PACKAGE_CONTACT)
  set(CPACK_PACKAGE_CONTACT "vantage <root@localhost>")
endif()
file(WRITE ${CMAKE_CURRENT_BINARY_DIR}/changelog
     "vantage (${PROJECT_VERSION}) unstable; urgency=medium\n\n  * Version ${PROJECT_VERSION}.\n\n -- ${CPACK_PACKAGE_CONTACT}  ${day}\n")
execute_process(COMMAND gzip -9nf ${CMAKE_CURRENT_BINARY_DIR}/changelog)
set(packages program:vantage development:libvantage-dev)
if(VANTAGE_PYTHON)
  list(APPEND packages python:python3-vantage)
endif()
set(CPACK_COMPONENTS_ALL "")
foreach(component_package IN LISTS packages)
  string(REPLACE ":" ";" pair ${component_package})
  list(GET pair 0 component)
  list(GET pair 1 package)
  list(APPEND CPACK_COMPONENTS_ALL ${component})
  string(TOUPPER ${component} name)
  set(CPACK_DEBIAN_${name}_PACKAGE_NAME ${package})
  install(FILES ${CMAKE_CURRENT_BINARY_DIR}/changelog.gz DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/${package} COMPONENT ${component})
endforeach()

set(CPACK_GENERATOR DEB)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_COMPONENTS_GROUPING IGNORE)
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_INSTALL_DEFAULT_DIRECTORY_PERMISSIONS OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ GROUP_EXECUTE WORLD_READ WORLD_EXECUTE)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_COMPRESSION_TYPE xz)
set(CPACK_DEBIAN_PROGRAM_PACKAGE_SECTION science)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_SECTION libdevel)
set(CPACK_DEBIAN_PYTHON_PACKAGE_SECTION python)
# The first line is the summary.
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "")
set(CPACK_COMPONENT_PROGRAM_DESCRIPTION
    "planner of terrestrial laser scanning surveys
vantage reads a model of a site, traces the rays that scanners would cast,
and searches for the stations that capture and link enough of it. It writes
the stations, a report for the crew, and simulated point clouds.

Rays are traced on a graphics card through Vulkan, or on processors.")
set(CPACK_COMPONENT_DEVELOPMENT_DESCRIPTION
    "planner of terrestrial laser scanning surveys - C++ library
The static library behind the program vantage, its headers, and the files by
which CMake and pkg-config find it.")
set(CPACK_COMPONENT_PYTHON_DESCRIPTION
    "planner of terrestrial laser scanning surveys - Python module
The Python module vantage: scenes, scanners, simulated scans, evaluations and
plans, with numpy's arrays.")
# Graphics cards, IFC, and the browser of the editor: there is the processor, glTF, and an address without them.
set(CPACK_DEBIAN_PROGRAM_PACKAGE_RECOMMENDS "libvulkan1, mesa-vulkan-drivers, nodejs, xdg-utils")
set(CPACK_DEBIAN_PYTHON_PACKAGE_RECOMMENDS "libvulkan1, mesa-vulkan-drivers, vantage (= ${PROJECT_VERSION}), python3-matplotlib")
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_DEPENDS
    "libembree-dev, libtbb-dev, libcairo2-dev, coinor-libcbc-dev, coinor-libclp-dev, libpng-dev, libseccomp-dev, libturbojpeg0-dev, libproj-dev, libminizip-dev, pkgconf")
if(VANTAGE_HAVE_REPORT)
  string(APPEND CPACK_DEBIAN_DEVELOPMENT_PACKAGE_DEPENDS ", libmeshoptimizer-dev, zlib1g-dev")
endif()
if(VANTAGE_PYTHON)
  find_package(Python 3.9 REQUIRED COMPONENTS Interpreter)
  math(EXPR next "${Python_VERSION_MINOR} + 1")
  set(CPACK_DEBIAN_PYTHON_PACKAGE_DEPENDS "python3 (>= 3.${Python_VERSION_MINOR}~), python3 (<< 3.${next}), python3-numpy")
endif()
include(CPack)
