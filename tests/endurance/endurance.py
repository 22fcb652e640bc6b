#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The Lanthorn authors
# SPDX-License-Identifier: Apache-2.0
"""Usage: endurance.py PROGRAM [--kills N] [--signals N] [--disks N] [--seed S] [--keep]

Interrupts renders at random moments, in three ways, and checks what the documentation promises:

  kills    SIGKILL at a random moment. Every file with its final name is complete, resuming the last checkpoint gives
           the same bytes as an undisturbed render, and the next render leaves no temporary file.
  signals  a random signal, up to three times. Signals that ask a program to end save what was rendered and end with
           exit code 0 (a third one ends it at once). After all others, files are complete, as after a kill.
  disks    a disk that fills up at a random byte (a small tmpfs, which needs root), or a limit on the size of a file.
           The program reports it, exits with 2, leaves no partial file there, and resuming the state that it saves
           elsewhere gives the same bytes.

Prints one line for each way, keeps the folders of failures, and exits with 1 if there are any. Not run by ctest: it
takes minutes.
"""
import argparse
import os
import random
import resource
import shutil
import signal
import subprocess
import sys
import tempfile
import time
from pathlib import Path

SCENE = Path(__file__).resolve().parents[2] / "scenes" / "cornell-caustics.pbrt"
METHODS = ["auto", "probppm", "sppm", "ppm", "vcm", "bdpt", "path", "light", "mlt", "photonmap", "reversephotonmap", "bpm"]
ASKING = [signal.SIGINT, signal.SIGTERM, signal.SIGHUP, signal.SIGPIPE, signal.SIGXFSZ]
ENDING = [signal.SIGKILL, signal.SIGQUIT, signal.SIGUSR1, signal.SIGUSR2, signal.SIGALRM, signal.SIGABRT,
          signal.SIGSEGV, signal.SIGBUS, signal.SIGXCPU, signal.SIGPROF, signal.SIGVTALRM]
PASSES = dict.fromkeys(METHODS, 60) | {"photonmap": 10, "reversephotonmap": 10}  # their passes take longer
LIMIT_S = 120  # longer is a hang


class Failure(Exception):
    pass


def check(condition: bool, what: str) -> None:
    if not condition:
        raise Failure(what)


class Trial:
    """A folder for a render that is disturbed, and the bytes that it must have in the end."""

    references: dict[str, bytes] = {}
    seconds: dict[str, float] = {}  # that the undisturbed render takes

    def __init__(self, program: Path, folder: Path, method: str):
        self.program, self.folder, self.method = program, folder, method
        self.home = folder / "home"
        self.home.mkdir(parents=True)
        self.work = folder / "work"
        self.work.mkdir()
        self.messages = folder / "messages"

    def command(self, outputs: list[str], more: list[str]) -> list[str]:
        words = [str(self.program), "render", str(SCENE), "-i", self.method, "-r", "64x64", "-n", "4000", "-q",
                 "--reproducible", "-p", str(PASSES[self.method])]
        for output in outputs:
            words += ["-o", output]
        return words + more

    def start(self, outputs: list[str], more: list[str], **options) -> subprocess.Popen:
        environment = dict(os.environ, HOME=str(self.home), XDG_STATE_HOME=str(self.home / "state"))
        with open(self.messages, "wb") as messages:
            return subprocess.Popen(self.command(outputs, more), cwd=self.work, env=environment,
                                    stdout=subprocess.DEVNULL, stderr=messages, **options)

    def said(self) -> str:
        return self.messages.read_text(errors="replace")

    def finish(self, process: subprocess.Popen) -> tuple[int, str]:
        try:
            process.wait(timeout=LIMIT_S)
        except subprocess.TimeoutExpired:
            process.kill()
            raise Failure(f"no end after {LIMIT_S} s: {self.said()}") from None
        return process.returncode, self.said()

    def reference(self) -> bytes:
        """The picture of all passes, rendered without interruption."""
        if self.method not in Trial.references:
            start = time.monotonic()
            code, err = self.finish(self.start(["reference.exr"], []))
            check(code == 0, f"the undisturbed render ends with {code}: {err}")
            Trial.seconds[self.method] = time.monotonic() - start
            Trial.references[self.method] = (self.work / "reference.exr").read_bytes()
            (self.work / "reference.exr").unlink()
        return Trial.references[self.method]

    def leftovers(self) -> list[str]:
        return sorted(p.name for p in self.work.glob("*.tmp"))

    def check_whole(self, path: Path) -> None:
        run = subprocess.run([self.program, "info", path], capture_output=True, timeout=LIMIT_S)
        check(run.returncode == 0, f"{path.name} is damaged: {run.stderr.decode(errors='replace')}")

    def check_goes_on(self, state: Path | None) -> None:
        """A new render, resuming `state` if there is one, gives the reference and deletes temporary files."""
        more = ["--resume", str(state)] if state else []
        # --force: other states of the disturbed render may have more passes than the one that is resumed.
        code, err = self.finish(self.start(["a.exr", "a.state"], more + ["--force"]))
        check(code == 0, f"going on ends with {code}: {err}")
        check((self.work / "a.exr").read_bytes() == self.reference(), "going on gives other bytes")
        check(not self.leftovers(), f"left over: {self.leftovers()}")

    def newest_state(self) -> Path | None:
        states = sorted(list(self.work.glob("*.state")) + list(self.home.rglob("*.state")),
                        key=lambda p: p.stat().st_mtime)
        for state in states:
            self.check_whole(state)
        return states[-1] if states else None

    def check_files(self) -> None:
        for path in self.work.iterdir():
            if path.suffix in (".exr", ".png"):
                self.check_whole(path)


