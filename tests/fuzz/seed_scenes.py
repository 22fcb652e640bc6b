# SPDX-FileCopyrightText: 2026 The Lanthorn authors
# SPDX-License-Identifier: Apache-2.0
"""Small scenes made for mutate_scenes.py: glTF, GLB, OBJ with MTL, each with meshes, images, a lamp and glass; pbrt-v3;
instances in pbrt-v4."""
import gzip
import json
import struct
import zlib
from pathlib import Path

# A floor, a lamp above it that faces down, and a tetrahedron.
FLOOR = [(-2, 0, 2), (2, 0, 2), (2, 0, -2), (-2, 0, -2)]
LAMP = [(-0.5, 2, -0.5), (0.5, 2, -0.5), (0.5, 2, 0.5), (-0.5, 2, 0.5)]
BODY = [(-0.5, 0.1, 0.4), (0.5, 0.1, 0.4), (0, 0.1, -0.5), (0, 0.9, 0)]
QUAD = [0, 1, 2, 0, 2, 3]
TETRAHEDRON = [0, 2, 1, 0, 1, 3, 1, 2, 3, 2, 0, 3]
UVS = [(0, 0), (1, 0), (1, 1), (0, 1)]


def png(width: int, height: int) -> bytes:
    """A small RGB image of stripes."""
    def chunk(kind: bytes, data: bytes) -> bytes:
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))
    rows = b"".join(b"\0" + bytes((64 * (x % 4) + 32, 40 * (y % 6), 128) [c] for x in range(width) for c in range(3))
                    for y in range(height))
    header = struct.pack(">IIBBBBB", width, height, 8, 2, 0, 0, 0)
    return b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header) + chunk(b"IDAT", zlib.compress(rows)) + chunk(b"IEND", b"")


class Buffer:
    """The one buffer of a glTF file, with its views and accessors."""

    def __init__(self) -> None:
        self.data = b""
        self.views: list = []
        self.accessors: list = []

    def view(self, data: bytes) -> int:
        self.data += b"\0" * (-len(self.data) % 4)
        self.views.append({"buffer": 0, "byteOffset": len(self.data), "byteLength": len(data)})
        self.data += data
        return len(self.views) - 1

    def floats(self, rows: list) -> int:
        rows = [r if isinstance(r, tuple) else (r,) for r in rows]
        kind = {1: "SCALAR", 2: "VEC2", 3: "VEC3", 4: "VEC4"}[len(rows[0])]
        view = self.view(b"".join(struct.pack(f"<{len(r)}f", *r) for r in rows))
        self.accessors.append({"bufferView": view, "componentType": 5126, "count": len(rows), "type": kind,
                               "min": [min(c) for c in zip(*rows)], "max": [max(c) for c in zip(*rows)]})
        return len(self.accessors) - 1

    def bytes(self, rows: list) -> int:
        view = self.view(b"".join(bytes(r) for r in rows))
        self.accessors.append({"bufferView": view, "componentType": 5121, "count": len(rows), "type": "VEC4"})
        return len(self.accessors) - 1

    def indices(self, values: list) -> int:
        view = self.view(struct.pack(f"<{len(values)}H", *values))
        self.accessors.append({"bufferView": view, "componentType": 5123, "count": len(values), "type": "SCALAR"})
        return len(self.accessors) - 1


