// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Forged states are rejected on resuming.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <memory>
#include <string>

#include "lanthorn/scene.h"
#include "lanthorn/session.h"
#include "render/state.h"
#include "support/error_text.h"

namespace lanthorn::resume_test {
namespace {

SharedScene box() { return build_scene(read_scene(LANTHORN_SOURCE_DIR "/scenes/cornell-caustics.pbrt")); }

RenderOptions small(const std::string& integrator) {
  RenderOptions options;
  options.integrator = integrator;
  options.photons = 1000;
  options.resolution = {12, 8};
  return options;
}

// Anybody can write the settings text of a state, so the data after it must be checked independently.
TEST(Resume, StatesWhoseFilmIsNotThatOfTheirSettingsAreRefused) {
  const SharedScene scene = box();
  Session first(scene, small("probppm"));
  first.render({.passes = {0, 1}});
  const auto refusal = [&](auto&& change) {
    auto forged = std::make_shared<RenderState>(first.state());
    change(*forged);
    Session resumed(scene, small("probppm"));
    return test::error_text([&] {
      resumed.resume(forged, "a.state");
      resumed.render();
    });
  };
  const Film& film = first.state().film;
  EXPECT_EQ(refusal([](RenderState&) {}), "no error");
  const std::string damaged = "a.state: damaged: its film is not that of its settings";
  EXPECT_EQ(refusal([&](RenderState& s) { s.film = Film(1, 1, 1, film.contents()); }), damaged);
  EXPECT_EQ(refusal([&](RenderState& s) {
              FilmContents contents = film.contents();
              contents.light.pop_back();
              s.film = Film(film.width(), film.height(), 1, contents);
            }),
            damaged);
  EXPECT_EQ(refusal([](RenderState& s) { s.integrator = "ppm"; }), damaged);
  EXPECT_EQ(refusal([](RenderState& s) { s.shardable = false; }), damaged);
}

TEST(Resume, StatesOfImpossibleRadiiAreRefused) {
  const SharedScene scene = box();
  for (const std::string schedule : {"hachisuka", "least-error", "chi-squared"})
    for (const std::string method : {"ppm", "sppm"}) {
      RenderOptions options = small(method);
      options.set["schedule"] = schedule;
      Session first(scene, options);
      first.render({.passes = {0, 1}});
      const auto refusal = [&](auto&& change) {
        auto forged = std::make_shared<RenderState>(first.state());
        change(forged->integrator_state);
        Session resumed(scene, options);
        return test::error_text([&] {
          resumed.resume(forged, "a.state");
          resumed.render({.passes = {1, 2}});
        });
      };
      SCOPED_TRACE(method + " " + schedule);
      EXPECT_EQ(refusal([](auto&) {}), "no error");
      EXPECT_EQ(refusal([](auto& bytes) { bytes.pop_back(); }),
                "a.state: damaged: its radii do not match the picture's pixels");
      // The bytes of a NaN, an infinity, a negative number and a large number, as float and as double.
      for (const int high : {0xff, 0x7f, 0xc0, 0x6f})
        EXPECT_EQ(
            refusal([&](auto& bytes) { std::fill(bytes.begin(), bytes.begin() + 8, static_cast<std::byte>(high)); }),
            "a.state: damaged: its radii are not those of this render")
            << high;
    }
}

}  // namespace
}  // namespace lanthorn::resume_test
