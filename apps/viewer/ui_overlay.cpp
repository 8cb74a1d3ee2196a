#include <imgui.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>

#include "apps/viewer/screen.hpp"
#include "apps/viewer/ui_parts.hpp"
#include "planning/device_camera.hpp"

namespace brume::viewer {
namespace {

constexpr ImGuiWindowFlags kPlain = ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoInputs |
                                    ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoSavedSettings |
                                    ImGuiWindowFlags_NoFocusOnAppearing | ImGuiWindowFlags_NoNav;
constexpr ImU32 kMark = IM_COL32(255, 190, 90, 255), kShade = IM_COL32(0, 0, 0, 160);
constexpr ImU32 kVisible = IM_COL32(110, 220, 130, 255), kHidden = IM_COL32(240, 90, 80, 255);
constexpr float kMargin = 8;

glm::vec2 display_size() {
  return {ImGui::GetIO().DisplaySize.x, ImGui::GetIO().DisplaySize.y};
}

/// Projects a world point to the display; nothing if it is behind the near plane.
std::optional<ImVec2> on_display(const scene::Camera& camera, glm::vec3 world) {
  const glm::vec2 size = display_size();
  const auto device = planning::device_camera(camera, glm::uvec2(glm::max(size, glm::vec2(1))));
  const glm::vec4 clip = device.clip_from_world * glm::vec4(world, 1);
  if (clip.w < planning::kNearPlane) return std::nullopt;
  return ImVec2((0.5f + 0.5f * clip.x / clip.w) * size.x, (0.5f + 0.5f * clip.y / clip.w) * size.y);
}

void label(ImDrawList& list, ImVec2 at, ImU32 colour, const std::string& text) {
  const ImVec2 size = ImGui::CalcTextSize(text.c_str());
  list.AddRectFilled(ImVec2(at.x - 4, at.y - 2), ImVec2(at.x + size.x + 4, at.y + size.y + 2), kShade, 3);
  list.AddText(at, colour, text.c_str());
}

std::string probe_text(const ProbeResult& result) {
  char text[128];
  if (result.wall_m) {
    std::snprintf(text, sizeof text, "wall at %.2f m", static_cast<double>(*result.wall_m));
  } else {
    std::snprintf(text, sizeof text, "transmittance %.1f %%, optical depth %.2f",
                  100 * static_cast<double>(result.transmittance), static_cast<double>(result.optical_depth));
  }
  return text;
}

void lay_out_probe(const Choices& choices, const Session& session, const scene::Camera& camera) {
  const Probe& probe = choices.probe;
  if (!probe.a_world) return;
  ImDrawList& list = *ImGui::GetBackgroundDrawList();
  const auto a = on_display(camera, *probe.a_world);
  if (a) list.AddCircleFilled(*a, 5, kMark);
  if (!probe.b_world) {
    if (a) label(list, ImVec2(a->x + 9, a->y - 8), kMark, "L: set the other end");
    return;
  }
  const auto result = evaluate(probe, session.live().scenario(), session.simulation(), session.seconds());
  const auto b = on_display(camera, *probe.b_world);
  const bool visible = result && result->transmittance > 0.05f;
  if (b) list.AddCircleFilled(*b, 5, kMark);
  if (a && b) list.AddLine(*a, *b, visible ? kVisible : kHidden, 2.5f);
  const auto at = b ? b : a;
  if (at)
    label(list, ImVec2(at->x + 9, at->y - 8), visible ? kVisible : kHidden,
          result ? probe_text(*result) : result.failure().message);
}

}  // namespace

void lay_out_marks(const Choices& choices, const Session& session, const Player& player) {
  const glm::vec2 middle = 0.5f * display_size();
  ImDrawList& list = *ImGui::GetBackgroundDrawList();
  if (!choices.panels && !choices.help && choices.overlay) {
    const ImVec2 at(middle.x, middle.y);
    list.AddCircle(at, 4.5f, IM_COL32(0, 0, 0, 140), 0, 2.5f);
    list.AddCircle(at, 4.5f, IM_COL32(255, 255, 255, 190), 0, 1.2f);
  }
  lay_out_probe(choices, session, player.camera());
}

void lay_out_overlay(const Choices& choices, const Session& session, const Player& player,
                     const Figures& figures, const Notices& notices) {
  ImGui::SetNextWindowPos(ImVec2(kMargin, kMargin));
  ImGui::SetNextWindowBgAlpha(0.55f);
  ImGui::Begin("figures", nullptr, kPlain);
  const Quality& quality = *notices.quality;
  ImGui::Text("%.0f fps  %.1f ms  %s%s", figures.frames_per_second(), figures.median(&FrameFigures::work_ms),
              choices.level ? "" : "auto: ", quality.name);
  ImGui::Text("%d frame in flight, latency %.1f ms", Screen::kFramesInFlight,
              figures.median(&FrameFigures::latency_ms));
  ImGui::Text("%.2f s%s  %s  shot: %s%s", session.seconds(), session.paused() ? " (paused)" : "",
              player.flying() ? "flying" : "walking", name_of(choices.weapons.kind),
              session.follows_path() ? "  following the camera path" : "");
  if (choices.view != passes::DebugView::none)
    ImGui::Text("view: %s", std::string(passes::debug_view_name(choices.view)).c_str());
  if (!notices.shader_errors.empty())
    ImGui::TextColored(ImVec4(1, 0.45f, 0.4f, 1), "shader error: see the panels");
  for (const std::string& line : notices.lines)
    ImGui::TextColored(ImVec4(1, 0.8f, 0.5f, 1), "%s", line.c_str());
  if (figures.count() < 600) ImGui::TextDisabled("H: help   Tab: panels");
  ImGui::End();
}

void lay_out_help() {
  const auto bindings = key_bindings();
  glm::vec2 name(0), does(0);
  for (const KeyBinding& binding : bindings) {
    const ImVec2 a = ImGui::CalcTextSize(binding.name), b = ImGui::CalcTextSize(binding.does);
    name = glm::max(name, glm::vec2(a.x, a.y));
    does = glm::max(does, glm::vec2(b.x, b.y));
  }
  // One or two columns, whichever allows the larger text in this window.
  const glm::vec2 room = display_size() - 4 * kMargin;
  const glm::vec2 padding(2 * ImGui::GetStyle().CellPadding.x, 2 * ImGui::GetStyle().CellPadding.y + 1);
  const auto scale_of = [&](int lists) {
    const float pairs = static_cast<float>(lists);
    const float rows = std::ceil(static_cast<float>(bindings.size()) / pairs);
    const glm::vec2 text((room.x / pairs - 3 * padding.x) / (name.x + does.x),
                         (room.y / rows - padding.y) / name.y);
    return std::clamp(std::min(text.x, text.y), 0.3f, 1.0f);
  };
  const int lists = scale_of(2) > scale_of(1) ? 2 : 1;
  const std::size_t rows =
      (bindings.size() + static_cast<std::size_t>(lists) - 1) / static_cast<std::size_t>(lists);

  const glm::vec2 middle = 0.5f * display_size();
  ImGui::SetNextWindowPos(ImVec2(middle.x, middle.y), ImGuiCond_Always, ImVec2(0.5f, 0.5f));
  ImGui::SetNextWindowBgAlpha(0.9f);
  ImGui::Begin("help", nullptr, kPlain);
  ImGui::SetWindowFontScale(scale_of(lists));
  if (ImGui::BeginTable("keys", 2 * lists, ImGuiTableFlags_SizingFixedFit)) {
    for (std::size_t row = 0; row < rows; ++row) {
      ImGui::TableNextRow();
      for (std::size_t i = row; i < bindings.size(); i += rows) {
        ImGui::TableNextColumn();
        ImGui::TextColored(ImVec4(1, 0.8f, 0.5f, 1), "%s", bindings[i].name);
        ImGui::TableNextColumn();
        ImGui::TextUnformatted(bindings[i].does);
      }
    }
    ImGui::EndTable();
  }
  ImGui::End();
}

}  // namespace brume::viewer
