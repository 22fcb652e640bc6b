# SPDX-FileCopyrightText: 2026 The Lanthorn authors
# SPDX-License-Identifier: Apache-2.0
"""Defines the panels of the interface. All settings have defaults for a first picture."""
import bpy

# Panels of Blender and Eevee that also apply to this engine.
SHARED_PREFIXES = ("RENDER_PT_", "VIEWLAYER_PT_", "MATERIAL_PT_", "DATA_PT_", "WORLD_PT_", "TEXTURE_PT_", "OBJECT_PT_",
                   "PARTICLE_PT_", "SCENE_PT_", "CAMERA_PT_")
EEVEE_PANELS = {"EEVEE_MATERIAL_PT_surface", "EEVEE_MATERIAL_PT_volume", "EEVEE_WORLD_PT_surface"}
VISIBLE_TYPES = {"MESH", "CURVE", "SURFACE", "META", "FONT", "CURVES", "LIGHT"}  # objects that can be hidden from the camera
NOT_SHARED = {"RENDER_PT_stamp_note", "RENDER_PT_simplify", "RENDER_PT_freestyle", "VIEWLAYER_PT_filter",
              "DATA_PT_EEVEE_light", "DATA_PT_EEVEE_shadow", "DATA_PT_spot"}


class LanthornPanel:
    bl_space_type = "PROPERTIES"
    bl_region_type = "WINDOW"
    COMPAT_ENGINES = {"LANTHORN"}
    subject = "scene"  # the member of the context that the panel is about

    @classmethod
    def poll(cls, context):
        return context.engine in cls.COMPAT_ENGINES and getattr(context, cls.subject, None) is not None


class LANTHORN_RENDER_PT_quality(LanthornPanel, bpy.types.Panel):
    bl_label = "Quality"
    bl_context = "render"

    def draw(self, context):
        layout, settings = self.layout, context.scene.lanthorn
        layout.use_property_split = True
        layout.prop(settings, "noise")
        layout.prop(settings, "seconds")
        layout.prop(settings, "denoise")


class LANTHORN_RENDER_PT_method(LanthornPanel, bpy.types.Panel):
    bl_label = "Method"
    bl_context = "render"
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, context):
        layout, settings = self.layout, context.scene.lanthorn
        layout.use_property_split = True
        for name in ("method", "passes", "spectral", "max_depth", "clamp", "seed", "bake_size"):
            layout.prop(settings, name)


class LANTHORN_VIEWLAYER_PT_passes(LanthornPanel, bpy.types.Panel):
    bl_label = "Passes"
    bl_context = "view_layer"

    def draw(self, context):
        layout, layer = self.layout, context.view_layer
        layout.use_property_split = True
        for name in ("use_pass_z", "use_pass_normal", "use_pass_position", "use_pass_emit"):
            layout.prop(layer, name)
        for name in ("use_caustic", "use_direct", "use_indirect", "use_media", "use_error"):
            layout.prop(layer.lanthorn, name)


class LANTHORN_MATERIAL_PT_measured(LanthornPanel, bpy.types.Panel):
    bl_label = "Measured Glass and Metal"
    bl_context = "material"
    bl_options = {"DEFAULT_CLOSED"}
    subject = "material"

    def draw(self, context):
        layout, own = self.layout, context.material.lanthorn
        layout.use_property_split = True
        layout.prop(own, "glass")
        column = layout.column()
        column.active = own.glass == "NONE"
        column.prop(own, "abbe")
        for name in ("film_thickness", "film_eta", "metal"):
            layout.prop(own, name)


class LANTHORN_LIGHT_PT_lamp(LanthornPanel, bpy.types.Panel):
    bl_label = "Light"
    bl_context = "data"
    subject = "light"

    def draw(self, context):
        layout, light = self.layout, context.light
        layout.use_property_split = True
        layout.row().prop(light, "type", expand=True)
        layout.prop(light, "color")
        layout.prop(light, "energy")
        if light.type in {"POINT", "SPOT"}:
            layout.prop(light, "shadow_soft_size", text="Radius")
        if light.type == "SUN":
            layout.prop(light, "angle")
        if light.type == "SPOT":
            layout.prop(light, "spot_size")
            layout.prop(light, "spot_blend")
        if light.type == "AREA":
            layout.prop(light, "shape")
            layout.prop(light, "size")
            if light.shape in {"RECTANGLE", "ELLIPSE"}:
                layout.prop(light, "size_y")
            layout.prop(light, "spread")


class LANTHORN_OBJECT_PT_visibility(LanthornPanel, bpy.types.Panel):
    bl_label = "Ray Visibility"
    bl_context = "object"
    bl_options = {"DEFAULT_CLOSED"}
    subject = "object"

    @classmethod
    def poll(cls, context):
        return super().poll(context) and context.object.type in VISIBLE_TYPES

    def draw(self, context):
        self.layout.use_property_split = True
        self.layout.prop(context.object, "visible_camera", text="Camera")


CLASSES = (LANTHORN_RENDER_PT_quality, LANTHORN_RENDER_PT_method, LANTHORN_VIEWLAYER_PT_passes, LANTHORN_MATERIAL_PT_measured,
           LANTHORN_LIGHT_PT_lamp, LANTHORN_OBJECT_PT_visibility)


def _shared_panels():
    for panel in bpy.types.Panel.__subclasses__():
        name, engines = panel.__name__, getattr(panel, "COMPAT_ENGINES", set())
        is_of_all = "BLENDER_RENDER" in engines and name.startswith(SHARED_PREFIXES) and name not in NOT_SHARED
        if is_of_all or name in EEVEE_PANELS:
            yield panel


def register():
    for c in CLASSES:
        bpy.utils.register_class(c)
    for panel in _shared_panels():
        panel.COMPAT_ENGINES.add("LANTHORN")


def unregister():
    for panel in _shared_panels():
        panel.COMPAT_ENGINES.discard("LANTHORN")
    for c in reversed(CLASSES):
        bpy.utils.unregister_class(c)
