// The settings of a tank's lights, its glass and its camera.
#include <imgui.h>

#include <optional>

#include "apps/viewer/option_panel.hpp"
#include "apps/viewer/tank_ui.hpp"
#include "apps/viewer/widgets.hpp"
#include "scene/tank_options.hpp"

namespace brume::viewer {
namespace {

/// Buttons for the keys of something that has `count` of them.
struct KeyButtons {
  bool add = false, remove = false;
};

KeyButtons lay_out_keys(std::size_t count) {
  KeyButtons clicked;
  clicked.add = button("add key");
  if (ImGui::IsItemHovered()) ImGui::SetTooltip("where it is now, at the time of the slider");
  ImGui::SameLine();
  if (count > 0) {
    clicked.remove = button("remove keys");
    ImGui::SameLine();
  }
  ImGui::TextDisabled(count == 1 ? "%zu key" : "%zu keys", count);
  return clicked;
}

/// A light in the upper part of the view, between the camera and its target.
scene::TankLight new_light(const TankState& state) {
  scene::TankLight light;
  const scene::Camera camera = state.camera();
  light.position_world =
      dragged(camera, glm::vec2(0, -0.25f), glm::mix(camera.target_world, camera.position_world, 0.4f));
  light.radius = 0.04f * state.size().y;
  light.intensity = 4 * state.size().y * state.size().y;
  return light;
}

/// Returns whether it shall be removed.
bool lay_out_light(TankState& state, std::size_t index) {
  scene::TankLight light = state.scene().lights[index];
  const auto& lights = state.file().lights;
  const scene::TankLight file = index < lights.size() ? lights[index] : scene::TankLight();
  // A light with keys is where they lead it: drag its mark to move all of them.
  const bool changed = tank_rows(
      light, file, [](auto& o, auto&& v) { scene::visit_tank_light_options(o, v); },
      [&](const std::string& key) { return key != "position" || light.keys.empty(); });
  if (changed) state.edit().lights[index] = light;
  const KeyButtons keys = lay_out_keys(light.keys.size());
  if (keys.add) state.add_light_key(index);
  if (keys.remove) {
    const glm::vec3 now = scene::light_at(light, state.seconds()).position_world;
    state.edit().lights[index].position_world = now;
    state.edit().lights[index].keys.clear();
  }
  ImGui::SameLine();
  return button("remove");
}

}  // namespace

void lay_out_lights(TankState& state, TankChoices& choices) {
  std::optional<std::size_t> removed;  // after the rows, which number the lights
  for (std::size_t i = 0; i < state.scene().lights.size(); ++i) {
    const std::string name = "light " + std::to_string(i + 1);
    glm::vec3 color = state.scene().lights[i].color;
    ImGui::PushID(static_cast<int>(i));
    if (color_patch(color)) state.edit().lights[i].color = color;
    ImGui::SameLine();
    if (begin_tree(name.c_str())) {
      if (lay_out_light(state, i)) removed = i;
      ImGui::TreePop();
    }
    ImGui::PopID();
  }
  if (state.scene().lights.size() < scene::kMostTankLights) {
    if (button("add a light")) {
      state.edit().lights.push_back(new_light(state));
      choices.selected = TankHandle{TankHandle::Kind::light, state.scene().lights.size() - 1};
    }
  } else {
    ImGui::TextDisabled("%zu lights are the most", scene::kMostTankLights);
  }
  if (choices.overlay) ImGui::TextDisabled("Drag the marks in the picture to move them.");
  if (!removed) return;
  auto& lights = state.edit().lights;
  lights.erase(lights.begin() + static_cast<std::ptrdiff_t>(*removed));
  choices.selected.reset();
}

void lay_out_glass(TankState& state) {
  bool is_there = state.scene().glass.has_value();
  if (checkbox("an ellipsoid of glass", &is_there)) {
    scene::TankGlass glass = state.file().glass.value_or(scene::TankGlass());
    if (!state.file().glass) {
      glass.radii = glm::vec3(0.25f * state.size().y);
      glass.position_world = glm::vec3(0, 0, 0.5f * state.size().z + 1.5f * glass.radii.z);
    }
    state.edit().glass = is_there ? std::optional(glass) : std::nullopt;
  }
  if (!state.scene().glass) return;
  scene::TankGlass glass = *state.scene().glass;
  const bool has_keys = !glass.keys.empty();
  const bool changed = tank_rows(
      glass, state.file().glass.value_or(scene::TankGlass()),
      [](auto& o, auto&& v) { scene::visit_glass_options(o, v); },
      [&](const std::string& key) { return !has_keys || key == "index"; });
  if (changed) state.edit().glass = glass;
  const KeyButtons keys = lay_out_keys(glass.keys.size());
  if (keys.add) state.add_glass_key();
  if (keys.remove) {
    state.edit().glass = scene::glass_at(glass, state.seconds());
    state.edit().glass->keys.clear();
  }
}

void lay_out_lens(TankState& state, UiRequests& requests) {
  scene::Camera camera = state.camera();
  const scene::Camera file = scene::camera_at(state.file(), state.size(), state.seconds());
  // The pictures of tanks have no motion blur.
  if (tank_rows(
          camera, file, [](auto& o, auto&& v) { scene::visit_camera_options(o, v); },
          [](const std::string& key) { return key != "shutter"; }))
    state.move_camera(camera);
  if (button("focus on the middle")) requests.actions.push_back(Action::focus);
  ImGui::SameLine();
  if (button("back to the scene's camera")) requests.actions.push_back(Action::home);
  const glm::vec3 p = camera.position_world, t = camera.target_world;
  ImGui::Text("eye at %.2f %.2f %.2f m", double{p.x}, double{p.y}, double{p.z});
  ImGui::Text("looks at %.2f %.2f %.2f m", double{t.x}, double{t.y}, double{t.z});
  ImGui::PushID("camera");
  const KeyButtons keys = lay_out_keys(state.scene().camera.size());
  if (keys.add) state.add_camera_key();
  if (keys.remove) {
    state.move_camera(state.camera());
    state.edit().camera.clear();
  }
  ImGui::PopID();
}

}  // namespace brume::viewer
