// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "viewer/window/interface.h"

#include <imgui.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <string>
#include <vector>

namespace lanthorn {

namespace {

const ImVec4 accent{0.96f, 0.68f, 0.26f, 1}, faint{0.58f, 0.60f, 0.64f, 1};

void heading(const char* text) {
  ImGui::Spacing();
  ImGui::Spacing();
  ImGui::TextColored(accent, "%s", text);
  ImGui::Separator();
}

void faint_text(const std::string& text) {
  ImGui::PushStyleColor(ImGuiCol_Text, faint);
  ImGui::PushTextWrapPos(0);
  ImGui::TextUnformatted(text.c_str());
  ImGui::PopTextWrapPos();
  ImGui::PopStyleColor();
}

void tip(const char* text) {
  if (ImGui::IsItemHovered()) ImGui::SetTooltip("%s", text);
}

// The title of a method in the list.
std::string title_of(const Panel& panel, std::size_t method) {
  return method < panel.techniques.size() ? panel.techniques[method].title
                                          : panel.methods[method] + "  (offline, refines)";
}

double number_of(const std::string& text, double otherwise) {
  double number = otherwise;
  std::from_chars(text.data(), text.data() + text.size(), number);
  return number;
}
std::string text_of(auto number) {
  std::array<char, 32> text{};
  return {text.data(), std::to_chars(text.data(), text.data() + text.size(), number).ptr};
}

// A value that a list offers.
struct Choice {
  std::string value, label;
};
// Words, powers of two, and whole numbers that may be a word, too; empty: the parameter has a slider.
std::vector<Choice> choices_of(const TechniqueParameter& p) {
  using Kind = NumberRange::Kind;
  std::vector<Choice> choices;
  const bool has_slider = p.numbers && (p.numbers->kind == Kind::real || p.numbers->kind == Kind::above_least ||
                                        (p.numbers->kind == Kind::whole && p.words.empty()));
  if (has_slider) return choices;
  for (std::size_t i = 0; i < p.words.size(); ++i) choices.push_back({p.words[i], p.control->words.at(i)});
  if (!p.numbers) return choices;
  const auto most = static_cast<int>(p.numbers->most);
  for (int i = static_cast<int>(p.numbers->least); i <= most; i = p.numbers->kind == Kind::whole ? i + 1 : 2 * i)
    choices.push_back({std::to_string(i), std::to_string(i)});
  return choices;
}

void draw_list(const char* label, const std::vector<Choice>& choices, std::string& value) {
  const auto shown =
      std::find_if(choices.begin(), choices.end(), [&](const Choice& choice) { return choice.value == value; });
  if (!ImGui::BeginCombo(label, shown == choices.end() ? value.c_str() : shown->label.c_str())) return;
  for (const Choice& choice : choices)
    if (ImGui::Selectable(choice.label.c_str(), choice.value == value)) value = choice.value;
  ImGui::EndCombo();
}

void draw_slider(const TechniqueParameter& p, float scene_radius, std::string& value) {
  const PanelControl& c = *p.control;
  const ImGuiSliderFlags flags = c.is_logarithmic ? ImGuiSliderFlags_Logarithmic : 0;
  if (p.numbers->kind == NumberRange::Kind::whole) {
    auto number = static_cast<int>(number_of(value, c.low));
    if (ImGui::SliderInt(c.label.c_str(), &number, static_cast<int>(c.low), static_cast<int>(c.high), "%d", flags))
      value = text_of(number);
    return;
  }
  const float unit = c.is_length ? scene_radius : 1;
  const float low = unit * static_cast<float>(c.low), high = unit * static_cast<float>(c.high);
  auto number = static_cast<float>(number_of(value, static_cast<double>(low)));
  if (ImGui::SliderFloat(c.label.c_str(), &number, low, high, c.format.c_str(), flags)) value = text_of(number);
}

void draw_parameter(const TechniqueParameter& p, float scene_radius, std::string& value) {
  const std::vector<Choice> choices = choices_of(p);
  if (choices.empty())
    draw_slider(p, scene_radius, value);
  else
    draw_list(p.control->label.c_str(), choices, value);
  if (!p.control->tip.empty()) tip(p.control->tip.c_str());
}

void draw_technique(Panel& panel, const TechniqueDescription& technique) {
  RealtimeSettings& s = panel.settings;
  if (technique.has_photons) {
    constexpr int fewest = 500, most = 400000;
    int photons = static_cast<int>(s.photons);
    if (ImGui::SliderInt("Photons", &photons, fewest, most, "%d", ImGuiSliderFlags_Logarithmic))
      s.photons = static_cast<std::uint32_t>(photons);
  }
  for (const TechniqueParameter& p : technique.parameters)
    if (p.control) draw_parameter(p, panel.scene_radius, s.values.at(p.info.name));
}

void draw_method(Panel& panel) {
  heading("Light");
  ImGui::SetNextItemWidth(-1);
  if (ImGui::BeginCombo("##method", title_of(panel, panel.method).c_str(), ImGuiComboFlags_HeightLarge)) {
    for (std::size_t i = 0; i < panel.methods.size(); ++i) {
      if (i == panel.techniques.size()) ImGui::Separator();
      if (ImGui::Selectable(title_of(panel, i).c_str(), i == panel.method)) panel.method = i;
    }
    ImGui::EndCombo();
  }
  tip("Keys 1 to 9");
  if (!panel.wants_offline()) draw_technique(panel, panel.techniques[panel.method]);
}

void draw_tone(Panel& panel) {
  heading("Picture");
  if (ImGui::SliderFloat("Exposure", &panel.exposure, -8, 8, "%+.1f stops")) panel.measures_exposure = false;
  if (ImGui::IsItemClicked(ImGuiMouseButton_Right)) {
    panel.exposure = 0;
    panel.measures_exposure = false;
  }
  tip("Right click: 0");
  ImGui::Checkbox("Measure the exposure", &panel.measures_exposure);
  tip("A white surface in the light of the picture becomes white");
  ImGui::BeginDisabled(!panel.wants_offline());
  ImGui::Checkbox("Denoise", &panel.denoises);
  ImGui::EndDisabled();
  if (ImGui::IsItemHovered(ImGuiHoveredFlags_AllowWhenDisabled))
    ImGui::SetTooltip("%s", panel.wants_offline()
                                ? "Pictures at rest (N): a preview while passes are rendered, full quality at the end"
                                : "Only pictures of offline methods can be denoised");
  int curve = static_cast<int>(panel.curve);
  if (ImGui::Combo("View", &curve, "Clipped\0Filmic\0AgX\0Highlights\0")) panel.curve = static_cast<ToneCurve>(curve);
  ImGui::Combo("Layer", &panel.layer, "All light\0Emission\0Direct\0Indirect\0Caustic\0");
}

void draw_light(Panel& panel, std::size_t i) {
  LightRow& light = panel.lights[i];
  ImGui::PushID(static_cast<int>(i));
  ImGui::Checkbox("##on", &light.on);
  tip("On or off");
  ImGui::SameLine();
  if (light.has_colour) {
    ImGui::ColorEdit3("##colour", &light.colour.r,
                      ImGuiColorEditFlags_NoInputs | ImGuiColorEditFlags_Float | ImGuiColorEditFlags_NoOptions);
    ImGui::SameLine();
  }
  const bool is_selected = panel.selected_light == i;
  if (ImGui::Selectable(light.name.c_str(), is_selected)) {
    panel.selected_object.reset();
    panel.selected_light = is_selected ? std::nullopt : std::optional(i);
  }
  if (is_selected) {
    ImGui::Indent();
    ImGui::SliderFloat("Strength", &light.strength, 0.01f, 100, "%.2f x", ImGuiSliderFlags_Logarithmic);
    if (light.position)
      faint_text("Drag its mark in the picture to move it.");
    else
      faint_text(light.is_area ? "A surface that emits: it stays in its place." : "Far away: it has no place.");
    ImGui::Unindent();
  }
  ImGui::PopID();
}

void draw_lights(Panel& panel) {
  heading("Lights");
  if (panel.lights.empty()) faint_text("The scene has none.");
  constexpr std::size_t most_rows = 6;
  const bool scrolls = panel.lights.size() > most_rows;
  if (scrolls) ImGui::BeginChild("lights", {0, ImGui::GetFrameHeightWithSpacing() * (most_rows + 1)});
  for (std::size_t i = 0; i < panel.lights.size(); ++i) draw_light(panel, i);
  if (scrolls) ImGui::EndChild();
  if (panel.selected_object) faint_text("Selected: " + panel.object_name + ". Drag it to move it.");
}

void draw_saving(Panel& panel) {
  heading("Save");
  const float third = (ImGui::GetContentRegionAvail().x - 2 * ImGui::GetStyle().ItemSpacing.x) / 3;
  Wishes& w = panel.wishes;
  if (ImGui::Button("PNG", {third, 0})) w.save_png = true;
  tip("The picture as it is shown (P)");
  ImGui::SameLine();
  if (ImGui::Button("EXR", {third, 0})) w.save_exr = true;
  tip("The picture with its layers, linear");
  ImGui::SameLine();
  ImGui::BeginDisabled(!panel.can_save_scene);
  if (ImGui::Button("Scene", {third, 0})) w.save_scene = true;
  ImGui::EndDisabled();
  if (ImGui::IsItemHovered(ImGuiHoveredFlags_AllowWhenDisabled))
    ImGui::SetTooltip("%s", panel.can_save_scene ? "A pbrt file with this camera, these lights and places (O)"
                                                 : "Only scenes of pbrt files can be saved");
  if (ImGui::Button("Copy the command of this picture", {-1, 0})) w.copy_command = true;
  tip(panel.command.c_str());
  const float half = (ImGui::GetContentRegionAvail().x - ImGui::GetStyle().ItemSpacing.x) / 2;
  if (ImGui::Button("Camera back", {half, 0})) w.reset_camera = true;
  tip("Where it was at first (R)");
  ImGui::SameLine();
  if (ImGui::Button("Undo edits", {half, 0})) w.reset_scene = true;
  if (!panel.message.empty()) {
    ImGui::PushTextWrapPos(0);
    ImGui::TextUnformatted(panel.message.c_str());
    ImGui::PopTextWrapPos();
  }
}

void row(const std::string& name, const std::string& value) {
  ImGui::TableNextRow();
  ImGui::TableNextColumn();
  ImGui::TextUnformatted(name.c_str());
  ImGui::TableNextColumn();
  const float free = ImGui::GetContentRegionAvail().x - ImGui::CalcTextSize(value.c_str()).x;
  ImGui::SetCursorPosX(ImGui::GetCursorPosX() + std::max(0.0f, free));
  ImGui::TextUnformatted(value.c_str());
}

std::string milliseconds(double ms) {
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), ms < 10 ? "%.2f ms" : "%.0f ms", ms);
  return text.data();
}

