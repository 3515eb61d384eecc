"""Links, anchors and pictures of README.md and docs resolve; every picture is shown somewhere."""

import re
import unittest
from pathlib import Path

SOURCE = Path(__file__).resolve().parents[2]
PAGES = [SOURCE / "README.md", *sorted((SOURCE / "docs").glob("*.md"))]

CODE = re.compile(r"^```.*?^```|``.*?``|`[^`\n]*`", re.MULTILINE | re.DOTALL)
LINK = re.compile(r"\]\(([^)\s]+)\)")
HEADING = re.compile(r"^#+ (.*)$", re.MULTILINE)
PICTURES = {".png", ".jpg", ".svg"}


def links(page):
    """(file or None for a web page, anchor) of each link."""
    for target in LINK.findall(CODE.sub("", page.read_text())):
        if re.match(r"https?://|mailto:", target):
            continue
        path, _, anchor = target.partition("#")
        yield target, (page.parent / path).resolve() if path else page, anchor


def anchors(page):
    """What GitHub makes of the page's headings."""
    text = re.sub(r"^```.*?^```", "", page.read_text(), flags=re.MULTILINE | re.DOTALL)
    return {re.sub(r"[^\w\- ]", "", heading.lower()).replace(" ", "-") for heading in HEADING.findall(text)}


class Links(unittest.TestCase):
    def test_every_link_leads_to_a_file_of_the_repository(self):
        for page in PAGES:
            for target, file, _ in links(page):
                self.assertTrue(file.exists(), f"{page.relative_to(SOURCE)} links to {target}")
                self.assertIn(SOURCE, file.parents, f"{page.relative_to(SOURCE)} links to {target}")

    def test_every_anchor_is_a_heading(self):
        for page in PAGES:
            for target, file, anchor in links(page):
                if anchor:
                    self.assertIn(anchor, anchors(file), f"{page.relative_to(SOURCE)} links to {target}")

    def test_every_picture_is_shown(self):
        shown = {file for page in PAGES for _, file, _ in links(page)}
        for picture in (SOURCE / "docs/images").iterdir():
            self.assertIn(picture, shown, "no page shows it")

    def test_every_page_can_be_reached_from_the_readme(self):
        reached, waiting = set(), [PAGES[0]]
        while waiting:
            page = waiting.pop()
            reached.add(page)
            waiting += [file for _, file, _ in links(page) if file in PAGES and file not in reached]
        self.assertEqual([page.name for page in PAGES if page not in reached], [])


if __name__ == "__main__":
    unittest.main()
