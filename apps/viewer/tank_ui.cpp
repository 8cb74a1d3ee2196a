#include "apps/viewer/tank_ui.hpp"

#include <imgui.h>

#include <algorithm>
#include <cfloat>
#include <cstdio>

#include "apps/viewer/ui_parts.hpp"
#include "apps/viewer/widgets.hpp"

namespace brume::viewer {
namespace {

/// A button of the time bar. Returns whether it was clicked.
bool tank_button(const char* label, const char* tooltip) {
  const bool clicked = button(label);
  if (ImGui::IsItemHovered()) ImGui::SetTooltip("%s", tooltip);
  ImGui::SameLine();
  return clicked;
}

/// Marks the keys on the slider.
void mark_keys(const scene::TankScene& scene, ImVec2 at, ImVec2 size) {
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const auto marks = [&](const auto& keys, ImU32 colour) {
    for (const auto& key : keys) {
      const float x = at.x + size.x * static_cast<float>(key.time / double{scene.duration});
      if (key.time <= double{scene.duration})
        list.AddLine(ImVec2(x, at.y), ImVec2(x, at.y + size.y), colour, 2);
    }
  };
  marks(scene.camera, IM_COL32(120, 160, 220, 255));
  for (const scene::TankLight& light : scene.lights) marks(light.keys, IM_COL32(255, 200, 110, 255));
  if (scene.glass) marks(scene.glass->keys, IM_COL32(150, 220, 210, 255));
}

}  // namespace

std::string grouped(std::uint64_t number) {
  const std::string digits = std::to_string(number);
  std::string text;
  for (std::size_t i = 0; i < digits.size(); ++i) {
    if (i > 0 && (digits.size() - i) % 3 == 0) text += ',';
    text += digits[i];
  }
  return text;
}

void lay_out_bar(double fraction, float height) {
  ImGui::PushStyleColor(ImGuiCol_PlotHistogram, ImVec4(0.93f, 0.66f, 0.30f, 0.9f));
  ImGui::ProgressBar(static_cast<float>(std::min(fraction, 1.0)), ImVec2(-FLT_MIN, height), "");
  ImGui::PopStyleColor();
}

void lay_out_tank_work(const TankWork& work, TankRequests& requests) {
  const ImVec2 display = ImGui::GetIO().DisplaySize;
  const float width = std::min(26 * ImGui::GetFontSize(), display.x - 2 * kMargin);
  ImGui::SetNextWindowPos(ImVec2(0.5f * display.x, 0.5f * display.y), ImGuiCond_Always, ImVec2(0.5f, 0.5f));
  ImGui::SetNextWindowSize(ImVec2(width, 0));
  ImGui::Begin("work", nullptr,
               ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoSavedSettings |
                   ImGuiWindowFlags_NoFocusOnAppearing | ImGuiWindowFlags_NoNav);
  ImGui::Text("%s, %.0f s", work.title.c_str(), work.seconds);
  if (work.progress && work.progress->total > 0) {
    const Progress::State& now = *work.progress;
    const double fraction = static_cast<double>(now.done) / static_cast<double>(now.total);
    lay_out_bar(fraction, 0.7f * ImGui::GetFontSize());
    char left[48] = "";
    if (now.seconds_left() >= 0) std::snprintf(left, sizeof left, ", %.0f s left", now.seconds_left());
    ImGui::TextDisabled("%s: %s of %s%s", now.name.c_str(), grouped(now.done).c_str(),
                        grouped(now.total).c_str(), left);
  }
  if (work.can_stop) {
    if (work.stops) {
      ImGui::TextDisabled("stops...");
    } else {
      requests.stop = button("Stop here");
      ImGui::SameLine();
      ImGui::TextDisabled("the spheres so far stay");
    }
  }
  ImGui::End();
}

void lay_out_tank_time_bar(TankState& state, TankRequests& requests) {
  const ImVec2 display = ImGui::GetIO().DisplaySize;
  ImGui::SetNextWindowPos(ImVec2(kMargin, display.y - kTimeBarHeight - kMargin), ImGuiCond_Always);
  ImGui::SetNextWindowSize(ImVec2(std::max(display.x - 2 * kMargin, 100.0f), kTimeBarHeight),
                           ImGuiCond_Always);
  ImGui::Begin("time", nullptr, ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove);
  const auto act = [&](const char* label, const char* tooltip, Action action) {
    if (tank_button(label, tooltip)) requests.actions.push_back(action);
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
  ImGui::Text("%.2f / %.2f s", state.seconds(), double{state.scene().duration});

  double now = state.seconds();
  ImGui::SetNextItemWidth(-1);
  const ImVec2 at = ImGui::GetCursorScreenPos();
  const ImVec2 size(ImGui::GetContentRegionAvail().x, ImGui::GetFrameHeight());
  if (slider("##time", &now, 0.0, double{state.scene().duration})) requests.seek = now;
  mark_keys(state.scene(), at, size);
  ImGui::End();
}

TankRequests lay_out_tank(TankState& state, TankChoices& choices, const TankStatus& status) {
  TankRequests requests;
  if (choices.overlay) {
    lay_out_tank_marks(state, choices, status);
    lay_out_tank_overlay(state, choices, status);
  }
  if (choices.panels) {
    lay_out_tank_panels(state, choices, status, requests);
    lay_out_tank_time_bar(state, requests);
  }
  if (status.work) lay_out_tank_work(*status.work, requests);
  if (choices.help) lay_out_help(KeyMap::tank, "The wheel: nearer or farther. H closes this.");
  ImGui::Render();
  return requests;
}

TankRequests lay_out_tank_loading(const std::string& name, const TankWork& work) {
  TankRequests requests;
  TankWork named = work;
  named.title = name + ": " + work.title;
  lay_out_tank_work(named, requests);
  ImGui::Render();
  return requests;
}

}  // namespace brume::viewer
