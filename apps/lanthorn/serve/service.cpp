// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "service.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <string_view>
#include <utility>

#include "../render_arguments.h"
#include "../report_json.h"
#include "../value_types.h"
#include "access.h"
#include "lanthorn/denoise.h"
#include "lanthorn/error.h"
#include "lanthorn/image_file.h"
#include "lanthorn/methods.h"
#include "lanthorn/text.h"

namespace lanthorn::program {

// The files of serve/page; the build generates these definitions.
extern const std::string_view page_document, page_style, page_program;

namespace {

constexpr const char* json_type = "application/json; charset=utf-8";

// "/TOKEN/resource" to "resource"; nullopt if the token is wrong.
std::optional<std::string> resource_of(const std::string& path, const std::string& token) {
  const std::size_t slash = path.find('/', 1);
  const std::string given = path.substr(1, slash == std::string::npos ? slash : slash - 1);
  if (!equal_in_constant_time(given, token) || slash == std::string::npos) return {};
  return path.substr(slash + 1);
}

HttpResponse attachment(const char* type, const std::vector<unsigned char>& bytes, const std::string& name) {
  return {HttpStatus::ok,
          type,
          share({bytes.begin(), bytes.end()}),
          {{"Content-Disposition", fmt::format("attachment; filename=\"{}\"", name)}}};
}

DVec3 vector_of(const nlohmann::json& json) {
  const auto numbers = json.get<std::array<double, 3>>();
  return {numbers[0], numbers[1], numbers[2]};
}

LookAt look_of(const nlohmann::json& json) {
  return {vector_of(json.at("eye")), vector_of(json.at("target")), vector_of(json.at("up"))};
}

// A number, or one of an option's words. Throws Error.
template <class Value>
Value value_of(const nlohmann::json& json, const char* name, const ValueType<Value>& type) {
  const std::string text =
      json.is_string() ? json.get<std::string>() : fmt::format("{}", static_cast<float>(json.get<double>()));
  const std::optional<Value> value = type.parse(text);
  if (!value) throw Error(fmt::format("{} {}: expected {}", name, printable(text), type.expected));
  return *value;
}

void read_lens(const nlohmann::json& json, ViewerEdit& edit) {
  if (!json.is_object()) throw Error("lens: expected fov, aperture, focus or focus_at");
  if (json.contains("fov")) edit.lens.fov = value_of(json.at("fov"), "field of view", fov_type());
  if (json.contains("aperture")) edit.lens.aperture = value_of(json.at("aperture"), "aperture", aperture_type());
  if (json.contains("focus")) edit.lens.focus = value_of(json.at("focus"), "focus", focus_type());
  if (!json.contains("focus_at")) return;
  const auto pixel = json.at("focus_at").get<std::array<float, 2>>();
  edit.focus_at = Vec2(pixel[0], pixel[1]);
}

EnvironmentChoice environment_of(const nlohmann::json& json) {
  return {json.at("source").get<std::string>(),
          value_of(json.value("rotation", nlohmann::json(0)), "rotation", environment_rotation_type()),
          value_of(json.value("scale", nlohmann::json(1)), "brightness", environment_scale_type())};
}

// Throws Error, or what the JSON library throws for wrong types.
ViewerEdit edit_of(const nlohmann::json& json) {
  ViewerEdit edit;
  edit.home = json.value("home", false);
  edit.moving = json.value("moving", false);
  if (json.contains("paused")) edit.paused = json.at("paused").get<bool>();
  if (json.contains("denoise")) edit.denoise = json.at("denoise").get<bool>();
  if (json.contains("method")) edit.method = json.at("method").get<std::string>();
  if (json.contains("size")) edit.size = json.at("size").get<std::array<int, 2>>();
  if (json.contains("camera")) edit.look = look_of(json.at("camera"));
  if (json.contains("lens")) read_lens(json.at("lens"), edit);
  if (json.contains("environment")) edit.environment = environment_of(json.at("environment"));
  if (!json.contains("lights")) return edit;
  edit.lights.emplace();
  for (const auto& [name, factor] : json.at("lights").items()) {
    const auto light = light_factor_type().parse(fmt::format("{}={}", name, factor.get<double>()));
    if (!light) throw Error(fmt::format("light {}: expected a factor of 0 or more", printable(name)));
    edit.lights->insert(*light);
  }
  return edit;
}

// Values of a one-channel layer that are shown as black and white.
struct GreyRange {
  double black = 0, white = 1;
};

// A layer as colours: one-channel layers become grey, with black where no surface is visible (0); normals are mapped
// from [-1, 1] to [0, 1].
std::optional<Image> as_colors(const PageFrame& frame, const std::string& layer, const GreyRange& range) {
  const std::optional<Image> pixels = frame.layer(layer);
  if (!pixels) return {};
  Image colors(pixels->width, pixels->height, {"R", "G", "B"});
  const std::size_t channels = pixels->channel_count();
  const bool is_vector = layer == "normal", is_grey = channels == 1;
  const auto black = static_cast<float>(range.black), scale = static_cast<float>(1 / (range.white - range.black));
  for (std::size_t i = 0; i < colors.pixels.size(); ++i) {
    const float value = pixels->pixels[i / 3 * channels + std::min(i % 3, channels - 1)];
    colors.pixels[i] = is_vector ? 0.5f + 0.5f * value : is_grey ? (value > 0 ? scale * (value - black) : 0) : value;
  }
  return colors;
}

void replace_all(std::string& text, std::string_view what, std::string_view by) {
  for (std::size_t at = text.find(what); at != std::string::npos; at = text.find(what, at + by.size()))
    text.replace(at, what.size(), by);
}

// One document with its style and script, which requests only the server's pictures. `nonce`: from the content security
// policy, authorises style and script.
std::string page_html(const std::string& nonce) {
  std::string page(page_document);
  replace_all(page, "{{nonce}}", nonce);
  replace_all(page, "{{style}}", page_style);
  replace_all(page, "{{program}}", page_program);
  return page;
}

}  // namespace

ViewService::ViewService(Viewer& viewer, const OutputSettings& display, std::string title, std::string token,
                         std::string host_name)
    : viewer_(viewer),
      display_(display),
      title_(std::move(title)),
      token_(std::move(token)),
      host_name_(std::move(host_name)) {}

HttpResponse ViewService::answer(const HttpRequest& request, const IsGone& is_gone) const {
  if (!is_own_host(request.field("host"), host_name_)) return plain_response(HttpStatus::misdirected);
  const std::optional<std::string> resource = resource_of(request.path, token_);
  if (!resource) return plain_response(HttpStatus::not_found);
  if (!is_own_origin(request)) return plain_response(HttpStatus::forbidden);
  if (request.method == "GET") return answer_get(*resource, request, is_gone);
  return *resource == "edit" ? edit(request) : plain_response(HttpStatus::not_found);
}

HttpResponse ViewService::answer_get(const std::string& resource, const HttpRequest& request,
                                     const IsGone& is_gone) const {
  if (resource.empty()) return page();
  if (resource == "scene") return scene();
  if (resource == "frame") return frame(request, is_gone);
  if (resource == "picture.png") return png(request);
  if (resource == "picture.exr") return exr();
  return plain_response(resource == "edit" ? HttpStatus::method_not_allowed : HttpStatus::not_found);
}

HttpResponse ViewService::page() const {
  const std::string nonce = random_token();
  const std::string policy = fmt::format(
      "default-src 'none'; script-src 'nonce-{0}'; style-src 'nonce-{0}'; connect-src 'self'; img-src data: blob:; "
      "base-uri 'none'; form-action 'none'; frame-ancestors 'none'",
      nonce);
  return {HttpStatus::ok,
          "text/html; charset=utf-8",
          share(page_html(nonce)),
          {{"Content-Security-Policy", policy}, {"Cross-Origin-Opener-Policy", "same-origin"}}};
}

HttpResponse ViewService::scene() const {
  nlohmann::json lights = nlohmann::json::array(), warnings = nlohmann::json::array(),
                 known_methods = nlohmann::json::array(), environments = nlohmann::json::array();
  for (const NamedLight& light : viewer_.lights()) lights.push_back({{"name", light.id}, {"description", light.words}});
  for (const description::Warning& warning : viewer_.warnings()) warnings.push_back(warning.message);
  for (const MethodInfo& method : methods())
    known_methods.push_back({{"name", method.name}, {"description", method.summary}});
  for (const std::string& source : viewer_.environments())
    environments.push_back(
        {{"source", source},
         {"label", source.empty() ? "As in the file" : std::filesystem::path(source).filename().string()}});
  const bool is_measured = display_.measures_exposure.value_or(viewer_.first_view().film.measures_exposure);
  return {HttpStatus::ok, json_type,
          share(json_text({{"title", title_},
                           {"lights", lights},
                           {"methods", known_methods},
                           {"environments", environments},
                           {"warnings", warnings},
                           {"exposure", display_.display.exposure},
                           {"measures_exposure", is_measured},
                           {"curve", view_transform_type().print(curve_of(display_, is_measured))}},
                          one_line))};
}

HttpResponse ViewService::frame(const HttpRequest& request, const IsGone& is_gone) const {
  const std::uint64_t after = parse_count(request.parameter("after")).value_or(0);
  const std::shared_ptr<const PageFrame> frame = viewer_.wait_for_frame(after, is_gone);
  if (!frame) return {HttpStatus::no_content};
  return {HttpStatus::ok, "application/octet-stream",
          frame->encoded(request.parameter("layer"), request.parameter("measure") == "1")};
}

HttpResponse ViewService::png(const HttpRequest& request) const {
  const std::shared_ptr<const PageFrame> frame = viewer_.last_frame();
  const double exposure = parse_number(request.parameter("exposure")).value_or(0);
  const std::string& layer = request.parameter("layer");
  const GreyRange range{parse_number(request.parameter("black")).value_or(0),
                        parse_number(request.parameter("white")).value_or(1)};
  if (range.black == range.white) return plain_response(HttpStatus::bad_request);
  const std::optional<Image> colors = frame ? as_colors(*frame, layer.empty() ? "color" : layer, range) : std::nullopt;
  if (!colors || std::abs(exposure) > DisplaySettings::largest_exposure)
    return plain_response(frame ? HttpStatus::bad_request : HttpStatus::unavailable);
  const DisplaySettings display{static_cast<float>(exposure),
                                view_transform_type().parse(request.parameter("curve")).value_or(ToneCurve::none)};
  const std::lock_guard lock(encoding_);
  return attachment("image/png", encode_png(*colors, display, frame->metadata()), title_ + ".png");
}

HttpResponse ViewService::exr() const {
  const std::shared_ptr<const PageFrame> frame = viewer_.last_frame();
  if (!frame) return plain_response(HttpStatus::unavailable);
  const std::lock_guard lock(encoding_);
  return attachment("image/x-exr", exr_of(*frame), title_ + ".exr");
}

// Files are always denoised at full quality, even if the page shows a preview.
std::vector<unsigned char> ViewService::exr_of(const PageFrame& frame) const {
  const Image& image = *frame.image();
  const nlohmann::json& about = frame.about();
  if (!about.at("denoise") || about.at("coarse") || about.at("passes") < 2) return encode_exr(image, frame.metadata());
  const DenoisedPicture denoised = denoise(image);
  nlohmann::json metadata = nlohmann::json::parse(frame.metadata());
  metadata["denoised_error"] = estimate_json(denoised.error);
  return encode_exr(denoised.picture, metadata.dump());
}

HttpResponse ViewService::edit(const HttpRequest& request) const {
  const nlohmann::json json = nlohmann::json::parse(request.body, nullptr, /*allow_exceptions=*/false);
  if (!json.is_object()) return plain_response(HttpStatus::bad_request);
  try {
    const std::uint64_t revision = viewer_.apply(edit_of(json));
    return {HttpStatus::ok, json_type, share(json_text({{"revision", revision}}, one_line))};
  } catch (const Error& problem) {
    return {HttpStatus::bad_request, "text/plain; charset=utf-8", share(printable(problem.message))};
  } catch (const nlohmann::json::exception&) {
    return plain_response(HttpStatus::bad_request);
  }
}

}  // namespace lanthorn::program
