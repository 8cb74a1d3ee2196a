#include <imgui.h>

#include <algorithm>

#include "apps/viewer/curve_editor.hpp"
#include "apps/viewer/option_panel.hpp"
#include "apps/viewer/ui_parts.hpp"
#include "apps/viewer/widgets.hpp"
#include "volumes/volume_grids.hpp"

namespace brume::viewer {
namespace {

constexpr const char* kUsualNames = "by the usual names";

/// A choice among grids; an empty name is the usual one.
bool grid_row(const char* label, const char* about, std::string& chosen,
              const std::vector<std::string>& names) {
  begin_row(label, about);
  if (!begin_combo((std::string("##") + label).c_str(), chosen.empty() ? kUsualNames : chosen.c_str()))
    return false;
  std::optional<std::string> choice;
  if (selectable(kUsualNames, chosen.empty())) choice = "";
  for (std::size_t i = 0; i < names.size(); ++i) {
    ImGui::PushID(static_cast<int>(i));
    if (selectable(names[i].c_str(), names[i] == chosen)) choice = names[i];
    ImGui::PopID();
  }
  if (choice) ImGui::CloseCurrentPopup();
  end_combo();
  if (!choice || *choice == chosen) return false;
  chosen = *choice;
  return true;
}

bool grid_rows(scene::VolumeOptions& options, const volumes::VolumeFrame& frame) {
  bool changed = grid_row("density grid", "what is dense", options.density, frame.number_grids);
  std::vector<std::string> heat_grids = frame.number_grids;
  heat_grids.emplace_back(volumes::kNoGrid);
  changed = grid_row("heat grid", "what glows", options.heat, heat_grids) || changed;
  if (!frame.color_grids.empty() && options.masks.empty()) {
    std::vector<std::string> color_grids = frame.color_grids;
    color_grids.emplace_back(volumes::kNoGrid);
    changed =
        grid_row("colour grid", "colours that multiply the albedo", options.color, color_grids) || changed;
  }
  return changed;
}

bool look_rows(scene::VolumeOptions& options, const scene::VolumeOptions& file, bool has_heat) {
  const auto shows = [&](std::string_view key) {
    return key == "extinction" || key == "albedo" || key == "anisotropy" || key == "emission" ||
           key == "glow" || (key == "kelvin" && has_heat);
  };
  const auto visit = [](auto& o, auto&& visitor) { scene::visit_volume_options(o, visitor); };
  return each_row(options, file, visit, [&](scene::OptionInfo info, auto& member, const auto& standard) {
    if (!shows(info.key)) return false;
    // The range of the file is too wide for a slider.
    if (std::string_view(info.key) == "extinction" && file.extinction > 0)
      info.high = std::min(info.high, 100 * double{file.extinction});
    if (std::string_view(info.key) == "emission") info.high = 1000;
    if (std::string_view(info.key) == "kelvin") info.high = 20000;
    return option_row(info, member, standard);
  });
}

/// The values that the curves span: the first frame's, or chosen.
bool range_row(scene::VolumeOptions& options, const volumes::VolumeFrame& frame) {
  begin_row("range of values", "what the curve and the colours span");
  bool is_set = options.range.has_value();
  bool changed = checkbox("##range set", &is_set);
  const glm::vec2 before = range_of(options, frame);
  if (changed) options.range = is_set ? std::optional(before) : std::nullopt;
  if (!options.range) {
    ImGui::SameLine();
    ImGui::TextDisabled("%.4g to %.4g", double{before.x}, double{before.y});
    return changed;
  }
  glm::vec2 range = *options.range;
  const float speed = 0.004f * (range.y - range.x), limit = static_cast<float>(scene::kFarthestValue);
  const float width = 0.5f * (ImGui::GetContentRegionAvail().x - kLabelWidth * ImGui::GetWindowWidth());
  ImGui::SameLine();
  ImGui::SetNextItemWidth(0.7f * width);
  changed = drag("##lowest", &range.x, speed, -limit, limit, "%.4g") || changed;
  ImGui::SameLine();
  ImGui::SetNextItemWidth(-1);
  changed = drag("##highest", &range.y, speed, -limit, limit, "%.4g") || changed;
  if (range.x < range.y) options.range = range;
  return changed;
}

/// Colour and brightness of what the masks emit.
bool mask_rows(scene::VolumeOptions& options, const scene::VolumeOptions& file) {
  bool changed = false;
  for (std::size_t i = 0; i < options.masks.size(); ++i) {
    scene::VolumeMask& mask = options.masks[i];
    ImGui::PushID(static_cast<int>(i));
    ImGui::Text("mask %s", mask.grid.c_str());
    if (mask.keys.empty()) {
      const auto visit = [](auto& o, auto&& visitor) { scene::visit_mask_options(o, visitor); };
      const double most = 10 * std::max(double{file.masks[i].intensity}, 1.0);
      const auto row = [&](scene::OptionInfo info, auto& member, const auto& standard) {
        if (std::string_view(info.key) == "intensity") info.high = std::min(info.high, most);
        return option_row(info, member, standard);
      };
      changed = each_row(mask, file.masks[i], visit, row) || changed;
    } else {
      ImGui::SameLine();
      ImGui::TextDisabled("colour and brightness by its %zu keys", mask.keys.size());
    }
    ImGui::PopID();
  }
  if (options.masks.empty()) return changed;
  const auto visit = [](auto& o, auto&& visitor) { scene::visit_particle_options(o, visitor); };
  return option_rows(options, file, visit) || changed;
}

/// The rows of a noise, `visit` of its options, in lengths up to the volume's own.
template <typename Noise, typename Visit>
bool noise_rows(const char* name, Noise& noise, const Noise& file, const volumes::VolumeFrame& frame,
                const Visit& visit) {
  const glm::vec3 size = frame.bounds.high - frame.bounds.low;
  const double edge = std::max({double{size.x}, double{size.y}, double{size.z}, 1e-3});
  if (!begin_tree(name)) return false;
  const bool changed =
      each_row(noise, file, visit, [&](scene::OptionInfo info, auto& member, const auto& standard) {
        if constexpr (std::is_same_v<std::remove_reference_t<decltype(member)>, glm::vec3>) {
          return vector_row(info, member, standard);
        } else {
          // At least up to what the file has.
          info.high = std::min(info.high, std::max(2 * edge, double{standard}));
          if (info.low > 0) info.low = std::min(1e-3 * edge, double{standard});
          return option_row(info, member, standard);
        }
      });
  ImGui::TreePop();
  return changed;
}

bool color_map_row(scene::ColorMap& map) {
  constexpr const char* kOwnColors = "own colours";
  begin_row("colour map", "colours of the values, in place of the albedo");
  const scene::ColorMap before = map;
  const char* const shown = !map.name.empty() ? map.name.c_str() : !map.points.empty() ? kOwnColors : "none";
  if (begin_combo("##colour map", shown)) {
    bool chosen = false;
    const auto choose = [&](const char* label, bool is_present, const scene::ColorMap& choice) {
      if (!selectable(label, is_present)) return;
      map = choice;
      chosen = true;
    };
    choose("none", map.empty(), {});
    for (const std::string_view name : scene::color_map_names())
      choose(std::string(name).c_str(), map.name == name, {std::string(name), {}});
    const scene::ColorMap grey{"grey", {}};
    choose(kOwnColors, !map.points.empty(), {"", points_of(before.empty() ? grey : before)});
    if (chosen) ImGui::CloseCurrentPopup();
    end_combo();
  }
  bool changed = map != before;
  if (!map.points.empty()) return edit_color_map("##colours", map.points) || changed;
  if (!map.empty()) draw_color_map(map);
  return changed;
}

bool transfer_rows(scene::VolumeOptions& options, const volumes::VolumeFrame& frame) {
  bool changed = color_map_row(options.color_map);
  begin_row("opacity curve", "opacity of the values, in place of the values themselves");
  bool has_curve = !options.opacity.empty();
  if (checkbox("##opacity set", &has_curve)) {
    options.opacity.clear();
    if (has_curve) options.opacity = {{0, 0}, {1, 1}};
    changed = true;
  }
  if (has_curve || !options.color_map.empty()) changed = range_row(options, frame) || changed;
  if (!has_curve) return changed;
  const glm::vec2 range = range_of(options, frame);
  const grids::BrickVolume& density = frame.density;
  const glm::vec2 own = (glm::vec2(density.low, density.high) - range.x) / (range.y - range.x);
  return edit_curve("##curve", options.opacity, {density.histogram, own, range}) || changed;
}

}  // namespace

void lay_out_volumes(Game& game) {
  const scenario::EditableScenario& live = game.session().live();
  std::vector<scene::VolumeOptions> volumes = live.scenario().timeline.volumes;
  const std::vector<scene::VolumeOptions>& file = game.session().file().volumes;
  bool changed = false;
  ImGui::PushID("volumes");
  for (std::size_t i = 0; i < volumes.size(); ++i) {
    ImGui::PushID(static_cast<int>(i));
    if (begin_tree(volumes[i].file.filename().string().c_str())) {
      const volumes::VolumeFrame& frame = live.scenario().volumes->typical_frame(i);
      // All rows are laid out, also after one that changed.
      changed = grid_rows(volumes[i], frame) || changed;
      changed = look_rows(volumes[i], file[i], frame.heat.has_value()) || changed;
      changed = mask_rows(volumes[i], file[i]) || changed;
      changed = noise_rows("disturbance", volumes[i].disturbance, file[i].disturbance, frame,
                           [](auto& o, auto&& v) { scene::visit_disturbance_options(o, v); }) ||
                changed;
      changed = noise_rows("detail", volumes[i].detail, file[i].detail, frame,
                           [](auto& o, auto&& v) { scene::visit_detail_options(o, v); }) ||
                changed;
      changed = transfer_rows(volumes[i], frame) || changed;
      ImGui::TreePop();
    }
    ImGui::PopID();
  }
  ImGui::PopID();
  if (!changed) return;
  scene::Timeline settings = live.scenario().timeline;
  settings.volumes = std::move(volumes);
  game.change_settings("volume", std::move(settings));
}

}  // namespace brume::viewer
