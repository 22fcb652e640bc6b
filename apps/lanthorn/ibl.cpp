// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "lanthorn/ibl.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <chrono>
#include <filesystem>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "commands.h"
#include "console.h"
#include "lanthorn/error.h"
#include "lanthorn/file.h"
#include "lanthorn/image_file.h"
#include "lanthorn/packed_float.h"
#include "lanthorn/threads.h"
#include "lanthorn/version.h"
#include "output_check.h"
#include "progress.h"
#include "render_arguments.h"
#include "report_json.h"
#include "signals.h"

namespace lanthorn::program {

namespace {

namespace fs = std::filesystem;
constexpr std::uint64_t largest_size = 4096, most_samples = 1 << 20, most_checks = 4096;

struct IblCommand {
  std::vector<fs::path> environment;
  std::string output;
  std::vector<std::string> maps{"irradiance", "specular", "brdf", "sh"}, formats{"exr", "ktx2", "dds"};
  TexelFormat texels = TexelFormat::half;
  IblSettings settings;
  int brdf_size = 128;
  bool sheen = false, print_report = false, quiet = false;
  unsigned threads = 0;
  std::uint64_t max_pixels = FileAccess::default_max_pixels;

  bool wants(const char* map) const { return std::find(maps.begin(), maps.end(), map) != maps.end(); }
  bool needs_environment() const { return wants("irradiance") || wants("specular") || wants("sh"); }
};

ValueType<RoughnessMapping> mapping_type() {
  return choice_type<RoughnessMapping>({{"square", RoughnessMapping::square},
                                        {"linear", RoughnessMapping::linear},
                                        {"filament", RoughnessMapping::filament}});
}

ValueType<LobeWeight> weight_type() {
  return choice_type<LobeWeight>({{"cosine", LobeWeight::cosine}, {"masking", LobeWeight::masking}});
}

nlohmann::json rgb_json(const Rgb& c) { return {c.r, c.g, c.b}; }

nlohmann::json error_json(const std::optional<MapError>& error) {
  if (!error) return nullptr;
  return {{"rms", error->rms}, {"max", error->max}, {"places", error->checks}};
}

nlohmann::json report_json(const IblCommand& a, const std::optional<Ibl>& ibl, const std::optional<Image>& table) {
  nlohmann::json report{{"lanthorn", version}};
  if (table) {
    std::optional<MapError> error;
    if (a.settings.checks > 0) error = brdf_table_error(*table, a.settings.checks);
    report["brdf"] = {{"size", a.brdf_size}, {"sheen", a.sheen}, {"error", error_json(error)}};
  }
  if (!ibl) return report;
  nlohmann::json files = nlohmann::json::array();
  for (const fs::path& file : a.environment) files.push_back(file.string());
  report["environment"] = {{"files", std::move(files)},   {"layout", layout_name(ibl->layout)},
                           {"width", ibl->width},         {"height", ibl->height},
                           {"mean", rgb_json(ibl->mean)}, {"unusable_values", ibl->unusable_values}};
  report["suns"] = {{"treatment", "a texel's excess over the threshold is integrated exactly for each direction"},
                    {"texels", ibl->sun_texels},
                    {"threshold", ibl->sun_threshold},
                    {"share_of_flux", rgb_json(ibl->sun_share)}};
  if (ibl->irradiance)
    report["irradiance"] = {{"size", ibl->irradiance->height}, {"error", error_json(ibl->irradiance_error)}};
  if (ibl->sh) report["sh"] = {{"window", ibl->sh->window}, {"error", error_json(ibl->sh_error)}};
  for (const SpecularLevel& level : ibl->specular)
    report["specular"].push_back({{"size", level.faces.height},
                                  {"roughness", level.roughness},
                                  {"alpha", level.alpha},
                                  {"samples", level.samples},
                                  {"error", error_json(level.error)}});
  return report;
}

nlohmann::json sh_json(const ShMaps& sh) {
  const auto coefficients = [](const ShCoefficients<4>& c, std::size_t count) {
    nlohmann::json list = nlohmann::json::array();
    for (std::size_t i = 0; i < count; ++i) list.push_back(rgb_json(c[i]));
    return list;
  };
  constexpr std::size_t order2 = 9, order3 = 16;
  return {{"basis", "real, without Condon-Shortley phase, polar axis +z, y up; by l² + l + m"},
          {"radiance", {{"order2", coefficients(sh.radiance, order2)}, {"order3", coefficients(sh.radiance, order3)}}},
          {"irradiance_over_pi",
           {{"order2", coefficients(sh.irradiance, order2)}, {"order3", coefficients(sh.irradiance, order3)}}},
          {"window", sh.window}};
}

// KTX keys such as "lanthornMap" become EXR attributes such as "lanthorn:map".
nlohmann::json attributes_of(const std::map<std::string, std::string>& key_values) {
  constexpr std::string_view prefix = "lanthorn";
  nlohmann::json attributes = nlohmann::json::object();
  for (const auto& [key, value] : key_values) {
    std::string name = key.substr(prefix.size());
    name.front() = static_cast<char>(std::tolower(static_cast<unsigned char>(name.front())));
    attributes[name] = value;
  }
  return attributes;
}

/// Creates a folder if it does not exist, and removes it again if nothing is kept in it.
class OutputFolder {
 public:
  explicit OutputFolder(fs::path path) : path_(std::move(path)) {
    std::error_code code;
    made_ = fs::create_directory(path_, code);
    if (code)
      throw Error({path_.string()},
                  fmt::format("-o: cannot be made: {}; create the folder above it first", code.message()));
  }
  OutputFolder(const OutputFolder&) = delete;
  OutputFolder& operator=(const OutputFolder&) = delete;
  ~OutputFolder() {
    std::error_code is_not_empty;
    if (made_) fs::remove(path_, is_not_empty);
  }
  const fs::path& path() const { return path_; }