def gltf(image: bytes | None) -> tuple[dict, bytes]:
    """The document and its buffer; `image` goes into the buffer, None: it stays a file of its own."""
    buffer = Buffer()
    quad, tetrahedron = buffer.indices(QUAD), buffer.indices(TETRAHEDRON)
    uvs, flat = buffer.floats(UVS), buffer.floats([(0, 1, 0)] * 4)
    def mesh(positions: list, indices: int, material: int) -> dict:
        attributes = {"POSITION": buffer.floats(positions), "TEXCOORD_0": uvs}
        if material == 0:
            attributes["NORMAL"] = flat
        return {"primitives": [{"attributes": attributes, "indices": indices, "material": material}]}
    meshes = [mesh(FLOOR, quad, 0), mesh(LAMP, quad, 1), mesh(BODY, tetrahedron, 2), mesh(BODY, tetrahedron, 0)]
    posed = meshes[3]["primitives"][0]
    posed["attributes"] |= {"COLOR_0": buffer.floats([(1, 0.5, 0.5, 1)] * 4),
                            "JOINTS_0": buffer.bytes([(0, 1, 0, 0)] * 4),
                            "WEIGHTS_0": buffer.floats([(0.7, 0.3, 0, 0)] * 4)}
    posed["targets"] = [{"POSITION": buffer.floats([(0, 0, 0)] * 3 + [(0.3, 0.2, 0)])}]
    meshes[3]["weights"] = [0.5]
    meshes.append({"primitives": [{"attributes": {"POSITION": posed["attributes"]["POSITION"]}, "mode": 3}]})
    times = buffer.floats([0, 1])
    places = buffer.floats([(1.2, 0, 0), (-1.2, 0, 0.4), (0, 0, -1)])
    sizes = buffer.floats([(1, 1, 1), (0.7, 1.3, 0.7), (1, 0.5, 1)])
    materials = [
        {"pbrMetallicRoughness": {"baseColorTexture": {"index": 0}, "metallicFactor": 0.1, "roughnessFactor": 0.6},
         "normalTexture": {"index": 0, "scale": 0.3}},
        {"emissiveFactor": [1, 0.9, 0.8], "doubleSided": True,
         "extensions": {"KHR_materials_emissive_strength": {"emissiveStrength": 6}}},
        {"pbrMetallicRoughness": {"baseColorFactor": [0.9, 0.9, 1, 1], "metallicFactor": 0, "roughnessFactor": 0},
         "extensions": {"KHR_materials_transmission": {"transmissionFactor": 1}, "KHR_materials_ior": {"ior": 1.5},
                        "KHR_materials_volume": {"thicknessFactor": 0.5, "attenuationDistance": 0.6,
                                                 "attenuationColor": [0.5, 0.9, 0.6]}}}]
    document = {
        "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0, 4, 6, 7, 8]}],
        "nodes": [
            {"children": [1, 2, 3], "scale": [1, 1.1, 1]}, {"mesh": 0}, {"mesh": 1, "translation": [0, 0.2, 0]},
            {"mesh": 2, "rotation": [0, 0.38, 0, 0.92], "translation": [0, 0.1, 0.5], "children": [5]},
            {"camera": 0, "translation": [0, 1.2, 5], "rotation": [-0.08, 0, 0, 0.997]},
            {"mesh": 2, "scale": [0.5, 0.5, 0.5], "extensions": {
                "EXT_mesh_gpu_instancing": {"attributes": {"TRANSLATION": places, "SCALE": sizes}},
                "KHR_lights_punctual": {"light": 0}}},
            {"mesh": 3, "skin": 0}, {"translation": [0.4, 0, 0.8], "children": [9]}, {"mesh": 4}, {}],
        "skins": [{"joints": [7, 9]}],
        "animations": [{
            "samplers": [{"input": times, "output": buffer.floats([(0, 0, 0), (0.3, 0.2, 0)])},
                         {"input": times, "output": buffer.floats([(0, 0, 0, 1), (0, 0.38, 0, 0.92)])},
                         {"input": times, "output": buffer.floats([0, 1]), "interpolation": "STEP"}],
            "channels": [{"sampler": 0, "target": {"node": 7, "path": "translation"}},
                         {"sampler": 1, "target": {"node": 9, "path": "rotation"}},
                         {"sampler": 2, "target": {"node": 6, "path": "weights"}}]}],
        "cameras": [{"type": "perspective", "perspective": {"yfov": 0.7, "znear": 0.01, "aspectRatio": 1.33}}],
        "meshes": meshes, "materials": materials, "textures": [{"source": 0, "sampler": 0}],
        "samplers": [{"wrapS": 10497, "wrapT": 10497}],
        "images": [{"uri": "stripes.png"} if image is None else
                   {"bufferView": buffer.view(image), "mimeType": "image/png"}],
        "extensionsUsed": ["EXT_mesh_gpu_instancing", "KHR_lights_punctual"],
        "extensions": {"KHR_lights_punctual": {"lights": [
            {"type": "spot", "intensity": 20, "color": [1, 1, 0.8], "spot": {"outerConeAngle": 0.8}}]}},
        "bufferViews": buffer.views, "accessors": buffer.accessors}
    document["buffers"] = [{"byteLength": len(buffer.data)}]
    return document, buffer.data


