# SPDX-FileCopyrightText: 2026 The Lanthorn authors
# SPDX-License-Identifier: Apache-2.0
"""What of a scene has no counterpart in Lanthorn, each said once."""


class Report:
    def __init__(self):
        self._notes = {}

    def note(self, owner, text):
        """`text` says what is missing and what stands in for it; `owner` is the name of where it is."""
        self._notes.setdefault(text, []).append(owner)

    def lines(self):
        """One line for each kind of note, with the names of up to three owners."""
        lines = []
        for text, owners in self._notes.items():
            names = list(dict.fromkeys(owners))
            more = f" and {len(names) - 3} more" if len(names) > 3 else ""
            lines.append(f"{', '.join(names[:3])}{more}: {text}")
        return lines
