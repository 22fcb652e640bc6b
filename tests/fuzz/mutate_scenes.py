#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The Lanthorn authors
# SPDX-License-Identifier: Apache-2.0
"""Usage: mutate_scenes.py PROGRAM FOLDER [COUNT [SEED]]

Renders COUNT (1000) random mutations of the .pbrt files in FOLDER, and of the files that they name, with PROGRAM, best a
build with sanitizers. A run must end with exit code 0 and a picture, or with 2, a message that names a place, and no
picture. Prints what did not, keeps those files, and ends with exit code 1 if there were any. By hand: it takes minutes.
"""
import os
import random
import re
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

WORDS = [b"-1", b"0", b"1e38", b"-1e38", b"nan", b"inf", b"1e-45", b"4294967296", b"2147483647", b"[", b"]", b'"', b"#",
         b"AttributeEnd", b"WorldBegin", b"Include", b'"no-such-file"', b"ObjectBegin", b"true", b"\xff", b"\0"]
LIMIT_S = 60
NUMBERS = WORDS[:9]


def mutate_text(text: bytes, rng: random.Random) -> bytes:
    tokens = re.findall(rb'"[^"\n]*"|[\[\]]|[^\s\[\]"]+|\s+', text)
    for _ in range(rng.choice([1, 1, 2, 5])):
        i = rng.randrange(len(tokens))
        kind = rng.choice([0, 1, 2, 3, 4, 5, 5, 5, 5])
        if kind == 0:
            tokens[i] = rng.choice(WORDS)
        elif kind == 1:
            del tokens[i]
        elif kind == 2:
            tokens.insert(i, tokens[rng.randrange(len(tokens))])
        elif kind == 3:
            j = rng.randrange(len(tokens))
            tokens[i], tokens[j] = tokens[j], tokens[i]
        elif kind == 4:
            del tokens[i:]
            tokens.append(b" ")
        else:
            numbers = [k for k, t in enumerate(tokens) if re.fullmatch(rb"-?[\d.]+(e-?\d+)?", t)]
            if numbers:
                tokens[rng.choice(numbers)] = rng.choice(NUMBERS)
    return b"".join(tokens)


def mutate_bytes(data: bytes, rng: random.Random) -> bytes:
    result = bytearray(data)
    for _ in range(rng.choice([1, 3, 10])):
        result[rng.randrange(min(len(result), rng.choice([300, len(result)])))] = rng.randrange(256)
    return bytes(result[: rng.randrange(len(result))] if rng.random() < 0.2 else result)


def is_named(path: Path, scene: Path) -> bool:
    return b'"' + os.path.relpath(path, scene.parent).encode() + b'"' in scene.read_bytes()


def problem_of(run: subprocess.CompletedProcess, victim: str, picture: Path) -> str:
    if b"Sanitizer" in run.stderr or b"runtime error" in run.stderr:
        return "sanitizer"
    if run.returncode == 0:
        return "" if picture.exists() else "no picture"
    if run.returncode != 2:
        return f"exit code {run.returncode}"
    if picture.exists():
        return "a picture in spite of an error"
    # Of binary files the name is all that there is to say.
    place = rb"\.pbrt:\d+:\d+: " if victim.endswith(".pbrt") else rb":\d+:\d+: |" + re.escape(victim.encode())
    return "" if re.search(place, run.stderr) else "a message without a place"


def main() -> int:
    program, source = Path(sys.argv[1]).resolve(), Path(sys.argv[2])
    count = int(sys.argv[3]) if len(sys.argv) > 3 else 1000
    rng = random.Random(int(sys.argv[4]) if len(sys.argv) > 4 else 1)
    kept = Path(tempfile.mkdtemp(prefix="lanthorn-mutations-"))
    endings = {}
    bad = 0
    for number in range(count):
        folder = kept / f"{number}"
        shutil.copytree(source, folder, ignore=shutil.ignore_patterns("refs", "*.md", "*.py"))
        scenes = sorted(folder.rglob("*.pbrt"))
        scene = scenes[number % len(scenes)]
        others = [p for p in sorted(folder.rglob("*.*")) if p.suffix != ".pbrt" and is_named(p, scene)]
        if others and rng.random() < 0.2:
            victim = rng.choice(others)
            victim.write_bytes(mutate_bytes(victim.read_bytes(), rng))
        else:
            victim = scene
            scene.write_bytes(mutate_text(scene.read_bytes(), rng))
        picture = scene.parent / "picture.exr"
        command = [program, "render", scene.name, "-o", picture.name, "-p", "1", "-n", "1000", "-q", "-r", "16x12"]
        try:
            run = subprocess.run(command, cwd=scene.parent, capture_output=True, timeout=LIMIT_S)
            problem = problem_of(run, victim.name, picture)
            ending = f"exit code {run.returncode}"
        except subprocess.TimeoutExpired:
            problem, ending, run = f"longer than {LIMIT_S} s", "time", None
        endings[ending] = endings.get(ending, 0) + 1
        if not problem:
            shutil.rmtree(folder)
            continue
        bad += 1
        print(f"{problem}: {victim} ({scene.name})")
        if run is not None:
            print(run.stderr.decode(errors="replace")[:600])
    print(f"{count} mutations: {endings}; {bad} bad, kept in {kept}")
    return 1 if bad else 0


if __name__ == "__main__":
    sys.exit(main())
