# Every third-party library the build uses, in one place. setup.sh installs them.
find_package(Threads REQUIRED)
find_package(TBB REQUIRED)
find_package(Eigen3 3.3 REQUIRED NO_MODULE)
find_package(glm REQUIRED)
find_package(nlohmann_json REQUIRED)
find_package(embree 3 QUIET)
if(NOT embree_FOUND)
  find_package(embree 4 REQUIRED)
endif()
string(REGEX MATCH "^[0-9]+" VANTAGE_EMBREE_MAJOR "${embree_VERSION}") # which headers src/core/embree.hpp includes
find_package(spdlog REQUIRED)
find_package(Vulkan REQUIRED) # headers only: the loader is opened at run time, so that a machine without one still has Embree
find_path(VANTAGE_VOLK_INCLUDE_DIR volk.h PATH_SUFFIXES Volk volk REQUIRED)
find_path(VANTAGE_TINYGLTF_INCLUDE_DIR tiny_gltf.h REQUIRED)
find_path(VANTAGE_STB_INCLUDE_DIR stb_image.h PATH_SUFFIXES stb REQUIRED)
find_program(VANTAGE_GLSLANG NAMES glslangValidator glslang REQUIRED)
find_package(PkgConfig REQUIRED)
pkg_check_modules(cairo REQUIRED IMPORTED_TARGET cairo)
pkg_check_modules(cbc REQUIRED IMPORTED_TARGET cbc clp) # linear programs, and their integer solutions
# The report is a page with three.js in it. It is left out where one of these is missing.
find_file(VANTAGE_THREE_JS three.min.js PATHS /usr/share/javascript/three /usr/local/share/javascript/three)
find_file(VANTAGE_ORBIT_JS OrbitControls.js PATHS /usr/share/javascript/three/examples/js/controls
                                                  /usr/local/share/javascript/three/examples/js/controls)
find_package(meshoptimizer QUIET)
find_package(ZLIB QUIET)
set(VANTAGE_HAVE_REPORT FALSE)
if(VANTAGE_THREE_JS AND VANTAGE_ORBIT_JS AND meshoptimizer_FOUND AND ZLIB_FOUND)
  set(VANTAGE_HAVE_REPORT TRUE)
elseif(VANTAGE_BUILD_CLI)
  message(STATUS "No report: libjs-three, libmeshoptimizer-dev or zlib1g-dev is not installed")
endif()
# Longitude and latitude of stations; without it those formats are refused.
option(VANTAGE_WITH_PROJ "Use PROJ where it is installed" ON)
set(VANTAGE_HAVE_PROJ FALSE)
if(VANTAGE_WITH_PROJ)
  pkg_check_modules(proj QUIET IMPORTED_TARGET "proj>=7")
  set(VANTAGE_HAVE_PROJ ${proj_FOUND})
endif()