void draw_times(const Panel& panel) {
  heading("Frame");
  if (!ImGui::BeginTable("times", 2)) return;
  ImGui::TableSetupColumn("what", ImGuiTableColumnFlags_WidthStretch, 2);
  ImGui::TableSetupColumn("amount", ImGuiTableColumnFlags_WidthStretch, 1);
  if (panel.is_offline) {
    row("Passes", std::to_string(panel.frames));
    if (!panel.left.empty()) row("Time left", panel.left);
    if (!panel.error.empty()) row("Error", panel.error);
    if (!panel.denoised.empty()) row("Denoised", panel.denoised);
  } else {
    row("Frames in the mean", std::to_string(panel.frames));
    if (panel.frame_milliseconds > 0) row("Whole frame", milliseconds(panel.frame_milliseconds));
    for (const FrameStage& stage : panel.stages) row("  " + stage.name, milliseconds(stage.milliseconds));
    for (std::size_t i = 0; i < std::min<std::size_t>(panel.photons_per_bounce.size(), 4); ++i)
      row("Photons, bounce " + std::to_string(i + 1), std::to_string(panel.photons_per_bounce[i]));
    std::uint64_t rest = 0;
    for (std::size_t i = 4; i < panel.photons_per_bounce.size(); ++i) rest += panel.photons_per_bounce[i];
    if (rest > 0) row("Photons, later ones", std::to_string(rest));
  }
  ImGui::EndTable();
  if (panel.is_offline && !panel.remark.empty()) faint_text(panel.remark);
}