 private:
  fs::path path_;
  bool made_ = false;
};

/// The output files, which get their final names once all of them are written to disk.
class Files {
 public:
  explicit Files(const IblCommand& a) : a_(a), folder_(a.output) {}

  template <class Bytes>
  void add(const std::string& file, const Bytes& bytes) {
    files_.add(folder_.path() / file, std::as_bytes(std::span(bytes)));
    ++count_;
  }
  void add_texture(const std::string& name, const std::vector<const Image*>& levels, bool cube,
                   std::map<std::string, std::string> key_values) {
    if (has("exr")) add_levels(name, levels, attributes_of(key_values).dump());
    const Texture texture{levels, cube, a_.texels};
    key_values["KTXorientation"] = "rd";
    key_values["KTXwriter"] = fmt::format("lanthorn {}", version);
    if (has("ktx2")) add(name + ".ktx2", encode_ktx2(texture, key_values));
    if (has("dds")) add(name + ".dds", encode_dds(texture));
    if (has("ktx2") || has("dds")) count_clamped(levels);
  }
  void commit() {
    files_.commit();
    if (clamped_ > 0) warn("{} values are larger than {} and were clamped in .ktx2 and .dds files", clamped_, limit());
  }
  std::size_t count() const { return count_; }

 private:
  bool has(const char* format) const {
    return std::find(a_.formats.begin(), a_.formats.end(), format) != a_.formats.end();
  }
  float limit() const { return a_.texels == TexelFormat::half ? largest_half : largest_rgb9e5; }
  void add_levels(const std::string& name, const std::vector<const Image*>& levels, const std::string& metadata) {
    const bool numbered = name == "specular";
    for (std::size_t i = 0; i < levels.size(); ++i)
      add(numbered ? fmt::format("{}-{}.exr", name, i) : name + ".exr", encode_exr(*levels[i], metadata));
  }
  void count_clamped(const std::vector<const Image*>& levels) {
    for (const Image* level : levels)
      clamped_ += std::count_if(level->pixels.begin(), level->pixels.end(), [&](float x) { return x > limit(); });
  }

