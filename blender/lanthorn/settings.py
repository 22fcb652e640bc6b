# SPDX-FileCopyrightText: 2026 The Lanthorn authors
# SPDX-License-Identifier: Apache-2.0
"""Defines the settings of scenes, view layers, materials and the add-on."""
import shutil

import bpy
from bpy.props import BoolProperty, EnumProperty, FloatProperty, IntProperty, PointerProperty, StringProperty

from . import presets

# Names as in `lanthorn list`.
METHODS = [("auto", "Automatic", "A pilot render chooses the method for each kind of light"),
           ("vcm", "Vertex connection and merging", "Finds all kinds of light"),
           ("path", "Path tracing", "Fast, but does not find caustics of small lights"),
           ("probppm", "Progressive photon mapping", "Finds all kinds of caustics"),
           ("bdpt", "Bidirectional path tracing", "Connects paths from the camera and the lights"),
           ("mlt", "Metropolis light transport", "Explores light that is hard to find")]


class LanthornSceneSettings(bpy.types.PropertyGroup):
    noise: FloatProperty(name="Noise", description="Stop when the picture's error falls below this value. 0: no limit",
                         default=2, min=0, max=100, soft_max=20, precision=1, subtype="PERCENTAGE")
    seconds: FloatProperty(name="Time", description="Stop after this time. 0: no limit", default=60, min=0, precision=0,
                           unit="TIME_ABSOLUTE")
    passes: IntProperty(name="Passes", description="Stop after this number of passes. 0: no limit", default=0,
                        min=0)
    method: EnumProperty(name="Method", items=METHODS, default="auto")
    denoise: BoolProperty(name="Denoise", description="Remove the noise of the finished picture", default=False)
    spectral: BoolProperty(name="Spectral", description="Render by wavelength instead of red, green and blue, which shows dispersion",
                           default=False)
    max_depth: IntProperty(name="Depth", description="Largest number of scattering events of a path. 0: the method's default",
                           default=0, min=0)
    clamp: FloatProperty(name="Clamp", description="Limit the contribution of a path to a pixel, except for directly visible lights. 0: no limit", default=0, min=0)
    seed: IntProperty(name="Seed", default=0, min=0)
    bake_size: IntProperty(name="Baked Textures", default=1024, min=16, max=8192, subtype="PIXEL",
                           description="Width and height of the images to which unsupported node trees are baked. The image "
                                       "of a world is half as high")

    def options(self):
        """Returns the options for `lanthorn link`."""
        options = {"integrator": self.method, "seed": self.seed, "color": "spectral" if self.spectral else "rgb"}
        if self.noise > 0:
            options["noise"] = min(1, self.noise / 100)
        if self.seconds > 0:
            options["seconds"] = self.seconds
        if self.passes > 0:
            options["passes"] = self.passes
        if self.max_depth > 0:
            options["max_depth"] = self.max_depth
        if self.clamp > 0:
            options["clamp"] = self.clamp
        return options

    def viewport_options(self):
        """Returns the options of a viewport, which refines without a time limit until its noise is low."""
        options = self.options()
        options.pop("seconds", None)
        options.pop("passes", None)
        options["noise"] = min(options.get("noise", 0.02), 0.02)
        return options


class LanthornMaterialSettings(bpy.types.PropertyGroup):
    """Holds properties that Blender's nodes lack, for the material's Glass, Glossy or Principled node."""
    glass: EnumProperty(name="Index", items=presets.GLASS_ITEMS, default="NONE",
                        description="Use a measured index of refraction and its dispersion instead of the node's index")
    abbe: FloatProperty(name="Abbe Number", default=0, min=0, soft_max=90, precision=1,
                        description="Dispersion around the node's index: about 60 for crown glass, 30 for flint glass. "
                                    "0: none. Spectral renders show it")
    film_thickness: FloatProperty(name="Thin Film", default=0, min=0, soft_max=1000, precision=0,
                                  description="Thickness of a thin film on the outside, in nanometres. 0: none")
    film_eta: FloatProperty(name="Film Index", default=1.33, min=1, soft_max=2.5, precision=3)
    metal: EnumProperty(name="Metal", items=presets.METAL_ITEMS, default="NONE",
                        description="Use a measured index and absorption instead of the node's colour")


class LanthornLayerSettings(bpy.types.PropertyGroup):
    use_caustic: BoolProperty(name="Caustic", description="Light that mirrors and glass have focused", default=True)
    use_direct: BoolProperty(name="Direct", default=False)
    use_indirect: BoolProperty(name="Indirect", default=False)
    use_media: BoolProperty(name="Media", description="Light that media such as fog, smoke and water scatter or emit", default=False)
    use_error: BoolProperty(name="Error", description="Standard error of each pixel", default=False)


class LanthornPreferences(bpy.types.AddonPreferences):
    bl_idname = __package__

    program: StringProperty(name="Program", description="Path of the program lanthorn. If empty, the PATH is searched", subtype="FILE_PATH")

    def draw(self, _context):
        self.layout.prop(self, "program")
        found = program_path()
        self.layout.label(text=found or MISSING, icon="CHECKMARK" if found else "ERROR")


MISSING = "The program lanthorn was not found on the PATH: install it, or enter its path in the add-on's preferences"


def program_path():
    """Returns the program's path; None if it is not found."""
    addon = bpy.context.preferences.addons.get(__package__)
    named = addon.preferences.program if addon is not None else ""
    return shutil.which(bpy.path.abspath(named) if named else "lanthorn")


CLASSES = (LanthornSceneSettings, LanthornMaterialSettings, LanthornLayerSettings, LanthornPreferences)


def register():
    for c in CLASSES:
        bpy.utils.register_class(c)
    bpy.types.Scene.lanthorn = PointerProperty(type=LanthornSceneSettings)
    bpy.types.Material.lanthorn = PointerProperty(type=LanthornMaterialSettings)
    bpy.types.ViewLayer.lanthorn = PointerProperty(type=LanthornLayerSettings)


def unregister():
    del bpy.types.ViewLayer.lanthorn, bpy.types.Material.lanthorn, bpy.types.Scene.lanthorn
    for c in reversed(CLASSES):
        bpy.utils.unregister_class(c)