void load_font(float scale) {
  constexpr float height = 15;
  static constexpr std::array fonts{"/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf",
                                    "/usr/share/fonts/truetype/noto/NotoSans-Regular.ttf",
                                    "/usr/share/fonts/truetype/liberation/LiberationSans-Regular.ttf"};
  ImGuiIO& io = ImGui::GetIO();
  for (const char* font : fonts) {
    std::error_code code;
    if (std::filesystem::exists(font, code) &&
        io.Fonts->AddFontFromFileTTF(font, std::round(scale * height)) != nullptr)
      return;
  }
  ImFontConfig config;
  config.SizePixels = std::round(scale * 13);
  io.Fonts->AddFontDefault(&config);
}

}  // namespace

void set_style(float scale) {
  ImGui::StyleColorsDark();
  ImGuiStyle& style = ImGui::GetStyle();
  style.WindowRounding = 0;
  style.WindowBorderSize = 0;
  style.FrameRounding = style.GrabRounding = style.PopupRounding = 4;
  style.WindowPadding = {14, 10};
  style.FramePadding = {8, 4};
  style.ItemSpacing = {8, 6};
  const auto set = [&](ImGuiCol colour, float r, float g, float b, float a = 1) {
    style.Colors[colour] = {r, g, b, a};
  };
  set(ImGuiCol_WindowBg, 0.10f, 0.105f, 0.115f);
  set(ImGuiCol_PopupBg, 0.13f, 0.135f, 0.15f);
  set(ImGuiCol_FrameBg, 0.18f, 0.185f, 0.20f);
  set(ImGuiCol_FrameBgHovered, 0.24f, 0.245f, 0.26f);
  set(ImGuiCol_FrameBgActive, 0.28f, 0.285f, 0.30f);
  set(ImGuiCol_Button, 0.20f, 0.21f, 0.23f);
  set(ImGuiCol_ButtonHovered, 0.29f, 0.30f, 0.32f);
  set(ImGuiCol_ButtonActive, 0.96f, 0.68f, 0.26f, 0.6f);
  set(ImGuiCol_Header, 0.96f, 0.68f, 0.26f, 0.28f);
  set(ImGuiCol_HeaderHovered, 0.96f, 0.68f, 0.26f, 0.18f);
  set(ImGuiCol_HeaderActive, 0.96f, 0.68f, 0.26f, 0.4f);
  style.Colors[ImGuiCol_SliderGrab] = style.Colors[ImGuiCol_CheckMark] = accent;
  style.Colors[ImGuiCol_SliderGrabActive] = accent;
  style.ScaleAllSizes(scale);
  load_font(scale);
}

