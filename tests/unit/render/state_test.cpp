// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "render/state.h"

#include <gtest/gtest.h>
#include <zlib.h>

#include <cstring>
#include <nlohmann/json.hpp>
#include <random>
#include <string>

#include "film/film_pass.h"
#include "lanthorn/error.h"
#include "lanthorn/file.h"
#include "render/plan.h"
#include "render/record.h"
#include "support/error_text.h"
#include "support/printable.h"
#include "support/temporary_dir.h"
#include "support/whole_film.h"

namespace lanthorn::state_test {
namespace {

using Bytes = std::vector<std::byte>;
using nlohmann::json;

// The record with a JSON merge patch applied to its settings.
RenderRecord patched(const RenderRecord& record, const json& patch) {
  json settings = json::parse(settings_text(record));
  settings.merge_patch(patch);
  return read_record(settings.dump(), "a.state");
}

RenderState shard(std::uint64_t first, std::uint64_t end, bool splats = true) {
  RenderState state;
  test::set_film(state, Film(6, 4, 10, {.light = {"direct", "caustic"}, .splats = splats}));
  for (std::uint64_t pass = first; pass < end; ++pass) {
    std::mt19937 rng(static_cast<unsigned>(pass));
    const auto value = [&] { return std::generate_canonical<float, 24>(rng) * 12 - 1; };
    for (std::uint32_t pixel = 0; pixel < 24; ++pixel) {
      PixelSample s;
      s.light[0] = {value(), value(), value()};
      s.features.depth = value();
      FilmPass(state.film, pass).add(pixel, s);
      if (splats) FilmPass(state.film, pass).splat(pixel, 1, {value(), 1e-13f, 0});
    }
    if (pass % 3 == 1) FilmPass(state.film, pass).add(static_cast<std::uint32_t>(pass), {.light = {Rgb{NAN, 0, 0}}});
    state.add_pass(pass);
  }
  state.integrator = "probppm";
  state.record.identity.seed = 5;
  state.record.identity.others = {{"camera", R"({"fov":40.5})"}};
  state.record.others = {{"threads", std::to_string(first + 1)}, {"host", R"("a")"}};
  state.seconds = 0.1 * static_cast<double>(end - first);
  return state;
}

TEST(State, PicturesWithAndWithoutTheirErrorAreTheSame) {
  RenderState state = shard(0, 9);
  state.record.identity.resolution = {8, 4};
  state.record.identity.crop = {1, 0, 7, 4};
  const MeasuredPicture measured = measured_picture_of(state);
  EXPECT_EQ(measured.picture.pixels, picture_of(state).pixels);
  EXPECT_GT(measured.error.noise, 0);
  EXPECT_EQ(measured.error.noise, estimate_error(state).noise);
  EXPECT_EQ(measured.error.bound, estimate_error(state).bound);
  const Image bare = picture_without_error(state);
  EXPECT_EQ(bare.window.x, 1);
  EXPECT_EQ(measured.picture.window.x, 1);
  for (const std::string& layer : layer_names(measured.picture)) {
    const auto own = select_layer(bare, layer);
    ASSERT_EQ(own.has_value(), layer != "error") << layer;
    if (own) {
      EXPECT_EQ(own->pixels, select_layer(measured.picture, layer)->pixels) << layer;
    }
  }
  state.record.bias_not_measured = true;
  EXPECT_FALSE(measured_picture_of(state).error.is_known());
  EXPECT_FALSE(estimate_error(state).is_known());
}

TEST(State, KeepsLayersAndTheirDecomposition) {
  RenderState state = shard(0, 3);
  const Decomposition parts{{"by.a", "by.b"}, "by.splat", Decomposition::Shares{"by.share", {{{0}, {1, 2}, {}}}}};
  test::set_film(state, Film(2, 1, 10, {.light = {"near", "far", "sky"}, .decomposition = parts, .splats = true}));
  PixelSample s;
  s.light = {Rgb{1, 2, 3}, Rgb{0, 1, 0}, Rgb{4, 0, 0}};
  s.parts = {Rgb{5, 2, 3}, Rgb{0, 1, 0}};
  FilmPass(state.film, 0).add(1, s);
  FilmPass(state.film, 0).splat(1, 2, {0, 0, 8});
  const RenderState read = decode_state(encode_state(state), "a.state");
  EXPECT_EQ(read.film.contents(), state.film.contents());
  const Image image = read.film.resolve(1);
  EXPECT_EQ(image.channels, state.film.resolve(1).channels);
  EXPECT_EQ(image.pixels, state.film.resolve(1).pixels);
  EXPECT_EQ(select_layer(image, "by.splat")->pixels, (std::vector<float>{0, 0, 0, 0, 0, 8}));
}

TEST(State, KeepsSpectralBucketsAndSamplesOfNegativeLobes) {
  RenderState state = shard(0, 3);
  test::set_film(state, Film(3, 2, 10,
                             {.light = {"direct", "caustic"},
                              .splats = true,
                              .buckets = SpectralBuckets{7, 400, 700},
                              .negative_share = 0.3f}));
  PixelSample s;
  s.spectrum.emplace();
  s.spectrum->radiance = {1, 2, 3, 4};
  s.spectrum->lambda = {410, 500, 600, 690};
  s.spectrum->pdf = {0.01f, 0.02f, 0.03f, 0.04f};
  FilmPass(state.film, 0).add(4, s);
  s.spectrum->radiance = {0.5f, 3, 1, 2};
  s.light[0] = {1, 2, 3};
  s.filter_part = FilterPart::negative;
  FilmPass(state.film, 1).add(4, s);
  const RenderState read = decode_state(encode_state(state), "a.state");
  EXPECT_EQ(read.film.contents(), state.film.contents());
  EXPECT_EQ(read.film.resolve(3).pixels, state.film.resolve(3).pixels);
  EXPECT_EQ(encode_state(read), encode_state(state));
}

TEST(PassRanges, AreSortedAndJoined) {
  RenderState state;
  for (const std::uint64_t pass : {5u, 1u, 6u, 3u, 2u, 0u}) state.add_pass(pass);
  EXPECT_EQ(state.passes, (std::vector<PassRange>{{0, 4}, {5, 7}}));
  EXPECT_EQ(state.pass_count(), 6u);
  EXPECT_TRUE(state.has_pass(6));
  EXPECT_FALSE(state.has_pass(4));
  EXPECT_FALSE(state.has_pass(7));
}

TEST(State, RoundTrips) {
  for (const bool splats : {true, false}) {
    RenderState state = shard(2, 5, splats);
    state.passes.push_back({9, 20});
    state.integrator_state = {std::byte{1}, std::byte{0}, std::byte{255}};
    state.shardable = false;
    state.eye = {.paths = 7, .cut = 3};
    state.light = {.paths = 11, .cut = 5};
    const Bytes bytes = encode_state(state);
    const RenderState read = decode_state(bytes, "x.state");
    EXPECT_EQ(encode_state(read), bytes);
    EXPECT_EQ(read.passes, state.passes);
    EXPECT_EQ(read.integrator, state.integrator);
    EXPECT_EQ(read.integrator_state, state.integrator_state);
    EXPECT_EQ(settings_text(read.record), settings_text(state.record));
    EXPECT_EQ(read.shardable, state.shardable);
    EXPECT_EQ(read.seconds, state.seconds);
    for (const auto& [ends, expected] : {std::pair{read.eye, state.eye}, {read.light, state.light}}) {
      EXPECT_EQ(ends.paths, expected.paths);
      EXPECT_EQ(ends.cut, expected.cut);
    }
    ASSERT_TRUE(read.film.compatible(state.film));
    for (std::size_t i = 0; i < state.film.plane_count(); ++i) EXPECT_EQ(read.film.plane(i), state.film.plane(i));
    EXPECT_EQ(read.film.report().non_finite, state.film.report().non_finite);
    EXPECT_EQ(read.film.report().first_non_finite, state.film.report().first_non_finite);
  }
}

TEST(State, SavesAndLoadsFiles) {
  const test::TemporaryDir dir;
  const RenderState state = shard(0, 2);
  save_state(state, dir.path() / "a.state");
  EXPECT_EQ(encode_state(load_state(dir.path() / "a.state")), encode_state(state));
  EXPECT_THROW(load_state(dir.path() / "none.state"), Error);
  EXPECT_THROW(load_state(dir.path()), Error);
  EXPECT_THROW(save_state(state, "/dev/full"), Error);
}

TEST(State, TruncatedFilesAreErrors) {
  const Bytes bytes = encode_state(shard(0, 3));
  for (std::size_t size = 0; size < bytes.size(); size += size < 600 ? 1 : 7)
    EXPECT_THROW(decode_state(std::span(bytes).first(size), "x"), Error) << size;
  Bytes longer = bytes;
  longer.push_back(std::byte{0});
  EXPECT_THROW(decode_state(longer, "x"), Error);
}

TEST(State, FlippedBitsAreErrors) {
  const Bytes bytes = encode_state(shard(0, 3));
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    Bytes damaged = bytes;
    damaged[i] ^= std::byte{1} << (i % 8);
    EXPECT_THROW(decode_state(damaged, "x"), Error) << i;
  }
}

void repair_checksum(Bytes& bytes) {
  const auto crc = static_cast<std::uint32_t>(
      crc32_z(0, reinterpret_cast<const Bytef*>(bytes.data()), bytes.size() - sizeof(std::uint32_t)));
  std::memcpy(&bytes[bytes.size() - sizeof(crc)], &crc, sizeof(crc));
}

// A forger can correct the checksum: no damage may do worse than cause an Error.
TEST(State, DamageBehindARightChecksumNeverDoesHarm) {
  const Bytes bytes = encode_state(shard(0, 3));
  std::mt19937 rng(11);
  int errors = 0;
  for (std::size_t i = 0; i < 2 * bytes.size(); ++i) {
    Bytes damaged = bytes;
    damaged[i / 2] = static_cast<std::byte>(i % 2 ? rng() % 256 : rng() % 10 + '0');
    repair_checksum(damaged);
    try {
      const RenderState state = decode_state(damaged, "x");
      encode_state(state);
      state.film.resolve(3);
    } catch (const Error&) {
      ++errors;
    }
  }
  EXPECT_GT(errors, static_cast<int>(bytes.size() / 2));
}

/// A copy of a file with this text as its header.
Bytes with_header(const std::string& header) {
  const Bytes bytes = encode_state(shard(0, 1));
  std::uint32_t old_size = 0;
  std::memcpy(&old_size, &bytes[12], 4);
  Bytes forged(bytes.begin(), bytes.begin() + 12);
  const auto size = static_cast<std::uint32_t>(header.size());
  for (const std::byte b : std::as_bytes(std::span(&size, 1))) forged.push_back(b);
  for (const std::byte b : std::as_bytes(std::span(header))) forged.push_back(b);
  forged.insert(forged.end(), bytes.begin() + 16 + old_size, bytes.end());
  repair_checksum(forged);
  return forged;
}

json header() {
  const Bytes bytes = encode_state(shard(0, 1));
  std::uint32_t size = 0;
  std::memcpy(&size, &bytes[12], 4);
  const auto* text = reinterpret_cast<const char*>(&bytes[16]);
  return json::parse(text, text + size);
}

TEST(State, ForgedHeadersAreErrors) {
  EXPECT_NO_THROW(decode_state(with_header(header().dump()), "x"));
  EXPECT_THROW(decode_state(with_header("{}"), "x"), Error);
  json deep = header(), nested = 0;
  for (int i = 0; i < 100; ++i) nested = {{"a", nested}};
  deep["settings"]["a"] = nested;
  EXPECT_THROW(decode_state(with_header(deep.dump()), "x"), Error)
      << "nesting is bounded, for those who recurse over it";
  const json huge[] = {{{"film", {{"width", 1 << 20}, {"height", 1 << 11}}}},
                       {{"film", {{"width", 6.5}}}},
                       {{"film", {{"width", 0}}}},
                       {{"film", {{"width", 18446744073709551615ull}}}},
                       {{"film", {{"step_exponent", -100000}}}},
                       {{"film", {{"step_exponent", "2"}}}},
                       {{"film", {{"layers", nullptr}}}},
                       {{"film", {{"layers", {{"light", json::array()}}}}}},
                       {{"film", {{"layers", {{"light", std::vector<std::string>(9, "a")}}}}}},
                       {{"film", {{"layers", {{"light", {"direct", "direct"}}}}}}},
                       {{"film", {{"layers", {{"light", {"direct", "a\nb"}}}}}}},
                       {{"film", {{"layers", {{"light", {"direct", std::string(65, 'a')}}}}}}},
                       {{"film", {{"layers", {{"parts", {"direct"}}}}}}},
                       {{"film", {{"layers", {{"splat_part", "direct"}}}}}},
                       {{"film", {{"layers", {{"shares", {{"name", "s"}, {"groups", {{1}, json::array(), {0}}}}}}}}}},
                       {{"film", {{"layers", {{"shares", {{"name", "s"}, {"groups", {{0}, {0}}}}}}}}}},
                       {{"passes", {{3, 3}}}},
                       {{"passes", {{0, 2}, {1, 3}}}},
                       {{"passes", {{0}}}},
                       {{"passes", 3}},
                       {{"seconds", -1}},
                       {{"seconds", nullptr}},
                       {{"seconds", 1e308}},
                       {{"settings", 1}},
                       {{"settings", {{"identity", 1}}}},
                       {{"integrator_state_bytes", 1000000000}},
                       {{"integrator_state_bytes", 7}},
                       {{"film", {{"non_finite", {{"count", 1}}}}}},
                       {{"film", {{"non_finite", {{"count", 1}, {"pass", 0}, {"pixel", 24}}}}}}};
  for (const json& change : huge) {
    json forged = header();
    forged.merge_patch(change);
    EXPECT_THROW(decode_state(with_header(forged.dump()), "x"), Error) << change;
  }
}

// A record with all members, each of which differs from its default.
RenderRecord full_record() {
  RenderRecord record{
      .identity = {.version = "1.2",
                   .scene_hash = "0f",
                   .files = {{"a.ply", {"01"}}, {"b.png", {"02", "03"}}},
                   .integrator = "auto",
                   .parameters = {{"alpha", "0.5"}},
                   .seed = ~std::uint64_t{0},
                   .color = ColorMode::spectral,
                   .max_depth = 9,
                   .photons = 10000,
                   .resolution = {9, 8},
                   .crop = {2, 1, 6, 5},
                   .margin = std::array{2, 0, 0, 0},
                   .filter = {.kind = description::FilterKind::mitchell, .radius = {2, 3}, .b = 0.1f, .c = 0.2f},
                   .wavelength_sets = 2,
                   .heroes_of_paths = true,
                   .filter_lobes_apart = true,
                   .view = "0c",
                   .coarse = std::array{4, 3},
                   .others = {{"new", "[1,{}]"}}},
      .scene = "a.pbrt",
      .measures_exposure = true,
      .display_emission = true,
      .bias_not_measured = true,
      .findings = EffortReport{.summary = "few caustics",
                               .short_part = 0.25,
                               .variance = 3.5,
                               .uniform = {{.place = {.connections = 4, .goes_on = false}, .work = 7}},
                               .work_of_eye_path = {.lookups = 2},
                               .work_of_light_path = {.vertices = 5}},
      .others = {{"host", R"("a")"}}};
  record.identity.options.clamp = 0.1f;
  return record;
}

TEST(State, KeepsTheRecordOfItsRender) {
  RenderState state = shard(0, 1);
  state.record = full_record();
  const RenderRecord read = decode_state(encode_state(state), "a.state").record;
  EXPECT_EQ(settings_text(read), settings_text(state.record));
  EXPECT_EQ(settings_text(read),
            R"({"bias_not_measured":true,"display_emission":true,"findings":{"caustic_light":0.0,"caustic_part":0.0,)"
            R"("connected_part":0.0,"everywhere":[{"connections":4,"connects_to_lens":true,"goes_on":false,)"
            R"("light_paths_per_pixel":0.0,"merges":true,"merges_in_media":true,"variance":0.0,"work":7.0}],)"
            R"("eye_path":{"connections":0.0,"lookups":2.0,"merges":0.0,"next_events":0.0,"rays":0.0},)"
            R"("light_by_light_paths":0.0,"light_path":{"rays":0.0,"vertices":5.0},"light_paths_per_pixel":0.0,)"
            R"("merged_part":0.0,"short_part":0.25,"summary":"few caustics","variance":3.5,"work":0.0},"host":"a",)"
            R"("identity":{"clamp":0.10000000149011612,"coarse":[4,3],"color":"spectral","crop":[2,1,6,5],)"
            R"("files":{"a.ply":"01","b.png":["02","03"]},"filter":{"b":0.10000000149011612,)"
            R"("c":0.20000000298023224,"kind":"mitchell","radius":[2.0,3.0]},"filter_lobes_apart":true,)"
            R"("heroes_of_paths":true,"integrator":"auto","margin":[2,0,0,0],"max_depth":9,"new":[1,{}],)"
            R"("parameters":{"alpha":"0.5"},"photons":10000,"plateau_wavelength_sets":2,"resolution":[9,8],)"
            R"("scene_hash":"0f","seed":18446744073709551615,"version":"1.2","view":"0c"},"measures_exposure":true,)"
            R"("scene":"a.pbrt"})");
  EXPECT_FALSE(identity_difference(read.identity, state.record.identity));
  EXPECT_EQ(read.identity.files, state.record.identity.files);
  EXPECT_EQ(read.identity.options.clamp, 0.1f);
  EXPECT_EQ(read.findings->uniform.at(0).place.connections, 4);
}

// Members that were added later keep their defaults.
TEST(State, RecordsOfEarlierVersionsAreRead) {
  const json earlier{{"measures_exposure", nullptr}, {"findings", {{"short_part", nullptr}}}};
  const RenderRecord read = patched(full_record(), earlier);
  EXPECT_FALSE(read.measures_exposure);
  EXPECT_EQ(read.findings->short_part, 0);
  EXPECT_EQ(read.findings->variance, 3.5);
}

// JSON has no infinity: files have null instead.
TEST(State, InfiniteNumbersOfARecordEqualThemselves) {
  RenderRecord record = read_record(header()["settings"], "a.state");
  record.identity.filter.radius.x = std::numeric_limits<float>::infinity();
  const RenderRecord read = read_record(settings_text(record), "a.state");
  EXPECT_EQ(identity_difference(record.identity, read.identity), std::nullopt);
  EXPECT_EQ(settings_text(read), settings_text(record));
}

TEST(State, MessagesNameTheMemberOfARecordThatIsDamaged) {
  const std::string evil = "\x1b]0;x\x07\nlanthorn: forged";
  const std::vector<std::pair<json, std::string>> forged{
      {{{"seed", "5"}}, "a count up to 18446744073709551615 at settings.identity.seed"},
      {{{"seed", nullptr}}, "a count up to 18446744073709551615 at settings.identity.seed"},
      {{{"max_depth", 2147483648}}, "a count up to 2147483647 at settings.identity.max_depth"},
      {{{"max_depth", -1}}, "a count up to 2147483647 at settings.identity.max_depth"},
      {{{"color", 1}}, "one of rgb, spectral at settings.identity.color"},
      {{{"integrator", 1}}, "text at settings.identity.integrator"},
      {{{"resolution", {6}}}, "2 numbers at settings.identity.resolution"},
      {{{"resolution", {6, "4"}}}, "a count up to 2147483647 at settings.identity.resolution[1]"},
      {{{"crop", {0, 0, 7, 4}}}, "a part of the resolution at settings.identity.crop"},
      {{{"crop", {3, 0, 3, 4}}}, "a part of the resolution at settings.identity.crop"},
      {{{"margin", {1, 0, 0, 0}}}, "pixels that are in the resolution at settings.identity.margin"},
      {{{"filter", {{"radius", {1, "2"}}}}}, "a number at settings.identity.filter.radius[1]"},
      {{{"filter", {{"kind", "round"}}}},
       "one of box, triangle, gaussian, mitchell, sinc at settings.identity.filter.kind"},
      {{{"filter", 3}}, "an object at settings.identity.filter"},
      {{{"files", {{"a.ply", {1}}}}}, "text at settings.identity.files.a.ply"},
      {{{"parameters", {{evil, 1}}}}, "text at settings.identity.parameters."},
      {{{"plateau_wavelength_sets", 17}}, "a count from 1 to 16 at settings.identity.plateau_wavelength_sets"},
      {{{"plateau_wavelength_sets", 0}}, "a count from 1 to 16 at settings.identity.plateau_wavelength_sets"},
      {{{"heroes_of_paths", 1}}, "true or false at settings.identity.heroes_of_paths"},
      {{{"clamp", 1e39}}, "a number at settings.identity.clamp"}};
  for (const auto& [change, expected] : forged) {
    json settings = header();
    settings["settings"]["identity"].merge_patch(change);
    const std::string message = test::error_text([&] { decode_state(with_header(settings.dump()), "a.state"); });
    EXPECT_TRUE(message.starts_with("a.state: damaged: expected " + expected)) << message;
    EXPECT_TRUE(test::is_printable(message)) << message;
  }
  json cropped = header();
  cropped["settings"]["identity"]["crop"] = {0, 0, 5, 4};
  EXPECT_EQ(test::error_text([&] { decode_state(with_header(cropped.dump()), "a.state"); }),
            "a.state: damaged: its film is not that of its settings");
}

TEST(State, AnySumOfCountsCanBeRead) {
  json forged = header();
  forged["film"]["non_finite"] = {{"count", std::uint64_t{1} << 63}, {"pass", 0}, {"pixel", 0}};
  RenderState a = decode_state(with_header(forged.dump()), "x"), b = empty_like(a);
  b.passes = {{7, 8}};
  FilmReport report;
  report.non_finite = 1;
  report.first_non_finite = FilmPlace{7, 0};
  b.film.add_report(report);
  const RenderState merged = merge_states(a, b);
  EXPECT_EQ(decode_state(encode_state(merged), "x").film.report().non_finite, (std::uint64_t{1} << 63) + 1);
}

TEST(State, ErrorsNameTheFile) {
  EXPECT_EQ(test::error_text([] { decode_state(Bytes(100), "a.state"); }), "a.state: not a Lanthorn state file");
  Bytes newer = encode_state(shard(0, 1));
  newer[8] = std::byte{77};
  EXPECT_EQ(test::error_text([&] { decode_state(newer, "a.state"); }),
            "a.state: a state file of version 77; this program reads versions 6 and 7");
}

TEST(MergeStates, EqualsOneRender) {
  const RenderState merged = merge_states(shard(0, 3), shard(3, 7)), whole = shard(0, 7);
  EXPECT_EQ(merged.passes, whole.passes);
  for (std::size_t i = 0; i < whole.film.plane_count(); ++i) EXPECT_EQ(merged.film.plane(i), whole.film.plane(i));
  EXPECT_EQ(merged.film.report().first_non_finite, whole.film.report().first_non_finite);
  EXPECT_NEAR(merged.seconds, 0.7, 1e-5);
}

TEST(MergeStates, CommutesAndAssociatesToTheByte) {
  RenderState a = shard(0, 3), b = shard(3, 4), c = shard(6, 11);
  a.seconds = 0.1;
  b.seconds = 0.2;
  c.seconds = 0.3;  // (0.1 + 0.2) + 0.3 is not 0.1 + (0.2 + 0.3)
  const Bytes expected = encode_state(merge_states(merge_states(a, b), c));
  EXPECT_EQ(encode_state(merge_states(c, merge_states(b, a))), expected);
  EXPECT_EQ(encode_state(merge_states(merge_states(c, a), b)), expected);
  EXPECT_EQ(encode_state(merge_states(a, merge_states(b, c))), expected);
  EXPECT_EQ(decode_state(expected, "x").passes, (std::vector<PassRange>{{0, 4}, {6, 11}}));
  EXPECT_EQ(decode_state(expected, "x").record.others, (OtherMembers{{"host", R"("a")"}}));
  EXPECT_EQ(decode_state(expected, "x").record.identity.others, a.record.identity.others);
}

TEST(MergeStates, RefusesWhatDoesNotBelongTogether) {
  const RenderState a = shard(0, 3);
  EXPECT_EQ(test::error_text([&] { merge_states(a, shard(2, 5)); }),
            "cannot merge: some passes are in both; make shards with disjoint --pass-range");
  RenderState b = shard(3, 5);
  b.record.identity.others["camera"] = R"({"fov":41})";
  EXPECT_EQ(test::error_text([&] { merge_states(a, b); }),
            "cannot merge: the renders differ in camera.fov (40.5 and 41)");
  b = shard(3, 5);
  b.record.identity.others["depth"] = "4";
  EXPECT_EQ(test::error_text([&] { merge_states(a, b); }), "cannot merge: the renders differ in depth (not set and 4)");
  b = shard(3, 5);
  b.shardable = false;
  EXPECT_NE(test::error_text([&] { merge_states(a, b); }).find("depends on the passes before it"), std::string::npos);
  b = shard(3, 5);
  b.integrator = "path";
  EXPECT_EQ(test::error_text([&] { merge_states(a, b); }), "cannot merge: integrators differ (path and probppm)");
  EXPECT_THROW(merge_states(a, shard(3, 5, false)), Error);
}

TEST(MergeStates, ReadsFilesStraightIntoTheSum) {
  const test::TemporaryDir dir;
  const RenderState a = shard(0, 3), b = shard(3, 7);
  save_state(b, dir.path() / "b.state");
  const SavedState saved(dir.path() / "b.state");
  EXPECT_EQ(saved.passes(), b.passes);
  EXPECT_FALSE(saved.identity_difference(a));
  EXPECT_EQ(encode_state(*saved.load()), encode_state(b));
  RenderState sum = a;
  saved.merge_into(sum);
  EXPECT_EQ(encode_state(sum), encode_state(merge_states(a, b)));
  const Bytes before = encode_state(sum);
  EXPECT_EQ(test::error_text([&] { saved.merge_into(sum); }),
            "cannot merge: some passes are in both; make shards with disjoint --pass-range");
  RenderState other = a;
  other.film = Film(4, 6, 10, a.film.contents());
  EXPECT_EQ(test::error_text([&] { saved.merge_into(other); }),
            "cannot merge: the films differ in size, scale or contents");
  EXPECT_EQ(encode_state(sum), before);
}

// Sums saturate, in whichever order they are added.
TEST(MergeStates, SaturatesAsTheFilmDoes) {
  const test::TemporaryDir dir;
  RenderState a = shard(0, 3), b = shard(3, 7);
  const std::vector<std::int64_t> large(24, std::int64_t{3} << 60), small(24, -(std::int64_t{3} << 60));
  for (RenderState* state : {&a, &b}) state->film.add_sums(0, 0, large), state->film.add_sums(1, 0, small);
  save_state(b, dir.path() / "b.state");
  RenderState sum = a;
  SavedState(dir.path() / "b.state").merge_into(sum);
  EXPECT_EQ(sum.film.plane(0)[23], std::int64_t{1} << 62);
  EXPECT_EQ(sum.film.plane(1)[0], -(std::int64_t{1} << 62));
  EXPECT_EQ(encode_state(sum), encode_state(merge_states(a, b)));
}

// A film of many blocks, the last one incomplete.
TEST(State, LargeFilmsAreSavedInBlocks) {
  RenderState state = shard(0, 1);
  test::set_film(state, Film(211, 97, 10, {.light = {"direct"}, .splats = true}));
  std::mt19937_64 rng(3);
  std::vector<std::int64_t> values(state.film.pixel_count());
  for (std::size_t plane = 0; plane < state.film.plane_count(); ++plane) {
    for (std::int64_t& value : values) value = static_cast<std::int64_t>(rng()) >> (rng() % 40 + 2);
    state.film.add_sums(plane, 0, values);
  }
  const Bytes bytes = encode_state(state);
  const RenderState read = decode_state(bytes, "x");
  for (std::size_t i = 0; i < state.film.plane_count(); ++i) EXPECT_EQ(read.film.plane(i), state.film.plane(i)) << i;
  EXPECT_EQ(encode_state(read), bytes);
}

// In version 6, the sums are planes of the whole film.
Bytes in_version_6(const RenderState& state) {
  const Bytes bytes = encode_state(state);
  std::uint32_t header_bytes = 0;
  std::memcpy(&header_bytes, &bytes[12], 4);
  Bytes old(bytes.begin(), bytes.begin() + 16 + header_bytes);
  old[8] = std::byte{6};
  const auto append_packed = [&old](const Bytes& raw) {
    uLongf size = compressBound(raw.size());
    Bytes packed(size);
    compress(reinterpret_cast<Bytef*>(packed.data()), &size, reinterpret_cast<const Bytef*>(raw.data()), raw.size());
    packed.resize(size);
    const std::uint64_t length = size;
    for (const std::byte b : std::as_bytes(std::span(&length, 1))) old.push_back(b);
    old.insert(old.end(), packed.begin(), packed.end());
  };
  for (std::size_t plane = 0; plane < state.film.plane_count(); ++plane) {
    const std::vector<std::int64_t> values = state.film.plane(plane);
    Bytes raw;
    for (int b = 0; b < 64; b += 8)
      for (const std::int64_t value : values) raw.push_back(static_cast<std::byte>(value >> b));
    append_packed(raw);
  }
  append_packed(state.integrator_state);
  old.resize(old.size() + sizeof(std::uint32_t));
  repair_checksum(old);
  return old;
}

TEST(State, ReadsTheVersionBefore) {
  RenderState state = shard(0, 3);
  state.integrator_state = {std::byte{5}, std::byte{6}};
  EXPECT_EQ(encode_state(decode_state(in_version_6(state), "x")), encode_state(state));
  state.integrator_state.clear();
  EXPECT_EQ(encode_state(decode_state(in_version_6(state), "x")), encode_state(state));
}

// Shards of the first passes have none.
TEST(MergeStates, KeepsTheIntegratorsStateOfAnyShard) {
  RenderState a = shard(0, 3), b = shard(3, 5);
  b.integrator_state = {std::byte{1}, std::byte{2}};
  EXPECT_EQ(merge_states(a, b).integrator_state, b.integrator_state);
  EXPECT_EQ(merge_states(b, a).integrator_state, b.integrator_state);
}

TEST(Film, ProblemsAreSaidWithTheirFirstPlace) {
  EXPECT_FALSE(describe_problems(shard(0, 1).film.report()));
  EXPECT_EQ(describe_problems(shard(1, 5).film.report()),
            "2 samples were not finite, 0 too large for the film, 0 sums saturated; first in pass 1, pixel 1");
}

TEST(Identity, NamesTheFirstDifference) {
  RenderState state = shard(0, 1);
  state.record.identity.scene_hash = "00";
  state.record.identity.files = {{"a.ply", {"01"}}};
  state.record.identity.others = {{"b", R"({"x.z": 1, "y": [1, 2]})"}, {"c", "3"}};
  const auto difference = [&](const char* field, const json& value) {
    const json patch{{"threads", 99}, {"identity", {{field, value}}}};
    const RenderIdentity other = patched(state.record, patch).identity;
    const std::string message = test::error_text([&] { require_same_identity(state, other, "a.state"); });
    const std::string begin = "a.state: belongs to another render: it differs in ";
    const std::string end = "; give the scene and settings it was made with, or another file";
    if (!message.starts_with(begin) || !message.ends_with(end)) return message;
    return message.substr(begin.size(), message.size() - begin.size() - end.size());
  };
  EXPECT_EQ(difference("c", 3), "no error");
  EXPECT_EQ(difference("c", 4), "c (3 and 4)");
  EXPECT_EQ(difference("b", {{"y", {1, 5}}}), "b.y ([1,2] and [1,5])");
  EXPECT_EQ(difference("b", {{"x.z", 2}}), "b.x.z (1 and 2)");
  EXPECT_EQ(difference("a", 5), "a (not set and 5)");
  EXPECT_EQ(difference("", 5), " (not set and 5)");
  EXPECT_EQ(difference("scene_hash", "07"), R"(the content of the scene file ("00" and "07"))");
  EXPECT_EQ(difference("files", {{"a.ply", "07"}}), R"(the content of a.ply ("01" and "07"))");
  EXPECT_EQ(difference("files", {{"a.ply", nullptr}}), R"(the content of a.ply ("01" and not set))");
}

}  // namespace
}  // namespace lanthorn::state_test
