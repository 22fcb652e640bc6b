# SPDX-FileCopyrightText: 2026 The Lanthorn authors
# SPDX-License-Identifier: Apache-2.0
"""Volume shaders as homogeneous media."""

BLACK = [0.0, 0.0, 0.0]
LEAST_ABSORPTION = 1e-4  # per metre, of a volume that emits
KINDS = {"VOLUME_ABSORPTION", "VOLUME_SCATTER", "PRINCIPLED_VOLUME", "EMISSION", "ADD_SHADER", "MIX_SHADER"}


def _zero():
    return {"sigma_a": BLACK, "sigma_s": BLACK, "g": 0.0, "emission": BLACK}


def _sum(first, second, shares=(1.0, 1.0)):
    """Two media in one place; of the phase functions, the mean by what they scatter."""
    made = {name: [shares[0] * a + shares[1] * b for a, b in zip(first[name], second[name])]
            for name in ("sigma_a", "sigma_s", "emission")}
    weights = [share * sum(part["sigma_s"]) for share, part in zip(shares, (first, second))]
    total = sum(weights)
    made["g"] = (weights[0] * first["g"] + weights[1] * second["g"]) / total if total > 0 else 0.0
    return made


class _Volume:
    def __init__(self, owner, textures, report):
        self.owner, self.textures, self.report = owner, textures, report

    def number(self, node, name):
        return self.textures.constant(node.inputs[name], self.owner, f"{name} of a volume")

    def color(self, node, name):
        output = self.textures.source(node.inputs[name])
        if output is not None:
            if output.node.type == "RGB":
                return list(output.default_value[:3])
            self.report.note(self.owner, f"{name} of a volume cannot vary: the socket's own value is used")
        return list(node.inputs[name].default_value[:3])

    def of_socket(self, socket):
        output = self.textures.source(socket)
        return self.of(output.node) if output is not None else _zero()

    def of(self, node):
        if node.type not in KINDS:
            self.report.note(self.owner, f"the volume shader {node.bl_label} has no counterpart: it is left out")
            return _zero()
        if node.type == "ADD_SHADER":
            return _sum(*(self.of_socket(socket) for socket in node.inputs[:2]))
        if node.type == "MIX_SHADER":
            amount = self.number(node, node.inputs[0].identifier)
            return _sum(*(self.of_socket(socket) for socket in node.inputs[1:3]), (1 - amount, amount))
        if node.type == "EMISSION":
            strength = self.number(node, "Strength")
            return {**_zero(), "emission": [strength * c for c in self.color(node, "Color")]}
        if node.type == "PRINCIPLED_VOLUME":
            return self._principled(node)
        color, density = self.color(node, "Color"), max(0.0, self.number(node, "Density"))
        if node.type == "VOLUME_ABSORPTION":
            return {**_zero(), "sigma_a": [density * max(0.0, 1 - c) for c in color]}
        return {**_zero(), "sigma_s": [density * c for c in color], "g": self.number(node, "Anisotropy")}

    def _principled(self, node):
        """Cycles scatters by the colour; the rest is absorbed, where the absorption colour is white not at all."""
        density = max(0.0, self.number(node, "Density"))
        color, absorbed = self.color(node, "Color"), self.color(node, "Absorption Color")
        emitted = self.number(node, "Emission Strength")
        if self.number(node, "Blackbody Intensity") > 0:
            self.report.note(self.owner, "the black body of a homogeneous volume is left out")
        return {"sigma_s": [density * c for c in color],
                "sigma_a": [density * max(0.0, 1 - c) * max(0.0, 1 - max(0.0, a) ** 0.5) for c, a in zip(color, absorbed)],
                "g": self.number(node, "Anisotropy"),
                "emission": [emitted * c for c in self.color(node, "Emission Color")]}


def medium(node, owner, textures, report):
    """The medium of a volume shader; None if it is none."""
    made = _Volume(owner, textures, report).of(node)
    emission = made.pop("emission")
    if max(emission) > 0:
        # Cycles has what a metre emits, Lanthorn the radiance of an infinitely deep medium: sigma_a times as much a metre.
        made["sigma_a"] = [max(a, LEAST_ABSORPTION if e > 0 else 0) for a, e in zip(made["sigma_a"], emission)]
        made["emission"] = [e / a if e > 0 else 0.0 for e, a in zip(emission, made["sigma_a"])]
    elif max(made["sigma_a"] + made["sigma_s"]) <= 0:
        return None
    return made
