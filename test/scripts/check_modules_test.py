"""A tree that keeps to the table passes scripts/check_modules.py; each way to break it is reported with its file and line."""

import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

CHECK_MODULES = Path(__file__).resolve().parents[2] / "scripts" / "check_modules.py"

GOOD_TREE = {
    "include/tartan_calib/error.h": "#include <stdexcept>\n",
    "include/tartan_calib/geometry/rigid3.h": "#include <Eigen/Core>\n",
    "include/tartan_calib/camera/camera.h": "#include \"tartan_calib/geometry/rigid3.h\"\n",
    "src/camera/table.h": "",
    "src/camera/camera.cpp": '#include "table.h"\n#include "tartan_calib/error.h"\n// std::cout << "a comment";\n'
                             'const char* kText = "int main() std::cout";\nint n = std::snprintf(b, 1, "");\n',
    "src/ros/bag.cpp": "#include <rosbag/bag.h>\n#include <ros/time.h>\n",
    "src/apps/options/options.h": "",
    "src/apps/calibrate.cpp": '#include "options/options.h"\nint main() { std::cout << 1; }\n',
    "CMakeLists.txt": "tartan_calib_module(camera USES geometry LINK x)\n",
}


def check(changes):
    """Exit code and output of the script on the good tree with `changes` (path: text)."""
    with tempfile.TemporaryDirectory() as root:
        for path, text in {**GOOD_TREE, **changes}.items():
            file = Path(root) / path
            file.parent.mkdir(parents=True, exist_ok=True)
            file.write_text(text)
        result = subprocess.run([sys.executable, CHECK_MODULES, root], capture_output=True, text=True)
        return result.returncode, result.stdout


class CheckModules(unittest.TestCase):
    def assert_reported(self, path, text, *words):
        code, output = check({path: text})
        self.assertEqual(code, 1, output)
        for word in (path, *words):
            self.assertIn(word, output)

    def test_a_tree_that_keeps_to_the_table_passes(self):
        code, output = check({})
        self.assertEqual(code, 0, output)

    def test_an_include_upwards_is_reported(self):
        self.assert_reported("src/geometry/a.cpp", '\n#include "tartan_calib/camera/camera.h"\n', ":2:", "may not use camera")

    def test_a_private_header_of_another_module_is_reported(self):
        self.assert_reported("src/geometry/a.cpp", '#include "../camera/table.h"\n', ":1:", "private header")

    def test_a_header_that_does_not_exist_is_reported(self):
        self.assert_reported("src/camera/a.cpp", '#include "nowhere.h"\n', "neither public nor")

    def test_a_public_header_of_no_module_is_reported(self):
        self.assert_reported("src/camera/a.cpp", '#include "tartan_calib/misc/a.h"\n', "belongs to no module")

    def test_a_folder_outside_of_the_table_is_reported(self):
        code, output = check({"src/misc/a.cpp": ""})
        self.assertEqual(code, 1)
        self.assertIn("src/misc: no such module", output)

    def test_ros_in_the_core_is_reported(self):
        self.assert_reported("include/tartan_calib/camera/a.h", "#include <ros/time.h>\n", "includes ROS")

    def test_a_bag_opened_outside_of_ros_is_reported(self):
        self.assert_reported("src/apps/a.cpp", "#include <rosbag/bag.h>\n", "opens bags")

    def test_printing_in_the_core_is_reported(self):
        for statement in ("std::cout << 1;", "std::cerr << 1;", "printf(kText);", "std::fprintf(f, kText);", "puts(kText);"):
            self.assert_reported("src/camera/a.cpp", f"void f() {{ {statement} }}\n", "prints")

    def test_a_main_outside_of_apps_is_reported(self):
        self.assert_reported("src/ros/a.cpp", "int main() {}\n", "owns a main")

    def test_ending_the_process_in_the_core_is_reported(self):
        self.assert_reported("src/camera/a.cpp", "void f() { std::exit(1); }\n", "ends the process")

    def test_cmake_that_gives_a_module_more_than_the_table_is_reported(self):
        code, output = check({"CMakeLists.txt": "tartan_calib_module(geometry USES camera LINK x)\n"})
        self.assertEqual(code, 1)
        self.assertIn("geometry may not use camera", output)


if __name__ == "__main__":
    unittest.main()
