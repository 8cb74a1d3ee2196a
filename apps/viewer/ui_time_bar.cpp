// The time slider with its buttons.
#include <imgui.h>

#include <algorithm>

#include "apps/viewer/ui_parts.hpp"
#include "apps/viewer/widgets.hpp"

namespace brume::viewer {
namespace {

// Marks the events of the timeline, and the keys of the carriers, on the slider.
void mark_events(const scene::Timeline& timeline, ImVec2 at, ImVec2 size, double end) {
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const auto marks = [&](const auto& events, ImU32 colour) {
    for (const auto& event : events) {
      const float x = at.x + size.x * static_cast<float>(event.time / std::max(end, 1e-3));
      list.AddLine(ImVec2(x, at.y), ImVec2(x, at.y + size.y), colour, 2);
    }
  };
  for (const scene::Carrier& carrier : timeline.carriers) marks(carrier.keys, IM_COL32(180, 130, 240, 255));
  marks(timeline.smokes, IM_COL32(200, 205, 215, 255));
  marks(timeline.shots, IM_COL32(255, 190, 90, 255));
  marks(timeline.texts, IM_COL32(255, 220, 140, 255));
  marks(timeline.blasts, IM_COL32(240, 90, 80, 255));
  marks(timeline.doors, IM_COL32(120, 190, 120, 255));
  marks(timeline.edits, IM_COL32(120, 160, 220, 255));
}

/// A button of the bar that stands for an action. Returns whether it was clicked.
bool bar_button(const char* label, const char* tooltip) {
  const bool clicked = button(label);
  if (ImGui::IsItemHovered()) ImGui::SetTooltip("%s", tooltip);
  ImGui::SameLine();
  return clicked;
}

}  // namespace

void lay_out_time_bar(const Session& session, UiRequests& requests) {
  const ImVec2 display = ImGui::GetIO().DisplaySize;
  ImGui::SetNextWindowPos(ImVec2(8, display.y - kTimeBarHeight - 8), ImGuiCond_Always);
  ImGui::SetNextWindowSize(ImVec2(std::max(display.x - 16, 100.0f), kTimeBarHeight), ImGuiCond_Always);
  ImGui::Begin("time", nullptr, ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove);

  // Buttons.
  const auto act = [&](const char* label, const char* tooltip, Action action) {
    if (bar_button(label, tooltip)) requests.actions.push_back(action);
  };
  act(session.paused() ? "resume###pause" : "pause###pause", "stop the time, or let it run (P)",
      Action::pause);
  act("to start", "back to the start: all actions happen again while you walk (R)", Action::rewind);
  if (bar_button("replay", "from the start, with all actions, along the recorded camera path"))
    requests.play = true;
  act("undo", "take back the last action or setting (Ctrl+Z)", Action::undo);
  act("redo", "do again what was undone (Ctrl+Y)", Action::redo);
  act("remove all", "remove all actions of this session (Shift+R); undo brings them back", Action::empty);
  act("save", "save the session as a timeline (F5)", Action::save_recording);
  ImGui::Text("%.2f / %.2f s", session.seconds(), session.end_seconds());

  // The slider.
  const double end = std::max(session.end_seconds(), 0.01);
  double now = session.seconds();
  ImGui::SetNextItemWidth(-1);
  const ImVec2 at = ImGui::GetCursorScreenPos();
  const ImVec2 size(ImGui::GetContentRegionAvail().x, ImGui::GetFrameHeight());
  if (slider("##time", &now, 0.0, end)) requests.seek = now;
  mark_events(session.live().scenario().timeline, at, size, end);
  ImGui::End();
}

}  // namespace brume::viewer
