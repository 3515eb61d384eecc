"""scripts/common.sh keeps what ROS and matplotlib write in the repository's build folder."""

import subprocess
import unittest
from pathlib import Path

SOURCE = Path(__file__).resolve().parents[2]


class Common(unittest.TestCase):
    def test_caches_and_logs_are_below_build(self):
        command = f"source '{SOURCE}/scripts/common.sh' && printenv ROS_HOME MPLCONFIGDIR"
        finished = subprocess.run(["bash", "-c", command], capture_output=True, text=True, check=True)
        for folder in finished.stdout.split():
            self.assertIn(SOURCE / "build", Path(folder).parents)
        self.assertEqual(len(finished.stdout.split()), 2)


if __name__ == "__main__":
    unittest.main()
