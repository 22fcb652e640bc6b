# SPDX-FileCopyrightText: 2026 The Lanthorn authors
# SPDX-License-Identifier: Apache-2.0
"""Collects the features of a scene that Lanthorn does not support, and names each of them once."""


class Report:
    def __init__(self):
        self._notes = {}

    def note(self, owner, text):
        """Notes that an object or material (`owner`) has an unsupported feature. `text` also names the replacement."""
        self._notes.setdefault(text, []).append(owner)

    def lines(self):
        """Returns a line for each text, with the names of up to three owners."""
        lines = []
        for text, owners in self._notes.items():
            names = list(dict.fromkeys(owners))
            more = f" and {len(names) - 3} more" if len(names) > 3 else ""
            lines.append(f"{', '.join(names[:3])}{more}: {text}")
        return lines
