#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""packaging/carry_libraries.py WHEEL FOLDER

Writes a copy of a wheel to FOLDER that carries the shared libraries it needs, as auditwheel does, which Debian 12 lacks. Those that every
Linux has stay out. The copy is tagged with this machine's C library, the oldest on which it runs.
"""
import os
import platform
import shutil
import subprocess
import sys
import sysconfig
import tempfile

# Of PEP 600's list what every machine with Python has: libraries of X, which are on it too, are missing on servers. And Vulkan's loader, which
# comes with the driver and is looked for at run time.
OF_THE_SYSTEM = ("ld-linux", "libc.so", "libdl.so", "libgcc_s.so", "libm.so", "libpthread.so", "libresolv.so", "librt.so", "libstdc++.so",
                 "libvulkan.so", "libz.so", "linux-vdso")


def output_of(*command):
    return subprocess.run(command, check=True, capture_output=True, text=True).stdout


def is_program_code(path):
    with open(path, "rb") as file:
        return file.read(4) == b"\x7fELF"


def libraries_of(path):
    """The libraries that a file needs, itself or by others: name to path. Those of the system are left out."""
    found = {}
    for line in output_of("ldd", path).splitlines():
        name, arrow, rest = line.strip().partition(" => ")
        if not arrow or name.startswith(OF_THE_SYSTEM):
            continue
        if rest.startswith("not found"):
            raise SystemExit(f"{path} needs {name}, which this machine lacks")
        found[name] = rest.split(" (")[0]
    return found


def package_of(path):
    """Debian's package that a library is of, for its licence."""
    for each in (path, path.removeprefix("/usr"), os.path.realpath(path)):
        found = subprocess.run(["dpkg-query", "--search", each], capture_output=True, text=True)
        if found.returncode == 0:
            return found.stdout.split(":")[0]
    raise SystemExit(f"{path} is of no package: its licence is not known")


def carry(tree):
    """Puts the libraries into vantage/lib, and licences beside the metadata. Returns their number."""
    package = os.path.join(tree, "vantage")
    lib = os.path.join(package, "lib")
    os.makedirs(lib)
    licences = os.path.join(next(entry.path for entry in os.scandir(tree) if entry.name.endswith(".dist-info")), "licences")
    os.makedirs(licences)
    shutil.copy(os.path.join(os.path.dirname(__file__), "copyright"), licences)
    needed = {}
    for folder, _, names in os.walk(package):
        for path in (os.path.join(folder, name) for name in names):
            if not is_program_code(path):
                continue
            needed.update(libraries_of(path))
            os.chmod(path, 0o755)  # `wheel unpack` of Debian 12 forgets it, and importers are run
            subprocess.run(["strip", "--strip-unneeded", path], check=True)
            up = os.path.relpath(lib, folder)
            subprocess.run(["patchelf", "--force-rpath", "--set-rpath", f"$ORIGIN/{up}", path], check=True)
    for name, path in needed.items():
        copy = os.path.join(lib, name)
        shutil.copy(os.path.realpath(path), copy)
        os.chmod(copy, 0o755)
        # Old-style RPATH, which holds for libraries of libraries, so that none of the machine's is taken instead.
        subprocess.run(["patchelf", "--force-rpath", "--set-rpath", "$ORIGIN", copy], check=True)
        owner = package_of(path)
        shutil.copy(f"/usr/share/doc/{owner}/copyright", os.path.join(licences, f"{owner}.txt"))
    # PROJ finds its tables of coordinate systems beside the folder of its library.
    shutil.copytree("/usr/share/proj", os.path.join(package, "share", "proj"))
    return len(needed)


def main():
    if len(sys.argv) != 3:
        raise SystemExit(__doc__)
    wheel, folder = sys.argv[1:]
    with tempfile.TemporaryDirectory() as temporary:
        subprocess.run([sys.executable, "-m", "wheel", "unpack", "--dest", temporary, wheel], check=True, stdout=subprocess.DEVNULL)
        tree = next(entry.path for entry in os.scandir(temporary))
        count = carry(tree)
        metadata = next(os.path.join(entry.path, "WHEEL") for entry in os.scandir(tree) if entry.name.endswith(".dist-info"))
        plain = sysconfig.get_platform().replace("-", "_")
        carried = f"manylinux_{platform.libc_ver()[1].replace('.', '_')}_{platform.machine()}"
        with open(metadata, encoding="utf-8") as file:
            text = file.read()
        if f"-{plain}\n" not in text:
            raise SystemExit(f"{wheel} is not for {plain}")
        with open(metadata, "w", encoding="utf-8") as file:
            file.write(text.replace(f"-{plain}\n", f"-{carried}\n"))
        subprocess.run([sys.executable, "-m", "wheel", "pack", "--dest-dir", folder, tree], check=True, stdout=subprocess.DEVNULL)
    print(f"{count} libraries carried; {carried}")


if __name__ == "__main__":
    main()
