# SPDX-FileCopyrightText: 2026 The Lanthorn authors
# SPDX-License-Identifier: Apache-2.0
"""Lanthorn renders light that other renderers lose: caustics, glass, water, lamps behind glass.

    import lanthorn

    scene = lanthorn.load_file("ring.pbrt")
    picture = lanthorn.render(scene, noise=0.02)    # until the error is below 2 %
    picture.save("ring.png")
    color = picture["color"]                        # numpy, (height, width, 3), no copy

    session = lanthorn.Session(scene, integrator="probppm")
    for picture in session.passes(64):              # the picture after each pass
        print(session.pass_count, picture.error)

Units are metres, watts and degrees; colours are linear Rec.709; a picture's rows start at the top. Invalid files,
scenes and options raise `lanthorn.Error`, which says where. docs/python.md has the rest.
"""

import html


def _problem():
    """Why the compiled module, which belongs to one version of Python, is not there; None if it is."""
    import importlib.machinery
    import pathlib
    import re
    import sys

    folder = pathlib.Path(__file__).resolve().parent
    built = sorted(file.name for file in folder.glob("_lanthorn*.so"))
    if any("_lanthorn" + suffix in built for suffix in importlib.machinery.EXTENSION_SUFFIXES):
        return None
    this = f"this is Python {sys.version.split()[0]} ({sys.executable})"
    if not built:
        return f"the compiled module of lanthorn is not in {folder}; {this}"
    versions = [re.sub(r"_lanthorn\.cpython-(\d)(\d+).*", r"Python \1.\2", name) for name in built]
    return f"lanthorn was built for {' and '.join(versions)}; {this} (docs/python.md says how to build it)"


try:
    from . import _lanthorn
except ImportError:
    if _problem() is None:
        raise
    raise ImportError(_problem()) from None
from ._lanthorn import (
    Bsdf,
    Error,
    ErrorEstimate,
    Passes,
    Photons,
    Picture,
    Scene,
    Session,
    State,
    __version__,
    bsdf_at,
    compare,
    converge,
    denoise,
    environments,
    ibl,
    intersect,
    load_dict,
    load_file,
    load_image,
    load_string,
    look_at,
    merge,
    open_state,
    radiance_along,
    read_environment,
    rotate,
    scale,
    set_threads,
    trace_photons,
    translate,
)


def render(scene, *, denoise=False, **options):
    """Renders the scene and returns the Picture.

    denoise: returns the denoised picture. options: the options of Session, such as noise=0.02, passes=64, seconds=10,
    integrator="vcm", resolution=(640, 360). Ctrl-C raises KeyboardInterrupt after the current pass; its attribute
    `picture` holds the Picture up to then, or None before the end of the first pass.
    """
    session = Session(scene, **options)
    try:
        session.render()
    except KeyboardInterrupt as interrupt:
        interrupt.picture = session.picture() if session.pass_count else None
        raise
    return session.denoised() if denoise else session.picture()


class Method(dict):
    """A rendering method: 'name', 'summary', 'paper' and 'parameters', which is {name: (default, help)}."""

    def __repr__(self):
        """Name and summary in one line."""
        return f"<lanthorn.Method {self['name']}: {self['summary']}>"

    def _repr_html_(self):
        """Representation in notebooks: the parameters with their defaults."""
        rows = "".join(_row(name, *texts) for name, texts in self["parameters"].items())
        paper = f"<br><i>{html.escape(self['paper'])}</i>" if self["paper"] else ""
        return f"<p><b>{html.escape(self['name'])}</b> {html.escape(self['summary'])}{paper}</p><table>{rows}</table>"


class Methods(list):
    """The methods, each a Method, in the order of `lanthorn list`."""

    def _repr_html_(self):
        """Representation in notebooks: one row per method."""
        return f"<table>{''.join(_row(m['name'], m['summary'], m['paper']) for m in self)}</table>"


def _row(name, *texts):
    cells = "".join(f"<td style='text-align:left'>{html.escape(text)}</td>" for text in texts)
    return f"<tr><th style='text-align:left'>{html.escape(name)}</th>{cells}</tr>"


def methods():
    """The rendering methods, a list of Method: summary, publication and parameters of each."""
    return Methods(map(Method, _lanthorn._methods()))


class Rays:
    """Rays of a tile: `origins` and `directions` (unit), both (n, 3) float32, metres, in the file's coordinates."""

    def __init__(self, origins, directions):
        """Keeps both arrays without copying them."""
        self.origins = origins
        self.directions = directions

    def __len__(self):
        """Number of rays."""
        return len(self.origins)


class Integrator:
    """A rendering method in Python, for teaching and experiments: override `radiance`, then call `add_integrator`.

        class Normals(lanthorn.Integrator):
            "shows normals as colours"

            def radiance(self, rays, scene, sampler):
                return lanthorn.intersect(scene, rays.origins, rays.directions)["normal"] / 2 + 0.5

        lanthorn.add_integrator("normals", Normals())
        lanthorn.render(scene, integrator="normals", passes=4)

    Pixels, filters, passes, states and merging work as for every other method.
    """

    def radiance(self, rays, scene, sampler):
        """Returns the radiance along `rays` (Rays), shape (n, 3), linear Rec.709: one sample per ray.

        scene: Scene. sampler: numpy.random.Generator; draw all random numbers from it, so that renders are repeatable.
        """
        raise NotImplementedError("an integrator needs a method radiance(self, rays, scene, sampler)")


def add_integrator(name, integrator):
    """Registers an Integrator under this name for `render` and Session; replaces an earlier one of the same name."""

    def radiance(scene, origins, directions, key):
        import numpy

        sampler = numpy.random.Generator(numpy.random.Philox(key=key))
        return integrator.radiance(Rays(origins, directions), scene, sampler)

    _lanthorn._add_integrator(name, (integrator.__doc__ or "").strip().split("\n")[0], radiance)


__all__ = [name for name in dir() if not name.startswith("_") and name != "html"] + ["__version__"]
