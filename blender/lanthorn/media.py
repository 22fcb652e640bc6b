# SPDX-FileCopyrightText: 2026 The Lanthorn authors
# SPDX-License-Identifier: Apache-2.0
"""Translates volume shaders to homogeneous media, or to grids if a socket varies over space. Cycles bakes such sockets
at the centres of the grid's cells (bake.py)."""
import math

import numpy

from . import blackbody, voxels

LEAST_ABSORPTION = 1e-4  # per metre; a smaller one could not emit
STEFAN_BOLTZMANN = 5.670373e-8 * 1e-6 / math.pi  # of Cycles' volumes: W m^-2 K^-4 sr^-1, times 10^-6
RAMP = 256               # samples that represent a Color Ramp
OPERATIONS = {"ADD": numpy.add, "SUBTRACT": numpy.subtract, "MULTIPLY": numpy.multiply, "MINIMUM": numpy.minimum,
              "MAXIMUM": numpy.maximum, "DIVIDE": lambda a, b: a / numpy.where(b == 0, numpy.inf, b),
              "POWER": lambda a, b: numpy.maximum(a, 0) ** b, "GREATER_THAN": lambda a, b: (a > b) * 1.0,
              "LESS_THAN": lambda a, b: (a < b) * 1.0}
OF_WORLD = "world volume"  # the name of the medium around all objects
KINDS = {"VOLUME_ABSORPTION", "VOLUME_SCATTER", "PRINCIPLED_VOLUME", "EMISSION", "ADD_SHADER", "MIX_SHADER"}


def _zero():
    return {"sigma_a": numpy.zeros(3), "sigma_s": numpy.zeros(3), "g": 0.0, "emission": numpy.zeros(3)}


def _sum(first, second, shares=(1.0, 1.0)):
    """Adds two media. The anisotropy is the mean, weighted by the scattering coefficients."""
    made = {name: shares[0] * first[name] + shares[1] * second[name] for name in ("sigma_a", "sigma_s", "emission")}
    weights = [numpy.mean(share * part["sigma_s"]) for share, part in zip(shares, (first, second))]
    total = sum(weights)
    made["g"] = (weights[0] * first["g"] + weights[1] * second["g"]) / total if total > 0 else 0.0
    return made


