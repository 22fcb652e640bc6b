#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The Lanthorn authors
# SPDX-License-Identifier: Apache-2.0
"""Renders random mutations of scenes of all formats with random methods, best with a build with sanitizers.

Three passes of each. Every tenth mutation changes a saved state instead, which is then inspected, resumed or merged. A
run must end within its time and memory: either with exit code 0, a picture without NaN and only finite samples, or with
exit code 2, one line that names the scene or one of its files, and no picture. A run must leave no other files behind,
and no control character of a file may reach the terminal. Prints the failing runs, keeps their files and commands, and
ends with exit code 1 if there are any. Mutation N of a seed is always the same. Run it by hand: it takes hours.
"""
import argparse
import gzip
import json
import os
import random
import re
import resource
import shutil
import struct
import subprocess
import sys
import tempfile
import zlib
from collections import Counter
from pathlib import Path

import seed_scenes

LEARNERS = ["probppm", "sppm", "ppm", "photonmap", "vcm", "bpm", "reversephotonmap"]  # know emission=learned
METHODS = ["auto", "probppm", "sppm", "ppm", "photonmap", "vcm", "bpm", "bdpt", "path", "light", "mlt", "reversephotonmap"]
NUMBERS = ["0", "-0.0", "-1", "1", "1e-30", "-1e-30", "1e30", "-1e30", "1e38", "1e-45", "1e-18", "1e18", "1e-6", "1e6",
           "179.999", "1e12", "-2", "1e-12", "0.5", "1e15", "-1e9", "3", "100"]
UNREADABLE = ["nan", "inf", "-inf", "1e400", "-1e400", "4294967296", "2147483647"]
WORDS = ["nan", "inf", "-inf", "[", "]", '"', "#", "AttributeEnd", "WorldBegin", "Include", '"no-such-file"',
         "ObjectBegin", "true", "\xff", "\0", '""', "Scale 0 0 0", "Scale 1e-20 1e-20 1e-20", "Scale 1e20 1e20 1e20",
         "Scale -1 1 1", "ReverseOrientation"]
FLOATS = [0.0, -1.0, float("nan"), float("inf"), -float("inf"), 1e-30, 1e30, 3e38, 1e-45, 1e18, -1e18]
NUMBER = re.compile(r"-?(\d+\.?\d*|\.\d+)([eE][-+]?\d+)?")
SEEDED = (".gltf", ".glb", ".obj", ".gz", ".pbrt")
WALL_S = 90  # of a machine that does other work as well; CPU time is what is limited


def mutate_text(text: str, rng: random.Random) -> str:
    """In half of all cases, changes only readable numbers, because the reader rejects most other changes."""
    tokens = re.findall(r'"[^"\n]*"|#[^\n]*|[\[\]]|[^\s\[\]"]+|\s+', text)
    words = [i for i, token in enumerate(tokens) if not token.isspace() and not token.startswith("#")]
    values_only = rng.random() < 0.5
    for _ in range(rng.choice([1, 1, 2, 5])):
        i = rng.choice(words)
        kind = 11 if values_only else rng.randrange(12)
        numbers = [k for k in words if NUMBER.fullmatch(tokens[k])]
        if kind == 0:
            tokens[i] = rng.choice(WORDS)
        elif kind == 1:
            tokens[i] = ""
        elif kind == 2:
            tokens[i] += " " + tokens[rng.choice(words)]
        elif kind == 3:
            j = rng.choice(words)
            tokens[i], tokens[j] = tokens[j], tokens[i]
        elif kind == 4 and rng.random() < 0.3:
            tokens[i:] = [" "] * (len(tokens) - i)
        elif numbers:
            for k in rng.sample(numbers, min(len(numbers), rng.choice([1, 1, 1, 3]))):
                tokens[k] = rng.choice(NUMBERS if values_only or rng.random() < 0.8 else UNREADABLE)
    return "".join(tokens)


# Textures that name others, and by which parameters.
CHAINED = {"scale": ["tex", "scale"], "mix": ["tex1", "tex2"], "checkerboard": ["tex1", "tex2"],
           "directionmix": ["tex1", "tex2"], "bilerp": ["v00", "v11"], "dots": ["inside", "outside"]}


