// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// The window, by GLFW, with its input. It is a module, so that programs without a window load neither GLFW nor X11.
#include <GLFW/glfw3.h>
#include <backends/imgui_impl_glfw.h>
#include <backends/imgui_impl_opengl3.h>
#include <imgui.h>

#include <algorithm>
#include <array>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "viewer/panel.h"
#include "viewer/window/interface.h"

namespace lanthorn {

namespace {

/// Where the picture lies in the window, in its pixels.
struct PicturePlace {
  Vec2 corner{0};
  float pixel_size = 1;
};

struct Window {
  GLFWwindow* handle = nullptr;
  float scale = 1;
  double time = 0;
  Vec2 pointer{0};
  Vec2 event_pointer{0};  // at the last event of the pointer
  // Where buttons went down and up since the last frame. Between two slow frames, the pointer may be elsewhere before
  // and after that.
  std::optional<Vec2> pressed_at, released_at;
  std::array<bool, 3> buttons{};
  bool drags_picture = false;
  std::vector<int> keys;  // that went down since the last frame, even if they are up again
};

// ImGui's callbacks, which are set later, call these.
void note_pointer(GLFWwindow* handle, double x, double y) {
  static_cast<Window*>(glfwGetWindowUserPointer(handle))->event_pointer = {static_cast<float>(x),
                                                                           static_cast<float>(y)};
}
void note_button(GLFWwindow* handle, int /*button*/, int action, int /*modifiers*/) {
  Window& w = *static_cast<Window*>(glfwGetWindowUserPointer(handle));
  (action == GLFW_PRESS ? w.pressed_at : w.released_at) = w.event_pointer;
}
void note_key(GLFWwindow* handle, int key, int /*code*/, int action, int /*modifiers*/) {
  if (action == GLFW_PRESS) static_cast<Window*>(glfwGetWindowUserPointer(handle))->keys.push_back(key);
}

std::string last_failure() {
  const char* text = nullptr;
  glfwGetError(&text);
  return text != nullptr ? text : "no reason given";
}

PicturePlace place_of(int width, int height, float scale) {
  const ImVec2 size = ImGui::GetIO().DisplaySize;
  const Vec2 area(std::max(1.0f, size.x - panel_width * scale), std::max(1.0f, size.y));
  const Vec2 picture(static_cast<float>(width), static_cast<float>(height));
  PicturePlace place;
  place.pixel_size = std::min(area.x / picture.x, area.y / picture.y);
  place.corner = glm::floor(0.5f * (area - place.pixel_size * picture));
  return place;
}

void* open(const char* title, int width, int height, std::string& failure) {
  glfwSetErrorCallback(nullptr);
  if (glfwInit() != GLFW_TRUE) {
    failure = last_failure();
    return nullptr;
  }
  glfwWindowHint(GLFW_CONTEXT_VERSION_MAJOR, 4);
  glfwWindowHint(GLFW_CONTEXT_VERSION_MINOR, 5);
  glfwWindowHint(GLFW_OPENGL_PROFILE, GLFW_OPENGL_CORE_PROFILE);
  glfwWindowHint(GLFW_OPENGL_DEBUG_CONTEXT, GLFW_TRUE);
  glfwWindowHint(GLFW_CONTEXT_ROBUSTNESS, GLFW_LOSE_CONTEXT_ON_RESET);
  glfwWindowHintString(GLFW_X11_CLASS_NAME, "lanthorn");
  auto window = std::make_unique<Window>();
  float scale_y = 1;
  glfwGetMonitorContentScale(glfwGetPrimaryMonitor(), &window->scale, &scale_y);
  int left = 0, top = 0, widest = width, highest = height;
  glfwGetMonitorWorkarea(glfwGetPrimaryMonitor(), &left, &top, &widest, &highest);
  constexpr float least_width = 640, least_height = 890;  // of the picture's place; of the whole panel
  const auto scaled = [&](float pixels) { return static_cast<int>(pixels * window->scale); };
  const int window_width = std::min(std::max(width, scaled(least_width)) + scaled(panel_width), widest);
  const int window_height = std::min(std::max(height, scaled(least_height)), highest);
  window->handle = glfwCreateWindow(window_width, window_height, title, nullptr, nullptr);
  if (window->handle == nullptr) {
    failure = last_failure();
    glfwTerminate();
    return nullptr;
  }
  glfwMakeContextCurrent(window->handle);
  glfwSwapInterval(1);
  IMGUI_CHECKVERSION();
  ImGui::CreateContext();
  ImGui::GetIO().IniFilename = nullptr;
  ImGui::GetIO().LogFilename = nullptr;
  set_style(window->scale);
  glfwSetWindowUserPointer(window->handle, window.get());
  glfwSetKeyCallback(window->handle, note_key);
  glfwSetCursorPosCallback(window->handle, note_pointer);
  glfwSetMouseButtonCallback(window->handle, note_button);
  ImGui_ImplGlfw_InitForOpenGL(window->handle, true);
  ImGui_ImplOpenGL3_Init("#version 450 core");
  window->time = glfwGetTime();
  return window.release();
}

void close(void* opaque) {
  const std::unique_ptr<Window> window(static_cast<Window*>(opaque));
  ImGui_ImplOpenGL3_Shutdown();
  ImGui_ImplGlfw_Shutdown();
  ImGui::DestroyContext();
  glfwDestroyWindow(window->handle);
  glfwTerminate();
}

bool is_down(const Window& w, int key) { return glfwGetKey(w.handle, key) == GLFW_PRESS; }
float axis(const Window& w, int forward, int back) {
  return static_cast<float>(is_down(w, forward)) - static_cast<float>(is_down(w, back));
}

void read_shortcut(int key, Panel& panel, Input& input) {
  if (key >= GLFW_KEY_1 && key <= GLFW_KEY_9) {
    const auto method = static_cast<std::size_t>(key - GLFW_KEY_1);
    if (method < panel.methods.size()) panel.method = method;
  }
  panel.wishes.save_png |= key == GLFW_KEY_P;
  panel.wishes.save_scene |= panel.can_save_scene && key == GLFW_KEY_O;
  panel.wishes.reset_camera |= key == GLFW_KEY_R;
  if (key == GLFW_KEY_N && panel.wants_offline()) panel.denoises = !panel.denoises;
  input.forget |= key == GLFW_KEY_ESCAPE;
}

void read_keys(Window& w, Panel& panel, Input& input) {
  const std::vector<int> keys = std::exchange(w.keys, {});
  const bool control = is_down(w, GLFW_KEY_LEFT_CONTROL) || is_down(w, GLFW_KEY_RIGHT_CONTROL);
  for (const int key : keys) input.closed |= key == GLFW_KEY_F10 || (control && key == GLFW_KEY_Q);
  if (control || ImGui::GetIO().WantTextInput) return;
  input.shift = is_down(w, GLFW_KEY_LEFT_SHIFT) || is_down(w, GLFW_KEY_RIGHT_SHIFT);
  input.fly = {axis(w, GLFW_KEY_D, GLFW_KEY_A), axis(w, GLFW_KEY_E, GLFW_KEY_Q), axis(w, GLFW_KEY_W, GLFW_KEY_S)};
  for (const int key : keys) read_shortcut(key, panel, input);
}

void read_pointer(Window& w, Input& input, const PicturePlace& place, int width, int height) {
  double x = 0, y = 0;
  glfwGetCursorPos(w.handle, &x, &y);
  const Vec2 now = w.released_at.value_or(Vec2(static_cast<float>(x), static_cast<float>(y)));
  input.pointer = (now - place.corner) / place.pixel_size;
  input.moved = (now - w.pressed_at.value_or(w.pointer)) / place.pixel_size;
  w.pointer = now;
  w.pressed_at.reset();
  const ImGuiIO& io = ImGui::GetIO();
  input.inside = !io.WantCaptureMouse && input.pointer.x >= 0 && input.pointer.y >= 0 &&
                 input.pointer.x < static_cast<float>(width) && input.pointer.y < static_cast<float>(height);
  // ImGui keeps clicks that begin and end between two frames.
  for (std::size_t i = 0; i < w.buttons.size(); ++i) {
    const bool down = io.MouseDown[i];
    input.pressed |= down && !w.buttons[i];
    input.released |= !down && w.buttons[i];
    w.buttons[i] = down;
  }
  if (input.released || !input.pressed) w.released_at.reset();
  if (input.pressed) w.drags_picture = input.inside;
  if (w.drags_picture) {
    input.left = io.MouseDown[ImGuiMouseButton_Left];
    input.right = io.MouseDown[ImGuiMouseButton_Right];
    input.middle = io.MouseDown[ImGuiMouseButton_Middle];
  }
  input.wheel = io.MouseWheel;
}

// The first half of an ImGui frame: `show` is the second.
Input read(void* opaque, bool may_wait, int width, int height, Panel& panel) {
  Window& w = *static_cast<Window*>(opaque);
  constexpr double longest_wait = 0.1;
  if (may_wait)
    glfwWaitEventsTimeout(longest_wait);
  else
    glfwPollEvents();
  ImGui_ImplOpenGL3_NewFrame();
  ImGui_ImplGlfw_NewFrame();
  ImGui::NewFrame();
  Input input;
  input.closed = glfwWindowShouldClose(w.handle) == GLFW_TRUE;
  const double now = glfwGetTime();
  constexpr double longest_step = 0.25;
  input.seconds = static_cast<float>(std::min(now - w.time, longest_step));
  w.time = now;
  read_pointer(w, input, place_of(width, height, w.scale), width, height);
  read_keys(w, panel, input);
  return input;
}

void show(void* opaque, unsigned texture, int width, int height, Panel& panel) {
  Window& w = *static_cast<Window*>(opaque);
  const PicturePlace place = place_of(width, height, w.scale);
  const ImVec2 corner(place.corner.x, place.corner.y);
  const ImVec2 end(corner.x + place.pixel_size * static_cast<float>(width),
                   corner.y + place.pixel_size * static_cast<float>(height));
  ImGui::GetBackgroundDrawList()->AddImage(reinterpret_cast<ImTextureID>(static_cast<std::uintptr_t>(texture)), corner,
                                           end);
  draw_marks(panel, place.corner, place.pixel_size, w.scale);
  draw_notice(panel, place.corner, {end.x - corner.x, end.y - corner.y}, w.scale);
  draw_panel(panel, w.scale);
  ImGui::Render();
  ImGui_ImplOpenGL3_RenderDrawData(ImGui::GetDrawData());
  glfwSwapBuffers(w.handle);
}

void copy(void* opaque, const char* text) { glfwSetClipboardString(static_cast<Window*>(opaque)->handle, text); }

}  // namespace

extern "C" const WindowFunctions* lanthorn_window() {
  static constexpr WindowFunctions functions{open, close, read, show, copy};
  return &functions;
}

}  // namespace lanthorn
