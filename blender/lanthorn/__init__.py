# SPDX-FileCopyrightText: 2026 The Lanthorn authors
# SPDX-License-Identifier: Apache-2.0
"""Makes Lanthorn a render engine of Blender. The add-on runs the program `lanthorn` as a separate process
(docs/blender.md)."""
from . import engine, panels, settings

bl_info = {
    "name": "Lanthorn",
    "author": "The Lanthorn authors",
    "version": (0, 1, 0),
    "blender": (3, 4, 0),
    "category": "Render",
    "location": "Render Properties > Render Engine > Lanthorn",
    "description": "Renders caustics of glass, water and metal",
    "support": "COMMUNITY",
}

MODULES = (settings, engine, panels)


def register():
    for module in MODULES:
        module.register()


def unregister():
    for module in reversed(MODULES):
        module.unregister()
