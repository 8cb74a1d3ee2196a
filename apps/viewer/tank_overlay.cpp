// Status and marks over the picture of a tank, and the buttons of its time bar.
#include <imgui.h>

#include <algorithm>
#include <cstdio>
#include <glm/gtc/color_space.hpp>
#include <numbers>

#include "apps/viewer/tank_ui.hpp"
#include "apps/viewer/widgets.hpp"

namespace brume::viewer {
namespace {

constexpr ImU32 kAccentMark = IM_COL32(255, 190, 90, 255), kRim = IM_COL32(255, 255, 255, 200),
                kShadow = IM_COL32(0, 0, 0, 170), kGlassLine = IM_COL32(190, 230, 235, 120);
constexpr float kMarkRadius = 7;  // [px]

std::optional<ImVec2> point_of(const scene::Camera& camera, const glm::vec3& world) {
  const auto at = on_display(camera, world);
  return at ? std::optional(ImVec2(at->x, at->y)) : std::nullopt;
}

ImU32 colour_of(const glm::vec3& color) {
  const float strongest = std::max({color.x, color.y, color.z, 1e-6f});
  const glm::vec3 srgb = glm::convertLinearToSRGB(glm::clamp(color / strongest, glm::vec3(0), glm::vec3(1)));
  return ImGui::ColorConvertFloat4ToU32(ImVec4(srgb.x, srgb.y, srgb.z, 1));
}

/// Beside a mark, where there is room.
void label_mark(ImDrawList& list, ImVec2 at, float display_width, const std::string& text) {
  const ImVec2 size = ImGui::CalcTextSize(text.c_str());
  const bool is_right = at.x + 18 + size.x < display_width;
  const ImVec2 low(is_right ? at.x + 14 : at.x - 14 - size.x, at.y - 0.5f * size.y);
  list.AddRectFilled(ImVec2(low.x - 4, low.y - 2), ImVec2(low.x + size.x + 4, low.y + size.y + 2), kShadow,
                     3);
  list.AddText(low, kAccentMark, text.c_str());
}

/// The outline of an ellipsoid: its circles between each two of its axes.
void draw_ellipsoid(ImDrawList& list, const scene::Camera& camera, const scene::TankGlass& glass) {
  constexpr int kSegments = 64;
  for (int axis = 0; axis < 3; ++axis) {
    std::optional<ImVec2> last;
    for (int i = 0; i <= kSegments; ++i) {
      const float turn = 2 * std::numbers::pi_v<float> * static_cast<float>(i) / kSegments;
      glm::vec3 unit(0);
      unit[(axis + 1) % 3] = std::cos(turn);
      unit[(axis + 2) % 3] = std::sin(turn);
      const auto now = point_of(camera, glass.position_world + unit * glass.radii);
      if (last && now) list.AddLine(*last, *now, kGlassLine, 1.2f);
      last = now;
    }
  }
}

void draw_mark(ImDrawList& list, const TankState& state, const TankHandle& handle, bool is_bright) {
  const scene::Camera camera = state.camera();
  const ImVec2 display = ImGui::GetIO().DisplaySize;
  const auto mark = mark_in(camera, {display.x, display.y}, place_of(state.scene(), handle, state.seconds()));
  const bool is_light = handle.kind == TankHandle::Kind::light;
  if (!is_light) draw_ellipsoid(list, camera, scene::glass_at(*state.scene().glass, state.seconds()));
  if (!mark) return;
  const ImVec2 at(mark->at.x, mark->at.y);
  const float radius = mark->is_at_edge ? 0.7f * kMarkRadius : kMarkRadius;
  const ImU32 fill =
      is_light ? colour_of(state.scene().lights[handle.index].color) : IM_COL32(150, 215, 225, 160);
  list.AddCircleFilled(at, radius + 2, kShadow);
  list.AddCircleFilled(at, radius - 1.5f, fill);
  list.AddCircle(at, radius, is_bright ? kAccentMark : kRim, 0, is_bright ? 2.5f : 1.5f);
  if (is_bright)
    label_mark(list, at, display.x, is_light ? "light " + std::to_string(handle.index + 1) : "glass");
}

void lay_out_samples(const TankState& state, const TankFigures& figures) {
  const std::uint32_t limit = state.scene().samples;
  const std::uint32_t done = std::min(figures.samples, limit);
  if (figures.moves) {
    ImGui::Text("preview of %u x %u pixels", figures.picture_px.x, figures.picture_px.y);
  } else if (done >= limit) {
    ImGui::Text("%u samples: done", limit);
  } else {
    const Progress::State progress{"samples", done, limit, figures.seconds};
    char rest[64] = "";
    if (progress.seconds_left() >= 0)
      std::snprintf(rest, sizeof rest, "  %.3g/s  %.0f s left", progress.rate(), progress.seconds_left());
    ImGui::Text("%u of %u samples%s", done, limit, rest);
  }
  lay_out_progress(static_cast<double>(done) / static_cast<double>(limit), 4);
}

}  // namespace

void lay_out_tank_marks(const TankState& state, const TankChoices& choices,
                        const std::optional<TankHandle>& hovered) {
  ImDrawList& list = *ImGui::GetBackgroundDrawList();
  for (const TankHandle& handle : handles_of(state.scene()))
    draw_mark(list, state, handle, hovered == handle || choices.selected == handle);
}

void lay_out_tank_status(const TankState& state, const TankFigures& figures) {
  lay_out_samples(state, figures);
  ImGui::Text("%s %s%s", grouped(figures.spheres).c_str(),
              state.scene().view == scene::TankView::voxels ? "spheres as voxels" : "spheres",
              state.is_complete() ? "" : ", packing was stopped");
  ImGui::Text("%.2f s, %s", state.seconds(),
              !state.follows_path() ? "free camera"
              : state.has_path()    ? "along the camera's path"
                                    : "the scene's camera");
}

void lay_out_tank_buttons(const TankState& state, UiRequests& requests) {
  const auto act = [&](const char* label, const char* tooltip, Action action) {
    if (bar_button(label, tooltip)) requests.actions.push_back(action);
  };
  act(state.is_playing() ? "pause###play" : "play###play", "let the time run, or stop it (P)", Action::pause);
  act("to start", "back to the start (R)", Action::rewind);
  act("undo", "take back the last setting (Ctrl+Z)", Action::undo);
  act("redo", "do again what was undone (Ctrl+Y)", Action::redo);
  act("save scene", "save all settings as a file (F5)", Action::save_recording);
  act("save picture", "save the picture and its scene (F12)", Action::screenshot);
  bool follows = state.follows_path();
  if (checkbox("scene's camera", &follows)) requests.actions.push_back(Action::camera_path);
  if (ImGui::IsItemHovered())
    ImGui::SetTooltip("%s", state.has_path() ? "follow the camera's path, or look around freely (C)"
                                             : "the camera of the scene, or a free one (C)");
  ImGui::SameLine();
}

void mark_keys(const scene::TankScene& scene, const TimeMark& mark) {
  const auto marks = [&](const auto& keys, ImU32 colour) {
    for (const auto& key : keys) mark(key.time, colour);
  };
  marks(scene.camera, IM_COL32(120, 160, 220, 255));
  for (const scene::TankLight& light : scene.lights) marks(light.keys, IM_COL32(255, 200, 110, 255));
  if (scene.glass) marks(scene.glass->keys, IM_COL32(150, 220, 210, 255));
}

}  // namespace brume::viewer
