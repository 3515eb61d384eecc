#!/usr/bin/env python3
"""Checks the direction between modules: what each may include, and who may print, own a main or know ROS.

Usage: scripts/check_modules.py [repository]
Prints one line per violation; the exit code is 1 when there is any.
"""

import re
import sys
from pathlib import Path

# Lowest first; each module may use only what its line names, besides itself and the headers at the root of
# include/tartan_calib. CMakeLists.txt may not give a module more than this either.
ALLOWED = {
    "geometry": "",
    "camera": "geometry",
    "target": "geometry",
    "observation": "geometry",
    "solver": "",
    "detection": "target observation",
    "calibration": "geometry camera target observation solver",
    "pipeline": "geometry camera target observation detection calibration",
    "guidance": "geometry camera target observation detection calibration pipeline",
    "simulation": "geometry camera target observation",
    "io": "geometry camera target observation calibration pipeline",
    "report": "geometry camera target observation calibration pipeline io",
    "ros": "geometry camera target observation detection calibration pipeline io report",
    "apps": "geometry camera target observation detection calibration pipeline guidance simulation io report ros",
}
ALLOWED = {module: set(used.split()) for module, used in ALLOWED.items()}

# Pattern, the modules that may match it, what is wrong elsewhere.
RESERVED = [
    (r'#include\s*<(ros|cv_bridge|(diagnostic|sensor|std)_msgs|std_srvs)/', {"ros", "apps"}, "includes ROS"),
    (r'#include\s*<rosbag/', {"ros"}, "opens bags"),
    (r'\bstd::(cout|cerr|clog)\b|\b(f|v|vf)?printf\s*\(|\b(f?puts|putchar)\s*\(', {"ros", "apps"}, "prints"),
    (r'\bROS_(DEBUG|INFO|WARN|ERROR|FATAL)', {"ros", "apps"}, "prints"),
    (r'\bint\s+main\s*\(', {"apps"}, "owns a main"),
    (r'\b(std::)?(_?exit|quick_exit|abort|terminate)\s*\(', {"apps"}, "ends the process"),
    (r'\bcv::(imshow|namedWindow|waitKey)\b', set(), "opens a window"),
]


def without_comments(text):
    """The code with comments and string literals blanked, line by line; the names in #include "..." stay."""
    pattern = r'//[^\n]*|/\*.*?\*/|(?<!#include )"(?:\\.|[^"\\\n])*"'
    return re.sub(pattern, lambda match: re.sub(r"[^\n]", " ", match.group()), text, flags=re.S)


def public_include_problem(module, name):
    """Why `module` may not include tartan_calib/..., or None."""
    other = name.split("/")[1]
    if other.endswith(".h") or other == module:
        return None
    if other not in ALLOWED:
        return f"includes {name}, which belongs to no module"
    return None if other in ALLOWED[module] else f"includes {name}, but {module} may not use {other}"


def private_include_problem(module_folder, file, name):
    """Why `file` may not include "name", which is no public header, or None."""
    for base in (file.parent, module_folder):
        target = (base / name).resolve()
        if target.exists():
            return None if module_folder in target.parents else f'includes "{name}", a private header of another module'
    return f'includes "{name}", which is neither public nor its module\'s own'


def include_problem(repository, module, file, line):
    include = re.match(r'\s*#include\s*([<"])([^>"]+)[>"]', line)
    if not include:
        return None
    delimiter, name = include.groups()
    if name.startswith("tartan_calib/"):
        return public_include_problem(module, name)
    return private_include_problem(repository / "src" / module, file, name) if delimiter == '"' else None


def check_file(repository, module, file):
    text = without_comments(file.read_text())
    for number, line in enumerate(text.splitlines(), start=1):
        problem = include_problem(repository, module, file, line)
        if problem:
            yield f"{file.relative_to(repository)}:{number}: {problem}"
        for pattern, modules, problem in RESERVED:
            if module not in modules and re.search(pattern, line):
                allowed = " and ".join(sorted(modules)) or "nobody"
                yield f"{file.relative_to(repository)}:{number}: {problem}, which only {allowed} may"


def check_cmake(repository):
    """The modules named in tartan_calib_module(<name> USES ...) against the table."""
    cmake = repository / "CMakeLists.txt"
    text = cmake.read_text() if cmake.exists() else ""
    for name, arguments in re.findall(r"tartan_calib_module\(\s*(\w+)([^)]*)\)", text):
        uses = re.search(r"USES((?:\s+[a-z]\w*)*)", arguments)
        for other in (uses.group(1).split() if uses else []):
            if other not in ALLOWED.get(name, set()):
                yield f"CMakeLists.txt: {name} may not use {other}"


def check(repository):
    yield from check_cmake(repository)
    for top in (repository / "include" / "tartan_calib", repository / "src"):
        for folder in sorted(path for path in top.glob("*") if path.is_dir()):
            if folder.name not in ALLOWED:
                yield f"{folder.relative_to(repository)}: no such module in the table"
                continue
            for file in sorted(folder.rglob("*")):
                if file.suffix in (".h", ".cpp"):
                    yield from check_file(repository, folder.name, file)


def main():
    repository = Path(sys.argv[1] if len(sys.argv) > 1 else Path(__file__).parent.parent).resolve()
    problems = list(check(repository))
    print("\n".join(problems) or "modules: every include and every main is where the table allows it")
    return 1 if problems else 0


if __name__ == "__main__":
    sys.exit(main())
