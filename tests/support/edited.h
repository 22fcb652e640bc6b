// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <utility>

#include "lanthorn/scene.h"
#include "scene/scene.h"

namespace lanthorn::test {

/// The scene after `edit(description)`, which shares with the scene what did not change.
template <class Edit>
SharedScene edited(const Scene& scene, Edit&& edit) {
  SceneDescription description = scene.description();
  edit(description);
  return build_scene(std::move(description), std::make_shared<const Scene>(scene));
}

}  // namespace lanthorn::test
