# SPDX-License-Identifier: Apache-2.0
"""conan create packaging/conan

A recipe of the tree it lies in: the library, and with -o vantage/*:tools=True the program."""
import os
import re

from conan import ConanFile
from conan.errors import ConanInvalidConfiguration
from conan.tools.build import check_min_cppstd
from conan.tools.cmake import CMake, CMakeDeps, CMakeToolchain, cmake_layout
from conan.tools.files import copy, load
from conan.tools.gnu import PkgConfigDeps


class Vantage(ConanFile):
    name = "vantage"
    description = "Plans terrestrial LiDAR surveys"
    license = "Apache-2.0"
    package_type = "static-library"
    settings = "os", "arch", "compiler", "build_type"
    options = {"tools": [True, False], "fPIC": [True, False]}
    default_options = {"tools": False, "fPIC": True}

    @property
    def tree(self):
        return os.path.join(self.recipe_folder, "..", "..")

    def set_version(self):
        self.version = re.search(r"project\(vantage VERSION ([0-9.]+)", load(self, os.path.join(self.tree, "CMakeLists.txt"))).group(1)

    def export_sources(self):
        for each in ("CMakeLists.txt", "LICENSE", "cmake/*", "data/*", "include/*", "packaging/*", "python/*", "shaders/*", "src/*"):
            copy(self, each, self.tree, self.export_sources_folder, excludes="*/node_modules/*")

    def layout(self):
        cmake_layout(self)

    def validate(self):
        check_min_cppstd(self, 20)
        if self.settings.os != "Linux":
            raise ConanInvalidConfiguration("vantage runs on Linux")

    def requirements(self):
        for each in ("boost/[>=1.74 <2]", "cairo/[>=1.16 <2]", "coin-cbc/[>=2.10 <3]", "coin-clp/[>=1.17 <2]", "eigen/[>=3.3 <4]",
                     "embree/[>=4 <5]", "glm/[>=0.9.9 <2]", "libjpeg-turbo/[>=2 <4]", "libpng/[>=1.6 <2]", "libseccomp/[>=2.5 <3]", "meshoptimizer/[>=0.18 <1]", "minizip/[>=1.2 <2]",
                     "nlohmann_json/[>=3.11 <4]", "onetbb/[>=2021 <2023]", "proj/[>=9 <10]", "spdlog/[>=1.10 <2]", "tinygltf/[>=2.5 <3]",
                     "volk/[>=1.3 <2]", "vulkan-headers/[>=1.3 <2]", "zlib/[>=1.2 <2]"):
            self.requires(each)
        if self.options.tools:
            for each in ("assimp/[>=5.2 <6]", "cli11/[>=2.3 <3]", "draco/[>=1.5 <2]", "expat/[>=2.5 <3]", "geos/[>=3.11 <4]"):
                self.requires(each)

    def build_requirements(self):
        self.tool_requires("glslang/[>=11]")
        self.tool_requires("pkgconf/[>=1.7 <3]")

    def generate(self):
        toolchain = CMakeToolchain(self)
        toolchain.cache_variables.update({
            "VANTAGE_BUILD_CLI": bool(self.options.tools), "VANTAGE_BUILD_TESTS": False, "VANTAGE_BUILD_EXAMPLES": False,
            "VANTAGE_INSTALL": True, "VANTAGE_WITH_REPORT": False})  # three.js is no package there
        toolchain.generate()
        CMakeDeps(self).generate()
        PkgConfigDeps(self).generate()  # cairo, cbc, libpng, libjpeg-turbo and PROJ are found by pkg-config

    def build(self):
        cmake = CMake(self)
        cmake.configure()
        cmake.build()

    def package(self):
        copy(self, "LICENSE", self.source_folder, os.path.join(self.package_folder, "licenses"))
        copy(self, "copyright", os.path.join(self.source_folder, "packaging"), os.path.join(self.package_folder, "licenses"))
        CMake(self).install()

    def package_info(self):
        self.cpp_info.set_property("cmake_find_mode", "none")  # the package's own vantageConfig.cmake
        self.cpp_info.builddirs = [os.path.join("lib", "cmake", "vantage")]
