# SPDX-FileCopyrightText: 2026 The Lanthorn authors
# SPDX-License-Identifier: Apache-2.0
"""Translates Blender's cameras and viewports to cameras of Lanthorn."""
import numpy


def rows(matrix):
    return [list(row) for row in matrix]


def times_flip_z(matrix):
    """Returns the camera-to-world matrix with z negated: Blender's cameras look along -z, Lanthorn's along +z."""
    return [[row[0], row[1], -row[2], row[3]] for row in matrix]


def screen_window(projection, is_perspective):
    """Returns the edges of the picture (x0, x1, y0, y1): in the plane z = 1 of a perspective camera, or in metres."""
    p = projection
    if is_perspective:
        return [(p[0][2] - 1) / p[0][0], (p[0][2] + 1) / p[0][0], (p[1][2] - 1) / p[1][1], (p[1][2] + 1) / p[1][1]]
    return [(-1 - p[0][3]) / p[0][0], (1 - p[0][3]) / p[0][0], (-1 - p[1][3]) / p[1][1], (1 - p[1][3]) / p[1][1]]


def lens_of(camera, matrix_world):
    """Returns the radius and the focal distance of the lens, in metres."""
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
    """Returns the camera of a final render. `size` is the size of the whole picture in pixels."""
    camera = object.data
    if camera.type == "PANO":
        report.note(object.name, "panoramic cameras are rendered as equirectangular ones")
        return {"type": "spherical", "mapping": "equirectangular",
                "camera_to_world": times_flip_z(without_scale(object.matrix_world))}
    projection = object.calc_matrix_camera(depsgraph, x=size[0], y=size[1], scale_x=pixel_aspect[0],
                                           scale_y=pixel_aspect[1])
    is_perspective = camera.type == "PERSP"
    if camera.dof.use_dof and (camera.dof.aperture_blades or camera.dof.aperture_ratio != 1):
        report.note(object.name, "the blades and the ratio of the aperture are not supported: it is a disk")
    part = {"type": "perspective" if is_perspective else "orthographic",
            "camera_to_world": times_flip_z(without_scale(object.matrix_world)),
            "screen_window": screen_window(projection, is_perspective), **lens_of(camera, object.matrix_world)}
    if is_perspective:
        part["fov"] = 90.0
    return part


def view_part(region_data):
    """Returns the camera of a viewport."""
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
    """Returns the pixels x0, y0, x1, y1 of the render region, y downwards, as Lanthorn's `crop`; all without a border."""
    width, height = size
    if not render.use_border:
        return [0, 0, width, height]

    def pixel(share, extent):  # rounded in single precision, as in Blender
        return int(numpy.float32(share) * numpy.float32(extent))

    x0, x1 = pixel(render.border_min_x, width), pixel(render.border_max_x, width)
    y0, y1 = pixel(render.border_min_y, height), pixel(render.border_max_y, height)
    return [x0, height - max(y1, y0 + 1), max(x1, x0 + 1), height - y0]


def film_part(size):
    return {"width": size[0], "height": size[1]}


def filter_part(width):
    """Returns a Gaussian of the width of Cycles' Blackman-Harris filter."""
    return {"kind": "gaussian", "radius": [width, width], "sigma": max(width, 1e-3) / 4}


def axial_depth(distance, window):
    """Converts distances along the rays of a perspective camera to Blender's depth along the camera's axis. `distance`
    has rows from the top; `window` is the `screen_window` of its pixels."""
    height, width = distance.shape
    x = numpy.linspace(window[0], window[1], 2 * width + 1, dtype=numpy.float32)[1::2]
    y = numpy.linspace(window[3], window[2], 2 * height + 1, dtype=numpy.float32)[1::2]
    return distance / numpy.sqrt(1 + x[None, :] ** 2 + y[:, None] ** 2)


def window_of_border(window, size, border):
    (x0, x1, y0, y1), (width, height) = window, size
    left, top, right, bottom = border
    return [x0 + (x1 - x0) * left / width, x0 + (x1 - x0) * right / width,
            y1 - (y1 - y0) * bottom / height, y1 - (y1 - y0) * top / height]
