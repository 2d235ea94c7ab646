"""Installs a wheel for Windows into a Python for Windows and compares what it does under Wine with this machine.

    run.py WHEEL FOLDER COMPILER EMULATOR...

The Python comes from the package index, as `requirements.txt` says; the compiler is mingw-w64. Wine before version 9
lacks functions that NumPy calls; `ucrt.c` has them, in a library of another name that the copy of NumPy here loads.
"""

import os
import re
import subprocess
import sys
from importlib.metadata import version
from pathlib import Path

HERE = Path(__file__).parent
CASE = HERE.parents[1] / "examples" / "cases" / "block_on_incline.toml"
MATH = "api-ms-win-crt-math-l1-1-0.dll"
OURS = "enm-ms-win-crt-math-l1-1-0.dll"


def main(wheel: str, folder: Path, compiler: str, emulator: list[str]):
    python, site, own = (folder / name for name in ("python", "site", "own"))
    fit = ["--no-deps", "--platform", "win_amd64", "--python-version", "3.12", "--only-binary=:all:"]
    numpy = f"numpy=={version('numpy')}"
    try:
        pip(python, "--no-deps", "--require-hashes", "-r", str(HERE / "requirements.txt"))
        pip(site, *fit, numpy)
    except subprocess.CalledProcessError as error:
        print(f"SKIPPED the package in a Python for Windows: {error}")
        return
    pip(own, *fit, wheel)
    (python / "python312._pth").write_text("python312.zip\n.\n../site\n../own\n", encoding="utf-8")
    give_numpy_its_functions(site, python, compiler)
    (program,) = own.rglob("enmm.exe")
    there = same([*emulator, str(python / "python.exe")], ENMM_LIBRARY="", ENMM_PROGRAM=f"Z:{program}")
    here = same([sys.executable])
    assert there == here, f"there it is\n{there}here it is\n{here}"
    print(f"the package in a Python for Windows has the same bits in {len(here.splitlines()) - 1} results")


def pip(target: Path, *words: str):
    install = ["install", "--quiet", "--disable-pip-version-check", "--target", str(target)]
    subprocess.run([sys.executable, "-m", "pip", *install, *words], check=True)


def same(python: list[str], **variables: str) -> str:
    """What `same.py` prints. All its streams are pipes or nothing: under Wine Python takes no files."""
    words = [*python, str(HERE / "same.py"), str(CASE)]
    pipes = {"stdin": subprocess.DEVNULL, "stdout": subprocess.PIPE, "stderr": subprocess.PIPE, "text": True}
    done = subprocess.run(words, env=os.environ | variables, check=False, **pipes)
    if done.returncode:
        sys.exit(f"{' '.join(words)} ended with {done.returncode}: {done.stderr}")
    return done.stdout


def give_numpy_its_functions(site: Path, python: Path, compiler: str):
    """Has the libraries of NumPy load mathematical functions from a library of ours, which forwards what Wine has."""
    wanted = set()
    for library in site.rglob("*.pyd"):
        content = library.read_bytes()
        if MATH.encode() in content:
            listed = subprocess.run([compiler.replace("gcc", "objdump"), "-p", library], capture_output=True, check=True)
            part = listed.stdout.decode(errors="replace").split(f"DLL Name: {MATH}")[1].split("DLL Name:")[0]
            wanted |= set(re.findall(r"^\t[0-9a-f]+\s+\d+\s+(\w+)", part, re.MULTILINE))
            library.write_bytes(content.replace(MATH.encode(), OURS.encode()))
    own = set(re.findall(r"(c(?:real|imag)[fl]?)\(", (HERE / "ucrt.c").read_text(encoding="utf-8")))
    lines = [name if name in own else f"{name} = ucrtbase.{name}" for name in sorted(wanted | own)]
    table = python / "ucrt.def"
    table.write_text(f"LIBRARY {OURS}\nEXPORTS\n" + "\n".join(lines) + "\n", encoding="utf-8")
    words = [compiler, "-shared", "-O1", "-fno-builtin", str(HERE / "ucrt.c"), str(table), "-o", str(python / OURS)]
    subprocess.run(words, check=True)


if __name__ == "__main__":
    main(sys.argv[1], Path(sys.argv[2]), sys.argv[3], sys.argv[4:])
