#include "apps/viewer/option_panel.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <glm/gtc/color_space.hpp>
#include <numbers>

#include "apps/viewer/widgets.hpp"

namespace brume::viewer {
namespace {

const ImVec4 kChanged(0.98f, 0.74f, 0.40f, 1);

// Angles are stored in radians and shown in degrees.
float shown(const scene::OptionInfo& info, float value) {
  return scene::is_angle(info) ? value / static_cast<float>(scene::kRadiansOfDegree) : value;
}
float stored(const scene::OptionInfo& info, float value) {
  return scene::is_angle(info) ? value * static_cast<float>(scene::kRadiansOfDegree) : value;
}

std::string number(float value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.4g", static_cast<double>(value));
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

/// A row: its label, marked if the value is not the file's, and then its widgets.
class Row {
 public:
  Row(const scene::OptionInfo& info, bool changed, std::string file)
      : info_(info), changed_(changed), file_(std::move(file)) {
    ImGui::PushID(info.key);
    ImGui::AlignTextToFramePadding();
    const std::string label = std::string(changed ? "* " : "") + label_of(info);
    if (changed) ImGui::PushStyleColor(ImGuiCol_Text, kChanged);
    ImGui::TextUnformatted(label.c_str());
    if (changed) ImGui::PopStyleColor();
    add_part();
    ImGui::SameLine(kLabelWidth * ImGui::GetWindowWidth());
    ImGui::SetNextItemWidth(-1);
  }
  Row(const Row&) = delete;
  ~Row() { ImGui::PopID(); }

  /// To be called after each of its widgets: the tooltip, and the right click.
  void add_part() {
    restores_ = restores_ || ImGui::IsItemClicked(ImGuiMouseButton_Right);
    if (!ImGui::IsItemHovered()) return;
    ImGui::BeginTooltip();
    ImGui::PushTextWrapPos(20 * ImGui::GetFontSize());
    ImGui::TextUnformatted(info_.about);
    ImGui::TextDisabled("%s to %s %s; `%s` in the file", number(static_cast<float>(info_.low)).c_str(),
                        number(static_cast<float>(info_.high)).c_str(), info_.unit, info_.key);
    if (changed_) ImGui::TextColored(kChanged, "right click: the file's %s", file_.c_str());
    ImGui::PopTextWrapPos();
    ImGui::EndTooltip();
  }
  /// The label of a widget of the row, which shows none.
  const char* id(const char* part = "") {
    id_ = std::string("##") + info_.key + " " + part;
    return id_.c_str();
  }
  /// Whether a right click asks for the file's value.
  bool restores() const { return restores_ && changed_; }

 private:
  const scene::OptionInfo& info_;
  bool changed_, restores_ = false;
  std::string file_, id_;
};

glm::vec3 hue_of(glm::vec3 colour, float strength) {
  return strength > 0 ? colour / strength : glm::vec3(1);
}

/// The popup of a swatch: edits the hue, and darker tones of it, below a strength that stays while it is
/// open.
bool pick_colour(glm::vec3& colour, float strength) {
  ImGuiStorage& storage = *ImGui::GetStateStorage();
  const ImGuiID key = ImGui::GetID("strength");
  if (swatch("##swatch", glm::convertLinearToSRGB(hue_of(colour, strength)))) {
    ImGui::OpenPopup("colour");
    storage.SetFloat(key, strength > 0 ? strength : 1);
  }
  const float held = storage.GetFloat(key, 1);
  if (!ImGui::BeginPopup("colour")) return false;
  glm::vec3 srgb = glm::convertLinearToSRGB(glm::clamp(colour / held, glm::vec3(0), glm::vec3(1)));
  const bool changed = colour_picker("##picker", &srgb);
  if (changed) colour = held * glm::convertSRGBToLinear(glm::clamp(srgb, glm::vec3(0), glm::vec3(1)));
  ImGui::EndPopup();
  return changed;
}

}  // namespace

std::string label_of(const scene::OptionInfo& info) {
  if (info.label) return info.label;
  std::string words = info.key;
  std::ranges::replace(words, '_', ' ');
  return words;
}

void begin_row(const char* label, const char* about) {
  ImGui::AlignTextToFramePadding();
  ImGui::TextUnformatted(label);
  if (about && ImGui::IsItemHovered()) ImGui::SetTooltip("%s", about);
  ImGui::SameLine(kLabelWidth * ImGui::GetWindowWidth());
  ImGui::SetNextItemWidth(-1);
}

bool color_patch(glm::vec3& color) {
  return pick_colour(color, 1);
}

bool option_row(const scene::OptionInfo& info, float& value, float file) {
  Row row(info, value != file, number(shown(info, file)));
  float edited = shown(info, value);
  const bool changed = slider(row.id(), &edited, static_cast<float>(info.low), static_cast<float>(info.high),
                              format_of(info).c_str(), flags_of(info));
  if (changed) value = stored(info, edited);
  row.add_part();
  if (row.restores()) value = file;
  return changed || row.restores();
}

bool drag_row(const scene::OptionInfo& info, float& value, float file) {
  Row row(info, value != file, number(file));
  const float speed = 0.01f * std::max(std::abs(value), 0.1f);
  const bool changed = drag(row.id(), &value, speed, static_cast<float>(info.low),
                            static_cast<float>(info.high), format_of(info).c_str());
  row.add_part();
  if (row.restores()) value = file;
  return changed || row.restores();
}

bool option_row(const scene::OptionInfo& info, std::uint32_t& value, std::uint32_t file) {
  Row row(info, value != file, std::to_string(file));
  const bool changed = slider(row.id(), &value, static_cast<std::uint32_t>(info.low),
                              static_cast<std::uint32_t>(info.high), flags_of(info));
  row.add_part();
  if (row.restores()) value = file;
  return changed || row.restores();
}

bool volume_row(const scene::OptionInfo& info, std::uint32_t& voxels, std::uint32_t file, float voxel_size) {
  const float voxel = voxel_size * voxel_size * voxel_size;
  Row row(info, voxels != file, number(static_cast<float>(file) * voxel) + " m\xc2\xb3");
  float volume = static_cast<float>(voxels) * voxel;
  const float radius = std::cbrt(0.75f * volume / std::numbers::pi_v<float>);
  char format[48];
  std::snprintf(format, sizeof format, "%%.4g m\xc2\xb3, radius %.1f m", static_cast<double>(radius));
  const bool changed =
      slider(row.id(), &volume, static_cast<float>(info.low) * voxel, static_cast<float>(info.high) * voxel,
             format, ImGuiSliderFlags_AlwaysClamp | ImGuiSliderFlags_Logarithmic);
  if (changed)
    voxels = static_cast<std::uint32_t>(std::clamp(double{volume} / double{voxel}, info.low, info.high));
  row.add_part();
  if (row.restores()) voxels = file;
  return changed || row.restores();
}

bool option_row(const scene::OptionInfo& info, glm::vec3& value, glm::vec3 file) {
  Row row(info, value != file, number(file.x) + ", " + number(file.y) + ", " + number(file.z));
  const auto low = static_cast<float>(info.low), high = static_cast<float>(info.high);
  float strength = std::max({value.x, value.y, value.z});
  const glm::vec3 hue = hue_of(value, strength);
  bool changed = pick_colour(value, strength);
  row.add_part();
  ImGui::SameLine();
  ImGui::SetNextItemWidth(-1);
  if (drag(row.id("strength"), &strength, 0.004f * std::max(strength, 0.1f), low, high, "brightness %.3g")) {
    value = glm::clamp(strength * hue, glm::vec3(low), glm::vec3(high));
    changed = true;
  }
  row.add_part();
  if (row.restores()) value = file;
  return changed || row.restores();
}

bool vector_row(const scene::OptionInfo& info, glm::vec3& value, glm::vec3 file) {
  Row row(info, value != file, number(file.x) + ", " + number(file.y) + ", " + number(file.z));
  constexpr std::array<const char*, 3> kAxes{"x", "y", "z"};
  const float largest = std::max({std::abs(value.x), std::abs(value.y), std::abs(value.z)});
  const float width = (ImGui::GetContentRegionAvail().x - 2 * ImGui::GetStyle().ItemSpacing.x) / 3;
  bool changed = false;
  for (int axis = 0; axis < 3; ++axis) {
    if (axis > 0) ImGui::SameLine();
    ImGui::SetNextItemWidth(width);
    changed =
        drag(row.id(kAxes[static_cast<std::size_t>(axis)]), &value[axis], 0.01f * std::max(largest, 0.1f),
             static_cast<float>(info.low), static_cast<float>(info.high), "%.3g") ||
        changed;
    row.add_part();
  }
  if (row.restores()) value = file;
  return changed || row.restores();
}

bool option_row(const scene::OptionInfo& info, std::optional<float>& value, std::optional<float> file) {
  Row row(info, value != file, file ? number(*file) : "none");
  bool is_set = value.has_value();
  bool changed = checkbox(row.id("set"), &is_set);
  if (changed)
    value = is_set ? std::optional(file.value_or(static_cast<float>(std::sqrt(info.low * info.high))))
                   : std::nullopt;
  row.add_part();
  if (value) {
    ImGui::SameLine();
    ImGui::SetNextItemWidth(-1);
    changed = slider(row.id(), &*value, static_cast<float>(info.low), static_cast<float>(info.high),
                     format_of(info).c_str(), flags_of(info)) ||
              changed;
    row.add_part();
  }
  if (row.restores()) value = file;
  return changed || row.restores();
}

}  // namespace brume::viewer
