# SPDX-FileCopyrightText: 2026 The Lanthorn authors
# SPDX-License-Identifier: Apache-2.0
"""Translates a depsgraph to the parts of a scene for `lanthorn link`."""
import collections
import tempfile

from . import camera, hair, lights, media, meshes, volumes, world
from .bake import Bakes
from .materials import Materials
from .report import Report
from .textures import ImageFiles

MESH_TYPES = {"MESH", "META"}
# Besides a curve, surface or text, the depsgraph shows its mesh as a separate instance. If particles instance the curve,
# this mesh is missing, and Blender's own engines do not draw it either.
SHOWN_AS_MESHES = {"CURVE", "SURFACE", "FONT"}
IGNORED_TYPES = SHOWN_AS_MESHES | {"CAMERA", "EMPTY", "ARMATURE", "LATTICE", "SPEAKER", "LIGHT_PROBE", "GPENCIL"}
VISIBILITIES = ("visible_diffuse", "visible_glossy", "visible_transmission", "visible_volume_scatter", "visible_shadow")
MOST_LAMPS = 1000000  # emitting triangles, each instance counted
TABLES = ("float_textures", "spectrum_textures", "materials", "media", "area_lights", "shapes", "objects", "instances",
          "lights")


def empty_parts():
    return {table: {} for table in TABLES}


