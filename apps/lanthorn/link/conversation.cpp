// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "conversation.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <new>
#include <set>
#include <string>
#include <utility>

#include "../report_json.h"
#include "../value_types.h"
#include "lanthorn/description_data.h"
#include "lanthorn/error.h"
#include "lanthorn/methods.h"
#include "lanthorn/plain_data.h"
#include "lanthorn/text.h"
#include "lanthorn/version.h"

namespace lanthorn::program {

namespace {

using plain::Dict;
using plain::Value;

constexpr std::uint64_t protocol_version = 1;
constexpr double most_patience = 10;  // seconds

// Reads the members that a request may have beside "request"; variables of absent members are unchanged.
template <class... T>
void read_members(const Dict& request, const std::pair<const char*, T*>&... members) {
  plain::Reader reader;
  plain::Keys known{"request"};
  [[maybe_unused]] const auto read = [&](const char* name, auto& out) {
    known.emplace_back(name);
    if (const Value* value = request.find(name)) reader.at(name, [&] { plain::read(reader, *value, out); });
  };
  (read(members.first, *members.second), ...);
  plain::refuse_other_keys(reader, request, known);
}

// The request without the members that other functions read.
Dict without_keys(const Dict& request, const plain::Keys& keys) {
  Dict rest;
  for (const auto& [key, value] : request.entries())
    if (std::find(keys.begin(), keys.end(), key) == keys.end()) rest.set(key, value);
  return rest;
}

// Without passes, time limit and error bound, a render continues until it is stopped.
RenderOptions options_in(const Dict& request) {
  const Value* data = request.find("options");
  RenderOptions options = data != nullptr ? options_of_data(*data) : RenderOptions();
  if (!options.passes && !options.pass_range && !options.seconds && !options.noise) options.passes = most_passes;
  return options;
}

const char* name_of(InteractivePhase phase) {
  switch (phase) {
    case InteractivePhase::preparing:
      return "preparing";
    case InteractivePhase::refining:
      return "refining";
    case InteractivePhase::paused:
      return "paused";
    case InteractivePhase::finished:
      return "finished";
    case InteractivePhase::out_of_time:
      return "out_of_time";
    case InteractivePhase::failed:
      break;
  }
  return "failed";
}

nlohmann::json texts_of(const std::vector<description::Warning>& warnings) {
  nlohmann::json texts = nlohmann::json::array();
  for (const description::Warning& warning : warnings) texts.push_back(Error(warning.location, warning.message).what());
  return texts;
}

// The requested layers that exist, one after the other, each once; without a request, all but the noise layers.
Image layers_of(const Image& image, const std::optional<std::vector<std::string>>& wanted) {
  Image names;
  std::copy_if(image.channels.begin(), image.channels.end(), std::back_inserter(names.channels),
               [](const std::string& channel) { return !is_noise_channel(channel); });
  std::optional<Image> all;
  std::set<std::string> seen;
  for (const std::string& name : wanted ? *wanted : layer_names(names)) {
    if (!seen.insert(name).second) continue;
    std::optional<Image> layer = select_layer(image, name);
    if (!layer) continue;
    all = all ? with_layers(*all, *layer) : std::move(*layer);
  }
  return all.value_or(Image(image.width, image.height, {}));
}

nlohmann::json about(const InteractivePicture& picture) {
  nlohmann::json about{{"passes", picture.state.pass_count},
                       {"seconds", picture.state.seconds},
                       {"is_coarse", picture.is_coarse},
                       {"revision", picture.revision},
                       {"full_size", picture.full_size},
                       {"integrator", picture.state.integrator},
                       {"limitation", picture.limitation},
                       {"remark", picture.remark},
                       {"settings", settings_json(picture.state.record)}};
  if (picture.seconds_left) about["seconds_left"] = *picture.seconds_left;
  if (picture.statistics.error) about["error"] = estimate_json(*picture.statistics.error);
  return about;
}

LinkAnswer picture_answer(const InteractivePicture& picture, const std::optional<InteractiveDenoised>& denoised,
                          const std::optional<std::vector<std::string>>& layers) {
  Image image = layers_of(picture.image, layers);
  if (denoised && !denoised->is_preview) image = layers_of(denoised->image, layers);
  LinkAnswer answer{about(picture)};
  answer.body["channels"] = image.channels;
  answer.body["is_denoised"] = denoised && !denoised->is_preview;
  answer.body["pixels"] = {
      {"$array", "float32"}, {"shape", {image.height, image.width, image.channel_count()}}, {"offset", 0}};
  answer.numbers = std::move(image.pixels);
  return answer;
}

}  // namespace

LinkAnswer Conversation::hello(const Dict& request) const {
  std::uint64_t wanted = 0;
  read_members(request, std::pair("protocol", &wanted));
  if (wanted != protocol_version)
    throw Error("this is lanthorn " + std::string(version) + ", which speaks version " +
                std::to_string(protocol_version) + " of the protocol; the client asks for " + std::to_string(wanted));
  nlohmann::json names = nlohmann::json::array();
  for (const MethodInfo& method : methods()) names.push_back(method.name);
  return {{{"version", version}, {"protocol", protocol_version}, {"methods", names}}};
}

LinkAnswer Conversation::update(const Dict& request) {
  bool is_moving = false;
  read_members(without_keys(request, {"set", "remove", "options"}), std::pair("is_moving", &is_moving));
  const bool has_options = request.contains("options");
  RenderOptions options = options_in(request);
  RenderEdit edit = scene_.update(request.find("set"), request.find("remove"));
  edit.is_moving = is_moving;
  if (has_options) edit.options = std::move(options);
  if (!render_) return {nlohmann::json::object()};
  return {{{"revision", render_->edit(std::move(edit))}}};
}

LinkAnswer Conversation::start(const Dict& request) {
  InteractiveSettings settings{.coarse_first = false};
  read_members(without_keys(request, {"options"}), std::pair("is_interactive", &settings.coarse_first),
               std::pair("denoise", &settings.denoises));
  const RenderOptions options = options_in(request);
  render_.reset();
  SharedScene scene = scene_.build();  // throws if there is none
  render_ = std::make_unique<InteractiveRender>(std::move(scene), scene_.view(), options, settings);
  return {{{"warnings", texts_of(render_->warnings())}}};
}

InteractiveSnapshot Conversation::wait_for_news(std::uint64_t after, double patience) const {
  const auto end = std::chrono::steady_clock::now() + std::chrono::duration<double>(patience);
  InteractiveSnapshot now = render_->snapshot();
  while (now.number <= after) {
    const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(end - std::chrono::steady_clock::now());
    if (left.count() <= 0) break;
    now = render_->wait(after, left);
  }
  return now;
}

LinkAnswer Conversation::wait(const Dict& request) {
  std::uint64_t after = 0;
  double patience = 0;
  std::optional<std::vector<std::string>> layers;
  read_members(request, std::pair("after", &after), std::pair("patience", &patience), std::pair("layers", &layers));
  if (!(patience >= 0 && patience <= most_patience))
    throw Error("patience: expected 0 to 10 seconds, got " + plain::shown(patience));
  if (!render_) throw Error("nothing is being rendered: send \"start\" first");
  const InteractiveSnapshot now = wait_for_news(after, patience);
  LinkAnswer answer{nlohmann::json::object()};
  const std::optional<InteractiveDenoised> denoised = now.denoised ? std::optional(*now.denoised) : std::nullopt;
  if (now.picture && now.number > after) answer = picture_answer(*now.picture, denoised, layers);
  answer.body["number"] = now.number;
  answer.body["phase"] = name_of(now.status.phase);
  if (!now.status.problem.empty()) answer.body["problem"] = now.status.problem;
  return answer;
}

LinkAnswer Conversation::finish_pass(const Dict& request) {
  read_members(request);
  if (render_) render_->pause(true);
  return {nlohmann::json::object()};
}

LinkAnswer Conversation::stop(const Dict& request) {
  read_members(request);
  render_.reset();
  return {nlohmann::json::object()};
}

LinkAnswer Conversation::answer_checked(const Dict& request) {
  using Handler = LinkAnswer (Conversation::*)(const Dict&);
  const std::array<std::pair<const char*, Handler>, 5> handlers{{{"update", &Conversation::update},
                                                                 {"start", &Conversation::start},
                                                                 {"wait", &Conversation::wait},
                                                                 {"finish_pass", &Conversation::finish_pass},
                                                                 {"stop", &Conversation::stop}}};
  const Value* name = request.find("request");
  if (name == nullptr || name->as<std::string>() == nullptr)
    throw Error("expected the name of a request under the key \"request\"");
  const std::string& wanted = *name->as<std::string>();
  if (wanted == "hello") return hello(request);
  std::vector<std::string> known{"hello"};
  for (const auto& [handled, handler] : handlers) {
    if (handled == wanted) return (this->*handler)(request);
    known.emplace_back(handled);
  }
  throw Error("unknown request " + in_quotes(wanted) + did_you_mean(wanted, known));
}

LinkAnswer Conversation::answer(const Dict& request) {
  try {
    LinkAnswer answer = answer_checked(request);
    answer.body["answer"] = std::get<std::string>(*request.find("request"));
    return answer;
  } catch (const Error& e) {
    return {{{"answer", "error"}, {"message", e.what()}}};
  } catch (const std::bad_alloc&) {
    return {{{"answer", "error"}, {"message", "not enough memory for this scene or picture"}}};
  }
}

}  // namespace lanthorn::program
