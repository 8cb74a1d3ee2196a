#include <imgui.h>

#include <algorithm>
#include <cstdio>

#include "apps/viewer/option_panel.hpp"
#include "apps/viewer/ui_parts.hpp"
#include "apps/viewer/widgets.hpp"
#include "scenario/aim.hpp"
#include "scene/event_fields.hpp"

namespace brume::viewer {
namespace {

bool is_shape(const std::string& key) {
  return key.starts_with("noise") || key == "erosion" || key.starts_with("swirl") || key == "rise";
}
bool is_lighting(const std::string& key) {
  return key == "anisotropy" || key == "droplet" || key == "multiple_scattering";
}

// Smoke settings; changing one that the simulation depends on simulates again from the start.
void smoke_rows(Game& game, const char* what, const std::function<bool(const std::string&)>& selects) {
  const scenario::Scenario& scenario = game.session().live().scenario();
  scene::SmokeOptions smoke = scenario.timeline.smoke;
  const scene::SmokeOptions& file = game.session().file().smoke;
  const auto visit = [](auto& options, auto&& visitor) { scene::visit_smoke_options(options, visitor); };
  const bool changed =
      each_row(smoke, file, visit, [&](const scene::OptionInfo& info, auto& member, const auto& standard) {
        if (!selects(info.key)) return false;
        if constexpr (std::is_same_v<std::remove_reference_t<decltype(member)>, std::uint32_t>) {
          return volume_row(info, member, standard, scenario.voxels.grid.layout().voxel_size);
        } else {
          return option_row(info, member, standard);
        }
      });
  if (!changed) return;
  scene::Timeline settings = scenario.timeline;
  settings.smoke = smoke;
  game.change_settings(what, std::move(settings));
}

void lay_out_light(Game& game) {
  const scene::Timeline& timeline = game.session().live().scenario().timeline;
  const scene::Timeline& file = game.session().file();
  scene::PictureSettings<> picture = timeline;
  scene::SkyOptions sky = timeline.sky;
  std::string changed;
  each_row<scene::PictureSettings<>>(
      picture, file, [](auto& o, auto&& visitor) { scene::visit_picture_options(o, visitor); },
      [&](const scene::OptionInfo& info, auto& member, const auto& standard) {
        if (!option_row(info, member, standard)) return false;
        changed = info.key;
        return true;
      });
  if (option_rows(sky, file.sky, [](auto& o, auto&& visitor) { scene::visit_sky_options(o, visitor); }))
    changed = "sky";
  if (!changed.empty()) {
    scene::Timeline settings = timeline;
    static_cast<scene::PictureSettings<>&>(settings) = picture;
    settings.sky = sky;
    game.change_settings(changed, std::move(settings));
  }
  smoke_rows(game, "light in the smoke", is_lighting);
}

// A list of the images of a folder.
void lay_out_file_list(Game& game) {
  Choices& choices = game.choices();
  if (button("choose...")) {
    choices.pictures.refresh();
    ImGui::OpenPopup("images");
  }
  if (ImGui::IsItemHovered()) ImGui::SetTooltip("an image of a folder; or drop a file on the window");
  ImGui::SetNextWindowSize(ImVec2(320, 220));
  if (!ImGui::BeginPopup("images")) return;
  ImGui::TextDisabled("%s", choices.pictures.folder().c_str());
  std::optional<std::filesystem::path> folder, file;
  for (const std::string& name : choices.pictures.folders())
    if (selectable((name + "/").c_str(), false)) folder = choices.pictures.folder() / name;
  for (const std::string& name : choices.pictures.files()) {
    const std::filesystem::path path = choices.pictures.folder() / name;
    if (selectable(name.c_str(), path == choices.weapons.picture)) file = path;
  }
  if (choices.pictures.files().empty()) ImGui::TextDisabled("no PNG or JPEG here");
  if (folder) choices.pictures.open(*folder);
  if (file) game.choose_picture(*file);
  if (file) ImGui::CloseCurrentPopup();
  ImGui::EndPopup();
}

void lay_out_shots(Game& game) {
  Weapons& weapons = game.choices().weapons;
  const Weapons& first = game.first_weapons();

  // What is shot. The buttons have an id of their own: the field of the word has the name of a kind, too.
  ImGui::PushID("kind");
  for (const ShotKind kind : {ShotKind::bullet, ShotKind::glyph, ShotKind::word, ShotKind::picture}) {
    if (kind != ShotKind::bullet) ImGui::SameLine();
    if (radio(name_of(kind), weapons.kind == kind)) weapons.kind = kind;
  }
  ImGui::PopID();
  ImGui::SetNextItemWidth(0.5f * ImGui::GetWindowWidth());
  if (text_field("word to shoot", &weapons.text.text)) game.setting_changed("word");
  std::string picture = weapons.picture.string();
  ImGui::SetNextItemWidth(0.5f * ImGui::GetWindowWidth());
  if (text_field("image", &picture)) {
    weapons.picture = picture;
    game.setting_changed("image to shoot");
  }
  ImGui::SameLine();
  lay_out_file_list(game);

  // How.
  for_each_weapon([&](const WeaponEvent& weapon, auto member) {
    if (!begin_tree(weapon.settings)) return;
    auto& event = weapons.*member;
    const auto visit = [](auto& o, auto&& visitor) { scene::visit_event_numbers(o, visitor); };
    if (option_rows(event, first.*member, visit)) game.setting_changed(weapon.settings);
    scene::keep_rules(event);
    ImGui::TreePop();
  });
}

void lay_out_quality(Choices& choices, const Notices& notices) {
  if (radio("auto", !choices.level)) choices.level.reset();
  const auto levels = quality_levels();
  for (std::size_t i = 0; i < levels.size(); ++i) {
    ImGui::SameLine();
    if (ImGui::GetContentRegionAvail().x < 80) ImGui::NewLine();
    if (radio(levels[i].name, choices.level == i)) choices.level = i;
  }
  auto rate = static_cast<float>(choices.frames_per_second);
  if (slider("frames per second", &rate, 5, 240, "%.0f")) choices.frames_per_second = double{rate};
  if (ImGui::IsItemHovered()) ImGui::SetTooltip("the rate that auto holds");
  checkbox("wait for the display", &choices.vertical_sync);
  checkbox("smooth over frames", &choices.temporal);
  if (ImGui::IsItemHovered()) ImGui::SetTooltip("smoke and edges: the mean of up to 16 frames");
  const Quality& now = notices.quality;
  ImGui::Text("now: %s, image of %ux%u pixels", now.name, notices.picture_px.x, notices.picture_px.y);
  ImGui::Text("one ray of smoke per %ux%u pixels", now.march_scale, now.march_scale);
  ImGui::Text("steps through smoke %.1f times as long", double{now.step_scale});
  ImGui::Text("at least 1/%.0f of the changed light updated per frame",
              1 / double{now.light_update_fraction});
}

void lay_out_slice(Choices& choices, Game& game) {
  bool has_slice = choices.slice.has_value();
  if (checkbox("slice at", &has_slice)) {
    choices.slice.reset();
    if (has_slice) choices.slice.emplace();
    game.change_picture();
  }
  ImGui::SameLine();
  if (!choices.slice) return ImGui::TextDisabled("the middle of the smoke");
  constexpr std::array kAxes{"x", "y", "z"};
  for (std::uint32_t axis = 0; axis < kAxes.size(); ++axis) {
    if (radio(kAxes[axis], choices.slice->axis == axis)) {
      choices.slice->axis = axis;
      game.change_picture();
    }
    ImGui::SameLine();
  }
  const voxel::GridLayout& frame = game.session().live().scenario().voxels.grid.layout();
  const auto axis = static_cast<int>(choices.slice->axis);
  const float low = frame.origin_world[axis];
  const float high = low + static_cast<float>(frame.size[axis]) * frame.voxel_size;
  ImGui::SetNextItemWidth(-1);
  if (slider("##slice", &choices.slice->at_world, low, high, "%.2f m")) game.change_picture();
}

void lay_out_views(Game& game) {
  Choices& choices = game.choices();
  const float column = ImGui::GetContentRegionAvail().x / 4;
  for (std::size_t i = 0; i < passes::kDebugViewNames.size(); ++i) {
    const auto view = static_cast<passes::DebugView>(i);
    if (i % 4 != 0) ImGui::SameLine(static_cast<float>(i % 4) * column + ImGui::GetStyle().WindowPadding.x);
    if (radio(std::string(passes::kDebugViewNames[i]).c_str(), choices.view == view)) {
      choices.view = view;
      game.change_picture();
    }
  }
  lay_out_slice(choices, game);
}

/// How far away the solid point in the middle of the view is, along the view axis [m].
float distance_of_middle(const Game& game) {
  constexpr float kFarthest = 1000;
  const scene::Camera camera = game.player().camera();
  const scenario::Aim aim = scenario::aim(game.grid(), camera.position_world,
                                          camera.target_world - camera.position_world, kFarthest);
  return aim.meets.value_or(kFarthest);
}

void choose_optics(Game& game, Optics optics) {
  // The target of a player is a direction: nothing that could be sharp.
  if (optics.lens.aperture > 0 && optics.lens.focus <= 0) optics.lens.focus = distance_of_middle(game);
  game.player().set_optics(optics);
  game.setting_changed("camera");
  game.session().leave_path();
  game.change_picture();
}

void lay_out_camera(Game& game, UiRequests& requests) {
  Player& player = game.player();
  scene::Camera camera = player.camera();
  if (option_rows(camera, game.first_camera(),
                  [](auto& o, auto&& visitor) { scene::visit_camera_options(o, visitor); })) {
    choose_optics(game, optics_of(camera));
  }
  if (button("focus on the middle")) {
    camera.lens.focus = distance_of_middle(game);
    choose_optics(game, optics_of(camera));
  }
  if (!camera.lens.opening.empty())
    ImGui::Text("opening: %s", camera.lens.opening.filename().string().c_str());
  if (begin_tree("body")) {
    scenario::WalkerOptions walker = player.options();
    if (option_rows(walker, scenario::WalkerOptions(),
                    [](auto& o, auto&& visitor) { scenario::visit_walker_options(o, visitor); })) {
      walker.eye = std::min(walker.eye, walker.height);  // the eye is in the body
      player.set_options(game.bodies(), walker);
      game.setting_changed("body");
    }
    ImGui::TreePop();
  }
  const glm::vec3 p = camera.position_world, d = camera.target_world - camera.position_world;
  ImGui::Text("eye at %.2f %.2f %.2f m", double{p.x}, double{p.y}, double{p.z});
  ImGui::Text("looks along %.2f %.2f %.2f", double{d.x}, double{d.y}, double{d.z});
  if (button(player.flying() ? "walk (G)###fly" : "fly (G)###fly")) requests.actions.push_back(Action::fly);
}

}  // namespace

void lay_out_level_sections(Game& game, const Figures& figures, const Notices& notices, const Status& status,
                            UiRequests& requests) {
  if (header("Smoke", true))
    smoke_rows(game, "smoke", [](const std::string& key) { return !is_shape(key) && !is_lighting(key); });
  if (header("Shots and explosions", false)) lay_out_shots(game);
  if (header("Shape of the smoke", false)) smoke_rows(game, "shape of the smoke", is_shape);
  if (!game.session().file().volumes.empty() && header("Volumes", false)) lay_out_volumes(game);
  if (!game.session().file().decals.empty() && header("Decals", false)) lay_out_decals(game);
  if (!game.session().file().carriers.empty() && header("Carriers", false)) lay_out_carriers(game, requests);
  if (header("Light", false)) lay_out_light(game);
  if (header("Camera", false)) lay_out_camera(game, requests);
  if (header("Quality", false)) lay_out_quality(game.choices(), notices);
  if (header("Debug views", false)) lay_out_views(game);
  if (header("Figures", false)) lay_out_figures(game.session(), figures, status);
}

}  // namespace brume::viewer