class SceneExport:
    """Exports a scene and remembers the parts that were sent, so that `changes` returns only new ones. Images without
    a file are written to a temporary folder, which is deleted with this object."""

    def __init__(self):
        self.folder = tempfile.TemporaryDirectory(prefix="lanthorn-")
        self.report = Report()
        self._images = ImageFiles(self.folder.name)
        self.is_unfinished = False  # True if the scene must be exported again after the bake
        self.bakes = Bakes(self.folder.name)
        self._sent, self._is_viewport = empty_parts(), False
        self._surfaces = {}  # (names of data-blocks, surface) by key, kept until `forget`

    def forget(self, depsgraph):
        """Removes the meshes that have changed since the last export."""
        names = {update.id.name_full for update in depsgraph.updates if update.is_updated_geometry}
        if names:
            self._surfaces = {key: made for key, made in self._surfaces.items() if not names & made[0]}

    def close(self):
        self.bakes.close()
        self.folder.cleanup()

    def parts(self, depsgraph, space=None):
        """Returns all visible objects, materials and lights, without the camera. `space` is the viewport's space, if any."""
        parts = empty_parts()
        self.report, self._is_viewport = Report(), space is not None
        materials = Materials(parts, self.report, self._images, self.bakes)
        scene_world = depsgraph.scene_eval.world
        if scene_world is not None:
            materials.around = world.volume_of_world(scene_world, self.report)
        for instance in depsgraph.object_instances:
            is_shown = instance.show_self and (space is None or instance.object.visible_in_viewport_get(space))
            if is_shown and not self._is_repeated(instance.object):
                self._add_instance(parts, materials, instance)
        if scene_world is not None:
            parts["lights"].update(world.lights_of_world(scene_world, self.report, self.bakes))
        self._put_out_crowds(parts, materials)
        if materials.around is not None:
            self._fill_world(parts, materials.around)
        self.is_unfinished = bool(materials.unfinished)
        return parts

    def _fill_world(self, parts, around):
        """Puts everything into the world's volume. No light arrives from infinitely far away, as in Cycles."""
        far = [name for name, light in parts["lights"].items() if light["type"] in {"distant", "infinite"}]
        for name in far:
            del parts["lights"][name]
        if far:
            self.report.note("world", "suns and the world's surface are dark: the world's volume absorbs their light")
        parts["media"][media.OF_WORLD] = media.part_of(around)
        for light in parts["lights"].values():
            light["medium"] = media.OF_WORLD
        for shape in [*parts["shapes"].values(), *(s for made in parts["objects"].values() for s in made["shapes"])]:
            shape.setdefault("outside_medium", media.OF_WORLD)
            shape.setdefault("inside_medium", media.OF_WORLD)

    def _put_out_crowds(self, parts, materials):
        """Limits the number of emitting triangles: the meshes with the most instances reflect light instead."""
        places = collections.Counter(instance["object"] for instance in parts["instances"].values())
        crowds = [(places[key] * len(shape["triangles"]), key, shape) for key, made in parts["objects"].items()
                  for shape in made["shapes"] if "area_light" in shape]
        total = sum(count for count, *_ in crowds)
        for count, key, shape in sorted(crowds, key=lambda crowd: -crowd[0]):
            if total <= MOST_LAMPS:
                break
            total -= count
            self.report.note(key.split("|")[0], f"more than {MOST_LAMPS} triangles would emit light: this mesh reflects its colour instead")
            materials.put_out(shape)

    @staticmethod
    def camera_medium(parts):
        """Returns the member of the camera that names the medium around it, if there is one."""
        return {"medium": media.OF_WORLD} if media.OF_WORLD in parts["media"] else {}

    def bake(self, parts, is_cancelled):
        """Bakes the images that the parts refer to, and waits for them."""
        if self.bakes.are_missing:
            self.bakes.run(is_cancelled)
        if self.bakes.problem:
            self.report.note("bake", f"{self.bakes.problem}: grey is used instead")
        self.settle(parts)

    def settle(self, parts):
        """Replaces missing images with grey."""
        baked = parts["lights"].pop(world.BAKED, None)
        if baked is not None:
            parts["lights"].update(world.lights_of_bake(baked["path"]))
        self.bakes.replace_missing(parts)

    def _note_object(self, object):
        """Notes unsupported properties of an object."""
        if not all(getattr(object, flag, True) for flag in VISIBILITIES):
            self.report.note(object.name, "of Ray Visibility, only Camera is supported: all other rays meet the object")
        if getattr(object, "lightgroup", ""):  # from Blender 3.2 on
            self.report.note(object.name, "light groups are not supported: they get no passes")
        if object.type != "LIGHT" and (object.is_holdout or object.is_shadow_catcher):
            self.report.note(object.name, "holdouts and shadow catchers are rendered as ordinary objects")

    def _add_instance(self, parts, materials, instance):
        object, matrix = instance.object, instance.matrix_world.copy()
        name = self.name_of(instance)
        if object.type not in IGNORED_TYPES:
            self._note_object(object)
        if object.type == "LIGHT":
            lights.add_light(parts, name, object, matrix, self.report)
        elif object.type in MESH_TYPES:
            key = self._mesh_key(object)
            if key not in parts["objects"]:
                parts["objects"][key] = self._shapes(key, object, materials, camera.rows(matrix))
            self._add_hair(parts, materials, instance, name)
            if parts["objects"][key]["shapes"]:
                parts["instances"][name] = {"object": key, "object_to_world": camera.rows(matrix)}
        elif object.type == "CURVES":
            self._add_curves(parts, materials, object, name, matrix)
        elif object.type == "VOLUME":
            self._add_volume(parts, materials, object, name, camera.rows(matrix))
        elif object.type not in IGNORED_TYPES:
            self.report.note(object.name, f"objects of type {object.type} are not supported: they are left out")

    def _add_volume(self, parts, materials, object, name, to_world):
        key = f"{object.name_full}|VOLUME"
        if key not in self._surfaces:
            fields = volumes.of_volume(object, self.report)
            self._surfaces[key] = {object.name_full, object.data.name_full}, fields and volumes.Box(key, fields)
        box = self._surfaces[key][1]
        if box is None:
            return
        if not object.visible_camera:
            self.report.note(object.name, "a volume cannot be hidden from the camera")
        box.object_name, box.to_world = object.name, to_world
        material = object.material_slots[0].material if len(object.material_slots) else None
        parts["objects"][key] = {"shapes": [{**box.shape(), **materials.box_members(material, box)}]}
        parts["instances"][name] = {"object": key, "object_to_world": to_world}

    def _add_hair(self, parts, materials, instance, name):
        if instance.is_instance:
            if len(instance.object.particle_systems):
                self.report.note(instance.object.name, "hair of instances is not supported: it is left out")
            return
        for strands in hair.strands(instance.object, self._is_viewport):
            key = f"{name}/{strands.system.name}"
            material = self._material_of(instance.object, strands.slot)
            image, seen = materials.image_of_fibres(material), self._visibility(instance.object)
            roots = strands.roots() if image is not None else None
            if roots is None:
                parts["shapes"][key] = {**strands.shape(), **materials.fibre_members(material), **seen}
                continue
            for number, (color, chosen) in enumerate(hair.groups_of_color(image, roots)):
                parts["shapes"][f"{key}/{number}"] = {**strands.shape(chosen), **materials.fibre_members(material, color),
                                                     **seen}

    def _add_curves(self, parts, materials, object, name, matrix):
        curves = hair.curves_shape(object)
        if curves is not None:
            key = f"{name}|CURVES"
            members = {**materials.fibre_members(self._material_of(object, 0)), **self._visibility(object)}
            parts["objects"][key] = {"shapes": [{**curves, **members}]}
            parts["instances"][name] = {"object": key, "object_to_world": camera.rows(matrix)}

    @staticmethod
    def _visibility(object):
        """Returns the member of a shape that hides it from the camera, if the object's Ray Visibility says so."""
        return {} if object.visible_camera else {"visible_to_camera": False}

    @staticmethod
    def _material_of(object, slot):
        slots = object.material_slots
        return slots[min(slot, len(slots) - 1)].material if len(slots) else None

    @staticmethod
    def name_of(instance):
        """Returns a name for an instance or an object that does not change over time."""
        if not instance.is_instance:
            return instance.object.name_full
        numbers = [str(i) for i in instance.persistent_id if i != 2**31 - 1]
        return f"{instance.parent.name_full}/{instance.object.name_full}/{'.'.join(numbers)}"

    @staticmethod
    def _is_repeated(object):
        """Returns whether this is the mesh of a metaball, which the depsgraph shows beside the metaball itself."""
        return object.type == "MESH" and object.original.type == "META"

    @staticmethod
    def _mesh_key(object):
        """Returns a key that is equal for objects with the same mesh, materials and visibility."""
        slots = ",".join(slot.material.name_full if slot.material else "" for slot in object.material_slots)
        if not object.visible_camera:
            slots += "|hidden"
        if object.type != "MESH":
            return f"{object.name_full}|{object.type}|{slots}"
        # Geometry nodes can instance several meshes with the same name, of one object.
        data = object.data
        is_own = bool(object.original.modifiers) or object.original.type != "MESH"
        owner = f"{object.name_full}/{len(data.vertices)}/{len(data.polygons)}/" if is_own else ""
        return f"{owner}{data.name_full}|{object.type}|{slots}"

    def _shapes(self, key, object, materials, to_world):
        if key not in self._surfaces:
            self._surfaces[key] = {object.name_full, object.data.name_full}, self._surface(key, object)
            if self._surfaces[key][1] is not None:
                self._surfaces[key][1].fields = volumes.of_fluid(object)
        slots, shapes = object.material_slots, []
        surface = self._surfaces[key][1]
        if surface is None:
            return {"shapes": []}
        surface.object_name, surface.to_world = object.name, to_world
        for slot in surface.used_slots():
            material = slots[min(slot, len(slots) - 1)].material if len(slots) else None
            shapes.append({**materials.shape(material, surface, slot), **self._visibility(object)})
        return {"shapes": shapes}

    @staticmethod
    def _surface(key, object):
        """Returns a copy of the object's mesh; None if it has none."""
        mesh = object.to_mesh()
        data = object.original.data
        texspace = None
        if object.original.type == "MESH" and not object.modifiers:
            texspace = [list(data.texspace_location), list(data.texspace_size)]
        try:
            return meshes.Surface(mesh, key, texspace) if mesh is not None else None
        finally:
            object.to_mesh_clear()

    def changes(self, parts):
        """Returns the members `set` and `remove` of an update from the parts that were sent last to these."""
        changed, gone = {}, {}
        for table in TABLES:
            old, new = self._sent[table], parts[table]
            differing = {name: part for name, part in new.items() if name not in old or not is_equal(old[name], part)}
            if differing:
                changed[table] = differing
            missing = [name for name in old if name not in new]
            if missing:
                gone[table] = missing
        self._sent = parts
        return changed, gone


def is_equal(a, b):
    """Returns whether two parts are equal, arrays included."""
    if a is b:
        return True
    if isinstance(a, dict) and isinstance(b, dict):
        return a.keys() == b.keys() and all(is_equal(a[key], b[key]) for key in a)
    if isinstance(a, (list, tuple)) and isinstance(b, (list, tuple)):
        return len(a) == len(b) and all(is_equal(x, y) for x, y in zip(a, b))
    if hasattr(a, "dtype") and hasattr(b, "dtype"):
        return a.shape == b.shape and bool((a == b).all())
    return type(a) is type(b) and a == b
