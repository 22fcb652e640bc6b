# SPDX-FileCopyrightText: 2026 The Lanthorn authors
# SPDX-License-Identifier: Apache-2.0
"""What a user may set: of a scene, of a view layer, and of the add-on."""
import shutil

import bpy
from bpy.props import BoolProperty, EnumProperty, FloatProperty, IntProperty, PointerProperty, StringProperty

from . import presets

# The methods that a user may choose, as `lanthorn list` names them.
METHODS = [("auto", "Automatic", "The method that a pilot finds best for each part of the picture"),
           ("vcm", "Vertex connection and merging", "All kinds of light"),
           ("path", "Path tracing", "Without caustics of small lights"),
           ("probppm", "Progressive photon mapping", "Caustics of every kind"),
           ("bdpt", "Bidirectional path tracing", "Unbiased"),
           ("mlt", "Metropolis light transport", "For light that is hard to find")]


class LanthornSceneSettings(bpy.types.PropertyGroup):
    noise: FloatProperty(name="Noise", description="Stop when the picture's error is below this; 0: never",
                         default=2, min=0, max=100, soft_max=20, precision=1, subtype="PERCENTAGE")
    seconds: FloatProperty(name="Time", description="Stop after this time; 0: never", default=60, min=0, precision=0,
                           unit="TIME_ABSOLUTE")
    passes: IntProperty(name="Passes", description="Stop after so many passes; 0: as many as it takes", default=0,
                        min=0)
    method: EnumProperty(name="Method", items=METHODS, default="auto")
    denoise: BoolProperty(name="Denoise", description="Remove the noise of the finished picture", default=False)
    spectral: BoolProperty(name="Spectral", description="Render wavelengths, for dispersion; else red, green, blue",
                           default=False)
    max_depth: IntProperty(name="Depth", description="Longest path, in scattering events; 0: the method's own",
                           default=0, min=0)
    clamp: FloatProperty(name="Clamp", description="Limit of what a path adds to a pixel; 0: none", default=0, min=0)
    seed: IntProperty(name="Seed", default=0, min=0)
    bake_size: IntProperty(name="Baked Textures", default=1024, min=16, max=8192, subtype="PIXEL",
                           description="Width and height of the images in which node trees are baked that have no "
                                       "counterpart; a world's is half as high")

    def options(self):
        """The options of `lanthorn link`."""
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
        """Those of a picture that refines as long as it is looked at, until the noise is low enough."""
        options = self.options()
        options.pop("seconds", None)
        options.pop("passes", None)
        options["noise"] = min(options.get("noise", 0.02), 0.02)
        return options


class LanthornMaterialSettings(bpy.types.PropertyGroup):
    """What Blender's nodes do not have; of the material's Glass, Glossy or Principled node."""
    glass: EnumProperty(name="Index", items=presets.GLASS_ITEMS, default="NONE",
                        description="Measured index of refraction and dispersion, instead of the node's")
    abbe: FloatProperty(name="Abbe Number", default=0, min=0, soft_max=90, precision=1,
                        description="Dispersion around the node's index: about 60 for crown glass, 30 for flint; 0: none. "
                                    "Seen in spectral renders")
    film_thickness: FloatProperty(name="Thin Film", default=0, min=0, soft_max=1000, precision=0,
                                  description="Thickness of a film on the outside, in nanometres; 0: none")
    film_eta: FloatProperty(name="Film Index", default=1.33, min=1, soft_max=2.5, precision=3)
    metal: EnumProperty(name="Metal", items=presets.METAL_ITEMS, default="NONE",
                        description="Measured index and absorption, instead of the node's colour")


class LanthornLayerSettings(bpy.types.PropertyGroup):
    use_caustic: BoolProperty(name="Caustic", description="Light that mirrors and glass have gathered", default=True)
    use_direct: BoolProperty(name="Direct", default=False)
    use_indirect: BoolProperty(name="Indirect", default=False)
    use_media: BoolProperty(name="Media", description="Light out of fog, smoke, water", default=False)
    use_error: BoolProperty(name="Error", description="One standard error of the picture", default=False)


class LanthornPreferences(bpy.types.AddonPreferences):
    bl_idname = __package__

    program: StringProperty(name="Program", description="lanthorn; empty: the one on the PATH", subtype="FILE_PATH")

    def draw(self, _context):
        self.layout.prop(self, "program")
        found = program_path()
        self.layout.label(text=found or MISSING, icon="CHECKMARK" if found else "ERROR")


MISSING = "The program lanthorn was not found on the PATH: install it, or name it in the add-on's preferences"


def program_path():
    """The program's path; none if it is not there."""
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