  const IblCommand& a_;
  OutputFolder folder_;  // outlives the temporary files
  FileSet files_;
  std::size_t count_ = 0;
  std::ptrdiff_t clamped_ = 0;
};

void add_maps(const Ibl& ibl, const IblCommand& a, Files& files) {
  const std::string normalised = "a white environment of radiance 1 gives 1";
  if (ibl.irradiance)
    files.add_texture("irradiance", {&*ibl.irradiance}, true,
                      {{"lanthornMap", "irradiance over pi, by normal; " + normalised}});
  if (!ibl.specular.empty()) {
    std::vector<const Image*> levels;
    std::string alphas;
    for (const SpecularLevel& level : ibl.specular) {
      levels.push_back(&level.faces);
      alphas += fmt::format("{}{:.6g}", alphas.empty() ? "" : " ", level.alpha);
    }
    files.add_texture("specular", levels, true,
                      {{"lanthornMap", "GGX at n = v = r, by direction of reflection; " + normalised},
                       {"lanthornMapping", mapping_type().print(a.settings.mapping)},
                       {"lanthornWeight", weight_type().print(a.settings.weight)},
                       {"lanthornAlphas", alphas}});
  }
  if (ibl.sh) files.add("sh.json", report_text(sh_json(*ibl.sh)));
  const Image sheet = contact_sheet(ibl);
  files.add("contact.png", encode_png(sheet, {.exposure = measured_exposure(sheet), .curve = ToneCurve::filmic}));
}

// Call before anything is written: the folder must not hold input files.
void check_folder(const IblCommand& a) {
  std::error_code code;
  if (fs::exists(a.output, code) && !fs::is_directory(a.output, code))
    throw Error({a.output}, "-o: is a file; give a folder");
  for (const fs::path& file : a.environment)
    if (fs::equivalent(fs::absolute(file, code).parent_path(), a.output, code))
      throw Error({a.output}, "-o: holds the environment itself; give another folder");
}

std::optional<Ibl> bake(IblCommand& a) {
  if (!a.needs_environment()) return std::nullopt;
  if (a.environment.empty()) throw Error("ENV: an environment is needed for all maps but brdf (see --maps)");
  const Image image = read_environment(a.environment, a.max_pixels);
  ProgressLine line(a.quiet);
  const auto start = std::chrono::steady_clock::now();
  a.settings.progress = [&](double fraction) {
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    line.show(fraction, seconds, [&] { return format_duration(seconds_left(fraction, seconds)) + " left"; });
  };
  Ibl ibl = bake_ibl(image, a.settings);
  line.finish();
  if (ibl.unusable_values > 0)
    warn("{}: {} values are negative or above {:g}, and count as 0", a.environment.front().string(),
         ibl.unusable_values, largest_environment_radiance);
  return ibl;
}

void run(IblCommand& a) {
  handle_signals();
  const ThreadLimit limit(a.threads);
  check_folder(a);
  a.settings.irradiance = a.wants("irradiance");
  a.settings.specular = a.wants("specular");
  a.settings.sh = a.wants("sh");
  const std::optional<Ibl> ibl = bake(a);
  std::optional<Image> table;
  if (a.wants("brdf")) table = brdf_table(a.brdf_size, a.sheen);
  const std::string report = report_text(report_json(a, ibl, table));
  set_stage(Stage::saving);
  Files files(a);
  if (ibl) add_maps(*ibl, a, files);
  if (table)
    files.add_texture("brdf", {&*table}, false,
                      {{"lanthornMap", "R F0 + G is the reflection of white by GGX; columns n.v, rows roughness"}});
  files.add("report.json", report);
  files.commit();
  if (a.print_report) return print_text(report);
  announce("{}: {} files\n", a.output, files.count());
}

OptionTable size_options(IblCommand& a) {
  const auto size = [](const char* name, const char* what, int& edge) {
    return Option{.names = name,
                  .value = into(edge, count_type({1, largest_size})),
                  .brief = what,
                  .otherwise = std::to_string(edge)};
  };
  return {size("--size", "Edge of the specular map's first level, a power of two", a.settings.specular_size),
          size("--smallest", "Edge of its last level, a power of two", a.settings.smallest_size),
          size("--brdf-size", "Edge of the table", a.brdf_size),
          {.names = "-n,--samples",
           .value = into(a.settings.samples, count_type({1, most_samples})),
           .brief = "Samples of the lobe at the last level; narrower lobes get fewer",
           .otherwise = std::to_string(a.settings.samples)},
          {.names = "--check",
           .value = into(a.settings.checks, count_type({0, most_checks})),
           .brief = "Texels of each map to compare with brute force",
           .otherwise = std::to_string(a.settings.checks)}};
}

OptionTable map_options(IblCommand& a) {
  return {
      {.names = "ENV",
       .value = each_into(a.environment, text_type("FILE"), Arity::several),
       .brief = "Environment: an image, or six of a cube",
       .details = "An image of 2:1 (equirectangular), 1:1 (octahedral, equal-area), 6:1, 1:6, 4:3 or 3:4 (cube), or "
                  "six files, +X -X +Y -Y +Z -Z."},
      {.names = "-o,--output",
       .value = into(a.output, text_type("DIR")),
       .brief = "Folder for the files; created if it does not exist",
       .required = true},
      {.names = "--maps",
       .value = into(a.maps, word_list_type({"irradiance", "specular", "brdf", "sh"})),
       .brief = "Maps to write, from irradiance,specular,brdf,sh",
       .otherwise = "all"},
      {.names = "--formats",
       .value = into(a.formats, word_list_type({"exr", "ktx2", "dds"})),
       .brief = "Formats to write, from exr,ktx2,dds",
       .otherwise = "all"},
      {.names = "--texels",
       .value =
           into(a.texels, choice_type<TexelFormat>({{"half", TexelFormat::half}, {"rgb9e5", TexelFormat::rgb9e5}})),
       .brief = "Texels of .ktx2 and .dds",
       .details = "half is R16G16B16A16F.",
       .otherwise = "half"},
      {.names = "--mapping",
       .value = into(a.settings.mapping, mapping_type()),
       .brief = "Roughness of the specular map's levels",
       .details = "At x, a fraction of the last level: square (alpha = x²), linear (alpha = x), or filament (x = r (2 "
                  "- r), alpha = r²).",
       .otherwise = "square"},
      {.names = "--weight",
       .value = into(a.settings.weight, weight_type()),
       .brief = "Weight of light in the lobe",
       .details = "cosine is n.l, as engines expect; masking is Smith's, which makes the split sum exact at n = v = r.",
       .otherwise = "cosine"}};
}

OptionTable ibl_options(IblCommand& a) {
  const OptionTable last{
      {.names = "--window",
       .value = flag(a.settings.windowed),
       .brief = "Window the harmonics of irradiance, so that none is negative"},
      {.names = "--sheen", .value = flag(a.sheen), .brief = "Third channel of the table: albedo of Charlie sheen"},
      threads_option(a.threads, "The files do not depend on it."),
      max_pixels_option(a.max_pixels),
      {.names = "--json", .value = flag(a.print_report), .brief = "Print report.json, too"},
      {.names = "-q,--quiet", .value = flag(a.quiet), .brief = "Print no progress"}};
  return joined(joined(map_options(a), size_options(a)), last);
}

}  // namespace

void add_ibl(CLI::App& app) {
  const auto a = std::make_shared<IblCommand>();
  constexpr const char* footer =
      "Writes irradiance, specular and brdf as .exr (specular-0.exr, ... by level), .ktx2 and .dds, sh.json, "
      "contact.png\n"
      "(all maps to look at) and report.json (settings, suns, errors). As .exr, the faces of a cube lie side by side:\n"
      "+X -X +Y -Y +Z -Z. y is up; the centre of an equirectangular image is +X.\n\n"
      "Example:\n  lanthorn ibl sky.hdr -o sky --size 512";
  add_command(app, {"ibl", "Bake an environment for image-based lighting in other programs", ibl_options(*a), footer,
                    [a] { run(*a); }});
}

}  // namespace lanthorn::program
