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

Units are metres, watts and degrees; colours are linear Rec.709; a picture's rows start at the top. What is wrong with a
file, a scene or an option raises `lanthorn.Error`, which says where. docs/python.md has the rest.
"""

from . import _lanthorn
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
    methods,
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

    denoise: without its noise. options: as of Session, such as noise=0.02, passes=64, seconds=10, integrator="vcm",
    resolution=(640, 360). Ctrl-C raises KeyboardInterrupt after the running pass, whose attribute `picture` is what was
    rendered until then.
    """
    session = Session(scene, **options)
    try:
        session.render()
    except KeyboardInterrupt as interrupt:
        interrupt.picture = session.picture() if session.pass_count else None
        raise
    return session.denoised() if denoise else session.picture()


class Rays:
    """Rays of a tile: `origins` and `directions` (unit), both (n, 3) float32, metres, in the file's coordinates."""

    def __init__(self, origins, directions):
        """Keeps both arrays as they are."""
        self.origins = origins
        self.directions = directions

    def __len__(self):
        """Number of rays."""
        return len(self.origins)


class Integrator:
    """A rendering method in Python, to learn and to try things: override `radiance`, then `add_integrator`.

        class Normals(lanthorn.Integrator):
            "shows normals as colours"

            def radiance(self, rays, scene, sampler):
                return lanthorn.intersect(scene, rays.origins, rays.directions)["normal"] / 2 + 0.5

        lanthorn.add_integrator("normals", Normals())
        lanthorn.render(scene, integrator="normals", passes=4)

    Pixels, filters, passes, states and merging are those of every other method.
    """

    def radiance(self, rays, scene, sampler):
        """Returns the radiance along `rays` (Rays), shape (n, 3), linear Rec.709: one sample for each.

        scene: Scene. sampler: numpy.random.Generator; draw all random numbers from it, so that a render can be repeated.
        """
        raise NotImplementedError("an integrator needs a method radiance(self, rays, scene, sampler)")


def add_integrator(name, integrator):
    """Makes an Integrator a method of this name for `render` and Session; again: another one in its place."""

    def radiance(scene, origins, directions, key):
        import numpy

        sampler = numpy.random.Generator(numpy.random.Philox(key=key))
        return integrator.radiance(Rays(origins, directions), scene, sampler)

    _lanthorn._add_integrator(name, (integrator.__doc__ or "").strip().split("\n")[0], radiance)


__all__ = [name for name in dir() if not name.startswith("_")] + ["__version__"]