void draw_panel(Panel& panel, float scale) {
  const ImVec2 size = ImGui::GetIO().DisplaySize;
  const float width = std::min(panel_width * scale, size.x);
  ImGui::SetNextWindowPos({size.x - width, 0});
  ImGui::SetNextWindowSize({width, size.y});
  ImGui::Begin("panel", nullptr,
               ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoResize | ImGuiWindowFlags_NoMove |
                   ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoBringToFrontOnFocus);
  ImGui::PushItemWidth(-96 * scale);
  ImGui::TextUnformatted(panel.scene.c_str());
  faint_text(panel.driver);
  draw_method(panel);
  draw_tone(panel);
  draw_lights(panel);
  draw_saving(panel);
  draw_times(panel);
  if (!panel.notes.empty()) {
    heading("Shown differently than by render");
    for (const std::string& note : panel.notes) faint_text(note);
  }
  heading("Hands");
  faint_text(
      "Drag: orbit. Right drag: look around. Middle or Shift drag: pan. Wheel: zoom. W A S D E Q: fly. Click: select a "
      "light or an object, then drag it. Esc: nothing selected.");
  ImGui::PopItemWidth();
  ImGui::End();
}

void draw_notice(const Panel& panel, const Vec2& corner, const Vec2& size, float scale) {
  if (panel.notice.empty()) return;
  ImDrawList& list = *ImGui::GetBackgroundDrawList();
  const float height = 1.4f * ImGui::GetFontSize(), margin = 12 * scale;
  const float wrap = std::max(1.0f, size.x - 4 * margin);
  const ImVec2 text = ImGui::GetFont()->CalcTextSizeA(height, wrap, wrap, panel.notice.c_str());
  const ImVec2 at(corner.x + 0.5f * (size.x - text.x), corner.y + 2 * margin);
  list.AddRectFilled({at.x - margin, at.y - 0.6f * margin}, {at.x + text.x + margin, at.y + text.y + 0.6f * margin},
                     IM_COL32(16, 16, 18, 215), 6 * scale);
  list.AddText(ImGui::GetFont(), height, at, ImGui::GetColorU32(accent), panel.notice.c_str(), nullptr, wrap);
}

void draw_marks(const Panel& panel, const Vec2& corner, float pixel_size, float scale) {
  ImDrawList& list = *ImGui::GetBackgroundDrawList();
  constexpr float radius = 7;
  constexpr int rays = 8;
  for (const LightMark& mark : panel.marks) {
    const LightRow& light = panel.lights[mark.light];
    const ImVec2 at(corner.x + pixel_size * mark.at.x, corner.y + pixel_size * mark.at.y);
    const bool is_selected = panel.selected_light == mark.light;
    const ImU32 edge = is_selected ? ImGui::GetColorU32(accent) : IM_COL32(20, 20, 20, 200);
    const ImU32 fill = light.on ? ImGui::GetColorU32({light.colour.r, light.colour.g, light.colour.b, 0.95f})
                                : IM_COL32(60, 60, 60, 220);
    const float r = scale * radius;
    for (int i = 0; i < rays; ++i) {
      const float angle = 6.2831853f * static_cast<float>(i) / rays, c = std::cos(angle), s = std::sin(angle);
      const ImVec2 inner(at.x + 1.35f * r * c, at.y + 1.35f * r * s), outer(at.x + 1.9f * r * c, at.y + 1.9f * r * s);
      list.AddLine(inner, outer, edge, 3.5f * scale);
      list.AddLine(inner, outer, fill, 1.5f * scale);
    }
    list.AddCircleFilled(at, r, fill);
    list.AddCircle(at, r, edge, 0, (is_selected ? 3 : 1.5f) * scale);
  }
}

}  // namespace lanthorn