class Volume:
    """Evaluates a volume shader. Numbers and colours are constants, or arrays with one row per cell."""

    def __init__(self, owner, textures, report):
        self.owner, self.textures, self.report = owner, textures, report
        self.grid, self.is_missing = None, False  # the cells of sockets that vary; True if a bake is still to come

    def _field(self, output):
        """Returns the socket's values in all cells, of shape (n, 3); None if it is constant or cannot be evaluated."""
        surface = self.textures.surface
        if output is None or surface is None:
            return None
        own = self._of_own_grids(output) if surface.fields is not None else None
        if own is not None or not self.textures.varies_in_space(output):
            return own
        self.grid = self.grid or voxels.around(surface, self.textures.bakes.size)
        path = self.textures.baked_field(output, self.grid, self.owner)
        values = self.grid.read(path)
        self.is_missing = self.is_missing or values is None
        return values

    def _of_own_grids(self, output):
        """Evaluates Attribute, Volume Info, Math and Color Ramp nodes on the object's grids."""
        node = output.node
        if node.type in {"ATTRIBUTE", "VOLUME_INFO"}:
            name = node.attribute_name if node.type == "ATTRIBUTE" else output.name.lower()
            return self._attribute(name)
        if node.type not in {"MATH", "VALTORGB"}:
            return None
        inputs = [self._field_or_number(socket) for socket in node.inputs if socket.enabled]
        if not any(numpy.size(value) > 1 for value in inputs):
            return None
        if node.type == "MATH":
            return self._computed(node, [numpy.mean(v, axis=1, keepdims=True) if numpy.size(v) > 1 else v for v in inputs])
        positions = numpy.linspace(0, 1, RAMP)
        colors = numpy.array([node.color_ramp.evaluate(x)[:3] for x in positions])
        values = numpy.mean(inputs[0], axis=1)
        return numpy.stack([numpy.interp(values, positions, colors[:, c]) for c in range(3)], axis=1)

    def _attribute(self, name):
        fields = self.textures.surface.fields
        self.grid = fields.grid
        if name not in fields.values:
            self.report.note(self.owner, f"the volume has no grid {name}: its value is 0")
            return numpy.zeros((int(fields.grid.counts.prod()), 3))
        return fields.values[name]

    def _field_or_number(self, socket):
        field = self._field(self.textures.source(socket))
        return field if field is not None else self.textures.constant(socket, self.owner, "a node of a volume")

    def _computed(self, node, inputs):
        operation = OPERATIONS.get(node.operation)
        if operation is None:
            self.report.note(self.owner, f"Math {node.operation} cannot be applied to a volume's grid: it is left out")
            return numpy.repeat(inputs[0] if numpy.size(inputs[0]) > 1 else inputs[1], 3, axis=1)
        made = operation(*inputs[:2])
        return numpy.repeat(numpy.clip(made, 0, 1) if node.use_clamp else made, 3, axis=1)

    def number(self, node, name):
        socket = node.inputs[name]
        field = self._field(self.textures.source(socket))
        if field is not None:
            return field.mean(axis=1, keepdims=True)
        return self.textures.constant(socket, self.owner, f"{name} of a volume")

    def color(self, node, name):
        output = self.textures.source(node.inputs[name])
        field = self._field(output)
        if field is not None:
            return field
        if output is not None and output.node.type == "RGB":
            return numpy.array(output.default_value[:3])
        if output is not None:
            self.report.note(self.owner, f"the nodes behind {name} of a volume cannot be evaluated: the socket's own value is used")
        return numpy.array(node.inputs[name].default_value[:3])

    def _of_socket(self, socket):
        output = self.textures.source(socket)
        return self.of(output.node) if output is not None else _zero()

    def of(self, node):
        if node.type not in KINDS:
            self.report.note(self.owner, f"the volume shader {node.bl_label} is not supported: it is left out")
            return _zero()
        if node.type == "ADD_SHADER":
            return _sum(*(self._of_socket(socket) for socket in node.inputs[:2]))
        if node.type == "MIX_SHADER":
            amount = self.number(node, node.inputs[0].identifier)
            return _sum(*(self._of_socket(socket) for socket in node.inputs[1:3]), (1 - amount, amount))
        if node.type == "EMISSION":
            return {**_zero(), "emission": self.number(node, "Strength") * self.color(node, "Color")}
        if node.type == "PRINCIPLED_VOLUME":
            return self._principled(node)
        color, density = self.color(node, "Color"), numpy.maximum(0.0, self.number(node, "Density"))
        if node.type == "VOLUME_ABSORPTION":
            return {**_zero(), "sigma_a": density * numpy.maximum(0.0, 1 - color)}
        return {**_zero(), "sigma_s": density * color, "g": self._even(self.number(node, "Anisotropy"))}

    def _even(self, value):
        """Returns the mean of a value that must be constant in Lanthorn."""
        if numpy.size(value) > 1:
            self.report.note(self.owner, "the anisotropy of a volume cannot vary: its mean is used")
        return float(numpy.mean(value))

    def _principled(self, node):
        """Returns Cycles' coefficients: the colour scatters, and the absorption colour lets part of the rest pass."""
        density = self._times_attribute(numpy.maximum(0.0, self.number(node, "Density")), node, "Density Attribute")
        color, absorbed = self.color(node, "Color"), self.color(node, "Absorption Color")
        emitted = self.number(node, "Emission Strength")
        glow = emitted * self.color(node, "Emission Color") + self._blackbody(node)
        return {"sigma_s": density * color,
                "sigma_a": density * numpy.maximum(0.0, 1 - color) * numpy.maximum(0.0, 1 - numpy.maximum(0.0, absorbed) ** 0.5),
                "g": self._even(self.number(node, "Anisotropy")),
                "emission": glow}

    def _times_attribute(self, value, node, name):
        """Returns the value times the grid that a socket names, if the object has that grid."""
        surface, attribute = self.textures.surface, node.inputs[name].default_value
        if surface is None or surface.fields is None or attribute not in surface.fields.values:
            return value
        return value * self._attribute(attribute).mean(axis=1, keepdims=True)

    def _blackbody(self, node):
        """Returns the emission per metre of a Principled Volume that is hot."""
        intensity = self.number(node, "Blackbody Intensity")
        if numpy.max(intensity) <= 0:
            return numpy.zeros(3)
        kelvin = numpy.maximum(0.0, self._times_attribute(self.number(node, "Temperature"), node, "Temperature Attribute"))
        power = STEFAN_BOLTZMANN * (1 + numpy.minimum(intensity, 1) * (kelvin**4 - 1))
        return power * blackbody.colors(kelvin) * self.color(node, "Blackbody Tint")


def _with_emission(made):
    """Divides Cycles' emission per metre by sigma_a, which gives Lanthorn's: the radiance of an infinitely deep medium."""
    emission = made["emission"]
    if numpy.max(emission) <= 0:
        made.pop("emission")
        return made
    is_dark = emission <= 0
    absorption = numpy.maximum(made["sigma_a"], numpy.where(is_dark, 0, LEAST_ABSORPTION))
    made["sigma_a"] = absorption
    made["emission"] = numpy.where(is_dark, 0, emission / numpy.maximum(absorption, LEAST_ABSORPTION))
    return made


def medium(volume, node, around=None):
    """Returns the medium of the volume shader at a node, or None if there is no such medium. `around` is the world's
    volume (`Volume.of`): as in Cycles, it also fills the objects inside it."""
    made = volume.of(node) if around is None else _sum(volume.of(node), around)
    return part_of(made, volume)


def part_of(made, volume=None):
    """Returns the medium as a part of a scene; None if it neither emits nor takes light. `volume` has the grid of values
    that vary."""
    if numpy.max(made["emission"]) <= 0 and max(numpy.max(made["sigma_a"]), numpy.max(made["sigma_s"])) <= 0:
        return None
    made = _with_emission(made)
    fields = {name: made.pop(name) for name in ("sigma_a", "sigma_s", "emission") if name in made}
    if all(numpy.size(values) == 3 for values in fields.values()):
        return {**made, **{name: numpy.reshape(values, 3).tolist() for name, values in fields.items()}}
    return {**made, "density": {"type": "rgbgrid", **{name: volume.grid.part(v) for name, v in fields.items()}},
            "medium_to_world": volume.textures.surface.to_world}
