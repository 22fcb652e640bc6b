# SPDX-FileCopyrightText: 2026 The Lanthorn authors
# SPDX-License-Identifier: Apache-2.0
"""Maps Blender's passes to layers of Lanthorn."""
from dataclasses import dataclass

import numpy

FAR = 1e10  # Blender's depth of the background


@dataclass(frozen=True)
class Pass:
    name: str      # in Blender
    channels: str  # their letters
    kind: str
    layer: str     # in Lanthorn
    first: str     # the layer's first channel


def count_text(count):
    return "1 pass" if count == 1 else f"{count} passes"


def color_pass(name, layer):
    return Pass(name, "RGB", "COLOR", layer, f"{layer}.R")


OF_VIEW_LAYER = (("use_pass_z", Pass("Depth", "Z", "VALUE", "depth", "depth.Z")),
                 ("use_pass_normal", Pass("Normal", "XYZ", "VECTOR", "normal", "normal.X")),
                 ("use_pass_position", Pass("Position", "XYZ", "VECTOR", "position", "position.X")),
                 ("use_pass_emit", color_pass("Emit", "emission")))
OWN = (("use_caustic", color_pass("Caustic", "caustic")), ("use_direct", color_pass("Direct", "direct")),
       ("use_indirect", color_pass("Indirect", "indirect")), ("use_media", color_pass("Media", "media")),
       ("use_error", color_pass("Error", "error")))
DENOISING = (color_pass("Denoising Albedo", "albedo"), Pass("Denoising Normal", "XYZ", "VECTOR", "normal", "normal.X"))


def wanted_passes(view_layer):
    """Returns the passes that a view layer asks for, without Combined."""
    passes = [p for flag, p in OF_VIEW_LAYER if getattr(view_layer, flag)]
    passes += [p for flag, p in OWN if getattr(view_layer.lanthorn, flag)]
    cycles = getattr(view_layer, "cycles", None)
    if cycles is not None and getattr(cycles, "denoising_store_passes", False):
        passes += DENOISING
    return passes


def layers_of(passes, is_transparent):
    layers = ["color", *(p.layer for p in passes)]
    if is_transparent:
        layers.append("depth")
    return list(dict.fromkeys(layers))


class Picture:
    """Reads the channels of an answer, rows from the top."""

    def __init__(self, answer):
        array = answer["pixels"]
        self.channels = answer["channels"]
        self.pixels = numpy.frombuffer(array.bytes, dtype=numpy.float32).reshape(array.shape)

    def values(self, first, count):
        """Returns `count` channels, starting with the one named `first`; None if there is no such channel."""
        if first not in self.channels:
            return None
        begin = self.channels.index(first)
        return self.pixels[:, :, begin:begin + count]

    def combined(self, is_transparent):
        color = self.values("R", 3)
        alpha = numpy.ones(color.shape[:2] + (1,), dtype=numpy.float32)
        depth = self.values("depth.Z", 1)
        if is_transparent and depth is not None:
            alpha = numpy.isfinite(depth).astype(numpy.float32)
            color = color * alpha
        return numpy.concatenate([color, alpha], axis=2)

    def of_pass(self, wanted):
        values = self.values(wanted.first, len(wanted.channels))
        if values is None:
            return None
        return numpy.where(numpy.isfinite(values), values, FAR) if wanted.kind == "VALUE" else values


def fill(layer, values, size):
    """Writes the passes of a render layer. `values` has an array (height, width, channels), rows from the top, or None,
    for each pass name. One call for all passes is 300 times as fast as one for each."""
    flat = []
    for blender_pass in layer.passes:
        pixels = values.get(blender_pass.name)
        if pixels is None:
            pixels = numpy.zeros((*size, blender_pass.channels), dtype=numpy.float32)
        flat.append(pixels[::-1].reshape(-1))
    layer.passes.foreach_set("rect", numpy.concatenate(flat).astype(numpy.float32))
