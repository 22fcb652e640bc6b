# SPDX-FileCopyrightText: 2026 The Lanthorn authors
# SPDX-License-Identifier: Apache-2.0
"""Translates node materials to materials, emission and media of Lanthorn."""
import math
from dataclasses import dataclass

import numpy

from . import hair as fibres
from . import media, presets
from .textures import Textures, is_native

BLACK = [0.0, 0.0, 0.0]
OPAQUE = 1.0
HALFWAY = 0.5
OLD_CLEARCOAT = 0.25  # the factor in Blender 3
# Fibres of this roughness, times this factor, have the albedo of Blender 3's sheen within 10 % at all angles.
OLD_SHEEN, OLD_SHEEN_ROUGHNESS = 0.089, 0.4
# For each sigma of Velvet: the roughness of fibres, and factors for the colours of fibres and of the surface below. The
# mean albedo equals that of Cycles' velvet (Ashikhmin). At angles where the albedo is large, it is within 25 %.
VELVET_SIGMA = [0.0, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 1.0]
VELVET_ROUGHNESS = [0.15, 0.15, 0.16, 0.25, 0.35, 0.38, 0.41, 0.42, 0.44, 0.44, 0.44]
VELVET_FIBRES = [0.0, 0.16, 0.70, 0.86, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0]
VELVET_BASE = [0.0, 0.0, 0.0, 0.0, 0.004, 0.061, 0.124, 0.19, 0.254, 0.316, 0.37]
SUBSURFACE = "subsurface scattering is rendered as diffuse reflection"
NO_SUBDIVISION = 1e9  # metres; longer than any edge


@dataclass
class Look:
    """The translation of a shader node: its material (None if it only emits or transmits straight), emission and alpha."""

    material: dict | None = None
    emission: object = None  # a colour or a texture
    strength: float = 1.0
    alpha: object = OPAQUE
    hole: object = None  # the colour socket of a Transparent shader


def clamped(color):
    return [min(1.0, max(0.0, c)) for c in color] if isinstance(color, list) else color


def is_black(color):
    return color is None or (isinstance(color, list) and max(color) <= 0)


def eta_of_blend(blend):
    """Returns the index of refraction of a Layer Weight node's Fresnel output."""
    return 1 / (1 - min(0.999, max(0.0, blend)))


