"""Build backend [PEP 517] by which pip builds the package as a wheel, with CMake and no other tool.

`pip install . --config-settings build-dir=build/release` uses a folder that CMake has configured; otherwise it creates build/wheel.
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
import zipfile

SOURCE = pathlib.Path(__file__).resolve().parent.parent


def run(*command):
    subprocess.run([str(word) for word in command], check=True, cwd=SOURCE)


def cmake_build(settings):
    """The folder with the built module."""
    chosen = (settings or {}).get("build-dir")
    folder = pathlib.Path(chosen) if chosen else SOURCE / "build" / "wheel"
    if not chosen:
        run("cmake", "-S", ".", "-B", folder, "-G", "Ninja", "-D", "CMAKE_BUILD_TYPE=Release", "-D", f"Python_EXECUTABLE={sys.executable}")
    run("cmake", "--build", folder, "--target", "abbe_python", "abbe_pictures")
    return folder


def metadata():
    """Name and METADATA of the wheel, from pyproject.toml and CITATION.cff."""
    project = (SOURCE / "pyproject.toml").read_text()
    field = {key: re.search(rf'^{key} = "(.*)"$', project, re.M).group(1) for key in ("name", "description", "requires-python")}
    version = re.search(r"^version: (.*)$", (SOURCE / "CITATION.cff").read_text(), re.M).group(1)
    lines = ["Metadata-Version: 2.1", f"Name: {field['name']}", f"Version: {version}", f"Summary: {field['description']}", "License: Apache-2.0",
             f"Requires-Python: {field['requires-python']}", "Requires-Dist: numpy"]
    return f"{field['name']}-{version}", "\n".join(lines) + "\n"


def tag():
    """The compatibility tag for this Python and platform."""
    python = f"cp{sys.version_info.major}{sys.version_info.minor}"
    return f"{python}-{python}-{sysconfig.get_platform().replace('-', '_').replace('.', '_')}"


def write_wheel(path, name, files):
    """Writes an archive of named files with their hashes as RECORD [PEP 427]."""
    record = []
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as archive:
        for file, content in files:
            archive.writestr(file, content)
            digest = base64.urlsafe_b64encode(hashlib.sha256(content).digest()).rstrip(b"=").decode()
            record.append(f'"{file}",sha256={digest},{len(content)}\n')
        archive.writestr(f"{name}.dist-info/RECORD", "".join(record) + f"{name}.dist-info/RECORD,,\n")


def build_wheel(wheel_directory, config_settings=None, metadata_directory=None):
    name, text = metadata()
    folder = cmake_build(config_settings)
    with tempfile.TemporaryDirectory() as staging:
        run("cmake", "--install", folder, "--component", "wheel", "--prefix", staging, "--strip")
        root = pathlib.Path(staging)
        files = [(str(file.relative_to(root)), file.read_bytes()) for file in sorted(root.rglob("*")) if file.is_file()]
    files += [(f"{name}.dist-info/METADATA", text.encode()),
              (f"{name}.dist-info/WHEEL", f"Wheel-Version: 1.0\nGenerator: abbe\nRoot-Is-Purelib: false\nTag: {tag()}\n".encode())]
    wheel = f"{name}-{tag()}.whl"
    write_wheel(os.path.join(wheel_directory, wheel), name, files)
    return wheel


def build_sdist(sdist_directory, config_settings=None):
    raise NotImplementedError("the sources are distributed as the repository")
