// The panel of the carriers: which one to steer, where it is, and its keys.
#include <imgui.h>

#include "apps/viewer/carrier_keys.hpp"
#include "apps/viewer/ui_parts.hpp"
#include "apps/viewer/widgets.hpp"

namespace brume::viewer {
namespace {

void tooltip(const char* text) {
  if (ImGui::IsItemHovered()) ImGui::SetTooltip("%s", text);
}

/// Which carrier the buttons and keys are about. Choosing another one ends a flight.
void lay_out_choice(Game& game, const std::vector<scene::Carrier>& carriers, UiRequests& requests) {
  ImGui::PushID("carriers");
  for (std::size_t i = 0; i < carriers.size(); ++i) {
    ImGui::PushID(static_cast<int>(i));
    if (radio(carriers[i].name.c_str(), game.choices().carrier == i) && game.choices().carrier != i) {
      if (game.flight()) requests.actions.push_back(Action::steer_carrier);
      game.choices().carrier = i;
    }
    ImGui::PopID();
  }
  ImGui::PopID();
}

void lay_out_keys(Game& game, const scene::Carrier& carrier, UiRequests& requests) {
  const double seconds = game.session().seconds();
  const auto key = key_of_time(carrier, seconds);
  const auto before = key_time_before(carrier, seconds), after = key_time_after(carrier, seconds);
  if (key) {
    ImGui::Text("key %zu of %zu, at %.2f s", *key + 1, carrier.keys.size(), carrier.keys[*key].time);
  } else {
    ImGui::Text("%zu keys, none at this time", carrier.keys.size());
  }
  if (button(key ? "move key (K)###add key" : "add key (K)###add key"))
    requests.actions.push_back(Action::add_key);
  tooltip("the carrier is where it is now at this time of the film, too; saved with the timeline");
  ImGui::SameLine();
  if (button("remove key")) game.remove_carrier_key();
  tooltip("the key at the current time");
  ImGui::SameLine();
  if (button("< key") && before) requests.seek = *before;
  tooltip("to the time of the key before");
  ImGui::SameLine();
  if (button("key >") && after) requests.seek = *after;
  tooltip("to the time of the next key");
}

}  // namespace

void lay_out_carriers(Game& game, UiRequests& requests) {
  const std::vector<scene::Carrier>& carriers = game.session().live().scenario().timeline.carriers;
  lay_out_choice(game, carriers, requests);
  const scene::Carrier& carrier = carriers[game.choices().carrier];
  if (!carrier.object.empty()) ImGui::TextDisabled("moves the object %s", carrier.object.c_str());
  const scene::CarrierKey pose = game.carrier_pose();
  const glm::vec3 p = pose.position_world, r = pose.rotation;
  ImGui::Text("at %.2f %.2f %.2f m", double{p.x}, double{p.y}, double{p.z});
  ImGui::Text("rotated by %.1f %.1f %.1f degrees", double{r.x}, double{r.y}, double{r.z});
  if (button(game.flight() ? "end (C)###steer" : "steer (C)###steer"))
    requests.actions.push_back(Action::steer_carrier);
  tooltip("the keys that move you move the carrier; close the panels to turn it by the mouse");
  lay_out_keys(game, carrier, requests);
}

}  // namespace brume::viewer