def add_chain(text: str, rng: random.Random) -> str:
    """A ball whose roughness is a chain of textures: each names the one before once (deep) or twice (doubling)."""
    kind = rng.choice(sorted(CHAINED))
    inputs = CHAINED[kind][: rng.choice([1, 2])]
    lines = ['Texture "chain0" "float" "fbm"']
    for i in range(1, rng.choice([2, 10, 30, 200, 10000])):
        named = " ".join(f'"texture {name}" "chain{i - 1}"' for name in inputs)
        lines.append(f'Texture "chain{i}" "float" "{kind}" {named}')
    is_v3 = "WorldEnd" in text
    lines += [f'Material "{"plastic" if is_v3 else "conductor"}" "texture roughness" "chain{len(lines) - 1}"',
              'Shape "sphere"', ""]
    end = text.rfind("WorldEnd") if is_v3 else len(text)
    return text[:end] + "\n" + "\n".join(lines) + text[end:]


def mutate_json(document: object, rng: random.Random) -> str:
    """Strings that begin with \\1 become bare numbers, which JSON's own writer does not know."""
    places: list = []
    values_only = rng.random() < 0.5

    def collect(value: object) -> None:
        keys = value.keys() if isinstance(value, dict) else range(len(value)) if isinstance(value, list) else ()
        for key in keys:
            places.append((value, key))
            collect(value[key])

    for _ in range(rng.choice([1, 1, 2, 4])):
        places.clear()
        collect(document)
        numbers = [(c, k) for c, k in places if isinstance(c[k], (int, float)) and not isinstance(c[k], bool)]
        container, key = rng.choice(numbers if values_only and numbers else places)
        kind = rng.randrange(8)
        if isinstance(container[key], (int, float)) and (values_only or kind < 6):
            container[key] = "\1" + rng.choice(NUMBERS if values_only or kind < 5 else UNREADABLE[3:])
        elif kind == 0:
            del container[key]
        elif kind == 1 and isinstance(container, list):
            container.insert(key, container[rng.randrange(len(container))])
        elif kind == 2:
            other, place = rng.choice(places)
            container[key] = json.loads(json.dumps(other[place]))
        elif kind == 3 and isinstance(container[key], list):
            del container[key][rng.randrange(len(container[key]) + 1):]
        elif kind == 4:
            container[key] = rng.choice([None, True, [], {}, "", "nan"])
        elif isinstance(container, dict):
            container[rng.choice(["scale", "matrix", "translation", "mesh", "extensions"])] = rng.choice(
                [[0, 0, 0], ["\0011e-20"] * 3, ["\0011e30"] * 3, [0] * 16, 0, {}])
    return re.sub(r'"\\u0001([^"]*)"', r"\1", json.dumps(document))


