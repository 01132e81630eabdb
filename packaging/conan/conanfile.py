# SPDX-License-Identifier: MIT
"""twinray's libraries as a Conan package: conan create packaging/conan --build=missing -s compiler.cppstd=20"""
import pathlib

from conan import ConanFile
from conan.errors import ConanInvalidConfiguration
from conan.tools.build import check_min_cppstd
from conan.tools.cmake import CMake, CMakeDeps, CMakeToolchain, cmake_layout
from conan.tools.files import copy


class Twinray(ConanFile):
    name = "twinray"
    version = "0.1.0"
    license = "MIT"
    description = "Vulkan ray tracing engine with two acceleration structures that check each other"
    topics = ("vulkan", "ray-tracing", "bvh", "graphics")
    package_type = "library"
    settings = "os", "compiler", "build_type", "arch"
    options = {"shared": [True, False]}
    default_options = {"shared": False}
    requires = (
        "eigen/3.4.0", "glm/1.0.1", "nlohmann_json/3.11.3", "openexr/3.2.4", "stb/cci.20240531", "tinygltf/2.9.0",
        "volk/1.3.296.0", "vulkan-headers/1.3.296.0", "vulkan-loader/1.3.290.0", "vulkan-memory-allocator/3.2.1",
        "zlib/1.3.1",
    )
    tool_requires = ("cmake/[>=3.25]", "glslang/1.3.296.0", "spirv-tools/1.3.296.0")

    def validate(self):
        check_min_cppstd(self, 20)
        if self.settings.compiler == "msvc":
            raise ConanInvalidConfiguration("twinray is not tested with MSVC; on Windows use MinGW-w64's GCC")

    def export_sources(self):
        root = pathlib.Path(self.recipe_folder).parent.parent
        for folder in ("cmake", "engine", "hwtlas", "include", "renderer", "samples", "shaders", "swtlas", "validation"):
            copy(self, f"{folder}/*", root, self.export_sources_folder)
        copy(self, "CMakeLists.txt", root, self.export_sources_folder)
        copy(self, "LICENSE", root, self.export_sources_folder)

    def layout(self):
        cmake_layout(self)

    def generate(self):
        CMakeDeps(self).generate()
        toolchain = CMakeToolchain(self)
        for part in ("CLI", "PATH_TRACER", "SAMPLES", "TESTS"):
            toolchain.cache_variables[f"TWINRAY_BUILD_{part}"] = False
        toolchain.generate()

    def build(self):
        cmake = CMake(self)
        cmake.configure()
        cmake.build()

    def package(self):
        CMake(self).install()

    def package_info(self):
        # The package has a CMake config of its own, which knows how its shaders are compiled.
        self.cpp_info.set_property("cmake_find_mode", "none")
        self.cpp_info.builddirs = ["lib/cmake/twinray"]
