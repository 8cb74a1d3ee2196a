// Status, messages and marks over the picture of a tank.
#include <imgui.h>

#include <algorithm>
#include <cfloat>
#include <cstdio>
#include <glm/gtc/color_space.hpp>
#include <numbers>

#include "apps/viewer/tank_ui.hpp"
#include "apps/viewer/ui_parts.hpp"

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

const ImVec4 kNoticeText(1, 0.8f, 0.5f, 1), kFaultText(1, 0.45f, 0.4f, 1);

void lay_out_samples(const TankState& state, const TankStatus& status) {
  const std::uint32_t limit = state.scene().samples;
  const std::uint32_t done = std::min(status.samples, limit);
  if (status.moves) {
    ImGui::Text("preview of %u x %u pixels", status.picture_px.x, status.picture_px.y);
  } else if (done >= limit) {
    ImGui::Text("%u samples: done", limit);
  } else {
    const Progress::State progress{"samples", done, limit, status.seconds};
    char rest[64] = "";
    if (progress.seconds_left() >= 0)
      std::snprintf(rest, sizeof rest, "  %.3g/s  %.0f s left", progress.rate(), progress.seconds_left());
    ImGui::Text("%u of %u samples%s", done, limit, rest);
  }
  lay_out_bar(static_cast<double>(done) / static_cast<double>(limit), 4);
}

}  // namespace

void lay_out_tank_marks(const TankState& state, const TankChoices& choices, const TankStatus& status) {
  ImDrawList& list = *ImGui::GetBackgroundDrawList();
  for (const TankHandle& handle : handles_of(state.scene()))
    draw_mark(list, state, handle, status.hovered == handle || choices.selected == handle);
}

void lay_out_tank_overlay(const TankState& state, const TankChoices& choices, const TankStatus& status) {
  const ImVec2 display = ImGui::GetIO().DisplaySize;
  const float room = display.x - 2 * kMargin - (choices.panels ? panel_width() + kMargin : 0);
  const float usual = std::min(room, 20 * ImGui::GetFontSize());
  ImGui::SetNextWindowPos(ImVec2(kMargin, kMargin));
  ImGui::SetNextWindowSizeConstraints(ImVec2(usual, 0), ImVec2(std::max(room, usual), FLT_MAX));
  ImGui::SetNextWindowBgAlpha(0.55f);
  ImGui::Begin("figures", nullptr,
               ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoInputs | ImGuiWindowFlags_AlwaysAutoResize |
                   ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoFocusOnAppearing |
                   ImGuiWindowFlags_NoNav);
  ImGui::PushTextWrapPos(room - ImGui::GetStyle().WindowPadding.x);
  lay_out_samples(state, status);
  ImGui::Text("%s %s%s", grouped(status.spheres).c_str(),
              state.scene().view == scene::TankView::voxels ? "spheres as voxels" : "spheres",
              state.is_complete() ? "" : ", packing was stopped");
  ImGui::Text("%.2f s, %s", state.seconds(),
              !state.follows_path() ? "free camera"
              : state.has_path()    ? "along the camera's path"
                                    : "the scene's camera");
  if (!status.shader_errors.empty()) ImGui::TextColored(kFaultText, "shader error: see the panels");
  for (const std::string& line : status.lines) ImGui::TextColored(kNoticeText, "%s", line.c_str());
  if (!choices.help && !choices.panels) ImGui::TextDisabled("H: help   Tab: settings");
  ImGui::PopTextWrapPos();
  ImGui::End();
}

}  // namespace brume::viewer