class Materials:
    """Adds the materials of a scene, with their textures, media and area lights, to its parts."""

    def __init__(self, parts, report, images, bakes):
        self.parts, self.report, self.bakes = parts, report, bakes
        self.textures = Textures(parts, report, images, bakes)
        self._done, self._kinds, self._mixes, self._tangent = {}, {}, 0, None
        self.around = None  # the world's volume, see media.medium
        self.unfinished = []  # materials whose media must be exported again after a bake

    def shape(self, material, surface, slot):
        """Returns the triangles of a slot as a shape, with the members of its material."""
        name = material.name_full if material is not None else ""
        kind = name, surface.fields is not None
        if kind not in self._kinds:
            self._kinds[kind] = self._kind(material, surface)
        is_baked, is_atlas, is_grid = self._kinds[kind]
        is_of_surface = is_atlas or is_grid or (is_baked and not self._fills_unit_square(surface, slot))
        key = (name, surface.key, slot) if is_of_surface else (name,)
        if key not in self._done:
            self._done[key] = self._add(material, surface, slot, is_atlas, " on ".join(map(str, key)))
        members, colors, tangent = self._done[key]
        if is_atlas:
            triangles = surface.atlas_shape(slot, self.bakes.size, tangent)
        else:
            triangles = surface.shape(slot, colors, "displacement" in members, tangent)
        return {"type": "triangles", **triangles, **members}

    def box_members(self, material, box):
        """Returns the members of the box around a volume object, with its medium."""
        key, members = f"{material.name_full if material is not None else ''} in {box.key}", {"material": self._interface()}
        self.textures.begin(material, box, 0, False, key)
        output = self._output(material)
        volume = self.textures.source(output.inputs["Volume"]) if output is not None else None
        if volume is None:
            self.report.note(box.object_name, "a volume without a volume shader is invisible")
            return members
        medium = self._medium(volume.node, material)
        if medium is not None:
            self.parts["media"][key] = medium
            members.update(self._media_members(key))
        return members

    def _media_members(self, inside):
        """Returns the members of a shape that contains this medium."""
        return {"inside_medium": inside, **({} if self.around is None else {"outside_medium": media.OF_WORLD})}

    def _interface(self):
        self.parts["materials"].setdefault("interface", {"type": "interface"})
        return "interface"

    def fibre_members(self, material, color=None):
        """Returns the members of curves with this material. Fibres have no texture coordinates: `color`, the colour at the
        root, replaces images."""
        name = "fibres " + (material.name_full if material is not None else "")
        key = name if color is None else f"{name} of {' '.join(f'{c:.4f}' for c in color)}"
        if key not in self._done:
            self.textures.color_at_root = color
            self._done[key] = self._add(material, None, 0, False, key)
            self.textures.color_at_root = None
            self._put_out(self._done[key][0], material)
        return {k: v for k, v in self._done[key][0].items() if k != "displacement"}

    def image_of_fibres(self, material):
        """Returns the image of a material; None if it has none, or one without pixels."""
        output = self._output(material)
        if output is None:
            return None
        self.textures.groups = []
        images = [node.image for node, outputs in self.textures.nodes_behind([output.inputs["Surface"]])
                  if node.type == "TEX_IMAGE" and "Color" in outputs and node.image is not None and node.image.size[0]]
        if len(set(images)) > 1:
            self.report.note(material.name, "hair takes its colour from its first image: the other images are ignored")
        return images[0] if images else None

    def _put_out(self, members, material):
        """Removes the emission of fibres, because each fibre would be a light of many triangles."""
        if "area_light" in members:
            self.report.note(material.name, "hair cannot emit light: it reflects its colour instead")
            lamp = members["area_light"]
            self.put_out(members)
            del self.parts["area_lights"][lamp]

    def put_out(self, members):
        """Removes the emission of a shape. A black surface reflects the emitted colour instead."""
        lamp, materials = members.pop("area_light"), self.parts["materials"]
        if materials[members["material"]] == {"type": "diffuse", "reflectance": BLACK}:
            unlit = f"{members['material']} that reflects"
            materials[unlit] = {"type": "diffuse", "reflectance": clamped(self.parts["area_lights"][lamp]["radiance"])}
            members["material"] = unlit

    @staticmethod
    def _fills_unit_square(surface, slot):
        low, high = surface.uv_bounds(slot)
        return not low.any() and (high == 1).all()

    def _output(self, material):
        if material is None or not (material.use_nodes and material.node_tree):
            return None
        return material.node_tree.get_output_node("CYCLES") or material.node_tree.get_output_node("ALL")

    def _kind(self, material, surface):
        """Returns three flags: the material needs baked images; they need an atlas of triangles; its volume varies."""
        output = self._output(material)
        if output is None:
            return False, False, False
        self.textures.groups = []
        nodes = [(node, outputs) for node, outputs in
                 self.textures.nodes_behind([output.inputs["Surface"], output.inputs["Displacement"]])
                 if node.type not in SHADERS]
        is_baked = any(not is_native(node) for node, _ in nodes)
        solid = {node.type for node, outputs in nodes if self.textures.is_solid(node, outputs)}
        if not is_baked:
            solid -= {"VERTEX_COLOR"}
        volume = self.textures.source(output.inputs["Volume"])
        is_grid = volume is not None and (surface.fields is not None or self.textures.varies_in_space(volume))
        return is_baked or bool(solid), bool(solid), is_grid

    def _add(self, material, surface, slot, is_atlas, key):
        name = f"material {key}"
        self.textures.begin(material, surface, slot, is_atlas, key)
        self._mixes, self._tangent = 0, None
        look, medium, moved = self._look_of(material)
        is_seen = look.material is not None or not is_black(look.emission)
        node = look.material or ({"type": "diffuse", "reflectance": BLACK} if is_seen else {"type": "interface"})
        self.parts["materials"][name] = node
        members = {"material": name}
        if medium is not None:
            self.parts["media"][name] = medium
            members.update(self._media_members(name))
        if not is_black(look.emission) and look.strength > 0:
            self.parts["area_lights"][name] = {"radiance": look.emission, "scale": look.strength, "two_sided": True}
            members["area_light"] = name
        if is_seen and look.alpha != OPAQUE:
            members["alpha"] = look.alpha
        return {**members, **moved}, self.textures.uses_colors, self._tangent

    def _look_of(self, material):
        """Returns the look, the medium, and the member of the shape that displaces it."""
        if material is None:
            return Look({"type": "diffuse", "reflectance": [0.8] * 3}), None, {}
        if not (material.use_nodes and material.node_tree):
            return Look({"type": "diffuse", "reflectance": list(material.diffuse_color[:3])}), None, {}
        output = self._output(material)
        if output is None:
            return Look({"type": "diffuse", "reflectance": BLACK}), None, {}
        surface = self.textures.source(output.inputs["Surface"])
        volume = self.textures.source(output.inputs["Volume"])
        medium = self._medium(volume.node, material) if volume is not None else None
        if surface is None:
            return (Look() if medium is not None else Look({"type": "diffuse", "reflectance": BLACK})), medium, {}
        look = self._with_measured(self._look_of_output(surface, material.name), material)
        return look, medium, self._displacement(output.inputs["Displacement"], material, look)

    def _medium(self, node, material):
        volume = media.Volume(material.name, self.textures, self.report)
        made = media.medium(volume, node, self.around)
        if volume.is_missing:  # until the bake is finished, the sockets' own values are used
            self.unfinished.append(material.name)
        return made

    @staticmethod
    def _with_measured(look, material):
        """Adds the measured index, dispersion and thin film of the material's own properties."""
        own, made = material.lanthorn, look.material
        if made is None:
            return look
        if made["type"] == "dielectric":
            if own.glass != "NONE":
                made["eta"] = presets.eta(own.glass)
            elif own.abbe > 0:
                made["eta"] = presets.of_abbe_number(made["eta"], own.abbe)
            if own.film_thickness > 0:
                made["film"] = {"thickness": own.film_thickness, "eta": own.film_eta}
        elif made["type"] == "conductor" and own.metal != "NONE":
            made.pop("reflectance", None)
            made.update(presets.metal(own.metal))
        return look

    def _displacement(self, socket, material, look):
        """Translates displacement. Cycles moves vertices, changes normals, or both, as the material says."""
        output = self.textures.source(socket)
        if output is None:
            return {}
        node, method = output.node, getattr(material.cycles, "displacement_method", "BUMP")
        method = getattr(material, "displacement_method", method)
        if node.type != "DISPLACEMENT":
            self.report.note(material.name, f"the node {node.bl_label} as displacement is not supported: it is left out")
            return {}
        height = self.textures.number(node.inputs["Height"], material.name)
        scale = self.textures.constant(node.inputs["Scale"], material.name, "the scale of a displacement")
        if not isinstance(height, dict) or scale == 0:
            return {}
        moved = self._scaled(height, scale, node.inputs["Midlevel"].default_value if method != "BUMP" else 0)
        if method == "BUMP":
            self._bend(look.material, moved)
            return {}
        if self.textures.is_atlas:
            self.report.note(material.name, "displacement that depends on more than UV changes normals, but moves no vertices")
            self._bend(look.material, self._scaled(height, scale, 0))
            return {}
        # Vertices move, as in Cycles without adaptive subdivision.
        return {"displacement": {"height": moved, "edge_length": NO_SUBDIVISION}}

    def _scaled(self, height, scale, middle):
        """Returns scale * (height - middle)."""
        name = f"{height['texture']}*{scale}-{middle}"
        self.parts["float_textures"][name] = {"type": "mix", "tex1": -scale * middle, "tex2": scale * (1 - middle),
                                              "amount": height}
        return {"texture": name}

    def _bend(self, material, height):
        """Adds the bump height to all closures of the material without a bump or normal map."""
        if material is None:
            return
        if material["type"] == "mix":
            for name in material["materials"]:
                self._bend(self.parts["materials"][name], height)
        elif material["type"] != "interface":
            material.setdefault("displacement", height)

    def _look(self, node, owner):
        make = SHADERS.get(node.type)
        if make is None:
            self.report.note(owner, f"the shader {node.bl_label} is not supported: a grey diffuse one replaces it")
            return Look({"type": "diffuse", "reflectance": [HALFWAY] * 3})
        return make(self, node, owner)

    def _input_look(self, socket, owner):
        source = self.textures.source(socket)
        return self._look_of_output(source, owner) if source is not None else Look({"type": "diffuse", "reflectance": BLACK})

    def _look_of_output(self, output, owner):
        """Translates the output of a shader, or of a colour, which emits as in Cycles."""
        if output.type == "SHADER":
            return self._look(output.node, owner)
        return Look(emission=self.textures.color_of(output, owner) or [HALFWAY] * 3)

    def _count(self):
        """Returns a number for each mix of a material, the same at each export."""
        self._mixes += 1
        return self._mixes

    def _solid(self, node, owner, **material):
        """Returns a closure with the bump or normal map of its shader node."""
        return {**material, **self._relief(node, owner)}

    def _relief(self, node, owner):
        """Returns the member normal_map or displacement, if the shader node has one."""
        socket = node.inputs.get("Normal")
        source = self.textures.source(socket) if socket is not None else None
        if source is None:
            return {}
        if source.node.type == "NORMAL_MAP":
            made = self.textures.normal_map(source.node, owner)
            return {"normal_map": made} if made else {}
        if source.node.type == "BUMP":
            return self._bump(source.node, owner)
        self.report.note(owner, f"the node {source.node.bl_label} as a normal is not supported: it is left out")
        return {}

    def _bump(self, node, owner):
        height = self.textures.number(node.inputs["Height"], owner)
        if not isinstance(height, dict):
            return {}
        distance = (self.textures.constant(node.inputs["Distance"], owner, "the distance of a bump")
                    * self.textures.constant(node.inputs["Strength"], owner, "the strength of a bump"))
        return {"displacement": self._scaled(height, -distance if node.invert else distance, 0)}

    def _roughness(self, node, owner, name="Roughness"):
        alpha = self.textures.squared(self.textures.number(node.inputs[name], owner), owner)
        return {"u": alpha, "v": alpha, "remap": False}

    def _albedo(self, node, owner, name="Color"):
        return clamped(self.textures.color(node.inputs[name], owner))

    def _constant(self, node, owner, name, what):
        """Returns the value of an input that must be constant."""
        return self.textures.constant(node.inputs[name], owner, what)

    # Shaders.

    def diffuse(self, node, owner):
        return Look(self._solid(node, owner, type="diffuse", reflectance=self._albedo(node, owner)))

    def translucent(self, node, owner):
        return Look(self._solid(node, owner, type="diffusetransmission", reflectance=BLACK,
                                transmittance=self._albedo(node, owner)))

    def transparent(self, node, owner):
        socket = node.inputs["Color"]
        if socket.is_linked or tuple(socket.default_value[:3]) != (1, 1, 1):
            self.report.note(owner, "the colour of a Transparent shader is not supported")
        return Look(alpha=0.0, hole=socket)

    def emission(self, node, owner):
        emission, strength = self._emitted(node.inputs["Color"], node.inputs["Strength"], owner)
        return Look(emission=emission, strength=strength)

    def _emitted(self, color, strength, owner):
        """Returns the radiance and its factor."""
        color, strength = self.textures.color(color, owner), self.textures.number(strength, owner)
        if not isinstance(strength, dict):
            return color, strength
        name = f"{self.textures.prefix}/emission{self._count()}"
        self.parts["spectrum_textures"][name] = {"type": "scale", "tex": color, "scale": strength}
        return {"texture": name}, 1.0

    def glossy(self, node, owner):
        made = self._metal(node, owner, "Color")
        anisotropy = node.inputs.get("Anisotropy")  # of Anisotropic BSDFs, and from Blender 4 on of Glossy
        if anisotropy is not None:
            amount = min(0.99, max(-0.99, self.textures.constant(anisotropy, owner, "anisotropy")))
            factors = (1 - amount, 1 / (1 - amount)) if amount >= 0 else (1 / (1 + amount), 1 + amount)
            self._brush(made, node, owner, factors, "Rotation")
        return Look(made)

    def _brush(self, made, node, owner, factors, rotation):
        """Sets the roughness of an anisotropic metal along and across its tangent."""
        if factors == (1, 1):
            return
        alpha = made["roughness"]["u"]
        made["roughness"] = {"u": self._times(alpha, factors[0]), "v": self._times(alpha, factors[1]), "remap": False}
        turn = self._constant(node, owner, rotation, "the rotation of anisotropy")
        tangent = (*self._direction_of_tangent(node.inputs.get("Tangent"), owner), turn)
        if self._tangent not in (None, tangent):
            self.report.note(owner, "a material can have only one tangent: the last one is used")
        self._tangent = tangent

    def _direction_of_tangent(self, socket, owner):
        """Returns ("RADIAL", axis) or ("UV", name of the layer)."""
        source = self.textures.source(socket) if socket is not None else None
        if source is None:
            return "RADIAL", "Z"
        if source.node.type == "TANGENT":
            node = source.node
            return ("RADIAL", node.axis) if node.direction_type == "RADIAL" else ("UV", node.uv_map)
        self.report.note(owner, f"the node {source.node.bl_label} as a tangent is not supported: it is ignored")
        return "RADIAL", "Z"

    def _dielectric(self, node, owner, color):
        # At each interface, Cycles multiplies by the colour, Lanthorn by the square root of the tint.
        tint = self.textures.color(node.inputs[color], owner)
        if isinstance(tint, list):
            tint = [c * c for c in clamped(tint)]
        eta = max(1.0001, self._constant(node, owner, "IOR", "the index of refraction"))
        return self._solid(node, owner, type="dielectric", eta=eta, tint=tint, roughness=self._roughness(node, owner))

    def glass(self, node, owner):
        return Look(self._dielectric(node, owner, "Color"))

    def refraction(self, node, owner):
        self.report.note(owner, "a Refraction shader is rendered as Glass, which also reflects")
        return self.glass(node, owner)

    def subsurface(self, node, owner):
        self.report.note(owner, SUBSURFACE)
        return self.diffuse(node, owner)

    def velvet(self, node, owner):
        sigma = self._constant(node, owner, "Sigma", "the sigma of velvet")
        roughness, fibres, base = (float(numpy.interp(sigma, VELVET_SIGMA, values))
                                   for values in (VELVET_ROUGHNESS, VELVET_FIBRES, VELVET_BASE))
        color = self._albedo(node, owner)
        return Look(self._solid(node, owner, type="plastic", specular=0.0, sheen_roughness=roughness,
                                sheen_color=self._times_color(color, fibres), reflectance=self._times_color(color, base)))

    def _times_color(self, color, factor):
        if isinstance(color, list):
            return [factor * c for c in color]
        name = f"{color['texture']}*{factor}"
        self.parts["spectrum_textures"][name] = {"type": "scale", "tex": color, "scale": factor}
        return {"texture": name}

    def hair(self, node, owner):
        number = lambda name: self._constant(node, owner, name, f"{name} of hair")
        made = {"type": "hair", "eta": max(1.0001, number("IOR")), "beta_m": number("Roughness"),
                "beta_n": number("Radial Roughness"), "alpha": math.degrees(number("Offset"))}
        if node.parametrization == "COLOR":
            made["color"] = self._albedo(node, owner)
        elif node.parametrization == "ABSORPTION":
            made["sigma_a"] = self.textures.color(node.inputs["Absorption Coefficient"], owner)
        else:
            made["sigma_a"] = fibres.color_of_melanin(node, lambda socket: self.textures.constant(socket, owner, "melanin"))
        return Look(made)

    def principled(self, node, owner):
        look = self._principled_base(node, owner)
        emission = node.inputs.get("Emission") or node.inputs["Emission Color"]
        color, strength = self._emitted(emission, node.inputs["Emission Strength"], owner)
        if strength > 0 and not is_black(color):
            look.emission, look.strength = color, strength
        look.alpha = self.textures.number(node.inputs["Alpha"], owner)
        return look

    def _principled_base(self, node, owner):
        transmission_name = "Transmission" if "Transmission" in node.inputs else "Transmission Weight"
        metallic = self.textures.number(node.inputs["Metallic"], owner)
        transmission = self.textures.number(node.inputs[transmission_name], owner)
        self._note_principled(node, owner)
        base = self._blend(lambda: self._plastic(node, owner),
                           lambda: self._dielectric(node, owner, "Base Color"), transmission, owner, "transmission")
        return Look(self._blend(lambda: base, lambda: self._brushed_metal(node, owner), metallic, owner, "metal"))

    def _brushed_metal(self, node, owner):
        made = self._metal(node, owner)
        aspect = math.sqrt(1 - 0.9 * self._constant(node, owner, "Anisotropic", "anisotropy"))
        self._brush(made, node, owner, (1 / aspect, aspect), "Anisotropic Rotation")
        return made

    def _blend(self, first, second, amount, owner, what):
        """Returns a mix of the materials that the two functions make: `first` for an amount of 0, `second` for 1."""
        if amount == 0:
            return first()
        if amount == 1:
            return second()
        names = [f"{self.textures.prefix}/{what}{i}" for i in range(2)]
        self.parts["materials"][names[0]], self.parts["materials"][names[1]] = first(), second()
        return {"type": "mix", "materials": names, "amount": amount}

    def _metal(self, node, owner, color="Base Color"):
        return self._solid(node, owner, type="conductor", reflectance=self._albedo(node, owner, color),
                           roughness=self._roughness(node, owner))

    def _plastic(self, node, owner):
        # The reflectance at normal incidence is 0.08 times Specular in Blender 3; in Blender 4, twice the level times the
        # reflectance from the index.
        specular = node.inputs.get("Specular") or node.inputs["Specular IOR Level"]
        factor = self.textures.number(specular, owner)
        if not isinstance(factor, dict):
            factor *= 2
        if not isinstance(factor, dict) and factor > 1:
            self.report.note(owner, "Specular is limited to 0.5")
            factor = 1.0
        base = self._solid(node, owner, type="plastic", reflectance=self._diffuse_color(node, owner), eta=1.5,
                           specular=factor, roughness=self._roughness(node, owner), **self._sheen(node, owner))
        return self._coated(base, node, owner)

    def _diffuse_color(self, node, owner):
        """Returns the base colour. Blender 3 mixes it with the subsurface colour."""
        base, under = self._albedo(node, owner, "Base Color"), node.inputs.get("Subsurface Color")
        amount = 0 if under is None else self.textures.number(node.inputs["Subsurface"], owner)
        if amount == 0:
            return base
        under = self._albedo(node, owner, under.identifier)
        if isinstance(base, list) and isinstance(under, list) and not isinstance(amount, dict):
            return [b + amount * (u - b) for b, u in zip(base, under)]
        name = f"{self.textures.prefix}/subsurface"
        self.parts["spectrum_textures"][name] = {"type": "mix", "tex1": base, "tex2": under, "amount": amount}
        return {"texture": name}

    def _sheen(self, node, owner):
        socket = node.inputs.get("Sheen") or node.inputs.get("Sheen Weight")
        amount = self.textures.constant(socket, owner, "sheen")
        if amount <= 0:
            return {}
        rough = node.inputs.get("Sheen Roughness")
        if rough is None:
            return {"sheen_color": [min(1.0, OLD_SHEEN * amount)] * 3, "sheen_roughness": OLD_SHEEN_ROUGHNESS}
        self.report.note(owner, "sheen is rendered as a layer of fibres, which is softer at the edge")
        return {"sheen_color": [min(1.0, amount)] * 3, "sheen_roughness": rough.default_value}

    def _coated(self, base, node, owner):
        """Adds the coat: in Blender 3 a quarter of a reflection of index 1.5, in Blender 4 a dielectric layer."""
        is_old = "Clearcoat" in node.inputs
        amount = self.textures.number(node.inputs["Clearcoat" if is_old else "Coat Weight"], owner)
        if amount == 0:
            return base
        roughness = self._roughness(node, owner, "Clearcoat Roughness" if is_old else "Coat Roughness")
        eta = 1.5 if is_old else self._constant(node, owner, "Coat IOR", "the index of a coat")
        if is_old:
            amount = self._times(amount, OLD_CLEARCOAT)
        relief = {name: base.pop(name) for name in ("normal_map", "displacement") if name in base}
        inner = {name: value for name, value in base.items() if name not in {"sheen_color", "sheen_roughness"}}
        coated = {"type": "coatedplastic", "base": {k: v for k, v in inner.items() if k != "type"},
                  "coat": {"roughness": roughness, "thickness": 0.0, "eta": max(1.0001, eta)}, **relief}
        return self._blend(lambda: {**base, **relief}, lambda: coated, amount, owner, "coat")

    def _times(self, value, factor):
        if not isinstance(value, dict):
            return value * factor
        name = f"{value['texture']}*{factor}"
        self.parts["float_textures"][name] = {"type": "scale", "tex": value, "scale": factor}
        return {"texture": name}

    def _note_principled(self, node, owner):
        metallic = self.textures.number(node.inputs["Metallic"], owner)
        for name, text in (("Subsurface", SUBSURFACE), ("Subsurface Weight", SUBSURFACE),
                           ("Anisotropic", "anisotropy is supported for metals only: it is left out")):
            socket = node.inputs.get(name)
            is_used = socket is not None and (socket.is_linked or socket.default_value > 0)
            if is_used and not (name == "Anisotropic" and metallic == 1):
                self.report.note(owner, text)

    def _coat_of_fresnel(self, node, owner):
        """Returns plastic for a mix of Diffuse and Glossy by Fresnel or Layer Weight; None for other mixes."""
        factor = self.textures.source(node.inputs[0])
        first, second = (self.textures.source(socket) for socket in node.inputs[1:3])
        if factor is None or factor.node.type not in {"FRESNEL", "LAYER_WEIGHT"} or first is None or second is None:
            return None
        if first.node.type != "BSDF_DIFFUSE" or second.node.type != "BSDF_GLOSSY":
            return None
        eta = self._constant(factor.node, owner, "IOR", "the index") if factor.node.type == "FRESNEL" else \
            eta_of_blend(self._constant(factor.node, owner, "Blend", "the blend"))
        return Look(self._solid(second.node, owner, type="plastic", eta=max(1.0001, eta),
                                reflectance=self._albedo(first.node, owner), roughness=self._roughness(second.node, owner)))

    def mix(self, node, owner):
        coated = self._coat_of_fresnel(node, owner)
        if coated is not None:
            return coated
        amount = self.textures.number(node.inputs[0], owner)
        if amount in (0, 1):
            return self._input_look(node.inputs[1 + int(amount)], owner)
        first, second = (self._input_look(socket, owner) for socket in node.inputs[1:3])
        is_hole = [look.material is None and is_black(look.emission) for look in (first, second)]
        if is_hole[0] != is_hole[1]:
            return self._with_holes(second if is_hole[0] else first, amount, is_hole[0], owner)
        return self._mixed(first, second, amount, owner)

    def _with_holes(self, look, amount, is_first_hole, owner):
        """Makes `look` transparent where the other part of a mix, a Transparent shader, is."""
        share = amount
        if not is_first_hole:
            share = self._complement(amount, owner)
        if look.alpha != OPAQUE:
            self.report.note(owner, "of several Transparent shaders in one material, the outermost one is used")
        look.alpha = share
        return look

    def _complement(self, amount, owner):
        if not isinstance(amount, dict):
            return 1 - amount
        name = f"1-{amount['texture']}"
        self.parts["float_textures"][name] = {"type": "mix", "tex1": 1.0, "tex2": 0.0, "amount": amount}
        return {"texture": name}

    def _mixed(self, first, second, amount, owner):
        look = Look()
        for part, share in ((first, self._complement(amount, owner)), (second, amount)):
            self._add_emission(look, part, share, owner)
        black = {"type": "diffuse", "reflectance": BLACK}
        solids = [part.material or black for part in (first, second)]
        if first.material is not None or second.material is not None:
            look.material = self._blend(lambda: solids[0], lambda: solids[1], amount, owner, f"mix{self._count()}")
        return look

    def _add_emission(self, look, part, share, owner):
        if is_black(part.emission):
            return
        if isinstance(share, dict):
            self.report.note(owner, "a texture cannot mix emission: one half is used")
            share = HALFWAY
        if not is_black(look.emission):
            self.report.note(owner, "of two emissions in one material, only the second one is used")
        look.emission, look.strength = part.emission, part.strength * share

    def add(self, node, owner):
        first, second = (self._input_look(socket, owner) for socket in node.inputs[:2])
        if first.material is not None and second.material is not None:
            self.report.note(owner, "Add of two surfaces is rendered as their mean")
            look = self._mixed(first, second, HALFWAY, owner)
            look.strength *= 2
            return look
        solid = first if first.material is not None else second
        look = Look(solid.material, alpha=solid.alpha)
        self._add_emission(look, first, 1, owner)
        self._add_emission(look, second, 1, owner)
        for part in first, second:
            if part.material is None and is_black(part.emission):
                self._add_hole(look, part.hole, owner)
        return look

    def _add_hole(self, look, hole, owner):
        """Adds a Transparent shader, whose colour socket is `hole` (None: black), to a look."""
        if look.material is None:
            if is_black(look.emission):
                look.alpha, look.hole = 0.0, look.hole or hole
            else:  # half of the surface, twice as bright
                self.report.note(owner, "Transparent added to an emission lets only half of the light through")
                look.alpha, look.strength = HALFWAY, 2 * look.strength
            return
        passing = self.textures.number(hole, owner) if hole is not None else 0
        if isinstance(passing, dict):
            self.report.note(owner, "where Transparent is added to a surface, the surface reflects less")
            look.alpha = self._product(look.alpha, self._complement(passing, owner))
        elif passing > 0:
            if passing > HALFWAY:
                self.report.note(owner, "Transparent added to a surface lets only half of the light through")
            share = 1 - min(passing, HALFWAY)
            look.alpha = self._product(look.alpha, share)
            self._brighten(look.material, 1 / share)

    def _product(self, first, second):
        """Returns the product of two numbers or textures."""
        if not isinstance(first, dict):
            first, second = second, first
        if not isinstance(first, dict):
            return first * second
        if second == 1:
            return first
        name = f"{first['texture']} * {second['texture'] if isinstance(second, dict) else second}"
        self.parts["float_textures"][name] = {"type": "scale", "tex": first, "scale": second}
        return {"texture": name}

    def _brighten(self, material, factor):
        """Multiplies the colours of a material's diffuse closures by a factor."""
        for name in material.get("materials", ()):
            self._brighten(self.parts["materials"][name], factor)
        for name in {"reflectance", "transmittance"} & material.keys():
            material[name] = clamped(self._times_color(material[name], factor))


SHADERS = {"BSDF_DIFFUSE": Materials.diffuse, "BSDF_TRANSLUCENT": Materials.translucent,
           "BSDF_TRANSPARENT": Materials.transparent, "EMISSION": Materials.emission,
           "BSDF_GLOSSY": Materials.glossy, "BSDF_ANISOTROPIC": Materials.glossy, "BSDF_GLASS": Materials.glass,
           "BSDF_REFRACTION": Materials.refraction, "SUBSURFACE_SCATTERING": Materials.subsurface,
           "BSDF_VELVET": Materials.velvet, "BSDF_PRINCIPLED": Materials.principled, "MIX_SHADER": Materials.mix,
           "ADD_SHADER": Materials.add, "BSDF_HAIR_PRINCIPLED": Materials.hair}
