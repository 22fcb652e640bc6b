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


__all__ = [name for name in dir() if not name.startswith("_")] + ["__version__"]
