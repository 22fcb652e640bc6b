# SPDX-FileCopyrightText: 2026 The Lanthorn authors
# SPDX-License-Identifier: Apache-2.0
"""Usage: make_zip.py ZIP FILE...

Packs files of the current folder. The zip depends on their names and contents alone, so that a release can be
reproduced: `cmake -E tar` would add the times of the last access and of the copy.
"""

import sys
import zipfile

TIME = (2026, 1, 1, 0, 0, 0)
REGULAR_FILE = 0o100644


def make_zip(path, names):
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as archive:
        for name in sorted(names):
            entry = zipfile.ZipInfo(name, TIME)
            entry.compress_type = zipfile.ZIP_DEFLATED
            entry.external_attr = REGULAR_FILE << 16
            with open(name, "rb") as file:
                archive.writestr(entry, file.read())


if __name__ == "__main__":
    make_zip(sys.argv[1], sys.argv[2:])
