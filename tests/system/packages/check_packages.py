#!/usr/bin/env python3
"""check_packages.py SOURCE BUILD HAS_CUDA: makes Debian packages of a build and checks what they hold.

The build stands for one with CUDA, too, where it has CUDA.
"""
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

NAMES = {"hypotrack", "hypotrack-doc", "hypotrack-lab", "libhypotrack-dev", "libhypotrack0",
         "python3-hypotrack"}
# In the place of one another.
ALTERNATIVES = {"libhypotrack0", "hypotrack-cuda"}


def output(*command, **options):
    return subprocess.run(list(map(str, command)), check=True, text=True, stdout=subprocess.PIPE,
                          **options).stdout


def files_below(folder):
    """Returns the paths of files and links below a folder, as strings relative to it."""
    return {str(path.relative_to(folder)) for path in folder.rglob("*")
            if path.is_symlink() or not path.is_dir()}


class Package:
    """A package, unpacked into a folder of its own."""

    def __init__(self, deb, folder):
        self.deb = deb
        self.name = output("dpkg-deb", "-f", deb, "Package").strip()
        self.root = folder / self.name
        self.root.mkdir(parents=True)
        subprocess.run(["dpkg-deb", "-x", deb, self.root], check=True)
        self.files = files_below(self.root)
        depends = output("dpkg-deb", "-f", deb, "Depends")
        self.depends = set(re.findall(r"(?:^|[,|]) *([a-z0-9.+-]+)", depends))

    def programs(self):
        """Yields what the dynamic linker reads, and the names of the libraries that it needs."""
        for name in sorted(self.files):
            file = self.root / name
            if file.is_symlink() or file.open("rb").read(4) != b"\x7fELF":
                continue
            dynamic = output("readelf", "-d", file, stderr=subprocess.DEVNULL)
            yield name, re.findall(r"\(NEEDED\).*\[(.*)\]", dynamic)


def check_each_file_is_in_one(packages):
    owners = {}
    for package in packages:
        for file in package.files:
            owners.setdefault(file, set()).add(package.name)
    twice = {file: who for file, who in owners.items() if len(who) > 1 and who != ALTERNATIVES}
    assert not twice, f"files of several packages: {twice}"


def check_nothing_is_left_out(packages, build, folder):
    """Compares the packages with an installation."""
    subprocess.run(["cmake", "--install", build, "--prefix", "/usr"], check=True,
                   env={**os.environ, "DESTDIR": str(folder)}, stdout=subprocess.DEVNULL)
    packed = {file.removesuffix(".gz") for package in packages for file in package.files}
    left_out = {file for file in files_below(folder) if file.removesuffix(".gz") not in packed}
    assert not left_out, f"installed, but in no package: {sorted(left_out)}"


def owner_on_this_machine(library):
    """Returns the Debian package of a shared library."""
    path = re.search(rf"^\s*{re.escape(library)} .*=> (.*)$", output("/sbin/ldconfig", "-p"), re.M)
    assert path, f"{library} is not on this machine"
    for file in (path[1], os.path.realpath(path[1]), path[1].removeprefix("/usr")):
        found = subprocess.run(["dpkg", "-S", file], text=True, capture_output=True)
        if found.returncode == 0:
            return found.stdout.split(":")[0]
    raise AssertionError(f"{path[1]} belongs to no package")


def check_libraries_are_in_packages_named(packages):
    by_name = {package.name: package for package in packages}
    own = {pathlib.Path(file).name: package.name for package in packages
           for file in package.files if ".so" in file and package.name != "hypotrack-cuda"}
    for package in packages:
        named = package.depends | {package.name}
        if package.name == "hypotrack-cuda":
            named.add("libhypotrack0")
        for file, libraries in package.programs():
            for library in libraries:
                if library in named:  # liblapack.so.3 is a package that several provide
                    continue
                owner = own.get(library) or owner_on_this_machine(library)
                assert owner in named, \
                    f"{package.name}: {file} needs {library}, but {owner} is not in Depends"
    assert "libhypotrack0" in by_name["hypotrack"].depends


def check_the_program_runs(packages, folder):
    """Runs the program without the lab, then with it."""
    def unpack(*names):
        for package in packages:
            if package.name in names:
                shutil.copytree(package.root, folder, symlinks=True, dirs_exist_ok=True)

    program = folder / "usr/bin/hypotrack"
    environment = {name: value for name, value in os.environ.items()
                   if not name.startswith("HYPOTRACK_")}
    unpack("hypotrack", "libhypotrack0")
    refused = subprocess.run([program, "compare", "study.yaml"], text=True, capture_output=True,
                             env=environment)
    assert refused.returncode == 1, refused
    assert refused.stderr.rstrip().endswith("; install the package hypotrack-lab"), refused.stderr
    plugins = output(program, "plugins", "list", env=environment)
    assert "pso" in plugins and "stereo_color" in plugins, plugins
    unpack("hypotrack-lab", "python3-hypotrack")
    assert "--variant" in output(program, "compare", "--help", env=environment)
    modules = folder / "usr/lib/python3/dist-packages"
    output(sys.executable, "-c", "import hypotrack", env={**environment, "PYTHONPATH": str(modules)})


def check_lintian_finds_no_error(packages):
    if not shutil.which("lintian"):
        print("lintian is not installed")
        return
    found = subprocess.run(["lintian", "--allow-root", "--fail-on", "error",
                            *(package.deb for package in packages)], text=True, capture_output=True)
    assert found.returncode == 0, found.stdout + found.stderr


def main(source, build, has_cuda):
    with tempfile.TemporaryDirectory() as scratch:
        scratch = pathlib.Path(scratch)
        cuda = [build] if has_cuda == "ON" else []
        # Compression takes most of the time.
        made = subprocess.run([f"{source}/debian/make.sh", build, scratch / "debs", *cuda],
                              text=True, stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                              env={**os.environ, "DEB_COMPRESSION": "-z0"})
        assert made.returncode == 0, made.stdout
        packages = [Package(deb, scratch / "unpacked") for deb in (scratch / "debs").rglob("*.deb")]
        names = {package.name for package in packages}
        assert names == NAMES | ({"hypotrack-cuda"} if cuda else set()), names
        check_each_file_is_in_one(packages)
        check_nothing_is_left_out(packages, build, scratch / "installed")
        check_libraries_are_in_packages_named(packages)
        check_the_program_runs(packages, scratch / "together")
        check_lintian_finds_no_error(packages)


if __name__ == "__main__":
    main(*sys.argv[1:])
