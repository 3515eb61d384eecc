"""Other packages and an install space get what they need: Kalibr's command, libraries with headers, programs, launch files."""

import os
import tempfile
import unittest
from pathlib import Path

from programs import DEVEL, SOURCE, run_command, run_in_workspace

PACKAGE_XML = """<package format="2"><name>consumer</name><version>0.0.0</version><description>A user of the libraries.
</description><maintainer email="a@example.org">a</maintainer><license>BSD</license><buildtool_depend>catkin</buildtool_depend>
<depend>tartan_calib</depend></package>"""

CMAKE = """cmake_minimum_required(VERSION 3.16)
project(consumer CXX)
set(CMAKE_CXX_STANDARD 17)
find_package(catkin REQUIRED COMPONENTS tartan_calib)
catkin_package()
include_directories(${catkin_INCLUDE_DIRS})
add_executable(consumer main.cpp)
target_link_libraries(consumer ${catkin_LIBRARIES})
"""

MAIN = """#include <tartan_calib/camera/camera.h>
#include <tartan_calib/io/target_yaml.h>
#include <iostream>
int main(int, char** argv) {
  const auto target = tartan_calib::io::loadTarget(argv[1]);
  std::cout << tartan_calib::camera::modelNames().size() << " models, " << tartan_calib::target::numCorners(target.target);
}
"""

CATKIN_MAKE = "catkin_make -j2 -DPYTHON_EXECUTABLE=/usr/bin/python3 -DPython3_EXECUTABLE=/usr/bin/python3"


class OtherWorkspace(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="tartan_calib_")
        self.addCleanup(folder.cleanup)
        self.workspace = Path(folder.name)
        (self.workspace / "src").mkdir()

    def build(self):
        finished = run_in_workspace(CATKIN_MAKE, cwd=self.workspace)
        self.assertEqual(finished.returncode, 0, finished.stdout + finished.stderr)
        return self.workspace / "devel/setup.bash"

    def test_the_overlay_answers_to_kalibrs_command(self):
        script = SOURCE / "scripts/make_kalibr_overlay"
        for _ in range(2):  # writing it again is fine
            self.assertEqual(run_command(script, self.workspace).returncode, 0)
        setup = self.build()
        finished = run_in_workspace("rosrun kalibr kalibr_calibrate_cameras --help", setup)
        self.assertEqual(finished.returncode, 0, finished.stderr)
        self.assertIn("--models", finished.stdout)
        finished = run_in_workspace("rosrun kalibr kalibr_calibrate_cameras --bag 'a b.bag'", setup)
        self.assertEqual(finished.returncode, 2)

    def test_the_overlay_leaves_another_kalibr_alone(self):
        kalibr = self.workspace / "src/kalibr"
        kalibr.mkdir()
        (kalibr / "package.xml").write_text("<package><name>kalibr</name></package>")
        finished = run_command(SOURCE / "scripts/make_kalibr_overlay", self.workspace)
        self.assertEqual(finished.returncode, 1)
        self.assertTrue(finished.stderr.startswith("[ERROR]"))

    def test_another_package_links_the_libraries(self):
        consumer = self.workspace / "src/consumer"
        consumer.mkdir()
        for name, text in (("package.xml", PACKAGE_XML), ("CMakeLists.txt", CMAKE), ("main.cpp", MAIN)):
            (consumer / name).write_text(text)
        setup = self.build()
        board = SOURCE / "config/targets/april_6x6_80x80cm.yaml"
        finished = run_in_workspace(f"rosrun consumer consumer {board}", setup)
        self.assertEqual(finished.stdout, "8 models, 144", finished.stderr)


class InstallSpace(unittest.TestCase):
    def test_programs_and_launch_files_run_from_it(self):
        finished = run_command("make", "-C", DEVEL.parent / "build", "install")
        self.assertEqual(finished.returncode, 0, finished.stdout + finished.stderr)
        setup = DEVEL.parent / "install/setup.bash"
        for command in ("rosrun tartan_calib calibrate_cameras --help", "rosrun tartan_calib kalibr_calibrate_cameras --help",
                        "roslaunch --files tartan_calib calibrate.launch bag:=a.bag"):
            finished = run_in_workspace(command, setup, env=self.bare_environment())
            self.assertEqual(finished.returncode, 0, command + finished.stderr)
        prefix = run_in_workspace("rospack find tartan_calib", setup, env=self.bare_environment()).stdout.strip()
        self.assertTrue(prefix.startswith(str(DEVEL.parent / "install")), prefix)

    def bare_environment(self):
        return {"PATH": os.environ["PATH"], "HOME": os.environ["HOME"]}


if __name__ == "__main__":
    unittest.main()
