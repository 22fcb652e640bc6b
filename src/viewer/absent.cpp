// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "lanthorn/viewer.h"

namespace lanthorn {

namespace {

[[noreturn]] void fail() {
  throw ViewerUnavailable("this lanthorn was built without OpenGL (LANTHORN_BUILD_VIEWER=OFF)");
}

}  // namespace

std::vector<MethodInfo> realtime_methods() { return {}; }

void make_nodes_movable(SceneDescription& /*scene*/) {}

ViewerFrames render_frames(const SharedScene& /*scene*/, const ViewDescription& /*view*/,
                           const ViewerOptions& /*options*/) {
  fail();
}

ViewerReport run_viewer(const SharedScene& /*scene*/, const ViewDescription& /*view*/,
                        const ViewerOptions& /*options*/) {
  fail();
}

}  // namespace lanthorn
