#include "apps/viewer/widgets.hpp"

#include <imgui_internal.h>
#include <imgui_stdlib.h>

#include <algorithm>

namespace brume::viewer {
namespace {

/// Reports the widget that ImGui has just laid out, and returns what ImGui said about it.
bool added(const char* kind, const char* label, bool result) {
  if (auto* const log = static_cast<WidgetLog*>(ImGui::GetIO().UserData))
    log->add(ImGui::GetID(label), kind, label);
  return result;
}

}  // namespace

void WidgetLog::add(ImGuiID id, const char* kind, const char* label) {
  Widget widget;
  widget.id = id;
  widget.kind = kind;
  const char* const end = ImGui::FindRenderedTextEnd(label);
  widget.label = end == label ? label : std::string(label, end);
  const ImVec2 low = ImGui::GetItemRectMin(), high = ImGui::GetItemRectMax();
  widget.low_px = {low.x, low.y};
  widget.high_px = {high.x, high.y};
  const ImRect clip(ImGui::GetCurrentWindow()->ClipRect);
  widget.reachable = clip.Contains(ImVec2(0.5f * (low.x + high.x), 0.5f * (low.y + high.y)));
  widget.in_popup = (ImGui::GetCurrentWindow()->Flags & ImGuiWindowFlags_Popup) != 0;
  if (ImGui::IsItemActivated()) ++uses_[id];
  widget.uses = uses_[id];
  widgets_.push_back(std::move(widget));
}

void set_widget_log(WidgetLog* log) {
  ImGui::GetIO().UserData = log;
}

bool button(const char* label) {
  return added("button", label, ImGui::Button(label));
}
bool radio(const char* label, bool active) {
  return added("radio", label, ImGui::RadioButton(label, active));
}
bool checkbox(const char* label, bool* value) {
  return added("checkbox", label, ImGui::Checkbox(label, value));
}
bool header(const char* label, bool open) {
  const bool is_open =
      ImGui::CollapsingHeader(label, open ? ImGuiTreeNodeFlags_DefaultOpen : ImGuiTreeNodeFlags_None);
  return added(is_open ? "open" : "closed", label, is_open);
}
bool begin_tree(const char* label) {
  const bool is_open = ImGui::TreeNodeEx(label, ImGuiTreeNodeFlags_NoTreePushOnOpen);
  added(is_open ? "open" : "closed", label, is_open);
  if (is_open) ImGui::TreePush(label);
  return is_open;
}
bool selectable(const char* label, bool selected) {
  return added("choice", label, ImGui::Selectable(label, selected, ImGuiSelectableFlags_DontClosePopups));
}
bool text_field(const char* label, std::string* text) {
  return added("text", label, ImGui::InputText(label, text));
}
bool slider(const char* label, float* value, float low, float high, const char* format,
            ImGuiSliderFlags flags) {
  return added("slider", label, ImGui::SliderFloat(label, value, low, high, format, flags));
}
bool slider(const char* label, std::uint32_t* value, std::uint32_t low, std::uint32_t high,
            ImGuiSliderFlags flags) {
  return added("slider", label,
               ImGui::SliderScalar(label, ImGuiDataType_U32, value, &low, &high, "%u", flags));
}
bool slider(const char* label, double* value, double low, double high) {
  return added("slider", label, ImGui::SliderScalar(label, ImGuiDataType_Double, value, &low, &high, ""));
}
bool drag(const char* label, float* value, float speed, float low, float high, const char* format) {
  return added("drag", label,
               ImGui::DragFloat(label, value, speed, low, high, format, ImGuiSliderFlags_AlwaysClamp));
}
bool swatch(const char* label, glm::vec3 srgb) {
  const ImVec4 colour(srgb.x, srgb.y, srgb.z, 1);
  const ImVec2 size(2.2f * ImGui::GetFrameHeight(), ImGui::GetFrameHeight());
  return added("swatch", label, ImGui::ColorButton(label, colour, ImGuiColorEditFlags_NoTooltip, size));
}
bool begin_combo(const char* label, const char* shown) {
  // Only while it is closed: then the last item is the combo, otherwise its list.
  const bool is_open = ImGui::BeginCombo(label, shown, ImGuiComboFlags_HeightLarge);
  if (!is_open) added("combo", label, false);
  return is_open;
}
void end_combo() {
  ImGui::EndCombo();
}
void close_popups() {
  if (ImGui::IsPopupOpen("", ImGuiPopupFlags_AnyPopup)) ImGui::ClosePopupToLevel(0, true);
}
bool canvas(const char* label, float height) {
  const ImVec2 size(std::max(ImGui::GetContentRegionAvail().x, 16.0f), height);
  return added("canvas", label,
               ImGui::InvisibleButton(label, size,
                                      ImGuiButtonFlags_MouseButtonLeft | ImGuiButtonFlags_MouseButtonRight));
}
bool colour_picker(const char* label, glm::vec3* srgb) {
  constexpr ImGuiColorEditFlags kFlags = ImGuiColorEditFlags_NoSidePreview | ImGuiColorEditFlags_NoLabel |
                                         ImGuiColorEditFlags_Float | ImGuiColorEditFlags_DisplayRGB;
  return added("picker", label, ImGui::ColorPicker3(label, &srgb->x, kFlags));
}

}  // namespace brume::viewer
