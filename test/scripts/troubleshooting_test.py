"""docs/troubleshooting.md explains every error and warning of a calibration, and every reason of its verdict."""

import re
import unittest
from pathlib import Path

SOURCE = Path(__file__).resolve().parents[2]

# What a calibration runs through. Other programs say what is wrong with their few flags.
FOLDERS = ("apps/calibrate_cameras", "apps/common", "calibration", "camera", "detection", "io", "pipeline", "report", "ros", "target")
# Broken contracts between modules, which no user can bring about.
INTERNAL = {"the detector needs images with one channel of 8 bits; convert them first", "board poses; each view needs one",
            "only 8-bit grey images can be written to topic"}
MIN_PHRASE = 12  # letters; shorter ones, such as ": ", are glue

MESSAGE = re.compile(r"\b(InputError|UsageError|CalibrationError|printWarning|printError|notify|warn|require|format|reject\w*|push_back)\s*\(")
LITERAL = re.compile(r'"((?:[^"\\]|\\.)*)"')
FILLED_IN = re.compile(r"%(?:%|[-+ 0#]*\d*(?:\.\d+)?(?:[hlzt]*)[a-zA-Z])")


def arguments(text, start):
    """The text from an opening bracket to the one that closes it."""
    depth = 0
    for bracket in re.finditer(r'"(?:[^"\\]|\\.)*"|[(){}]', text[start:]):
        depth += {"(": 1, "{": 1, ")": -1, "}": -1}.get(bracket.group(), 0)
        if depth == 0:
            return text[start:start + bracket.end()]
    raise ValueError("a bracket is not closed")


def phrases(text):
    """The longest fixed part of each message in a source."""
    for call in MESSAGE.finditer(text):
        joined = re.sub(r'"\s*\n\s*"', "", arguments(text, call.end() - 1))
        parts = [part.strip(" :;,.'()") for literal in LITERAL.findall(joined) for part in FILLED_IN.split(literal)]
        longest = max(parts, key=len, default="")
        if len(longest) >= MIN_PHRASE and " " in longest:
            yield longest


def sources():
    return [file for folder in FOLDERS for file in sorted((SOURCE / "src" / folder).glob("*.cpp"))]


class Troubleshooting(unittest.TestCase):
    def test_every_message_is_in_the_page(self):
        page = " ".join((SOURCE / "docs/troubleshooting.md").read_text().split())
        missing = [f"{file.relative_to(SOURCE)}: {phrase}" for file in sources() for phrase in phrases(file.read_text())
                   if phrase not in INTERNAL and phrase not in page]
        self.assertEqual(missing, [], "docs/troubleshooting.md does not explain:\n" + "\n".join(missing))

    def test_messages_are_found_in_the_source(self):
        found = {phrase for file in sources() for phrase in phrases(file.read_text())}
        self.assertGreater(len(found), 100)
        self.assertIn("does not exist: check the path", found)
        self.assertIn("images have the stamp of the image before and were skipped", found)


if __name__ == "__main__":
    unittest.main()
