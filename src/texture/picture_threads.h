// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <OpenImageIO/imageio.h>

#include <algorithm>
#include <thread>

#include "base/parallel.h"
#include "base/threads.h"

namespace lanthorn {

/// Must be called before a picture is read or written. OpenEXR starts a thread for every core and fails if it cannot:
/// if there are not enough threads besides ours, OpenEXR gets none.
inline void limit_picture_threads() {
  static const bool done = [] {
    const unsigned wanted = thread_count() - 1 + std::max(1u, std::thread::hardware_concurrency());
    if (startable_threads(wanted) < wanted) OIIO::attribute("exr_threads", -1);
    return true;
  }();
  static_cast<void>(done);
}

}  // namespace lanthorn
