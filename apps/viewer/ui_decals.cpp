// The panel of the decals: how each darkens what is in its box, and a switch to compare with none.
#include <imgui.h>

#include "apps/viewer/option_panel.hpp"
#include "apps/viewer/ui_parts.hpp"
#include "apps/viewer/widgets.hpp"

namespace brume::viewer {
namespace {

bool decal_rows(scene::DecalOptions& decal, const scene::DecalOptions& file) {
  const auto visit = [](auto& options, auto&& visitor) { scene::visit_decal_options(options, visitor); };
  return each_row(decal, file, visit, [&](scene::OptionInfo info, auto& member, const auto& standard) {
    const std::string_view key = info.key;
    if (key == "rotation") return false;  // where it lies is not tuned here
    // The range of the file is too wide for a slider.
    if (key == "scale") {
      info.low = std::max(info.low, 0.1 * double{file.scale});
      info.high = std::min(info.high, 10 * double{file.scale});
    }
    return option_row(info, member, standard);
  });
}

}  // namespace

void lay_out_decals(Game& game) {
  const scenario::EditableScenario& live = game.session().live();
  bool shown = game.choices().decals;
  if (checkbox("show (B)", &shown)) game.act(Action::decals, glm::vec3(0, 0, -1));
  if (ImGui::IsItemHovered()) ImGui::SetTooltip("off, to compare with the picture without decals; not saved");

  std::vector<scene::DecalOptions> decals = live.scenario().timeline.decals;
  const std::vector<scene::DecalOptions>& file = game.session().file().decals;
  bool changed = false;
  ImGui::PushID("decals");
  for (std::size_t i = 0; i < decals.size(); ++i) {
    ImGui::PushID(static_cast<int>(i));
    if (begin_tree(decals[i].file.filename().string().c_str())) {
      if (!decals[i].carrier.empty()) ImGui::TextDisabled("moves with %s", decals[i].carrier.c_str());
      changed = decal_rows(decals[i], file[i]) || changed;
      ImGui::TreePop();
    }
    ImGui::PopID();
  }
  ImGui::PopID();
  if (!changed) return;
  scene::Timeline settings = live.scenario().timeline;
  settings.decals = std::move(decals);
  game.change_settings("decal", std::move(settings));
}

}  // namespace brume::viewer
