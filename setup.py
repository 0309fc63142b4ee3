"""Builds the Python package, with the program and its plugins in it, by CMake."""
import pathlib
import re
import subprocess
import sys

from setuptools import Extension, setup
from setuptools.command.build_ext import build_ext

SOURCE = pathlib.Path(__file__).parent.resolve()
BUILD = SOURCE / "build/pip"
COMPONENTS = ("library", "program", "python", "lab")  # of cmake/HypotrackInstall.cmake


class CMakeBuild(build_ext):
    def run(self):
        package = pathlib.Path(self.build_lib).resolve() / "hypotrack"
        # A wheel has no links: libraries have one name each.
        self.cmake("--preset", "release", "-B", BUILD, f"-DPython3_EXECUTABLE={sys.executable}",
                   "-DHYPOTRACK_PYTHON=ON", "-DHYPOTRACK_PYTHON_PACKAGE_DIR=.",
                   "-DCMAKE_INSTALL_LIBDIR=lib", "-DCMAKE_PLATFORM_NO_VERSIONED_SONAME=ON")
        self.cmake("--build", BUILD)
        for component in COMPONENTS:
            self.cmake("--install", BUILD, "--prefix", package, "--component", component)

    @staticmethod
    def cmake(*arguments):
        subprocess.run(["cmake", *map(str, arguments)], check=True, cwd=SOURCE)


version = re.search(r"project\(hypotrack VERSION ([0-9.]+)", (SOURCE / "CMakeLists.txt").read_text())
(SOURCE / "build").mkdir(exist_ok=True)
setup(version=version[1], packages=[], ext_modules=[Extension("hypotrack._core", [])],
      cmdclass={"build_ext": CMakeBuild}, options={"egg_info": {"egg_base": "build"}})
