// What the windows of all documents have: overlay, panels, time slider and work in the background.
#include <imgui.h>

#include <algorithm>
#include <cfloat>
#include <cstdio>

#include "apps/viewer/ui_parts.hpp"
#include "apps/viewer/widgets.hpp"

namespace brume::viewer {
namespace {

constexpr ImGuiWindowFlags kPlain = ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoInputs |
                                    ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoSavedSettings |
                                    ImGuiWindowFlags_NoFocusOnAppearing | ImGuiWindowFlags_NoNav;
constexpr float kPanelWidth = 400;  // [px]

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

float panel_width() {
  return std::min(kPanelWidth, 0.5f * ImGui::GetIO().DisplaySize.x);
}

void lay_out_progress(double fraction, float height) {
  ImGui::PushStyleColor(ImGuiCol_PlotHistogram, ImVec4(0.93f, 0.66f, 0.30f, 0.9f));
  ImGui::ProgressBar(static_cast<float>(std::min(fraction, 1.0)), ImVec2(-FLT_MIN, height), "");
  ImGui::PopStyleColor();
}

void lay_out_overlay(Document& document, const Status& status) {
  // Beside the panels, not under them; as wide as its usual lines, so that it does not jump.
  const float beside = document.choices().panels ? panel_width() + kMargin : 0;
  const float room = ImGui::GetIO().DisplaySize.x - 2 * kMargin - beside;
  const float usual = std::min(room, 20 * ImGui::GetFontSize());
  ImGui::SetNextWindowPos(ImVec2(kMargin, kMargin));
  ImGui::SetNextWindowSizeConstraints(ImVec2(usual, 0), ImVec2(std::max(room, usual), FLT_MAX));
  ImGui::SetNextWindowBgAlpha(0.55f);
  ImGui::Begin("figures", nullptr, kPlain);
  ImGui::PushTextWrapPos(room - ImGui::GetStyle().WindowPadding.x);
  document.lay_out_status();
  if (!status.shader_errors.empty()) ImGui::TextColored(kFaultText, "shader error: see the panels");
  for (const std::string& line : status.lines) ImGui::TextColored(kAccentText, "%s", line.c_str());
  if (document.shows_hint()) ImGui::TextDisabled("H: help   Tab: settings");
  ImGui::PopTextWrapPos();
  ImGui::End();
}

void lay_out_panels(Document& document, const Status& status, UiRequests& requests) {
  const ImVec2 display = ImGui::GetIO().DisplaySize;
  const float width = panel_width();
  ImGui::SetNextWindowPos(ImVec2(display.x - width - kMargin, kMargin), ImGuiCond_Always);
  ImGui::SetNextWindowSize(ImVec2(width, std::max(display.y - kTimeBarHeight - 3 * kMargin, 80.0f)),
                           ImGuiCond_Always);
  ImGui::Begin("Settings", nullptr,
               ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoResize | ImGuiWindowFlags_NoCollapse |
                   ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_AlwaysVerticalScrollbar);
  if (!status.shader_errors.empty()) {
    ImGui::PushStyleColor(ImGuiCol_Text, kFaultText);
    ImGui::TextWrapped("%s", status.shader_errors.c_str());
    ImGui::PopStyleColor();
  }
  document.lay_out_sections(status, requests);
  ImGui::End();
}

bool bar_button(const char* label, const char* tooltip) {
  const bool clicked = button(label);
  if (ImGui::IsItemHovered()) ImGui::SetTooltip("%s", tooltip);
  ImGui::SameLine();
  return clicked;
}

void lay_out_time_bar(Document& document, UiRequests& requests) {
  const ImVec2 display = ImGui::GetIO().DisplaySize;
  ImGui::SetNextWindowPos(ImVec2(kMargin, display.y - kTimeBarHeight - kMargin), ImGuiCond_Always);
  ImGui::SetNextWindowSize(ImVec2(std::max(display.x - 2 * kMargin, 100.0f), kTimeBarHeight),
                           ImGuiCond_Always);
  ImGui::Begin("time", nullptr, ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove);
  document.lay_out_buttons(requests);
  ImGui::Text("%.2f / %.2f s", document.seconds(), document.end_seconds());

  // The slider.
  const double end = std::max(document.end_seconds(), 0.01);
  double now = document.seconds();
  ImGui::SetNextItemWidth(-1);
  const ImVec2 at = ImGui::GetCursorScreenPos();
  const ImVec2 size(ImGui::GetContentRegionAvail().x, ImGui::GetFrameHeight());
  if (slider("##time", &now, 0.0, end)) requests.seek = now;
  document.mark_times([&](double time, std::uint32_t colour) {
    const float x = at.x + size.x * static_cast<float>(time / end);
    if (time <= end)
      ImGui::GetWindowDrawList()->AddLine(ImVec2(x, at.y), ImVec2(x, at.y + size.y), colour, 2);
  });
  ImGui::End();
}

bool lay_out_work(const Work& work) {
  const ImVec2 display = ImGui::GetIO().DisplaySize;
  const float width = std::min(26 * ImGui::GetFontSize(), display.x - 2 * kMargin);
  ImGui::SetNextWindowPos(ImVec2(0.5f * display.x, 0.5f * display.y), ImGuiCond_Always, ImVec2(0.5f, 0.5f));
  ImGui::SetNextWindowSize(ImVec2(width, 0));
  ImGui::Begin("work", nullptr,
               ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoSavedSettings |
                   ImGuiWindowFlags_NoFocusOnAppearing | ImGuiWindowFlags_NoNav);
  ImGui::Text("%s, %.0f s", work.title.c_str(), work.seconds);
  // As high without progress as with it: the button keeps its place.
  const Progress::State now = work.progress.value_or(Progress::State{});
  lay_out_progress(now.total > 0 ? static_cast<double>(now.done) / static_cast<double>(now.total) : 0,
                   0.7f * ImGui::GetFontSize());
  char left[48] = "";
  if (now.seconds_left() >= 0) std::snprintf(left, sizeof left, ", %.0f s left", now.seconds_left());
  if (now.total > 0)
    ImGui::TextDisabled("%s: %s of %s%s", now.name.c_str(), grouped(now.done).c_str(),
                        grouped(now.total).c_str(), left);
  else
    ImGui::TextDisabled("begins...");

  // The button, until it was pressed.
  bool stops = false;
  if (work.stops) {
    ImGui::TextDisabled("stops...");
  } else {
    stops = button("Stop here");
    ImGui::SameLine();
    ImGui::TextDisabled("the spheres so far stay");
  }
  ImGui::End();
  return stops;
}

}  // namespace brume::viewer
