// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Renders a scene file to a picture (.exr or .png): render_a_file SCENE PICTURE
#include <lanthorn/render.h>

#include <iostream>

int main(int argc, char** argv) {
  if (argc != 3) {
    std::cerr << "usage: render_a_file SCENE PICTURE\n";
    return 2;
  }
  lanthorn::RenderRequest request;
  request.scene = argv[1];
  request.passes = 16;
  request.progress = [&](std::uint64_t passes) {
    std::cerr << '\r' << passes << " of " << *request.passes << " passes" << std::flush;
    return true;  // false would end the render here
  };
  try {
    lanthorn::save(lanthorn::render(request), argv[2]);
    std::cerr << '\n';
  } catch (const lanthorn::Error& e) {
    std::cerr << e.what() << '\n';
    return 2;
  }
}
