// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "path/path_class.h"

namespace lanthorn {

FilmContents path_layers(const Scene& scene) {
  FilmContents contents{.light = {"emission", "direct", "indirect", "caustic"}};
  if (scene.has_scattering_media() || scene.has_emissive_media()) contents.repeated = {"media"};
  return contents;
}

}  // namespace lanthorn
