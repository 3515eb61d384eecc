"""Every program explains itself and answers a wrong command line with one line."""

import filecmp
import unittest

from programs import PROGRAMS, run, run_in_workspace

NAMES = sorted(path.name for path in PROGRAMS.iterdir() if path.is_file())


class EveryProgram(unittest.TestCase):
    def test_there_are_programs(self):
        for name in ("calibrate_cameras", "kalibr_calibrate_cameras", "make_bag", "simulate"):
            self.assertIn(name, NAMES)

    def test_help_shows_a_command_to_start_from(self):
        for name in NAMES:
            for flag in ("--help", "-h"):
                finished = run(name, flag)
                self.assertEqual(finished.returncode, 0, name)
                self.assertIn("rosrun tartan_calib", finished.stdout, name)
                self.assertEqual(finished.stderr, "", name)

    def test_without_arguments_the_exit_code_is_that_of_a_wrong_command_line(self):
        for name in NAMES:
            finished = run(name)
            self.assertEqual(finished.returncode, 2, name)
            self.assertIn("--help", finished.stdout + finished.stderr, name)

    def test_an_unknown_flag_is_named_in_one_line(self):
        for name in NAMES:
            finished = run(name, "--no-such-flag")
            self.assertEqual(finished.returncode, 2, name)
            self.assertEqual(len(finished.stderr.splitlines()), 1, finished.stderr)
            self.assertTrue(finished.stderr.startswith("[ERROR]"), finished.stderr)
            self.assertIn("unrecognised option '--no-such-flag'", finished.stderr)

    def test_the_program_is_there_under_kalibrs_name(self):
        names = [PROGRAMS / name for name in ("calibrate_cameras", "kalibr_calibrate_cameras")]
        self.assertTrue(filecmp.cmp(*names, shallow=False))

    def test_rosrun_finds_each_without_a_question(self):
        for name in NAMES:
            finished = run_in_workspace(f"rosrun tartan_calib {name} --help")
            self.assertEqual(finished.returncode, 0, finished.stderr)
            self.assertEqual(finished.stderr, "")


if __name__ == "__main__":
    unittest.main()