def glb(document: dict | bytes, binary: bytes) -> bytes:
    text = document if isinstance(document, bytes) else json.dumps(document).encode()
    text += b" " * (-len(text) % 4)
    binary += b"\0" * (-len(binary) % 4)
    chunks = struct.pack("<II", len(text), 0x4E4F534A) + text + struct.pack("<II", len(binary), 0x004E4942) + binary
    return b"glTF" + struct.pack("<II", 2, 12 + len(chunks)) + chunks


def obj() -> str:
    lines = ["mtllib scene.mtl"]
    first = 1
    for name, positions, faces in (("floor", FLOOR, [(1, 2, 3, 4)]), ("lamp", LAMP, [(1, 2, 3, 4)]),
                                   ("glass", BODY, [(1, 3, 2), (1, 2, 4), (2, 3, 4), (3, 1, 4)])):
        lines += [f"o {name}", f"usemtl {name}"]
        lines += [f"v {x} {y} {z}" for x, y, z in positions] + [f"vt {u} {v}" for u, v in UVS]
        lines += ["vn 0 1 0"] * 4 if name == "floor" else []
        for face in faces:
            numbers = [first + i - 1 for i in face]
            lines.append("f " + " ".join(f"{i}/{i}/{i}" if name == "floor" else f"{i}/{i}" for i in numbers))
        first += 4
    return "\n".join(lines) + "\n"


MTL = """newmtl floor
Kd 0.8 0.7 0.6
map_Kd -s 2 2 1 stripes.png
Ks 0.2 0.2 0.2
Ns 40
illum 2
newmtl lamp
Kd 0 0 0
Ke 12 11 10
newmtl glass
Kd 0 0 0
Ni 1.5
d 0.9
illum 7
"""


def write_seeds(folder: Path) -> None:
    """Writes scene.gltf, scene.glb, scene.obj, what they name, and wrapped.pbrt.gz into the folder."""
    image = png(8, 6)
    (folder / "stripes.png").write_bytes(image)
    document, data = gltf(None)
    document["buffers"][0]["uri"] = "scene.bin"
    (folder / "scene.gltf").write_text(json.dumps(document, indent=1))
    (folder / "scene.bin").write_bytes(data)
    (folder / "scene.glb").write_bytes(glb(*gltf(image)))
    (folder / "scene.obj").write_text(obj())
    (folder / "scene.mtl").write_text(MTL)
    (folder / "version3.pbrt").write_text(VERSION_3)
    (folder / "wrapped.pbrt.gz").write_bytes(gzip.compress(INSTANCES.encode(), mtime=0))


VERSION_3 = """LookAt 0 2 6  0 0.4 0  0 1 0
Camera "perspective" "float fov" [35]
Sampler "halton" "integer pixelsamples" [16]
Integrator "sppm" "integer photonsperiteration" [1000] "float radius" [0.1]
Film "image" "integer xresolution" [64] "integer yresolution" [48] "string filename" "picture.png"
WorldBegin
LightSource "infinite" "rgb L" [0.3 0.3 0.4]
LightSource "spot" "point from" [2 4 2] "point to" [0 0 0] "blackbody I" [4000 20] "float coneangle" [30]
Texture "stripes" "color" "imagemap" "string filename" "stripes.png" "string wrap" "clamp"
Texture "checks" "spectrum" "checkerboard" "float uscale" [4] "rgb tex1" [0.1 0.2 0.3] "texture tex2" "stripes"
MakeNamedMaterial "a" "string type" "uber" "rgb Kd" [0.4 0.3 0.2] "rgb Ks" [0.2 0.2 0.2] "float roughness" [0.1]
MakeNamedMaterial "b" "string type" "mirror"
Material "mix" "string namedmaterial1" "a" "string namedmaterial2" "b" "rgb amount" [0.5 0.5 0.5]
Shape "trianglemesh" "point P" [-3 0 3  3 0 3  3 0 -3  -3 0 -3] "float uv" [0 0 1 0 1 1 0 1]
  "integer indices" [0 1 2 0 2 3]
TransformBegin
Translate -0.7 0.5 0
Material "glass" "rgb Kr" [1 1 1] "rgb Kt" [0.9 1 0.9] "float index" [1.5]
Shape "sphere" "float radius" [0.4]
TransformEnd
AttributeBegin
Translate 0.7 0.5 0
Material "disney" "rgb color" [0.3 0.4 0.8] "float metallic" [0.4] "float sheen" [0.3] "float clearcoat" [0.5]
Shape "heightfield" "integer nu" [2] "integer nv" [3] "float Pz" [0 0.1 0.2 0.3 0.1 0]
Material "substrate" "texture Kd" "checks" "float uroughness" [0.1] "float vroughness" [0.2]
Shape "cylinder" "float radius" [0.3] "float zmin" [-0.5] "float zmax" [0.5]
Material "metal" "float roughness" [0.05] "spectrum eta" "metal-Cu-eta" "spectrum k" "metal-Cu-k"
Shape "loopsubdiv" "integer nlevels" [2] "point P" [-0.3 0 0.3  0.3 0 0.3  0 0.6 0  0 0 -0.4]
  "integer indices" [0 1 2 1 3 2 3 0 2 0 3 1]
AttributeEnd
AttributeBegin
AreaLightSource "diffuse" "rgb L" [8 7 6] "bool twosided" "true"
Translate 0 2.5 0
Rotate 90 1 0 0
Shape "disk" "float radius" [0.5]
AttributeEnd
WorldEnd
"""