def mutate_bytes(data: bytes, rng: random.Random) -> bytes:
    result = bytearray(data)
    if not result:
        return b"\0"
    for _ in range(rng.choice([1, 3, 10])):
        if rng.random() < 0.5 and len(result) >= 8:
            struct.pack_into("<f", result, 4 * rng.randrange(len(result) // 4), rng.choice(FLOATS))
        else:
            result[rng.randrange(min(len(result), rng.choice([64, 300, len(result)])))] = rng.randrange(256)
    return bytes(result[: rng.randrange(len(result))] if rng.random() < 0.15 else result)


# Parameters at the ends of what is legal, by the kind of material or medium.
WIDTHS = {"uroughness": ["0", ".001", ".46", "10"], "vroughness": ["0", ".857", "1"]}
EXTREMES = {
    "diffuse": {"reflectance": ["0 0 0", "1 1 1"]},
    "conductor": WIDTHS | {"eta": ["0 0 0", "1e30 1 1e-30"], "k": ["0 0 0", "1e30 1e10 1"]},
    "dielectric": WIDTHS | {"eta": ["1", "1.0000001", "8.6", "1e10", "1e-10"]},
    "thindielectric": {"eta": ["1", "8.6", "1e10", "1e-10"]},
    "coateddiffuse": WIDTHS | {"eta": ["1", "8.6", "1e6"], "thickness": ["0", "1e10"], "reflectance": ["1 1 1"],
                               "albedo": ["0 0 0", "1 1 1"], "g": ["-1", ".9999999"], "maxdepth": ["1", "100"]},
    "coatedconductor": {"interface.uroughness": ["0", "1"], "interface.eta": ["1", "8.6"], "thickness": ["0", "1e10"]},
    "hair": {"beta_m": ["0", "1"], "beta_n": ["0", "1"], "alpha": ["-90", "90"], "eta": ["1", "10"]}}
MEDIUM = {"g": ["-.9999999", ".9999", ".9999999"], "sigma_s": ["3 3 3", "1e-10 1000 0"], "sigma_a": ["0 0 0", "1e6 0 1"]}


def extreme_parameters(of: dict, rng: random.Random) -> str:
    words = []
    for name in rng.sample(sorted(of), rng.randint(1, len(of))):
        value = rng.choice(of[name])
        kind = "integer" if name == "maxdepth" else "rgb" if " " in value else "float"
        words.append(f'"{kind} {name}" [{value}]')
    return " ".join(words)


def add_extremes(text: str, rng: random.Random) -> str:
    """A ball of a material with extreme parameters, around a medium with such ones in half of all cases."""
    kind = rng.choice(sorted(EXTREMES))
    lines = ["AttributeBegin"]
    if rng.random() < 0.5:
        lines += [f'MakeNamedMedium "extreme" "string type" "homogeneous" {extreme_parameters(MEDIUM, rng)}',
                  'MediumInterface "extreme" ""']
        kind = rng.choice(["dielectric", "thindielectric"])
    lines += [f'Material "{kind}" {extreme_parameters(EXTREMES[kind], rng)}', 'Shape "sphere" "float radius" [.5]',
              "AttributeEnd", ""]
    return text + "\n" + "\n".join(lines)


def mutate_state(data: bytes, rng: random.Random) -> bytes:
    """Damages the header or an unpacked block, and makes the checksum right again, which hides the damage."""
    if rng.random() < 0.1:
        return mutate_bytes(data, rng)
    length = struct.unpack_from("<I", data, 12)[0]
    header, rest, blocks = data[16 : 16 + length], data[16 + length : -4], []
    while rest:
        size = struct.unpack_from("<Q", rest)[0]
        blocks.append(zlib.decompress(rest[8 : 8 + size]))
        rest = rest[8 + size :]
    if rng.random() < 0.5:
        text = mutate_json(json.loads(header), rng)
        if rng.random() < 0.2:  # control characters in a random string
            text = re.sub(r'"([a-z]+)"', rng.choice([r'"\1\\u001b[31m"', r'"\1\\n"', r'"\1\\u009b"']), text, count=rng.randint(1, 20))
        header = text.encode(errors="surrogateescape")
    else:
        i = rng.choice([rng.randrange(len(blocks)), len(blocks) - 1])  # the last one is the integrator's
        damaged = bytearray(blocks[i])
        for _ in range(rng.choice([1, 3, 10])):
            if len(damaged) >= 8:
                kind, value = rng.choice([("<f", rng.choice(FLOATS)), ("<I", rng.randrange(1 << 32)), ("<d", 1e300)])
                struct.pack_into(kind, damaged, 4 * rng.randrange(len(damaged) // 4 - 1), value)
        blocks[i] = bytes(damaged)
    whole = data[:12] + struct.pack("<I", len(header)) + header
    for block in blocks:
        packed = zlib.compress(block)
        whole += struct.pack("<Q", len(packed)) + packed
    return whole + struct.pack("<I", zlib.crc32(whole))


def mutate_glb(data: bytes, rng: random.Random) -> bytes:
    length = struct.unpack_from("<I", data, 12)[0]
    text, binary = data[20 : 20 + length], data[28 + length :]
    if rng.random() < 0.6:
        return seed_scenes.glb(mutate_json(json.loads(text), rng).encode(errors="surrogateescape"), binary)
    if rng.random() < 0.7:
        return seed_scenes.glb(text, mutate_bytes(binary, rng))
    return mutate_bytes(data, rng)


def mutate(path: Path, rng: random.Random) -> None:
    data = path.read_bytes()
    if path.suffix in (".pbrt", ".obj", ".mtl", ".dat"):
        text = data.decode("latin-1")
        has_chain = path.suffix == ".pbrt" and rng.random() < 0.1
        path.write_bytes((add_chain(text, rng) if has_chain else mutate_text(text, rng)).encode("latin-1"))
    elif path.suffix == ".gz" and rng.random() < 0.9:
        text = mutate_text(gzip.decompress(data).decode("latin-1"), rng)
        path.write_bytes(gzip.compress(text.encode("latin-1"), mtime=0))
    elif path.suffix == ".gltf":
        path.write_text(mutate_json(json.loads(data), rng))
    elif path.suffix == ".glb":
        path.write_bytes(mutate_glb(data, rng))
    else:
        path.write_bytes(mutate_bytes(data, rng))


def named_by(scene: Path) -> list[Path]:
    """Files beside the scene that the scene names, directly or through another file."""
    files = [p for p in sorted(scene.parent.iterdir()) if p.suffix not in SEEDED]
    found: list[Path] = []
    text = scene.read_bytes()
    if scene.suffix == ".gz":
        text = gzip.decompress(text)
    for _ in range(2):
        for path in files:
            if path not in found and path.name.encode() in text:
                found.append(path)
                text += path.read_bytes()
    return found


class Runner:
    def __init__(self, options: argparse.Namespace):
        self.program = str(Path(options.program).resolve())
        self.has_sanitizer = b"__asan_init" in Path(self.program).read_bytes()
        self.seconds, self.megabytes = options.seconds, options.megabytes
        self.environment = os.environ | {
            "ASAN_OPTIONS": f"hard_rss_limit_mb={options.megabytes}:detect_leaks=0", "UBSAN_OPTIONS": "print_stacktrace=1"}

    def limit(self) -> None:
        resource.setrlimit(resource.RLIMIT_CPU, (self.seconds, self.seconds))
        resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
        if not self.has_sanitizer:  # which reserves terabytes of addresses
            resource.setrlimit(resource.RLIMIT_AS, (self.megabytes << 20, self.megabytes << 20))

    def run(self, arguments: list[str], folder: Path) -> subprocess.CompletedProcess:
        return subprocess.run([self.program, *arguments], cwd=folder, capture_output=True, timeout=WALL_S,
                              env=self.environment, preexec_fn=self.limit)


def problem_of(run: subprocess.CompletedProcess, runner: Runner, folder: Path, before: set[str],
               expects_picture: bool) -> str:
    """What is wrong with how a run ended, or an empty string."""
    errors = run.stderr.decode(errors="replace")
    if re.search(rb"[\x00-\x08\x0b-\x1f\x7f]|\xc2[\x80-\x9f]", run.stdout + run.stderr):
        return "a control character on the terminal"
    if "Sanitizer" in errors or "runtime error" in errors:
        limit = "rss limit" in errors or "allocation-size-too-big" in errors or "out-of-memory" in errors
        return "memory" if limit else "sanitizer"
    if run.returncode in (-9, -24):
        return f"more than {runner.seconds} s of CPU time"
    if run.returncode not in (0, 2):
        return f"exit code {run.returncode}"
    left = {p.name for p in folder.iterdir()} - before
    if run.returncode == 2:
        lines = [line for line in errors.splitlines() if line.startswith("lanthorn: ")]
        if left:
            return f"left behind: {sorted(left)}"
        if len(lines) != 1:
            return "not one line about the error"
        return "" if any(name in lines[0] for name in before) else "an error without a file"
    if re.search(r"[1-9]\d* samples were not finite", errors):
        return "samples that were not finite"
    if not left and not expects_picture:
        return ""
    if left != {"picture.exr"}:
        return f"left behind: {sorted(left)}"
    try:
        compared = runner.run(["compare", "picture.exr", "picture.exr", "--max-mse", "0"], folder)
    except subprocess.TimeoutExpired:
        return "the picture takes too long to read"
    return "" if compared.returncode == 0 else "the picture cannot be read, or has NaN in it"


def make_mutation(seeds: Path, folder: Path, name: str) -> tuple[Path, list[str]]:
    """A folder with a mutated scene; the scene and the arguments to render it."""
    rng = random.Random(name)
    kind = rng.choice([".pbrt", ".pbrt", ".gz", ".gltf", ".glb", ".obj"])
    scene = rng.choice([p for p in sorted(seeds.iterdir()) if p.suffix == kind])
    folder.mkdir(parents=True)
    for path in [scene, *named_by(scene)]:
        shutil.copy(path, folder)
    scene = folder / scene.name
    others = named_by(scene)
    is_v4 = kind == ".pbrt" and b"WorldEnd" not in scene.read_bytes()
    if is_v4 and rng.random() < 0.2:
        scene.write_text(add_extremes(scene.read_text("latin-1"), rng), "latin-1")
    else:
        mutate(scene if not others or rng.random() < 0.7 else rng.choice(others), rng)
    method = rng.choice(METHODS)
    arguments = ["render", scene.name, "-o", "picture.exr", "-i", method, "-p", "3", "-n", "1000", "-r", "16x12", "-T",
                 "2"]
    if method in LEARNERS and rng.random() < 0.3:
        arguments += ["--set", "emission=learned"]
    if rng.random() < 0.2:
        arguments += ["--color", "spectral"]
    if kind in (".gltf", ".glb") and rng.random() < 0.4:
        arguments += ["--at", "0.5"]
    for option in (["--window-glass"], ["--clamp", "5"]):
        if rng.random() < 0.1:
            arguments += option
    return scene, arguments


def make_state_mutation(runner: Runner, seeds: Path, folder: Path, name: str) -> tuple[Path, list[str]]:
    """A folder with a scene and a damaged state of two passes of it; the scene and arguments of a command on the state."""
    rng = random.Random(name)
    scene = rng.choice([p for p in sorted(seeds.iterdir()) if p.suffix == ".pbrt"])
    folder.mkdir(parents=True)
    for path in [scene, *named_by(scene)]:
        shutil.copy(path, folder)
    settings = ["-i", rng.choice(METHODS), "-n", "500", "-r", "16x12", "-T", "2"]
    runner.run(["render", scene.name, "-o", "a.state", "-p", "2", *settings], folder)
    state = folder / "a.state"
    if not state.exists():  # a scene that this method refuses
        return folder / scene.name, ["info", scene.name]
    state.write_bytes(mutate_state(state.read_bytes(), rng))
    return folder / scene.name, rng.choice([
        ["info", "a.state"], ["merge", "a.state", "-o", "picture.exr"],
        ["render", scene.name, "-o", "picture.exr", "-p", "3", "--resume", "a.state", *settings]])


def gather_seeds(sources: list[Path], folder: Path) -> None:
    """All scenes in one folder, with the files beside them."""
    folder.mkdir()
    for source in sources:
        for path in sorted(source.iterdir()):
            if path.is_file() and path.suffix not in (".md", ".py"):
                shutil.copy(path, folder)
    seed_scenes.write_seeds(folder)


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("program")
    parser.add_argument("scenes", nargs="*", type=Path, default=[Path(__file__).parent.parent / "scenes"],
                        help="folders with scenes to mutate besides generated ones (default: tests/scenes)")
    parser.add_argument("--count", type=int, default=2000)
    parser.add_argument("--seed", default="1")
    parser.add_argument("--first", type=int, default=0, help="number of the first mutation: to repeat one")
    parser.add_argument("--seconds", type=int, default=20, help="of CPU time for a run, at most")
    parser.add_argument("--megabytes", type=int, default=3000, help="of memory for a run, at most")
    options = parser.parse_args()

    runner = Runner(options)
    kept = Path(tempfile.mkdtemp(prefix="lanthorn-mutations-"))
    gather_seeds(options.scenes, kept / "seeds")
    endings, formats, methods, problems = Counter(), Counter(), Counter(), Counter()
    for number in range(options.first, options.first + options.count):
        folder = kept / str(number)
        name = f"{options.seed}-{number}"
        if number % 10 == 9:
            scene, arguments = make_state_mutation(runner, kept / "seeds", folder, name)
        else:
            scene, arguments = make_mutation(kept / "seeds", folder, name)
        before = {p.name for p in folder.iterdir()}
        try:
            run = runner.run(arguments, folder)
            problem = problem_of(run, runner, folder, before, arguments[0] != "info")
            ending = f"exit code {run.returncode}"
            text = run.stderr.decode(errors="replace")
        except subprocess.TimeoutExpired:
            problem, ending, text = f"longer than {WALL_S} s", "time", ""
        endings[ending] += 1
        formats[scene.suffix] += 1
        methods[arguments[arguments.index("-i") + 1] if "-i" in arguments else arguments[0]] += 1
        if (number + 1) % 100 == 0:
            print(f"{number + 1}: {dict(endings)}", flush=True)
        if not problem:
            shutil.rmtree(folder)
            continue
        problems[problem] += 1
        (folder / "command").write_text(" ".join(arguments) + "\n")
        (folder / "stderr").write_text(text)
        print(f"{problem}: {folder}: {' '.join(arguments)}\n{text[-600:]}", flush=True)
    print(f"{options.count} mutations: {dict(endings)}; {dict(formats)}; {dict(methods)}")
    print(f"{problems.total()} bad: {dict(problems)}, kept in {kept}")
    return 1 if problems else 0


if __name__ == "__main__":
    sys.exit(main())
