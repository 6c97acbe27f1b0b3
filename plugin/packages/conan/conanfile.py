# conan create <this folder> --build=missing
import os
import re

from conan import ConanFile
from conan.tools.cmake import CMake, CMakeDeps, CMakeToolchain, cmake_layout
from conan.tools.files import copy, load

REPOSITORY = ("..", "..", "..")


class Tetskin(ConanFile):
    name = "tetskin"
    license = "Zlib"
    description = "High-resolution render meshes carried by coarse Bullet soft bodies"
    topics = ("bullet", "soft-body", "physics", "skinning")
    package_type = "library"
    settings = "os", "arch", "compiler", "build_type"
    options = {"shared": [True, False], "fPIC": [True, False], "io": [True, False]}
    default_options = {"shared": False, "fPIC": True, "io": True}
    implements = ["auto_shared_fpic"]

    def set_version(self):
        header = load(self, os.path.join(self.recipe_folder, *REPOSITORY, "plugin", "tetskin", "tetskin.h"))
        self.version = ".".join(re.findall(r"#define TETSKIN_VERSION_[A-Z]+ (\d+)", header))

    def export_sources(self):
        repository = os.path.join(self.recipe_folder, *REPOSITORY)
        for pattern in ("CMakeLists.txt", "LICENSE", "plugin/*"):
            copy(self, pattern, repository, self.export_sources_folder)

    def requirements(self):
        self.requires("bullet3/[>=3.24 <4]", transitive_headers=True)
        self.requires("eigen/[>=3.4 <4]", transitive_headers=True)
        if self.options.io:
            self.requires("assimp/[>=5.2 <6]")
            self.requires("tinygltf/[>=2.8 <3]")

    def layout(self):
        cmake_layout(self)

    def generate(self):
        double = bool(self.dependencies["bullet3"].options.get_safe("double_precision"))
        toolchain = CMakeToolchain(self)
        toolchain.cache_variables["TETSKIN_DEMOS"] = False
        toolchain.cache_variables["TETSKIN_TESTS"] = False
        toolchain.cache_variables["TETSKIN_IO"] = bool(self.options.io)
        toolchain.cache_variables["TETSKIN_DOUBLE_PRECISION"] = double
        toolchain.generate()
        CMakeDeps(self).generate()

    def build(self):
        cmake = CMake(self)
        cmake.configure()
        cmake.build()

    def package(self):
        copy(self, "LICENSE", self.source_folder, os.path.join(self.package_folder, "licenses"))
        CMake(self).install()

    def package_info(self):
        # The package has its own CMake package, which finds Bullet and Eigen as provided by Conan.
        self.cpp_info.set_property("cmake_find_mode", "none")
        self.cpp_info.builddirs.append(os.path.join("lib", "cmake", "tetskin"))
