# SPDX-FileCopyrightText: 2026 The Lanthorn authors
# SPDX-License-Identifier: Apache-2.0
"""Objects that Python makes or changes behind the module's back: errors, not crashes."""

import copy
import pathlib
import pickle
import shutil
import subprocess
import sys
import tempfile
import threading
import unittest

import numpy as np

import lanthorn

CLASSES = [value for value in vars(lanthorn).values() if isinstance(value, type) and value.__module__ == "lanthorn._lanthorn"]
WITH_CONSTRUCTOR = {lanthorn.Bsdf, lanthorn.Picture, lanthorn.Session, lanthorn.Error}


def examples():
    """An object of each class."""
    scene = lanthorn.load_dict({"film": {"width": 4, "height": 4}, "shapes": [{"type": "sphere"}], "lights": [{"type": "infinite"}]})
    session = lanthorn.Session(scene, integrator="path", passes=4)
    picture = session.render(passes=4)
    with tempfile.TemporaryDirectory() as folder:
        session.save(f"{folder}/a.state")
        state = lanthorn.open_state(f"{folder}/a.state")
    return [scene, session, picture, state, picture.error, session.passes(1), lanthorn.Bsdf({"type": "diffuse"}),
            lanthorn.trace_photons(scene, origins=[0, 0, 3], directions=[0, 0, -1])]


def use(thing):
    """Reads each attribute and calls each method that needs no arguments, ignoring exceptions."""
    for name in dir(type(thing)):
        try:
            member = getattr(thing, name)
            if callable(member) and name not in ("__class__", "__subclasshook__", "__init_subclass__"):
                member()
        except (TypeError, AttributeError, ValueError, lanthorn.Error, StopIteration):
            pass


class Misuse(unittest.TestCase):
    def test_all_classes_are_here(self):
        self.assertEqual({type(thing) for thing in examples()}, set(CLASSES) - {lanthorn.Error})

    def test_classes_without_constructor(self):
        for made in CLASSES:
            if made in WITH_CONSTRUCTOR:
                continue
            with self.subTest(made.__name__):
                heir = type("Heir", (made,), {})
                for attempt in (made, heir, lambda: made.__new__(made), lambda: heir.__new__(heir), lambda: object.__new__(made),
                                lambda: object.__new__(heir)):
                    with self.assertRaises(TypeError):
                        attempt()
        with self.assertRaisesRegex(TypeError, "lanthorn.*Scene has no constructor"):
            lanthorn.Scene()

    def test_objects_without_value(self):
        for made in WITH_CONSTRUCTOR - {lanthorn.Error}:
            with self.subTest(made.__name__):
                heir = type("Heir", (made,), {"__init__": lambda self: None})
                with self.assertRaises(TypeError):
                    heir()
                for bare in (made.__new__(made), heir.__new__(heir)):
                    use(bare)
        bare = lanthorn.Picture.__new__(lanthorn.Picture)
        for attempt in (lambda: bare.width, lambda: bare["color"], lambda: np.asarray(bare), lambda: lanthorn.compare(bare, bare),
                        lambda: lanthorn.Session.__new__(lanthorn.Session).pass_count,
                        lambda: lanthorn.Bsdf.__new__(lanthorn.Bsdf).eval([0, 0, 1], [0, 0, 1])):
            with self.assertRaisesRegex(TypeError, "without __init__"):
                attempt()

    def test_heirs_of_two_classes(self):
        for second in (lanthorn.Session, lanthorn.Scene):
            both = type("Both", (lanthorn.Picture, second), {})
            use(both.__new__(both))

    def test_values_stay_in_their_classes(self):
        for thing in examples():
            for other in CLASSES:
                if other is not type(thing):
                    with self.assertRaises(TypeError):
                        thing.__class__ = other
            self.assertIs(thing.__class__, type(thing))
            use(thing)

    def test_copies_and_pickles(self):
        for thing in examples():
            for attempt in (copy.copy, copy.deepcopy, *(lambda t, p=p: pickle.dumps(t, p) for p in range(6))):
                with self.subTest(repr(thing)):
                    with self.assertRaisesRegex(TypeError, "pickle|copy"):
                        attempt(thing)

    def test_methods_called_with_other_objects(self):
        for thing in examples():
            for other in CLASSES:
                for name, member in vars(other).items():
                    if other is type(thing) or not callable(member) or name in ("__new__", "__class__"):
                        continue
                    try:
                        member(thing)
                    except (TypeError, AttributeError, RuntimeError):
                        pass

    def test_initialised_twice(self):
        picture = lanthorn.Picture(np.ones((2, 2, 3)))
        array = picture.array
        picture.__init__(np.zeros((3, 3, 3)))
        np.testing.assert_array_equal(array, 1)

    def test_errors_have_their_attributes(self):
        error = pickle.loads(pickle.dumps(lanthorn.Error("of one's own")))
        self.assertEqual((str(error), error.file, error.line, error.column, error.message), ("of one's own", "", 0, 0, ""))

    def test_a_scene_that_was_read_from_a_session_stays(self):
        session = examples()[1]
        before = session.scene
        session.scene = before.edit(film={"width": 9, "height": 7})
        self.assertEqual((before.resolution, session.scene.resolution), ((4, 4), (9, 7)))

    def test_threads_may_read_a_session_that_renders(self):
        session = examples()[1]
        worker = threading.Thread(target=lambda: [session.render(passes=1) for _ in range(300)])
        worker.start()
        while worker.is_alive():
            repr((session.statistics, session.warnings, session.planned_passes, session.scene, session))
        worker.join()


class OtherVersions(unittest.TestCase):
    """Another version of Python looks for another name of the compiled module."""

    def message(self, rename):
        with tempfile.TemporaryDirectory() as folder:
            package = pathlib.Path(folder) / "lanthorn"
            shutil.copytree(pathlib.Path(lanthorn.__file__).parent, package, ignore=shutil.ignore_patterns("*.so*", "__pycache__"))
            for name in rename:
                (package / name).write_bytes(b"")
            ending = subprocess.run([sys.executable, "-c", "import lanthorn"], cwd=folder, env={"PYTHONPATH": folder}, text=True,
                                    stderr=subprocess.PIPE)
            self.assertEqual(ending.returncode, 1)
            return ending.stderr.splitlines()[-1]

    def test_the_message_names_both_versions(self):
        this = f"this is Python {sys.version.split()[0]}"
        said = self.message(["_lanthorn.cpython-399-x86_64-linux-gnu.so"])
        self.assertIn("ImportError: lanthorn was built for Python 3.99; " + this, said)
        self.assertIn("is not in", self.message([]))
        self.assertIn("too short", self.message([pathlib.Path(lanthorn._lanthorn.__file__).name]))  # the loader's own message


if __name__ == "__main__":
    unittest.main()
