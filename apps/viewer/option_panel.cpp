#include "apps/viewer/option_panel.hpp"

#include <cmath>
#include <cstdio>

namespace brume::viewer {
namespace {

constexpr float kLabelWidth = 150;

// Angles are stored in radians and shown in degrees.
float shown(const scene::OptionInfo& info, float value) {
  return scene::is_angle(info) ? value / static_cast<float>(scene::kRadiansOfDegree) : value;
}
float stored(const scene::OptionInfo& info, float value) {
  return scene::is_angle(info) ? value * static_cast<float>(scene::kRadiansOfDegree) : value;
}

std::string number(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.4g", value);
  return text;
}

// Wide non-negative ranges get a logarithmic slider.
ImGuiSliderFlags flags_of(const scene::OptionInfo& info) {
  const bool wide = info.low >= 0 && info.high >= 50;
  return ImGuiSliderFlags_AlwaysClamp | (wide ? ImGuiSliderFlags_Logarithmic : ImGuiSliderFlags_None);
}

std::string format_of(const scene::OptionInfo& info) {
  return std::string("%.3g ") + info.unit;
}

/// The label at the left; positions the widget.
void begin_row(const scene::OptionInfo& info) {
  ImGui::PushID(info.key);
  ImGui::AlignTextToFramePadding();
  ImGui::TextUnformatted(info.key);
  ImGui::SameLine(kLabelWidth);
  ImGui::SetNextItemWidth(-1);
}

/// The tooltip. Returns whether a right click asks for the default.
bool end_row(const scene::OptionInfo& info, const std::string& initial) {
  const bool restore = ImGui::IsItemClicked(ImGuiMouseButton_Right);
  if (ImGui::IsItemHovered()) {
    ImGui::SetTooltip("%s\n%s .. %s %s, default %s (right click)", info.about, number(info.low).c_str(),
                      number(info.high).c_str(), info.unit, initial.c_str());
  }
  ImGui::PopID();
  return restore;
}

}  // namespace

bool option_row(const scene::OptionInfo& info, float& value, float initial) {
  begin_row(info);
  float edited = shown(info, value);
  const bool changed =
      ImGui::SliderFloat("##value", &edited, static_cast<float>(info.low), static_cast<float>(info.high),
                         format_of(info).c_str(), flags_of(info));
  if (changed) value = stored(info, edited);
  if (!end_row(info, number(static_cast<double>(shown(info, initial))))) return changed;
  value = initial;
  return true;
}

bool option_row(const scene::OptionInfo& info, std::uint32_t& value, std::uint32_t initial) {
  begin_row(info);
  const auto low = static_cast<std::uint32_t>(info.low), high = static_cast<std::uint32_t>(info.high);
  const bool changed =
      ImGui::SliderScalar("##value", ImGuiDataType_U32, &value, &low, &high, "%u", flags_of(info));
  if (!end_row(info, std::to_string(initial))) return changed;
  value = initial;
  return true;
}

bool option_row(const scene::OptionInfo& info, glm::vec3& value, glm::vec3 initial) {
  begin_row(info);
  const auto low = static_cast<float>(info.low), high = static_cast<float>(info.high);
  const bool changed = ImGui::DragFloat3("##value", &value.x, 0.002f * std::max(1.0f, glm::length(value)),
                                         low, high, "%.3g", ImGuiSliderFlags_AlwaysClamp);
  const auto text = [&](float x) { return number(static_cast<double>(x)); };
  if (!end_row(info, text(initial.x) + ", " + text(initial.y) + ", " + text(initial.z))) return changed;
  value = initial;
  return true;
}

bool option_row(const scene::OptionInfo& info, std::optional<float>& value, std::optional<float> initial) {
  ImGui::PushID(info.key);
  bool is_set = value.has_value();
  bool changed = ImGui::Checkbox("##set", &is_set);
  if (changed)
    value = is_set ? std::optional(static_cast<float>(std::sqrt(info.low * info.high))) : std::nullopt;
  ImGui::PopID();
  ImGui::SameLine();
  if (value) return option_row(info, *value, initial.value_or(*value)) || changed;
  ImGui::TextUnformatted(info.key);
  if (ImGui::IsItemHovered()) ImGui::SetTooltip("%s", info.about);
  return changed;
}

}  // namespace brume::viewer
