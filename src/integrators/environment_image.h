// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "lanthorn/image.h"
#include "scene/scene.h"

namespace lanthorn {

/// All infinite lights of the scene as one equirectangular image, in linear RGB and in world space. Each texel is the
/// mean over several directions; with one direction per texel, a sun that covers a few texels would lose or gain light.
Image environment_image(const Scene& scene);

}  // namespace lanthorn
