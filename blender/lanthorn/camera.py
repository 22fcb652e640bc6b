# SPDX-FileCopyrightText: 2026 The Lanthorn authors
# SPDX-License-Identifier: Apache-2.0
"""Blender's cameras and views as Lanthorn's."""
import numpy


def rows(matrix):
    return [list(row) for row in matrix]


def times_flip_z(matrix):
    """Camera to world: Blender's cameras look along -z, Lanthorn's along +z."""
    return [[row[0], row[1], -row[2], row[3]] for row in matrix]


def screen_window(projection, is_perspective):
    """The edges of the picture (x0, x1, y0, y1): in the plane z = 1, or in metres of an orthographic camera."""
    p = projection
    if is_perspective:
        return [(p[0][2] - 1) / p[0][0], (p[0][2] + 1) / p[0][0], (p[1][2] - 1) / p[1][1], (p[1][2] + 1) / p[1][1]]
    return [(-1 - p[0][3]) / p[0][0], (1 - p[0][3]) / p[0][0], (-1 - p[1][3]) / p[1][1], (1 - p[1][3]) / p[1][1]]


def lens_of(camera, matrix_world):
    """Radius and focal distance of the lens, in metres."""
    dof = camera.dof
    if not dof.use_dof:
        return {}
    distance = dof.focus_distance
    if dof.focus_object is not None:
        to_focus = dof.focus_object.matrix_world.translation - matrix_world.translation
        axis = matrix_world.to_3x3().normalized().col[2]
        distance = abs(to_focus.dot(axis))
    focal_length = 1e-3 * camera.lens if camera.type == "PERSP" else camera.ortho_scale / 2
    return {"lens_radius": focal_length / (2 * max(dof.aperture_fstop, 1e-3)), "focal_distance": max(distance, 1e-5)}


def without_scale(matrix):
    location, rotation, _ = matrix.decompose()
    turned = rotation.to_matrix().to_4x4()
    turned.translation = location
    return turned


def camera_part(object, depsgraph, size, pixel_aspect, report):
    """The camera of a final render. `size`: width and height of the whole picture, in pixels."""
    camera = object.data
    if camera.type == "PANO":
        report.note(object.name, "a panoramic camera becomes an equirectangular one")
        return {"type": "spherical", "mapping": "equirectangular",
                "camera_to_world": times_flip_z(without_scale(object.matrix_world))}
    projection = object.calc_matrix_camera(depsgraph, x=size[0], y=size[1], scale_x=pixel_aspect[0],
                                           scale_y=pixel_aspect[1])
    is_perspective = camera.type == "PERSP"
    if camera.dof.use_dof and (camera.dof.aperture_blades or camera.dof.aperture_ratio != 1):
        report.note(object.name, "the aperture is a disk, without blades")
    part = {"type": "perspective" if is_perspective else "orthographic",
            "camera_to_world": times_flip_z(without_scale(object.matrix_world)),
            "screen_window": screen_window(projection, is_perspective), **lens_of(camera, object.matrix_world)}
    if is_perspective:
        part["fov"] = 90.0
    return part


def view_part(region_data):
    """What a viewport sees."""
    is_perspective = region_data.is_perspective
    part = {"type": "perspective" if is_perspective else "orthographic",
            "camera_to_world": times_flip_z(region_data.view_matrix.inverted()),
            "screen_window": screen_window(region_data.window_matrix, is_perspective)}
    if is_perspective:
        part["fov"] = 90.0
    return part


def picture_size(render):
    share = render.resolution_percentage / 100
    return max(1, int(render.resolution_x * share)), max(1, int(render.resolution_y * share))


def border_pixels(render, size):
    """x0, y0, x1, y1 of the part that is rendered, y downwards, as `crop` of Lanthorn; the whole without a border."""
    width, height = size
    if not render.use_border:
        return [0, 0, width, height]

    def pixel(share, extent):  # in single precision, as Blender does
        return int(numpy.float32(share) * numpy.float32(extent))

    x0, x1 = pixel(render.border_min_x, width), pixel(render.border_max_x, width)
    y0, y1 = pixel(render.border_min_y, height), pixel(render.border_max_y, height)
    return [x0, height - max(y1, y0 + 1), max(x1, x0 + 1), height - y0]


def film_part(size):
    return {"width": size[0], "height": size[1]}


def filter_part(width):
    """About the Blackman-Harris filter of Cycles: a Gaussian of the same width."""
    return {"kind": "gaussian", "radius": [width, width], "sigma": max(width, 1e-3) / 4}


def axial_depth(distance, window):
    """Depth along the camera's axis, as Blender has it, from the distance along rays of a perspective camera. `window`:
    `screen_window` of the pixels of `distance`, an array with rows from the top."""
    height, width = distance.shape
    x = numpy.linspace(window[0], window[1], 2 * width + 1, dtype=numpy.float32)[1::2]
    y = numpy.linspace(window[3], window[2], 2 * height + 1, dtype=numpy.float32)[1::2]
    return distance / numpy.sqrt(1 + x[None, :] ** 2 + y[:, None] ** 2)


def window_of_border(window, size, border):
    (x0, x1, y0, y1), (width, height) = window, size
    left, top, right, bottom = border
    return [x0 + (x1 - x0) * left / width, x0 + (x1 - x0) * right / width,
            y1 - (y1 - y0) * bottom / height, y1 - (y1 - y0) * top / height]
