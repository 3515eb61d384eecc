"""package.xml and scripts/common.sh name what the tests in Python import and run."""

import ast
import re
import sys
import unittest
from pathlib import Path
from xml.etree import ElementTree

SOURCE = Path(__file__).resolve().parents[2]
FILES = sorted((SOURCE / "test").rglob("*.py"))
OWN = {file.stem for file in (SOURCE / "test").rglob("*.py")} | {file.stem for file in SOURCE.glob("s*/**/*.py")}
ROSDEP_KEYS = {"yaml": "python3-yaml", "numpy": "python3-numpy", "matplotlib": "python3-matplotlib", "rosrun": "rosbash"}
COMMAND = re.compile(r"""["'](ros(?:bag|launch|node|param|run|service|test|topic)) """)


def imported(file):
    for node in ast.walk(ast.parse(file.read_text())):
        names = [alias.name for alias in node.names] if isinstance(node, ast.Import) else []
        names += [node.module] if isinstance(node, ast.ImportFrom) else []
        yield from (name.split(".")[0] for name in names)


def needed():
    modules = {name for file in FILES for name in imported(file)} - set(sys.stdlib_module_names) - OWN
    commands = {name for file in FILES for name in COMMAND.findall(file.read_text())}
    return sorted({ROSDEP_KEYS.get(name, name) for name in modules | commands})


@unittest.skipUnless(hasattr(sys, "stdlib_module_names"), "older Pythons do not list their modules")
class Package(unittest.TestCase):
    def test_all_that_tests_need_is_found(self):
        for name in ("python3-yaml", "rosbag", "rosbash", "rosservice", "std_srvs"):
            self.assertIn(name, needed())

    def test_package_xml_names_what_tests_need(self):
        package = ElementTree.parse(SOURCE / "package.xml").getroot()
        named = {element.text for element in package if element.tag in ("depend", "exec_depend", "test_depend")}
        self.assertEqual([name for name in needed() if name not in named], [])

    def test_so_do_the_debian_packages(self):
        listed = re.findall(r"[a-z0-9-]+", " ".join(re.findall(r"packages=\(([^)]*)\)", (SOURCE / "scripts/common.sh").read_text())))
        wanted = {name: {name, "python3-" + name.replace("_", "-")} for name in needed()}
        self.assertEqual([name for name, packages in wanted.items() if not packages & set(listed)], [])


if __name__ == "__main__":
    unittest.main()
