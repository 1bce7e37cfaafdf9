"""Makes a wheel of what CMake builds and installs (PEP 517), with nothing but Python and CMake.

    pip install . --no-build-isolation
    pip install . --no-build-isolation --config-settings build-dir=build/release

The second takes a build folder that has been configured with UWVDB_BUILD_PYTHON, by the interpreter
that pip belongs to; the first builds in build/pip.
"""

import base64
import hashlib
import os
import pathlib
import re
import subprocess
import sys
import sysconfig
import tempfile
import tomllib
import zipfile

ROOT = pathlib.Path(__file__).resolve().parent.parent


def run(*command):
    subprocess.run([str(word) for word in command], cwd=ROOT, check=True)


def install(build, prefix):
    """Builds the package and installs it below `prefix`. Returns the folder that holds it."""
    if build is None:
        build = ROOT / "build/pip"
        run("cmake", "--preset", "release", "-B", build, "-DUWVDB_BUILD_PYTHON=ON",
            f"-DPython_EXECUTABLE={sys.executable}")
    run("cmake", "--build", build, "--target", "uwvdb_python", "--parallel", os.cpu_count())
    run("cmake", "--install", build, "--component", "python", "--prefix", prefix, "--strip")
    (package,) = pathlib.Path(prefix).glob("lib/python3/dist-packages")
    return package


def numpy_requirement():
    """The module that is built here cannot read NumPy 2's arrays before pybind11 2.12."""
    found = subprocess.run(["pkg-config", "--modversion", "pybind11"], capture_output=True, text=True)
    version = re.match(r"(\d+)\.(\d+)", found.stdout)
    return "numpy<2" if version and tuple(map(int, version.groups())) < (2, 12) else "numpy"


def metadata(project, requirements=None):
    """The version, and the text of METADATA of what needs `requirements`."""
    version = re.search(r"project\(uwvdb VERSION ([\d.]+)", (ROOT / "CMakeLists.txt").read_text())[1]
    lines = ["Metadata-Version: 2.1", f"Name: {project['name']}", f"Version: {version}",
             f"Summary: {project['description']}", f"Requires-Python: {project['requires-python']}",
             *(f"Requires-Dist: {one}" for one in requirements or [numpy_requirement()])]
    return version, "\n".join(lines) + "\n"


def project():
    return tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]


def tag():
    python = f"cp{sys.version_info.major}{sys.version_info.minor}"
    return f"{python}-{python}-{re.sub(r'[^a-zA-Z0-9]', '_', sysconfig.get_platform())}"


def info_files():
    """The folder of the wheel's metadata, and its files but for the record."""
    version, text = metadata(project())
    return f"uwvdb-{version}.dist-info", {
        "METADATA": text,
        "WHEEL": f"Wheel-Version: 1.0\nGenerator: uwvdb\nRoot-Is-Purelib: false\nTag: {tag()}\n"}


def prepare_metadata_for_build_wheel(metadata_directory, config_settings=None):
    info, files = info_files()
    folder = pathlib.Path(metadata_directory) / info
    folder.mkdir()
    for name, text in files.items():
        (folder / name).write_text(text)
    return info


def build_wheel(wheel_directory, config_settings=None, metadata_directory=None):
    info, files = info_files()
    name = f"{info.removesuffix('.dist-info')}-{tag()}.whl"
    record = []
    with tempfile.TemporaryDirectory() as prefix, \
            zipfile.ZipFile(pathlib.Path(wheel_directory) / name, "w",
                            zipfile.ZIP_DEFLATED) as wheel:
        def add(path, content):
            digest = base64.urlsafe_b64encode(hashlib.sha256(content).digest()).rstrip(b"=")
            record.append(f"{path},sha256={digest.decode()},{len(content)}\n")
            wheel.writestr(path, content)
        package = install((config_settings or {}).get("build-dir"), prefix)
        for file in sorted(package.rglob("*")):
            if file.is_file():
                add(file.relative_to(package).as_posix(), file.read_bytes())
        for file, text in files.items():
            add(f"{info}/{file}", text.encode())
        wheel.writestr(f"{info}/RECORD", "".join(record) + f"{info}/RECORD,,\n")
    return name


def build_sdist(sdist_directory, config_settings=None):
    raise RuntimeError("there is no source distribution: install from a checkout")