def disturb(process: subprocess.Popen, signals: list[signal.Signals], span: float, rng: random.Random) -> None:
    """Sends the first signal at a random moment within `span` seconds, and the others shortly afterwards."""
    for number, each in enumerate(signals):
        time.sleep(rng.uniform(0, span if number == 0 else 0.1))
        if process.poll() is not None:
            return
        process.send_signal(each)


def kill_trial(trial: Trial, rng: random.Random) -> None:
    trial.reference()
    process = trial.start(["a.exr", "a.state"], ["--checkpoint", "0.05"])
    disturb(process, [signal.SIGKILL], Trial.seconds[trial.method], rng)
    code, err = trial.finish(process)
    check(code in (0, -signal.SIGKILL), f"ends with {code}: {err}")
    check(len(trial.leftovers()) <= 1, f"left over: {trial.leftovers()}")
    trial.check_files()
    trial.check_goes_on(trial.newest_state())


def signal_trial(trial: Trial, rng: random.Random) -> None:
    trial.reference()
    asked = rng.random() < 0.7
    times = rng.choice([1, 1, 2, 3]) if asked else 1
    signals = [rng.choice(ASKING if asked else ENDING) for _ in range(times)]
    process = trial.start(["a.exr", "a.state"], ["--checkpoint", "0.05"])
    disturb(process, signals, Trial.seconds[trial.method], rng)
    code, err = trial.finish(process)
    names = " ".join(s.name for s in signals)
    nothing_yet = code == 2 and "nothing to save" in err
    if asked and times < 3:
        # Before the program handles signals, a signal terminates it.
        before = code < 0 and not any(trial.work.iterdir())
        check(code == 0 or nothing_yet or before, f"{names}: ends with {code}: {err}")
    if code == 0:
        check((trial.work / "a.exr").exists() and (trial.work / "a.state").exists(), f"{names}: a file is missing")
        check(not trial.leftovers(), f"{names}: left over: {trial.leftovers()}")
    trial.check_files()
    trial.check_goes_on(trial.newest_state())


def disk_trial(trial: Trial, rng: random.Random) -> None:
    reference = trial.reference()
    by_limit = rng.random() < 0.5 or os.geteuid() != 0
    room = rng.randrange(4096, 4 * len(reference))
    outputs, more = ["a.exr", "a.state", "a.png"], ["--checkpoint", "0.05"]
    if by_limit:
        process = trial.start(outputs, more, preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (room, room)))
    else:
        subprocess.run(["mount", "-t", "tmpfs", "-o", f"size={room}", "tmpfs", trial.work], check=True)
        process = trial.start(outputs, more)
    saved = None
    try:
        while process.poll() is None and "exists only in memory" not in trial.said():
            time.sleep(0.02)
        process.terminate()
        code, err = trial.finish(process)
        check(code in (0, 2), f"ends with {code}: {err}")
        given_up = "not saved" in err
        check(by_limit or not given_up, f"gives up in spite of the home folder: {err}")
        check(not trial.leftovers(), f"left over: {trial.leftovers()}")
        trial.check_files()
        state = trial.newest_state()
        check(code == 0 or given_up or state is not None, f"nothing is saved: {err}")
        if state:
            saved = trial.folder / "saved.state"
            shutil.copy(state, saved)
    finally:
        if not by_limit:
            subprocess.run(["umount", trial.work], check=True)
    trial.check_goes_on(saved)


def run_trials(name: str, count: int, trial_of, options, rng: random.Random, root: Path) -> int:
    bad = 0
    start = time.monotonic()
    for number in range(count):
        folder = root / f"{name}-{number}"
        trial = Trial(options.program.resolve(), folder, METHODS[number % len(METHODS)])
        try:
            trial_of(trial, rng)
        except Failure as failure:
            bad += 1
            print(f"{name} {number} ({trial.method}): {failure}\n  kept in {folder}", flush=True)
            continue
        if not options.keep:
            shutil.rmtree(folder)
    print(f"{name}: {count} trials, {bad} failed, {time.monotonic() - start:.0f} s", flush=True)
    return bad


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program", type=Path)
    parser.add_argument("--kills", type=int, default=100)
    parser.add_argument("--signals", type=int, default=100)
    parser.add_argument("--disks", type=int, default=50)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--keep", action="store_true", help="keep all folders")
    options = parser.parse_args()
    rng = random.Random(options.seed)
    root = Path(tempfile.mkdtemp(prefix="lanthorn-endurance-"))
    bad = run_trials("kills", options.kills, kill_trial, options, rng, root)
    bad += run_trials("signals", options.signals, signal_trial, options, rng, root)
    bad += run_trials("disks", options.disks, disk_trial, options, rng, root)
    if not bad and not options.keep:
        shutil.rmtree(root)
    return 1 if bad else 0


if __name__ == "__main__":
    sys.exit(main())
