# SPDX-FileCopyrightText: 2026 The Lanthorn authors
# SPDX-License-Identifier: Apache-2.0
"""Runs the examples of docs/python.md in the page's order, in one folder."""

import os
import pathlib
import shutil
import tempfile
import unittest

import lanthorn

SOURCE = pathlib.Path(__file__).resolve().parents[2]


def examples(page):
    """Yields the blocks between ```python and ```, each with the number of the line before it."""
    block, start = None, 0
    for number, line in enumerate(page.read_text().splitlines(), start=1):
        if block is None and line.strip() == "```python":
            block, start = [], number
        elif block is not None and line.strip() == "```":
            yield start, "\n".join(block)
            block = None
        elif block is not None:
            block.append(line)


class Docs(unittest.TestCase):
    def test_examples_run(self):
        page = SOURCE / "docs/python.md"
        before = os.getcwd()
        with tempfile.TemporaryDirectory() as folder:
            for file in ("ring.pbrt", "ring.ply"):
                shutil.copy(SOURCE / "scenes" / file, folder)
            os.chdir(folder)
            try:
                # Small pictures, to save time.
                names = {}
                count = 0
                original = lanthorn.load_file
                lanthorn.load_file = lambda *a, **k: original(*a, **k).edit(film={"width": 32, "height": 24})
                for line, text in examples(page):
                    # Errors show the page's line numbers.
                    exec(compile("\n" * line + text, str(page), "exec"), names)
                    count += 1
            finally:
                lanthorn.load_file = original
                os.chdir(before)
            self.assertGreater(count, 8)


if __name__ == "__main__":
    unittest.main()