# What the scenes in tests/scenes have few of: instances, still and in motion, of quadrics, meshes, curves and lamps.
INSTANCES = """LookAt 0 2 6  0 0.4 0  0 1 0
Camera "perspective" "float fov" [35] "float lensradius" [0.02] "float focaldistance" [6] "float shutterclose" [1]
Film "rgb" "integer xresolution" [64] "integer yresolution" [48]
TransformTimes 0 1
WorldBegin
Texture "stripes" "spectrum" "imagemap" "string filename" "stripes.png"
LightSource "infinite" "rgb L" [0.3 0.3 0.4]
LightSource "spot" "point3 from" [2 4 2] "point3 to" [0 0 0] "rgb I" [20 20 20] "float coneangle" [30]
Material "coateddiffuse" "texture reflectance" "stripes" "float roughness" [0.1]
Shape "trianglemesh" "point3 P" [-3 0 3  3 0 3  3 0 -3  -3 0 -3] "point2 uv" [0 0 1 0 1 1 0 1]
  "normal N" [0 1 0  0 1 0  0 1 0  0 1 0] "integer indices" [0 1 2 0 2 3]
ObjectBegin "group"
Material "dielectric" "float eta" [1.5]
Shape "sphere" "float radius" [0.3]
Material "conductor" "float roughness" [0.2]
Shape "cylinder" "float radius" [0.1] "float zmin" [-0.5] "float zmax" [0.5]
Shape "disk" "float radius" [0.4] "float height" [-0.2]
Shape "bilinearmesh" "point3 P" [-0.4 0 0.4  0.4 0.1 0.4  -0.4 0 -0.4  0.4 0.4 -0.4]
Material "hair" "float eumelanin" [1.3]
Shape "curve" "point3 P" [0 0 0  0.1 0.3 0  0 0.6 0.1  0.2 0.9 0] "float width" [0.05] "string type" ["cylinder"]
Shape "curve" "point3 P" [0.2 0 0  0.3 0.3 0  0.2 0.6 0.1  0.4 0.9 0] "float width" [0.05] "string type" ["ribbon"]
  "normal N" [0 0 1  0.2 0 1]
AttributeBegin
AreaLightSource "diffuse" "rgb L" [8 7 6]
Translate 0 1 0
Shape "sphere" "float radius" [0.1]
AttributeEnd
ObjectEnd
AttributeBegin
Translate -1.2 0.4 0
Scale 1 1.5 1
ObjectInstance "group"
AttributeEnd
AttributeBegin
Translate 1.2 0.4 0
ConcatTransform [1 0 0 0  0.4 1 0 0  0 0 -1 0  0 0 0 1]
ActiveTransform EndTime
Rotate 30 0 1 0
Scale 1.2 1 1
ActiveTransform All
ObjectInstance "group"
AttributeEnd
MakeNamedMedium "fog" "string type" "homogeneous" "rgb sigma_s" [1 1 1] "rgb sigma_a" [0.2 0.1 0.1] "rgb Le" [0.1 0 0]
AttributeBegin
MediumInterface "fog" ""
Material "interface"
Translate 0 0.6 0.5
Shape "sphere" "float radius" [0.5]
AttributeEnd
"""
