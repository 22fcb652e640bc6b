# SPDX-FileCopyrightText: 2026 The Lanthorn authors
# SPDX-License-Identifier: Apache-2.0
"""Node materials as materials, emission and media of Lanthorn."""
from dataclasses import dataclass

from .textures import Textures

BLACK = [0.0, 0.0, 0.0]
OPAQUE = 1.0
HALFWAY = 0.5


@dataclass
class Look:
    """The translation of a shader node: its material (None if it only emits or lets light through), emission and opacity."""

    material: dict | None = None
    emission: object = None  # a color, or a texture
    strength: float = 1.0
    alpha: object = OPAQUE


def clamped(color):
    return [min(1.0, max(0.0, c)) for c in color] if isinstance(color, list) else color


def is_black(color):
    return color is None or (isinstance(color, list) and max(color) <= 0)


class Materials:
    """Adds what a scene's materials need to its parts."""

    def __init__(self, parts, report, images):
        self.parts, self.report = parts, report
        self.textures = Textures(parts, report, images)
        self._done, self._mixes = {}, 0

    def shape_members(self, material):
        """Returns what a shape with this shader needs: material, area_light, alpha."""
        key = material.name_full if material is not None else ""
        if key not in self._done:
            self._done[key] = self._add(key, material)
        return self._done[key]

    def _add(self, key, material):
        self.textures.groups, self._mixes = [], 0
        name = f"material {key}"
        look, medium = self._look_of(material)
        is_seen = look.material is not None or not is_black(look.emission)
        node = look.material or ({"type": "diffuse", "reflectance": BLACK} if is_seen else {"type": "interface"})
        if medium is not None:
            self.parts["media"][name] = medium
            node = {**node, "interior": name}
        self.parts["materials"][name] = node
        members = {"material": name}
        if not is_black(look.emission) and look.strength > 0:
            self.parts["area_lights"][name] = {"radiance": look.emission, "scale": look.strength, "two_sided": True}
            members["area_light"] = name
        if is_seen and look.alpha != OPAQUE:
            members["alpha"] = look.alpha
        return members

    def _look_of(self, material):
        if material is None:
            return Look({"type": "diffuse", "reflectance": [0.8] * 3}), None
        if not (material.use_nodes and material.node_tree):
            return Look({"type": "diffuse", "reflectance": list(material.diffuse_color[:3])}), None
        output = material.node_tree.get_output_node("CYCLES") or material.node_tree.get_output_node("ALL")
        if output is None:
            return Look({"type": "diffuse", "reflectance": BLACK}), None
        surface = self.textures.source(output.inputs["Surface"])
        volume = self.textures.source(output.inputs["Volume"])
        medium = self._medium(volume.node, material.name) if volume is not None else None
        if output.inputs["Displacement"].is_linked:
            self.report.note(material.name, "displacement is left out")
        if surface is None:
            return (Look() if medium is not None else Look({"type": "diffuse", "reflectance": BLACK})), medium
        return self._look(surface.node, material.name), medium

    def _look(self, node, owner):
        make = SHADERS.get(node.type)
        if make is None:
            self.report.note(owner, f"the shader {node.bl_label} has no counterpart: a grey diffuse one stands in")
            return Look({"type": "diffuse", "reflectance": [HALFWAY] * 3})
        return make(self, node, owner)

    def _input_look(self, socket, owner):
        source = self.textures.source(socket)
        return self._look(source.node, owner) if source is not None else Look({"type": "diffuse", "reflectance": BLACK})

    def _count(self):
        """A number for each mix of a material, the same at each export."""
        self._mixes += 1
        return self._mixes

    def _solid(self, node, owner, **material):
        """A closure with the relief that its shader node asks for."""
        return {**material, **self._relief(node, owner)}

    def _relief(self, node, owner):
        """normal_map or displacement."""
        socket = node.inputs.get("Normal")
        source = self.textures.source(socket) if socket is not None else None
        if source is None:
            return {}
        if source.node.type == "NORMAL_MAP":
            made = self.textures.normal_map(source.node, owner)
            return {"normal_map": made} if made else {}
        if source.node.type == "BUMP":
            height = self.textures.number(source.node.inputs["Height"], owner)
            if isinstance(height, dict):
                distance = source.node.inputs["Distance"].default_value * source.node.inputs["Strength"].default_value
                name = f"{height['texture']}*{distance}"
                self.parts["float_textures"][name] = {"type": "scale", "tex": height, "scale": distance}
                return {"displacement": {"texture": name}}
        self.report.note(owner, f"the node {source.node.bl_label} at a normal has no counterpart")
        return {}

    def _roughness(self, node, owner, name="Roughness"):
        alpha = self.textures.squared(self.textures.number(node.inputs[name], owner), owner)
        return {"u": alpha, "v": alpha, "remap": False}

    def _albedo(self, node, owner, name="Color"):
        return clamped(self.textures.color(node.inputs[name], owner))

    def _constant(self, node, owner, name, what):
        """The number of an input that no texture can vary."""
        value = self.textures.number(node.inputs[name], owner)
        if isinstance(value, dict):
            self.report.note(owner, f"{what} cannot vary over a surface: the socket's own value is used")
            return node.inputs[name].default_value
        return value

    # Shaders.

    def diffuse(self, node, owner):
        return Look(self._solid(node, owner, type="diffuse", reflectance=self._albedo(node, owner)))

    def translucent(self, node, owner):
        return Look(self._solid(node, owner, type="diffusetransmission", reflectance=BLACK,
                                transmittance=self._albedo(node, owner)))

    def transparent(self, node, owner):
        color = self.textures.color(node.inputs["Color"], owner)
        if color != [1.0, 1.0, 1.0]:
            self.report.note(owner, "transparency has no colour")
        return Look(alpha=0.0)

    def emission(self, node, owner):
        return Look(emission=self.textures.color(node.inputs["Color"], owner),
                    strength=self._constant(node, owner, "Strength", "the strength of emission"))

    def glossy(self, node, owner):
        return Look(self._metal(node, owner, "Color"))

    def _dielectric(self, node, owner, color):
        # Cycles multiplies by the colour at each interface, Lanthorn by the root of the tint.
        tint = self.textures.color(node.inputs[color], owner)
        if isinstance(tint, list):
            tint = [c * c for c in clamped(tint)]
        eta = max(1.0001, self._constant(node, owner, "IOR", "the index of refraction"))
        return self._solid(node, owner, type="dielectric", eta=eta, tint=tint, roughness=self._roughness(node, owner))

    def glass(self, node, owner):
        return Look(self._dielectric(node, owner, "Color"))

    def refraction(self, node, owner):
        self.report.note(owner, "a Refraction shader reflects, too, as Glass does")
        return self.glass(node, owner)

    def subsurface(self, node, owner):
        self.report.note(owner, "light under the surface is scattered where it enters: a diffuse shader stands in")
        return self.diffuse(node, owner)

    def velvet(self, node, owner):
        self.report.note(owner, "Velvet becomes a black surface with sheen")
        return Look(self._solid(node, owner, type="plastic", reflectance=BLACK, specular=0.0, sheen_roughness=0.5,
                                sheen_color=self._albedo(node, owner)))

    def principled(self, node, owner):
        look = self._principled_base(node, owner)
        emission = node.inputs.get("Emission") or node.inputs["Emission Color"]
        strength = self._constant(node, owner, "Emission Strength", "the strength of emission")
        color = self.textures.color(emission, owner)
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
        return Look(self._blend(lambda: base, lambda: self._metal(node, owner), metallic, owner, "metal"))

    def _blend(self, first, second, amount, owner, what):
        """The material `first` makes where amount is 0, that of `second` where it is 1."""
        if amount == 0:
            return first()
        if amount == 1:
            return second()
        names = [f"{owner}/{what}{i}" for i in range(2)]
        self.parts["materials"][names[0]], self.parts["materials"][names[1]] = first(), second()
        return {"type": "mix", "materials": names, "amount": amount}

    def _metal(self, node, owner, color="Base Color"):
        return self._solid(node, owner, type="conductor", reflectance=self._albedo(node, owner, color),
                           roughness=self._roughness(node, owner))

    def _plastic(self, node, owner):
        # Blender 3: the reflection at normal incidence is 0.08 times Specular; 4: twice that of the index.
        specular = node.inputs.get("Specular") or node.inputs["Specular IOR Level"]
        factor = self.textures.number(specular, owner)
        if not isinstance(factor, dict):
            factor *= 2
        if not isinstance(factor, dict) and factor > 1:
            self.report.note(owner, "Specular above 0.5 is taken as 0.5")
            factor = 1.0
        return self._solid(node, owner, type="plastic", reflectance=self._albedo(node, owner, "Base Color"), eta=1.5,
                           specular=factor, roughness=self._roughness(node, owner))

    def _note_principled(self, node, owner):
        for name, what in (("Subsurface", "subsurface scattering"), ("Subsurface Weight", "subsurface scattering"),
                           ("Clearcoat", "the coat"), ("Coat Weight", "the coat"), ("Sheen", "sheen"),
                           ("Sheen Weight", "sheen"), ("Anisotropic", "anisotropy")):
            socket = node.inputs.get(name)
            if socket is not None and (socket.is_linked or socket.default_value > 0):
                self.report.note(owner, f"{what} of a Principled BSDF is left out")

    def mix(self, node, owner):
        amount = self.textures.number(node.inputs[0], owner)
        if amount in (0, 1):
            return self._input_look(node.inputs[1 + int(amount)], owner)
        first, second = (self._input_look(socket, owner) for socket in node.inputs[1:3])
        is_hole = [look.material is None and is_black(look.emission) for look in (first, second)]
        if is_hole[0] != is_hole[1]:
            return self._with_holes(second if is_hole[0] else first, amount, is_hole[0], owner)
        return self._mixed(first, second, amount, owner)

    def _with_holes(self, look, amount, is_first_hole, owner):
        """`look` where the other part of a mix, a Transparent shader, is not."""
        share = amount
        if not is_first_hole:
            share = self._complement(amount, owner)
        if look.alpha != OPAQUE:
            self.report.note(owner, "of several transparencies in one material, the outermost one is used")
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
            self.report.note(owner, "a texture that mixes emission counts as one half")
            share = HALFWAY
        if not is_black(look.emission):
            self.report.note(owner, "of two emissions in one material, the second one is used")
        look.emission, look.strength = part.emission, part.strength * share

    def add(self, node, owner):
        first, second = (self._input_look(socket, owner) for socket in node.inputs[:2])
        if first.material is not None and second.material is not None:
            self.report.note(owner, "Add of two surfaces becomes their mean")
            look = self._mixed(first, second, HALFWAY, owner)
            look.strength *= 2
            return look
        look = Look(first.material or second.material)
        self._add_emission(look, first, 1, owner)
        self._add_emission(look, second, 1, owner)
        return look

    # Media.

    def _medium(self, node, owner):
        if node.type not in {"VOLUME_ABSORPTION", "VOLUME_SCATTER", "PRINCIPLED_VOLUME"}:
            self.report.note(owner, f"the volume shader {node.bl_label} has no counterpart: it is left out")
            return None
        if any(socket.is_linked for socket in node.inputs):
            self.report.note(owner, "a volume is the same everywhere: its sockets' own values are used")
        color = list(node.inputs["Color"].default_value[:3])
        density = node.inputs["Density"].default_value
        absorbed = [density * max(0.0, 1 - c) for c in color]
        if node.type == "VOLUME_ABSORPTION":
            return {"sigma_a": absorbed, "sigma_s": BLACK}
        scattered = [density * c for c in color]
        if node.type == "VOLUME_SCATTER":
            return {"sigma_a": BLACK, "sigma_s": scattered, "g": node.inputs["Anisotropy"].default_value}
        return {"sigma_a": absorbed, "sigma_s": scattered, "g": node.inputs["Anisotropy"].default_value}


SHADERS = {"BSDF_DIFFUSE": Materials.diffuse, "BSDF_TRANSLUCENT": Materials.translucent,
           "BSDF_TRANSPARENT": Materials.transparent, "EMISSION": Materials.emission,
           "BSDF_GLOSSY": Materials.glossy, "BSDF_ANISOTROPIC": Materials.glossy, "BSDF_GLASS": Materials.glass,
           "BSDF_REFRACTION": Materials.refraction, "SUBSURFACE_SCATTERING": Materials.subsurface,
           "BSDF_VELVET": Materials.velvet, "BSDF_PRINCIPLED": Materials.principled, "MIX_SHADER": Materials.mix,
           "ADD_SHADER": Materials.add}
