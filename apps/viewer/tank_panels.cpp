// The settings of a tank: its picture, how it is packed, files and figures.
#include <imgui.h>

#include <algorithm>
#include <cstdio>

#include "apps/viewer/option_panel.hpp"
#include "apps/viewer/tank_ui.hpp"
#include "apps/viewer/widgets.hpp"
#include "palettes/choice.hpp"
#include "scene/tank_options.hpp"

namespace brume::viewer {
namespace {

constexpr std::uint32_t kMostSeeds = 999;

/// Names of a choice in a row of buttons behind its label, if any. Returns whether another one was chosen.
template <typename Value>
bool radios(const char* id, const char* title, Value& value,
            std::initializer_list<std::pair<const char*, Value>> choices) {
  bool changed = false;
  if (title) {
    ImGui::AlignTextToFramePadding();
    ImGui::TextUnformatted(title);
    ImGui::SameLine();
  }
  ImGui::PushID(id);
  for (const auto& [label, choice] : choices) {
    if (choice != choices.begin()->second) ImGui::SameLine();
    if (radio(label, value == choice) && value != choice) {
      value = choice;
      changed = true;
    }
  }
  ImGui::PopID();
  return changed;
}

void lay_out_picture(TankState& state, TankChoices& choices) {
  scene::TankScene scene = state.scene();
  bool changed = radios("view", nullptr, scene.view,
                        {{"spheres", scene::TankView::spheres}, {"voxels", scene::TankView::voxels}});
  if (scene.view == scene::TankView::voxels)
    changed |= radios("lighting", "their light:", scene.lighting,
                      {{"maps", scene::TankLighting::maps}, {"exact", scene::TankLighting::exact}});
  changed |= radios("lens points", "points of the lens:", scene.lens_points,
                    {{"remap", scene::LensPoints::remap}, {"rejection", scene::LensPoints::rejection}});
  changed |=
      tank_rows(scene, state.file(), [](auto& o, auto&& v) { scene::visit_tank_picture_options(o, v); });
  changed |= tank_rows(scene, state.file(), [](auto& o, auto&& v) { scene::visit_film_options(o, v); });
  changed |= radios("tone", "tone curve:", scene.tone,
                    {{"neutral", scene::ToneCurve::neutral}, {"standard", scene::ToneCurve::standard}});
  if (changed) state.edit() = scene;
  checkbox("wait for the display", &choices.vertical_sync);
}

void lay_out_sky(TankState& state) {
  scene::TankScene scene = state.scene();
  // A tank has no stars, nor rooms that light must find the way into.
  bool changed = tank_rows(
      scene.sky, state.file().sky, [](auto& o, auto&& v) { scene::visit_sky_options(o, v); },
      [](const std::string& key) { return key != "stars" && key != "bounce"; });
  ImGui::PushID("fog");
  ImGui::TextDisabled("fog in the tank");
  changed |=
      tank_rows(scene.fog, state.file().fog, [](auto& o, auto&& v) { scene::visit_fog_options(o, v); });
  ImGui::PopID();
  if (changed) state.edit() = scene;
}

/// The numbers of voxels of a tank, in a row.
bool size_row(glm::uvec3& size) {
  bool changed = false;
  begin_row("size [voxels]");
  const float width = (ImGui::GetContentRegionAvail().x - 2 * ImGui::GetStyle().ItemSpacing.x) / 3;
  constexpr const char* kNames[]{"##size x", "##size y", "##size z"};
  for (int axis = 0; axis < 3; ++axis) {
    if (axis > 0) ImGui::SameLine();
    auto edited = static_cast<float>(size[axis]);
    ImGui::SetNextItemWidth(width);
    if (!drag(kNames[axis], &edited, 1, 1, static_cast<float>(spheres::kMostVoxelsPerAxis), "%.0f")) continue;
    size[axis] = static_cast<std::uint32_t>(edited);
    changed = true;
  }
  return changed;
}

/// Rows for what no table of settings holds.
bool radius_rows(spheres::PackOptions& pack, const spheres::PackOptions& file) {
  const double largest = 0.5 * std::min({pack.size.x, pack.size.y, pack.size.z});
  const scene::OptionInfo smallest_info{
      "smallest",          "voxels", "`radius` in the file, its first number",
      scene::kLeastRadius, largest,  "smallest radius"};
  const scene::OptionInfo largest_info{
      "largest",           "voxels", "`radius` in the file, its second number",
      scene::kLeastRadius, largest,  "largest radius"};
  bool changed = false;
  if (option_row(smallest_info, pack.radius.x, file.radius.x)) {
    pack.radius.y = std::max(pack.radius.x, pack.radius.y);
    changed = true;
  }
  if (option_row(largest_info, pack.radius.y, file.radius.y)) {
    pack.radius.x = std::min(pack.radius.x, pack.radius.y);
    changed = true;
  }
  return changed;
}

bool seed_row(spheres::PackOptions& pack, const spheres::PackOptions& file) {
  const scene::OptionInfo info{"seed", "", "another one: other places", 0, kMostSeeds};
  auto seed = static_cast<std::uint32_t>(pack.seed);
  if (!option_row(info, seed, static_cast<std::uint32_t>(file.seed))) return false;
  pack.seed = seed;
  return true;
}

/// "largest first"
std::string shown_name(std::string name) {
  std::replace(name.begin(), name.end(), '_', ' ');
  return name;
}

/// One of `count` values by its name.
template <typename Choice>
bool choice_row(const std::string& key, Choice& chosen, std::uint32_t count, const char* (*name_of)(Choice)) {
  bool changed = false;
  begin_row(key.c_str());
  if (!begin_combo(("##" + key).c_str(), shown_name(name_of(chosen)).c_str())) return false;
  for (std::uint32_t i = 0; i < count; ++i) {
    const auto choice = Choice{i};
    if (!selectable(shown_name(name_of(choice)).c_str(), choice == chosen)) continue;
    changed = changed || choice != chosen;
    chosen = choice;
    ImGui::CloseCurrentPopup();
  }
  end_combo();
  return changed;
}

/// The colour space in which a palette is interpolated.
void space_row(TankState& state) {
  std::string space = state.scene().palette_space;
  bool changed = false;
  for (const char* name : {"oklab", "linear", "srgb", "nearest"}) {
    if (radio(name, space == name)) {
      changed = changed || space != name;
      space = name;
    }
    if (ImGui::IsItemHovered()) ImGui::SetTooltip("how colours between those of the palette are mixed");
    ImGui::SameLine();
  }
  ImGui::NewLine();
  if (changed) state.edit().palette_space = space;
}

void lay_out_pack_button(const TankState& state, const TankFigures& figures, const Status& status,
                         UiRequests& requests) {
  // While it packs, the window over the picture stops it.
  if (status.work) return ImGui::TextDisabled("packing...");
  if (button("Pack")) requests.pack = true;
  if (ImGui::IsItemHovered()) ImGui::SetTooltip("in the background; the picture stays until it is done");
  ImGui::SameLine();
  if (state.differs_from_packed()) {
    ImGui::TextColored(kChangedText, "the picture shows the spheres before");
  } else {
    ImGui::TextDisabled("%s spheres%s", grouped(figures.spheres).c_str(),
                        state.is_complete() ? "" : ", stopped");
  }
}

void lay_out_tank_files(const TankState& state, UiRequests& requests) {
  const auto act = [&](const char* label, const char* tooltip, Action action) {
    if (button(label)) requests.actions.push_back(action);
    if (ImGui::IsItemHovered()) ImGui::SetTooltip("%s", tooltip);
  };
  act("save the scene (F5)", "all settings as TOML; brume render takes it", Action::save_recording);
  act("save the picture (F12)", "as PNG, with the scene that renders it again", Action::screenshot);
  act("save the spheres (F6)", "the packed tank as a .spheres file", Action::save_tank);
  if (!state.scene().file.empty())
    ImGui::TextWrapped("the tank is from %s", state.scene().file.filename().c_str());
}

void lay_out_tank_figures(const TankState& state, const TankFigures& figures, const Status& status) {
  constexpr double kMiB = 1024.0 * 1024.0;
  ImGui::TextWrapped("%s", status.device.c_str());
  ImGui::Text("GPU memory: %.0f MiB", static_cast<double>(status.device_bytes) / kMiB);
  ImGui::Text("picture: %u x %u pixels, %zu spheres", figures.picture_px.x, figures.picture_px.y,
              figures.spheres);
  const glm::vec3 size = state.size();
  ImGui::Text("tank: %.2f x %.2f x %.2f m", double{size.x}, double{size.y}, double{size.z});
  for (const auto& scope : status.timings)
    ImGui::Text("%.*s: %.2f ms", static_cast<int>(scope.name.size()), scope.name.data(), scope.milliseconds);
}

void lay_out_packing(TankState& state, const TankFigures& figures, const Status& status,
                     UiRequests& requests) {
  scene::TankScene scene = state.scene();
  if (!scene.file.empty()) {
    ImGui::TextWrapped("The spheres are those of %s.", scene.file.filename().c_str());
    if (button("pack others instead")) state.edit().file.clear();
    return;
  }

  // Rows of options; noise has a size only where something uses it.
  spheres::PackOptions& pack = scene.pack;
  const spheres::PackOptions& file = state.file().pack;
  bool changed = false;
  const auto rows = [&](const std::string& key) {
    const auto visit = [](auto& o, auto&& v) { scene::visit_pack_options(o, v); };
    changed |= tank_rows(pack, file, visit, [&](const std::string& each) { return each == key; });
  };
  rows("spheres");
  changed |= radius_rows(pack, file);
  rows("distribution");
  changed |= choice_row("arrangement", pack.arrangement, scene::kArrangements, scene::arrangement_name);
  changed |= choice_row("coloring", pack.coloring, scene::kColorings, scene::coloring_name);
  if (pack.arrangement == spheres::Arrangement::noise || pack.coloring == spheres::Coloring::noise)
    rows("noise_size");
  changed |= seed_row(pack, file);
  rows("opacity");
  changed |= size_row(pack.size);
  rows("voxel");
  if (changed) state.edit() = scene;

  lay_out_pack_button(state, figures, status, requests);
}

void lay_out_palette(TankState& state, TankChoices& choices, const TankFigures& figures, const Status& status,
                     UiRequests& requests) {
  if (!state.scene().file.empty()) return ImGui::TextDisabled("the spheres have the colours of their file");
  // What the text chooses, once for each text: a file may be behind it.
  std::string palette = state.scene().palette;
  if (palette != choices.palette_text) {
    choices.palette_text = palette;
    choices.palette = {};
    if (const auto choice = palettes::parse_palette_choice(palette))
      choices.palette = {choice->palette.name, static_cast<float>(choice->low),
                         static_cast<float>(choice->high)};
  }
  if (lay_out_palettes(choices.palettes, palettes::built_in(), choices.palette, 12 * ImGui::GetFontSize())) {
    const PaletteSelection& chosen = choices.palette;
    choices.palette_text = palettes::choice_text(chosen.name, double{chosen.low}, double{chosen.high});
    state.edit().palette = choices.palette_text;
  }
  palette = state.scene().palette;
  ImGui::SetNextItemWidth(0.6f * ImGui::GetWindowWidth());
  if (text_field("palette", &palette)) state.edit().palette = palette;
  if (ImGui::IsItemHovered())
    ImGui::SetTooltip("NAME, NAME:0.2-0.6 for a part of it, or a .gpl or .json file; empty: white");
  space_row(state);
  lay_out_pack_button(state, figures, status, requests);
}

}  // namespace

void lay_out_tank_sections(TankState& state, TankChoices& choices, const TankFigures& figures,
                           const Status& status, UiRequests& requests) {
  if (header("Picture", true)) lay_out_picture(state, choices);
  if (header("Lights", true)) lay_out_lights(state, choices);
  if (header("Glass", false)) lay_out_glass(state);
  if (header("Camera and lens", false)) lay_out_lens(state, requests);
  if (header("Sky and fog", false)) lay_out_sky(state);
  if (header("Packing", false)) lay_out_packing(state, figures, status, requests);
  if (header("Palette", false)) lay_out_palette(state, choices, figures, status, requests);
  if (header("Files", false)) lay_out_tank_files(state, requests);
  if (header("Figures", false)) lay_out_tank_figures(state, figures, status);
}

}  // namespace brume::viewer
