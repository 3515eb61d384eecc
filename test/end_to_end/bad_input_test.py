"""Bad input ends in one [ERROR] line that names cause and remedy, in the right exit code, and leaves no file behind."""

import os
import shutil
import unittest

from programs import PROGRAMS, Recordings, assert_stopped, calibrate, interrupt_after, run, run_command, start

GOOD_TARGET = {"target_type": "'aprilgrid'", "tagCols": "6", "tagRows": "6", "tagSize": "0.088", "tagSpacing": "0.3"}


class BadInput(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.recordings = Recordings()
        cls.addClassCleanup(cls.recordings.remove)
        cls.folder = cls.recordings.path
        cls.bag = cls.recordings.simulate("rig", "--lens", "pinhole70", "--resolution", "480x400", "--views", 6, "--cameras", 2)
        cls.target = cls.recordings.target("rig")

    def assert_refused(self, finished, code, *words):
        """One line on standard error with these words, that exit code, and no result file anywhere."""
        lines = finished.stderr.splitlines()
        self.assertEqual(len(lines), 1, finished.stderr)
        self.assertTrue(lines[0].startswith("[ERROR]"), lines[0])
        for word in words:
            self.assertIn(word, lines[0])
        self.assertEqual(finished.returncode, code, lines[0])
        for pattern in ("*-camchain.yaml*", "*-results-cam.txt*", "*-calibration.yaml*", "*.tmp*"):
            left = [file.name for file in self.folder.rglob(pattern) if "-truth-" not in file.name]
            self.assertEqual(left, [])

    def calibrate(self, bag=None, target=None, models=("pinhole-radtan",), topics=None, extra=()):
        return calibrate(bag or self.bag, target or self.target, models, topics, extra)

    def truth(self):
        return self.folder / "rig-truth-camchain.yaml"

    def written(self, name, text):
        file = self.folder / name
        file.write_text(text) if isinstance(text, str) else file.write_bytes(text)
        return file

    def board(self, **changes):
        """A target file with keys changed, or left out where the change is None."""
        keys = {key: value for key, value in {**GOOD_TARGET, **changes}.items() if value is not None}
        return self.written("board.yaml", "".join(f"{key}: {value}\n" for key, value in keys.items()))


class WrongCommandLine(BadInput):
    def test_flags(self):
        self.assert_refused(self.calibrate(extra=["--bag-freq", "often"]), 2, "bag-freq")
        self.assert_refused(self.calibrate(extra=["--bag-from-to", "1"]), 2, "bag-from-to")
        self.assert_refused(self.calibrate(extra=["--min-views-outlier", "0"]), 2, "--min-views-outlier", "positive")
        self.assert_refused(self.calibrate(extra=["--mo", "a", "--no-"]), 2, "ambiguous")

    def test_missing_flags(self):
        everything = {"--bag": [self.bag], "--target": [self.target], "--topics": ["/cam0/image_raw"], "--models": ["ds-none"]}
        for flag in everything:
            words = [word for other, values in everything.items() if other != flag for word in (other, *values)]
            self.assert_refused(run("calibrate_cameras", *words), 2, flag)

    def test_a_model_too_few(self):
        topics = ["/cam0/image_raw", "/cam1/image_raw"]
        self.assert_refused(self.calibrate(topics=topics), 2, "one camera model per topic")

    def test_a_topic_for_two_cameras(self):
        topics = ["/cam0/image_raw"] * 2
        self.assert_refused(self.calibrate(topics=topics, models=["ds-none"] * 2), 2, "topic /cam0/image_raw is there twice")
        chain = self.written("twice.yaml", self.truth().read_text().replace("/cam1/", "/cam0/"))
        finished = run("calibrate_cameras", "--bag", self.bag, "--target", self.target, "--init", chain)
        self.assert_refused(finished, 2, "topic /cam0/image_raw is there twice")

    def test_the_models_of_a_camchain_are_called_that(self):
        finished = run("calibrate_cameras", "--bag", self.bag, "--target", self.target, "--init", self.truth(), "--topics",
                       "/cam0/image_raw")
        self.assert_refused(finished, 2, "2 models (those of --init) and 1 topics")

    def test_far_too_many_threads_are_fewer(self):
        finished = self.calibrate(extra=["--threads", "1000000", "--max-rounds", "0"])
        self.assertEqual((finished.returncode, finished.stderr), (0, ""))
        for name in ("camchain.yaml", "results-cam.txt", "calibration.yaml"):
            (self.folder / f"rig-{name}").unlink()

    def test_an_unknown_model_is_answered_with_the_known_ones(self):
        self.assert_refused(self.calibrate(models=["pinhole"]), 1, "model: pinhole.", "pinhole-radtan", "ds-none")


class WrongRecording(BadInput):
    def test_a_bag_that_is_not_there(self):
        self.assert_refused(self.calibrate(bag=self.folder / "nowhere.bag"), 1, "nowhere.bag")

    def test_a_bag_in_a_folder_that_is_not_there(self):
        bag = self.folder / "nowhere" / "x.bag"
        for program, more in (("calibrate_cameras", ("--models", "ds-none")), ("detect_corners", ())):
            finished = run(program, "--bag", bag, "--target", self.target, "--topics", "/cam0/image_raw", *more)
            self.assert_refused(finished, 1, f"bag {bag} does not exist")

    def test_a_file_that_is_no_camchain_to_start_from(self):
        finished = self.calibrate(extra=["--init", self.target])
        self.assert_refused(finished, 1, self.target.name, "is no camchain")

    def test_cameras_in_another_order_than_those_to_start_from(self):
        topics = ["/cam1/image_raw", "/cam0/image_raw"]
        extra = ["--init", self.truth(), "--max-rounds", "0", "--fix", "extrinsics"]
        finished = self.calibrate(models=["ds-none"] * 2, topics=topics, extra=extra)
        for file in self.folder.glob("rig-*"):
            if "truth" not in file.name and file != self.target:
                file.unlink()
        warnings = [line for line in finished.stdout.splitlines() if "calibration to start from" in line]
        self.assertEqual(len(warnings), 2, finished.stdout)
        self.assertIn("cam0 is /cam1/image_raw, but /cam0/image_raw", warnings[0])
        self.assertIn("cam1 is /cam0/image_raw, but /cam1/image_raw", warnings[1])

    def test_a_bag_that_is_none(self):
        self.assert_refused(self.calibrate(bag=self.written("text.bag", "no bag\n" * 100)), 1, "text.bag")
        self.assert_refused(self.calibrate(bag=self.written("empty.bag", "")), 1, "empty.bag")

    def test_a_bag_that_ends_early(self):
        data = self.bag.read_bytes()
        self.assert_refused(self.calibrate(bag=self.written("cut.bag", data[: len(data) // 2])), 1, "cut.bag")

    def test_a_folder_without_images(self):
        (self.folder / "empty").mkdir(exist_ok=True)
        self.assert_refused(self.calibrate(bag=self.folder / "empty"), 1, "empty")

    def test_a_misspelt_topic_is_answered_with_the_image_topics(self):
        self.assert_refused(self.calibrate(topics=["/cam7"]), 1, "/cam7", "/cam0/image_raw", "/cam1/image_raw")

    def test_a_time_window_without_images(self):
        self.assert_refused(self.calibrate(extra=["--bag-from-to", "3", "1"]), 1, "time window", "start")
        self.assert_refused(self.calibrate(extra=["--bag-from-to", "1000", "2000"]), 1, "/cam0/image_raw", "lasts")

    def test_what_is_only_doubtful_is_a_warning(self):
        folder = self.folder / "doubtful"
        self.assertEqual(run("simulate", "--output-dir", folder, "--lens", "pinhole70", "--resolution", "480x400", "--views", 12)
                         .returncode, 0)
        image = sorted((folder / "cam0").iterdir())[3]
        image.write_bytes(image.read_bytes()[:2000])
        finished = self.calibrate(bag=folder, extra=["--bag-from-to", "-1", "1000"])
        self.assertEqual(finished.returncode, 0, finished.stderr)
        self.assertEqual(finished.stderr, "")
        warnings = [line for line in finished.stdout.splitlines() if line.startswith("[ WARN]")]
        for words in (("time window -1 to 1000 s exceeds", "lasts"), ("1 images cannot be read", image.name, "cut off")):
            self.assertTrue(any(all(word in line for word in words) for line in warnings), warnings)
        for file in self.folder.glob("doubtful-*"):
            file.unlink()
        shutil.rmtree(folder)

    def test_a_rate_that_is_none(self):
        for rate in ("-1", "0", "nan"):
            self.assert_refused(self.calibrate(extra=["--bag-freq", rate]), 1, "images per second")

    def test_an_encoding_that_is_no_image_is_named_with_its_topic(self):
        length = (5).to_bytes(4, "little")
        data = self.bag.read_bytes().replace(length + b"mono8", length + b"32FC1")
        self.assert_refused(self.calibrate(bag=self.written("float.bag", data)), 1, "/cam0/image_raw", "32FC1")

    def test_a_board_that_is_not_in_the_images(self):
        board = self.written("checkers.yaml", "target_type: 'checkerboard'\ntargetCols: 17\ntargetRows: 23\n"
                                              "rowSpacingMeters: 0.02\ncolSpacingMeters: 0.02\n")
        self.assert_refused(self.calibrate(target=board), 1, "/cam0/image_raw")

    def test_another_model_or_size_than_that_to_start_from(self):
        chain = self.truth()
        start = self.written("start.yaml", chain.read_text().replace("[480, 400]", "[400, 480]"))
        for model, words in (("omni-none", ("is to be omni-none", "leave --models out")), ("ds-none", ("480x400", "for 400x480"))):
            finished = self.calibrate(models=[model] * 2, extra=["--init", start])
            self.assert_refused(finished, 1, *words, "without --init")
            self.assertNotIn("Extracting", finished.stdout)

    def test_a_board_with_another_border_is_answered_with_the_remedy(self):
        self.assert_refused(self.calibrate(target=self.board(tagBorder=1)), 1, "none of its", "border of 2 cells", "tagBorder: 2")

    def test_a_board_of_another_size_is_answered_with_its_size(self):
        board = self.board(tagCols=5, tagRows=5)
        self.assert_refused(self.calibrate(target=board), 1, "/cam0/image_raw", "6 rows and 6 columns", "5 and 5", "tagCols")

    def test_a_few_tags_taken_for_another_board_give_no_calibration(self):
        board = self.written("checkers.yaml", "target_type: 'checkerboard'\ntargetCols: 6\ntargetRows: 7\n"
                                              "rowSpacingMeters: 0.02\ncolSpacingMeters: 0.02\n")
        bag = self.recordings.simulate("few", "--lens", "pinhole70", "--resolution", "480x400", "--views", 12, "--cameras", 2)
        finished = self.calibrate(bag=bag, target=board)
        bag.unlink()
        self.assert_refused(finished, 1, "did not converge", "focal length is uncertain", "target file")

    def test_cameras_that_never_see_the_board_together(self):
        folder = self.folder / "apart"
        arguments = ["--lens", "pinhole70", "--resolution", "480x400", "--views", 12, "--cameras", 2]
        self.assertEqual(run("simulate", "--output-dir", folder, *arguments).returncode, 0)
        images = [sorted((folder / camera).iterdir()) for camera in ("cam0", "cam1")]
        for file in images[0][6:] + images[1][:6]:
            file.unlink()
        self.assert_refused(self.calibrate(bag=folder, models=["pinhole-radtan"] * 2), 1, "cam0", "cam1", "--approx-sync")
        shutil.rmtree(folder)


class WrongTarget(BadInput):
    def test_a_file_that_is_not_there(self):
        self.assert_refused(self.calibrate(target=self.folder / "nowhere.yaml"), 1, "nowhere.yaml")

    def test_a_file_that_is_no_yaml(self):
        self.assert_refused(self.calibrate(target=self.written("board.yaml", "a: [1\nb: }")), 1, "board.yaml")

    def test_a_missing_key_is_named_with_the_file(self):
        for key in GOOD_TARGET:
            self.assert_refused(self.calibrate(target=self.board(**{key: None})), 1, "board.yaml", key)

    def test_a_missing_key_of_other_boards_is_named_too(self):
        boards = {"checkerboard": ("targetCols", "targetRows", "rowSpacingMeters", "colSpacingMeters"),
                  "circlegrid": ("targetCols", "targetRows", "spacingMeters", "asymmetricGrid")}
        values = {"targetCols": 6, "targetRows": 7, "asymmetricGrid": "true"}
        for kind, keys in boards.items():
            for missing in keys:
                lines = [f"target_type: {kind}"] + [f"{key}: {values.get(key, 0.02)}" for key in keys if key != missing]
                board = self.written("board.yaml", "\n".join(lines) + "\n")
                self.assert_refused(self.calibrate(target=board), 1, "board.yaml", missing)

    def test_an_unknown_type_is_answered_with_the_known_ones(self):
        finished = self.calibrate(target=self.board(target_type="'chessboard'"))
        self.assert_refused(finished, 1, "chessboard", "aprilgrid", "checkerboard", "circlegrid")

    def test_values_that_are_none(self):
        for key, value in (("tagSize", "0.0"), ("tagSize", "-1"), ("tagSize", "big"), ("tagSpacing", "0"), ("tagRows", "2.5"),
                           ("tagRows", "0"), ("tagRows", "2"), ("tagCols", "[6]"), ("tagFamily", "'t1h1'"), ("tagBorder", "0")):
            self.assert_refused(self.calibrate(target=self.board(**{key: value})), 1, "board.yaml", key)


class CannotFinish(BadInput):
    def test_ctrl_c_ends_it_without_files(self):
        process = start("calibrate_cameras", "--bag", self.bag, "--target", self.target, "--topics", "/cam0/image_raw", "--models",
                        "pinhole-radtan")
        stopped = interrupt_after("Initializing cam0", process)
        assert_stopped(self, stopped, "in round 0 (detect cam0); nothing was written")
        self.assertEqual([file for file in self.folder.glob("rig-*") if "truth" not in file.name], [self.target])

    def test_a_limit_of_the_size_of_files(self):
        words = [PROGRAMS / "calibrate_cameras", "--bag", self.bag, "--target", self.target, "--topics", "/cam0/image_raw",
                 "--models", "pinhole-radtan", "--max-rounds", "0", "--no-report"]
        finished = run_command("bash", "-c", 'ulimit -f 1 && exec "$@"', "bash", *words)
        self.assert_refused(finished, 1, "cannot write", "File too large")

    def test_a_result_that_would_replace_its_own_input(self):
        chain = self.folder / "rig-camchain.yaml"
        shutil.copy(self.truth(), chain)
        before = chain.read_bytes()
        finished = self.calibrate(models=["ds-none"] * 2, extra=["--init", chain])
        kept = chain.read_bytes()
        chain.unlink()
        self.assert_refused(finished, 1, "written over", str(chain), "--init", "copy")
        self.assertEqual(kept, before)
        corners = self.written("x-corners.csv", "by hand\n")
        finished = run("calibrate_cameras", "--corners", corners, "--target", self.target, "--models", "ds-none", "--export-corners")
        self.assert_refused(finished, 1, "written over", str(corners), "--corners", "copy")
        self.assertEqual(corners.read_text(), "by hand\n")

    def test_what_tartan_calibrate_writes_first_does_not_replace_its_input(self):
        chain = self.folder / "x0-camchain.yaml"
        shutil.copy(self.truth(), chain)
        finished = run("tartan_calibrate", "--bag", self.bag, "--target", self.target, "--init", chain, "--save_dir", self.folder,
                       "--log_dest", "x", "--no-report")
        kept = chain.read_bytes()
        chain.unlink()
        self.assert_refused(finished, 1, "written over", str(chain), "--init")
        self.assertEqual(kept, (self.truth()).read_bytes())

    def test_a_result_folder_that_does_not_exist(self):
        corners = self.folder / "nowhere" / "x-corners.csv"
        finished = run("calibrate_cameras", "--corners", corners, "--target", self.target, "--models", "ds-none")
        self.assert_refused(finished, 1, "nowhere")

    @unittest.skipUnless(os.geteuid() == 0, "a full disk is mounted, which needs root")
    def test_a_full_disk_leaves_the_files_of_an_earlier_run_as_they_were(self):
        full, copy = self.folder / "full", self.folder / "copy"
        full.mkdir()
        for folder in (full, copy):
            self.addCleanup(shutil.rmtree, folder, ignore_errors=True)
        finished = run_command("unshare", "--mount", "sh", "-c", self.program_on_small_disk(full, copy))
        if "unshare" in finished.stderr or "mount:" in finished.stderr:
            self.skipTest(finished.stderr)
        left = {file.name: file.read_text() for file in copy.iterdir() if file.name != "x.bag"}
        self.assertEqual(left, {"x-camchain.yaml": "earlier\n"})
        self.assertEqual(finished.returncode, 1, finished.stderr)
        self.assertRegex(finished.stderr, r"^\[ERROR\].*/x-[^\n]*\n$")

    def program_on_small_disk(self, folder, copy):
        """Calibrates on a disk of three pages, one taken, copies what it left there, and ends with the calibration's exit code."""
        command = (f"{PROGRAMS}/calibrate_cameras --bag '{folder}/x.bag' --target '{self.target}' --topics /cam0/image_raw "
                   "--models pinhole-radtan --no-report")
        return (f"mount -t tmpfs -o size=12k none '{folder}' && ln -s '{self.bag}' '{folder}/x.bag' && "
                f"echo earlier > '{folder}/x-camchain.yaml' && {{ {command}; code=$?; cp -r '{folder}' '{copy}'; exit $code; }}")


del BadInput  # the base holds no test of its own

if __name__ == "__main__":
    unittest.main()
