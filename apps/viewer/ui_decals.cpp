// The panel of the decals: how each darkens what is in its box, and a switch to compare with none.
#include <imgui.h>

#include "apps/viewer/option_panel.hpp"
#include "apps/viewer/ui_parts.hpp"
#include "apps/viewer/widgets.hpp"

namespace brume::viewer {
namespace {

bool decal_rows(scene::DecalOptions& decal, const scene::DecalOptions& file) {
  const auto visit = [&](auto& options, auto&& visitor) {
    scene::visit_decal_options(options, [&](scene::OptionInfo info, auto& member) {
      // The range of the file is too wide for a slider.
      if (std::string_view(info.key) == "scale") {
        info.low = std::max(info.low, 0.1 * double{file.scale});
        info.high = std::min(info.high, 10 * double{file.scale});
      }
      visitor(info, member);
    });
  };
  // Where it lies is not tuned here.
  return option_rows(decal, file, visit, [](const std::string& key) { return key != "rotation"; });
}

}  // namespace

void lay_out_decals(Game& game) {
  scenario::EditableScenario& live = game.session().live();
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
  if (const auto done = live.set_decals(std::move(decals)); !done) return game.notify(done.failure().message);
  game.setting_changed("decal");
  game.change_picture();
}

}  // namespace brume::viewer
