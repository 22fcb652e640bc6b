# SPDX-FileCopyrightText: 2026 The Lanthorn authors
# SPDX-License-Identifier: Apache-2.0
"""A depsgraph as the parts of a scene that `lanthorn link` takes."""
import collections
import tempfile

from . import camera, hair, lights, meshes, volumes, world
from .bake import Bakes
from .materials import Materials
from .report import Report
from .textures import ImageFiles

MESH_TYPES = {"MESH", "CURVE", "SURFACE", "META", "FONT"}
IGNORED_TYPES = {"CAMERA", "EMPTY", "ARMATURE", "LATTICE", "SPEAKER", "LIGHT_PROBE", "GPENCIL"}
VISIBILITIES = ("visible_camera", "visible_diffuse", "visible_glossy", "visible_transmission", "visible_shadow")
MOST_LAMPS = 1000000  # triangles that emit, at all places
TABLES = ("float_textures", "spectrum_textures", "materials", "media", "area_lights", "shapes", "objects", "instances",
          "lights")


def empty_parts():
    return {table: {} for table in TABLES}


class SceneExport:
    """Exports a scene, and remembers what it has sent, so that `changes` returns only what is new. Images without a
    file are written to a temporary folder, which is deleted with this object."""

    def __init__(self):
        self.folder = tempfile.TemporaryDirectory(prefix="lanthorn-")
        self.report = Report()
        self._images = ImageFiles(self.folder.name)
        self.is_unfinished = False  # parts that must be exported again after the bake
        self.bakes = Bakes(self.folder.name)
        self._sent, self._is_viewport = empty_parts(), False
        self._surfaces = {}  # names and surface, by key; kept until `forget`

    def forget(self, depsgraph):
        """Drops the meshes that have changed since the last export."""
        names = {update.id.name_full for update in depsgraph.updates if update.is_updated_geometry}
        if names:
            self._surfaces = {key: made for key, made in self._surfaces.items() if not names & made[0]}

    def close(self):
        self.bakes.close()
        self.folder.cleanup()

    def parts(self, depsgraph, space=None):
        """All objects, materials and lights that are seen; without the camera. `space`: of a viewport."""
        parts = empty_parts()
        self.report, self._is_viewport = Report(), space is not None
        materials = Materials(parts, self.report, self._images, self.bakes)
        for instance in depsgraph.object_instances:
            if instance.show_self and (space is None or instance.object.visible_in_viewport_get(space)):
                self._add_instance(parts, materials, instance)
        scene_world = depsgraph.scene_eval.world
        if scene_world is not None:
            parts["lights"].update(world.lights_of_world(scene_world, self.report, self.bakes))
        self._put_out_crowds(parts, materials)
        self.is_unfinished = bool(materials.unfinished)
        return parts

    def _put_out_crowds(self, parts, materials):
        """Limits the number of lights. Every instance of an emitting triangle is one, which crowds of instances make too many."""
        places = collections.Counter(instance["object"] for instance in parts["instances"].values())
        crowds = [(places[key] * len(shape["triangles"]), key, shape) for key, made in parts["objects"].items()
                  for shape in made["shapes"] if "area_light" in shape]
        total = sum(count for count, *_ in crowds)
        for count, key, shape in sorted(crowds, key=lambda crowd: -crowd[0]):
            if total <= MOST_LAMPS:
                break
            total -= count
            self.report.note(key.split("|")[0], f"more than {MOST_LAMPS} triangles would emit: this mesh reflects the colour instead")
            materials.put_out(shape)

    def bake(self, parts, is_cancelled):
        """Makes the images that the parts refer to, and waits for them."""
        if self.bakes.are_missing:
            self.bakes.run(is_cancelled)
        if self.bakes.problem:
            self.report.note("bake", f"{self.bakes.problem}: grey is used instead")
        self.settle(parts)

    def settle(self, parts):
        """Puts grey in the place of images that are not there."""
        baked = parts["lights"].pop(world.BAKED, None)
        if baked is not None:
            parts["lights"].update(world.lights_of_bake(baked["path"]))
        self.bakes.replace_missing(parts)

    def _note_object(self, object):
        """What objects have beside shape, place and material."""
        if not all(getattr(object, flag, True) for flag in VISIBILITIES):
            self.report.note(object.name, "is seen by all rays: ray visibility has no counterpart")

    def _add_instance(self, parts, materials, instance):
        object, matrix = instance.object, instance.matrix_world.copy()
        name = self.name_of(instance)
        if object.type == "LIGHT":
            lights.add_light(parts, name, object.data, matrix, self.report)
        elif object.type in MESH_TYPES:
            self._note_object(object)
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
            self.report.note(object.name, f"objects of the type {object.type} are left out")

    def _add_volume(self, parts, materials, object, name, to_world):
        key = f"{object.name_full}|VOLUME"
        if key not in self._surfaces:
            fields = volumes.of_volume(object, self.report)
            self._surfaces[key] = {object.name_full, object.data.name_full}, fields and volumes.Box(key, fields)
        box = self._surfaces[key][1]
        if box is None:
            return
        box.object_name, box.to_world = object.name, to_world
        material = object.material_slots[0].material if len(object.material_slots) else None
        parts["objects"][key] = {"shapes": [{**box.shape(), **materials.box_members(material, box)}]}
        parts["instances"][name] = {"object": key, "object_to_world": to_world}

    def _add_hair(self, parts, materials, instance, name):
        if instance.is_instance:
            if len(instance.object.particle_systems):
                self.report.note(instance.object.name, "hair of instances is left out")
            return
        for strands in hair.strands(instance.object, self._is_viewport):
            key = f"{name}/{strands.system.name}"
            material = self._material_of(instance.object, strands.slot)
            image = materials.image_of_fibres(material)
            roots = strands.roots() if image is not None else None
            if roots is None:
                parts["shapes"][key] = {**strands.shape(), **materials.fibre_members(material)}
                continue
            for number, (color, chosen) in enumerate(hair.groups_of_color(image, roots)):
                parts["shapes"][f"{key}/{number}"] = {**strands.shape(chosen), **materials.fibre_members(material, color)}

    def _add_curves(self, parts, materials, object, name, matrix):
        curves = hair.curves_shape(object)
        if curves is not None:
            key = f"{name}|CURVES"
            parts["objects"][key] = {"shapes": [{**curves, **materials.fibre_members(self._material_of(object, 0))}]}
            parts["instances"][name] = {"object": key, "object_to_world": camera.rows(matrix)}

    @staticmethod
    def _material_of(object, slot):
        slots = object.material_slots
        return slots[min(slot, len(slots) - 1)].material if len(slots) else None

    @staticmethod
    def name_of(instance):
        """The name of an instance, or of an object that is there once; the same at every time."""
        if not instance.is_instance:
            return instance.object.name_full
        numbers = [str(i) for i in instance.persistent_id if i != 2**31 - 1]
        return f"{instance.parent.name_full}/{instance.object.name_full}/{'.'.join(numbers)}"

    @staticmethod
    def _mesh_key(object):
        """Objects of one key have the same mesh and the same materials."""
        slots = ",".join(slot.material.name_full if slot.material else "" for slot in object.material_slots)
        if object.type != "MESH":
            return f"{object.name_full}|{object.type}|{slots}"
        # Geometry nodes may instance several meshes of one object, even meshes with the same name.
        data = object.data
        owner = f"{object.name_full}/{len(data.vertices)}/{len(data.polygons)}/" if object.modifiers else ""
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
            shapes.append(materials.shape(material, surface, slot))
        return {"shapes": shapes}

    @staticmethod
    def _surface(key, object):
        """None if there is no mesh."""
        mesh = object.to_mesh()
        data = object.original.data
        texspace = None
        if object.type == "MESH" and not object.modifiers:
            texspace = [list(data.texspace_location), list(data.texspace_size)]
        try:
            return meshes.Surface(mesh, key, texspace) if mesh is not None else None
        finally:
            object.to_mesh_clear()

    def changes(self, parts):
        """The members `set` and `remove` of an update that leads from what was sent to these parts."""
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
    """Whether two parts are the same, arrays included."""
    if a is b:
        return True
    if isinstance(a, dict) and isinstance(b, dict):
        return a.keys() == b.keys() and all(is_equal(a[key], b[key]) for key in a)
    if isinstance(a, (list, tuple)) and isinstance(b, (list, tuple)):
        return len(a) == len(b) and all(is_equal(x, y) for x, y in zip(a, b))
    if hasattr(a, "dtype") and hasattr(b, "dtype"):
        return a.shape == b.shape and bool((a == b).all())
    return type(a) is type(b) and a == b
