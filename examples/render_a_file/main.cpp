// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Renders a scene file to a picture (.exr or .png): render_a_file SCENE PICTURE
#include <lanthorn/error.h>
#include <lanthorn/image_file.h>
#include <lanthorn/scene.h>
#include <lanthorn/session.h>

#include <iostream>

int main(int argc, char** argv) {
  if (argc != 3) {
    std::cerr << "usage: render_a_file SCENE PICTURE\n";
    return 2;
  }
  try {
    lanthorn::RenderOptions options;
    options.passes = 16;
    lanthorn::Session session(lanthorn::build_scene(lanthorn::read_scene(argv[1])), options);
    while (session.pass_count() < options.passes && session.render_pass())
      std::cerr << '\r' << session.pass_count() << " of " << *options.passes << " passes" << std::flush;
    lanthorn::write_image(argv[2], session.picture());
    std::cerr << '\n';
  } catch (const lanthorn::Error& e) {
    std::cerr << e.what() << '\n';
    return 2;
  }
}
