#include <imgui.h>
#include <imgui_stdlib.h>

#include <algorithm>
#include <cstdio>

#include "apps/viewer/option_panel.hpp"
#include "apps/viewer/ui_parts.hpp"
#include "sim/cloud.hpp"

namespace brume::viewer {
namespace {

constexpr float kPanelWidth = 400, kTimeBarHeight = 64;
// Colours of the passes in the graph, in frame order.
constexpr std::array kPassColours{
    IM_COL32(94, 129, 172, 255),  IM_COL32(136, 192, 208, 255), IM_COL32(163, 190, 140, 255),
    IM_COL32(235, 203, 139, 255), IM_COL32(208, 135, 112, 255), IM_COL32(191, 97, 106, 255),
    IM_COL32(180, 142, 173, 255), IM_COL32(229, 233, 240, 255), IM_COL32(143, 188, 187, 255),
    IM_COL32(129, 161, 193, 255), IM_COL32(200, 170, 90, 255),  IM_COL32(120, 140, 90, 255),
    IM_COL32(170, 110, 160, 255), IM_COL32(110, 110, 130, 255)};

ImU32 pass_colour(std::size_t pass) {
  return kPassColours[pass % kPassColours.size()];
}

bool is_noise(const std::string& key) {
  return key.starts_with("noise") || key == "erosion" || key.starts_with("swirl") || key == "rise";
}
bool is_lighting(const std::string& key) {
  return key == "albedo" || key == "anisotropy" || key == "droplet" || key == "multiple_scattering";
}

void report(const Result<void>& done, std::vector<std::string>& failures) {
  if (!done) failures.push_back(done.failure().message);
}

// Smoke settings; changing one that the simulation depends on simulates again from the start.
void smoke_rows(Session& session, UiRequests& requests, std::vector<std::string>& failures,
                const std::function<bool(const std::string&)>& selects) {
  scene::SmokeOptions smoke = session.live().scenario().timeline.smoke;
  const auto visit = [](auto& options, auto&& visitor) { scene::visit_smoke_options(options, visitor); };
  if (!option_rows(smoke, visit, selects)) return;
  requests.changed_picture = true;
  report(session.live().set_smoke(smoke), failures);
}

void lay_out_light(Session& session, UiRequests& requests, std::vector<std::string>& failures) {
  smoke_rows(session, requests, failures, is_lighting);
  const scene::Timeline& timeline = session.live().scenario().timeline;
  scene::SkyOptions sky = timeline.sky;
  const auto visit = [](auto& options, auto&& visitor) { scene::visit_sky_options(options, visitor); };
  if (option_rows(sky, visit)) {
    report(session.live().set_sky(sky), failures);
    requests.changed_picture = true;
  }
  scene::Timeline exposed;
  exposed.exposure = timeline.exposure;
  const auto visit_timeline = [](auto& options, auto&& visitor) {
    scene::visit_timeline_options(options, visitor);
  };
  if (option_rows(exposed, visit_timeline, [](const std::string& key) { return key == "exposure"; })) {
    report(session.live().set_exposure(exposed.exposure), failures);
    requests.changed_picture = true;
  }
}

void lay_out_holes(Choices& choices) {
  Weapons& weapons = choices.weapons;
  // An id of its own: the fields below have the names of kinds, too, and two widgets of one id abort at a
  // click.
  ImGui::PushID("kind");
  for (const ShotKind kind : {ShotKind::bullet, ShotKind::glyph, ShotKind::word, ShotKind::picture}) {
    if (kind != ShotKind::bullet) ImGui::SameLine();
    if (ImGui::RadioButton(name_of(kind), weapons.kind == kind)) weapons.kind = kind;
  }
  ImGui::PopID();
  ImGui::InputText("word", &weapons.text.text);
  std::string picture = weapons.picture.string();
  if (ImGui::InputText("picture", &picture)) weapons.picture = picture;
  if (ImGui::TreeNode("bullets and pictures")) {
    option_rows(weapons.shot, [](auto& o, auto&& visitor) { scene::visit_shot_options(o, visitor); });
    ImGui::TreePop();
  }
  if (ImGui::TreeNode("letters and words")) {
    option_rows(weapons.text, [](auto& o, auto&& visitor) { scene::visit_text_options(o, visitor); });
    ImGui::TreePop();
  }
  if (ImGui::TreeNode("explosions")) {
    option_rows(weapons.blast, [](auto& o, auto&& visitor) { scene::visit_blast_options(o, visitor); });
    weapons.blast.refill_middle = std::max(weapons.blast.refill_middle, weapons.blast.refill_rim);
    ImGui::TreePop();
  }
}

void lay_out_quality(Choices& choices, const Notices& notices) {
  if (ImGui::RadioButton("auto", !choices.level)) choices.level.reset();
  const auto levels = quality_levels();
  for (std::size_t i = 0; i < levels.size(); ++i) {
    ImGui::SameLine();
    if (ImGui::GetContentRegionAvail().x < 80) ImGui::NewLine();
    if (ImGui::RadioButton(levels[i].name, choices.level == i)) choices.level = i;
  }
  auto rate = static_cast<float>(choices.frames_per_second);
  if (ImGui::SliderFloat("frames per second", &rate, 5, 240, "%.0f", ImGuiSliderFlags_AlwaysClamp))
    choices.frames_per_second = static_cast<double>(rate);
  ImGui::Checkbox("vertical sync", &choices.vertical_sync);
  const Quality& now = *notices.quality;
  ImGui::Text("current level: %s", now.name);
  ImGui::Text("  resolution %ux%u", notices.picture_px.x, notices.picture_px.y);
  ImGui::Text("  one ray per %ux%u pixels, step scale %.1f", now.march_scale, now.march_scale,
              static_cast<double>(now.step_scale));
  ImGui::Text("  1/%.0f of the changed light updated per frame",
              1 / static_cast<double>(now.light_update_fraction));
}

void lay_out_views(Choices& choices, const Session& session, UiRequests& requests) {
  for (std::size_t i = 0; i < passes::kDebugViewNames.size(); ++i) {
    const auto view = static_cast<passes::DebugView>(i);
    if (i % 4 != 0) ImGui::SameLine(static_cast<float>(i % 4) * 92);
    if (ImGui::RadioButton(std::string(passes::kDebugViewNames[i]).c_str(), choices.view == view)) {
      choices.view = view;
      requests.changed_picture = true;
    }
  }
  bool has_slice = choices.slice.has_value();
  if (ImGui::Checkbox("slice", &has_slice)) {
    choices.slice.reset();
    if (has_slice) choices.slice.emplace();
    requests.changed_picture = true;
  }
  if (!choices.slice) {
    ImGui::SameLine();
    ImGui::TextDisabled("through the middle of the smoke");
    return;
  }
  const voxel::GridLayout& frame = session.live().scenario().voxels.grid.layout();
  auto axis = static_cast<int>(choices.slice->axis);
  ImGui::SameLine();
  if (ImGui::Combo("##axis", &axis, "x\0y\0z\0")) requests.changed_picture = true;
  choices.slice->axis = static_cast<std::uint32_t>(axis);
  const float low = frame.origin_world[axis];
  const float high = low + static_cast<float>(frame.size[axis]) * frame.voxel_size;
  if (ImGui::SliderFloat("at", &choices.slice->at_world, low, high, "%.2f m"))
    requests.changed_picture = true;
}

void lay_out_camera(Session& session, Player& player, UiRequests& requests) {
  scene::Camera camera = player.camera();
  if (option_rows(camera, [](auto& o, auto&& visitor) { scene::visit_camera_options(o, visitor); })) {
    player.set_vertical_fov(camera.vertical_fov);
    session.leave_path();
    requests.changed_picture = true;
  }
  scenario::WalkerOptions walker = player.options();
  if (ImGui::TreeNode("body")) {
    if (option_rows(walker, [](auto& o, auto&& visitor) { scenario::visit_walker_options(o, visitor); })) {
      walker.eye = std::min(walker.eye, walker.height);
      player.set_options(session.simulation().world().grid(), walker);
    }
    ImGui::TreePop();
  }
  const glm::vec3 p = camera.position_world, d = camera.target_world - camera.position_world;
  ImGui::Text("eye %.2f %.2f %.2f m", static_cast<double>(p.x), static_cast<double>(p.y),
              static_cast<double>(p.z));
  ImGui::Text("direction %.2f %.2f %.2f", static_cast<double>(d.x), static_cast<double>(d.y),
              static_cast<double>(d.z));
  if (ImGui::Button(player.flying() ? "walk (G)" : "fly (G)")) requests.actions.push_back(Action::fly);
}

// GPU times of the last frames as stacked bars, scaled to the slowest frame.
void lay_out_graph(const Figures& figures) {
  const auto& names = figures.pass_names();
  const auto& frames = figures.frames();
  const ImVec2 at = ImGui::GetCursorScreenPos();
  const ImVec2 size(ImGui::GetContentRegionAvail().x, 110);
  ImDrawList& list = *ImGui::GetWindowDrawList();
  list.AddRectFilled(at, ImVec2(at.x + size.x, at.y + size.y), IM_COL32(20, 22, 28, 255));
  double slowest = 1e-3;
  for (const FrameFigures& frame : frames) {
    double sum = 0;
    for (const auto& pass : frame.passes) sum += pass.milliseconds;
    slowest = std::max(slowest, sum);
  }
  const float bar = size.x / static_cast<float>(Figures::kHistory);
  float x = at.x + size.x - bar * static_cast<float>(frames.size());
  for (const FrameFigures& frame : frames) {
    float y = at.y + size.y;
    for (const auto& pass : frame.passes) {
      const auto index =
          static_cast<std::size_t>(std::find(names.begin(), names.end(), pass.name) - names.begin());
      const float height = size.y * static_cast<float>(pass.milliseconds / slowest);
      list.AddRectFilled(ImVec2(x, y - height), ImVec2(x + std::max(bar, 1.0f), y), pass_colour(index));
      y -= height;
    }
    x += bar;
  }
  char top[32];
  std::snprintf(top, sizeof top, "%.2f ms", slowest);
  list.AddText(ImVec2(at.x + 4, at.y + 2), IM_COL32(230, 230, 230, 255), top);
  ImGui::Dummy(size);
}

void lay_out_times(const Figures& figures) {
  ImGui::TextUnformatted("GPU time by pass [ms]");
  lay_out_graph(figures);
  if (figures.frames().empty() || !ImGui::BeginTable("passes", 4, ImGuiTableFlags_SizingFixedFit)) return;
  for (const auto& pass : figures.frames().back().passes) {
    const auto& names = figures.pass_names();
    const auto index =
        static_cast<std::size_t>(std::find(names.begin(), names.end(), pass.name) - names.begin());
    ImGui::TableNextColumn();
    const ImVec4 colour = ImGui::ColorConvertU32ToFloat4(pass_colour(index));
    ImGui::TextColored(colour, "%s", pass.name.c_str());
    ImGui::TableNextColumn();
    ImGui::Text("%7.2f  ", pass.milliseconds);
  }
  ImGui::EndTable();
}

void lay_out_state(const Session& session, const Figures& figures, const Notices& notices) {
  const sim::State& state = session.simulation().world().state();
  constexpr double kMiB = 1024.0 * 1024.0;
  ImGui::Text("%s", notices.device.c_str());
  ImGui::Text("simulation: %.3f ms CPU", figures.median(&FrameFigures::tick_ms));
  ImGui::Text("memory: GPU %.0f MiB, process %.0f MiB", static_cast<double>(notices.device_bytes) / kMiB,
              static_cast<double>(resident_bytes()) / kMiB);
  ImGui::Text("tick %u, %zu clouds, %zu holes, %zu blasts", state.tick, state.clouds.size(),
              state.holes.size(), state.blasts.size());
  std::uint64_t amount = 0;  // in voxels / 2^20
  for (const sim::LiveCloud& cloud : state.clouds) amount += cloud.cloud->amount(state.tick);
  ImGui::Text("%llu voxels of smoke in %u bricks", static_cast<unsigned long long>(amount >> 20),
              session.simulation().volume().slot_count());
}

}  // namespace

void lay_out_panels(Choices& choices, Session& session, Player& player, const Figures& figures,
                    const Notices& notices, UiRequests& requests) {
  const ImVec2 display = ImGui::GetIO().DisplaySize;
  const float width = std::min(kPanelWidth, 0.9f * display.x);
  ImGui::SetNextWindowPos(ImVec2(display.x - width - 8, 8), ImGuiCond_Always);
  ImGui::SetNextWindowSize(ImVec2(width, std::max(display.y - kTimeBarHeight - 24, 80.0f)), ImGuiCond_Always);
  ImGui::Begin("Brume", nullptr,
               ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoResize | ImGuiWindowFlags_NoCollapse);
  std::vector<std::string> failures;
  if (!notices.shader_errors.empty()) {
    ImGui::PushStyleColor(ImGuiCol_Text, ImVec4(1, 0.45f, 0.4f, 1));
    ImGui::TextWrapped("%s", notices.shader_errors.c_str());
    ImGui::PopStyleColor();
  }
  if (ImGui::CollapsingHeader("Figures", ImGuiTreeNodeFlags_DefaultOpen)) {
    lay_out_times(figures);
    lay_out_state(session, figures, notices);
  }
  if (ImGui::CollapsingHeader("View", ImGuiTreeNodeFlags_DefaultOpen))
    lay_out_views(choices, session, requests);
  if (ImGui::CollapsingHeader("Smoke"))
    smoke_rows(session, requests, failures,
               [](const std::string& key) { return !is_noise(key) && !is_lighting(key); });
  if (ImGui::CollapsingHeader("Holes")) lay_out_holes(choices);
  if (ImGui::CollapsingHeader("Light")) lay_out_light(session, requests, failures);
  if (ImGui::CollapsingHeader("Noise")) smoke_rows(session, requests, failures, is_noise);
  if (ImGui::CollapsingHeader("March")) lay_out_quality(choices, notices);
  if (ImGui::CollapsingHeader("Resolve")) ImGui::Checkbox("accumulate smoke over frames", &choices.temporal);
  if (ImGui::CollapsingHeader("Camera")) lay_out_camera(session, player, requests);
  for (const std::string& failure : failures) ImGui::TextWrapped("%s", failure.c_str());
  ImGui::End();
}

namespace {

// Marks the events of the timeline on the slider.
void mark_events(const scene::Timeline& timeline, ImVec2 at, ImVec2 size, double end) {
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const auto marks = [&](const auto& events, ImU32 colour) {
    for (const auto& event : events) {
      const float x = at.x + size.x * static_cast<float>(event.time / std::max(end, 1e-3));
      list.AddLine(ImVec2(x, at.y), ImVec2(x, at.y + size.y), colour, 2);
    }
  };
  marks(timeline.smokes, IM_COL32(200, 205, 215, 255));
  marks(timeline.shots, IM_COL32(255, 190, 90, 255));
  marks(timeline.texts, IM_COL32(255, 220, 140, 255));
  marks(timeline.blasts, IM_COL32(240, 90, 80, 255));
  marks(timeline.doors, IM_COL32(120, 190, 120, 255));
  marks(timeline.edits, IM_COL32(120, 160, 220, 255));
}

}  // namespace

void lay_out_time_bar(Session& session, UiRequests& requests) {
  const ImVec2 display = ImGui::GetIO().DisplaySize;
  ImGui::SetNextWindowPos(ImVec2(8, display.y - kTimeBarHeight - 8), ImGuiCond_Always);
  ImGui::SetNextWindowSize(ImVec2(std::max(display.x - 16, 100.0f), kTimeBarHeight), ImGuiCond_Always);
  ImGui::Begin("time", nullptr, ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove);
  if (ImGui::Button(session.paused() ? "resume" : "pause")) requests.actions.push_back(Action::pause);
  ImGui::SameLine();
  if (ImGui::Button("play")) requests.play = true;
  if (ImGui::IsItemHovered()) ImGui::SetTooltip("replay all actions from the start, along the camera path");
  ImGui::SameLine();
  if (ImGui::Button("save")) requests.actions.push_back(Action::save_recording);
  if (ImGui::IsItemHovered()) ImGui::SetTooltip("save the session as a timeline (F5)");
  ImGui::SameLine();
  if (ImGui::Button("reset")) requests.actions.push_back(Action::reset);
  ImGui::SameLine();
  ImGui::Text("%.2f / %.2f s, tick %u", session.seconds(), session.end_seconds(),
              session.simulation().world().tick());
  const double end = std::max(session.end_seconds(), 0.01);
  double now = session.seconds();
  const double zero = 0;
  ImGui::SetNextItemWidth(-1);
  const ImVec2 at = ImGui::GetCursorScreenPos();
  const ImVec2 size(ImGui::GetContentRegionAvail().x, ImGui::GetFrameHeight());
  if (ImGui::SliderScalar("##time", ImGuiDataType_Double, &now, &zero, &end, "")) requests.seek = now;
  mark_events(session.live().scenario().timeline, at, size, end);
  ImGui::End();
}

}  // namespace brume::viewer
