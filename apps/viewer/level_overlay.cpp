#include <imgui.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <string>
#include <string_view>
#include <utility>

#include "apps/viewer/tank_camera.hpp"
#include "apps/viewer/ui_parts.hpp"

namespace brume::viewer {
namespace {

constexpr ImU32 kMark = IM_COL32(255, 190, 90, 255), kShade = IM_COL32(0, 0, 0, 160);
constexpr ImU32 kVisible = IM_COL32(110, 220, 130, 255), kHidden = IM_COL32(240, 90, 80, 255);

glm::vec2 display_size() {
  return {ImGui::GetIO().DisplaySize.x, ImGui::GetIO().DisplaySize.y};
}

std::optional<ImVec2> place_of(const scene::Camera& camera, glm::vec3 world) {
  const auto at = on_display(camera, world);
  return at ? std::optional(ImVec2(at->x, at->y)) : std::nullopt;
}

void label(ImDrawList& list, ImVec2 at, ImU32 colour, const std::string& text) {
  const ImVec2 size = ImGui::CalcTextSize(text.c_str());
  list.AddRectFilled(ImVec2(at.x - 4, at.y - 2), ImVec2(at.x + size.x + 4, at.y + size.y + 2), kShade, 3);
  list.AddText(at, colour, text.c_str());
}

std::string probe_text(const ProbeResult& result) {
  char text[128];
  if (result.wall_m) {
    std::snprintf(text, sizeof text, "wall at %.2f m", static_cast<double>(*result.wall_m));
  } else {
    std::snprintf(text, sizeof text, "transmittance %.1f %%, optical depth %.2f",
                  100 * static_cast<double>(result.transmittance), static_cast<double>(result.optical_depth));
  }
  return text;
}

void lay_out_probe(const Choices& choices, const Session& session, const scene::Camera& camera) {
  const Probe& probe = choices.probe;
  if (!probe.a_world) return;
  ImDrawList& list = *ImGui::GetBackgroundDrawList();
  const auto a = place_of(camera, *probe.a_world);
  if (a) list.AddCircleFilled(*a, 5, kMark);
  if (!probe.b_world) {
    if (a) label(list, ImVec2(a->x + 9, a->y - 8), kMark, "L: set the other end");
    return;
  }
  const auto result = evaluate(probe, session.live().scenario(), session.simulation(), session.seconds());
  const auto b = place_of(camera, *probe.b_world);
  const bool visible = result && result->transmittance > 0.05f;
  if (b) list.AddCircleFilled(*b, 5, kMark);
  if (a && b) list.AddLine(*a, *b, visible ? kVisible : kHidden, 2.5f);
  const auto at = b ? b : a;
  if (at)
    label(list, ImVec2(at->x + 9, at->y - 8), visible ? kVisible : kHidden,
          result ? probe_text(*result) : result.failure().message);
}

}  // namespace

std::optional<glm::vec2> on_display(const scene::Camera& camera, glm::vec3 world) {
  return in_picture(camera, display_size(), world);
}

void lay_out_level_marks(const Game& game) {
  const Choices& choices = game.choices();
  const glm::vec2 middle = 0.5f * display_size();
  ImDrawList& list = *ImGui::GetBackgroundDrawList();
  if (!choices.panels && !choices.help && choices.overlay) {
    const ImVec2 at(middle.x, middle.y);
    list.AddCircle(at, 4.5f, IM_COL32(0, 0, 0, 140), 0, 2.5f);
    list.AddCircle(at, 4.5f, IM_COL32(255, 255, 255, 190), 0, 1.2f);
  }
  lay_out_probe(choices, game.session(), game.player().camera());
}

/// What the window shows: frames of a film, or a still.
void lay_out_level_status(const Game& game, const Figures& figures, const Notices& notices) {
  if (notices.refinement == Refinement::drawing) {
    ImGui::TextUnformatted("paused, drawing the best image...");
  } else if (notices.refinement == Refinement::done) {
    ImGui::TextUnformatted("paused, best image");
  } else if (figures.count() > 0) {
    ImGui::Text("%.0f frames/s, quality %s%s", figures.frames_per_second(), notices.quality.name,
                notices.automatic ? " (auto)" : "");
  } else {
    ImGui::TextUnformatted("begins...");
  }
  // How the player moves, and what a click shoots.
  std::string moves = game.session().follows_path() ? "along the path"
                      : game.player().flying()      ? "flying"
                                                    : "walking";
  if (const CarrierFlight* flight = game.flight())
    moves = "steering " + game.session().live().scenario().timeline.carriers[flight->carrier()].name;
  ImGui::Text("%.2f s, %s, shoots: %s", game.session().seconds(), moves.c_str(),
              name_of(game.choices().weapons.kind));
  if (notices.pace < 0.95 && !game.session().paused()) {
    ImGui::SameLine();
    ImGui::TextColored(kAccentText, " slowed: %.1fx", notices.pace);
  }
  // What differs from the picture of a film.
  const Choices& choices = game.choices();
  if (choices.view != passes::DebugView::none)
    ImGui::Text("view: %s", std::string(passes::debug_view_name(choices.view)).c_str());
  if (!choices.decals) ImGui::TextUnformatted("decals hidden (B)");
}

/// The colour of the marks of a kind of events: red, unless the table has it; 0: no mark.
ImU32 colour_of(std::string_view type) {
  constexpr std::array kColours{std::pair{std::string_view("smoke"), IM_COL32(200, 205, 215, 255)},
                                std::pair{std::string_view("shot"), IM_COL32(255, 190, 90, 255)},
                                std::pair{std::string_view("text"), IM_COL32(255, 220, 140, 255)},
                                std::pair{std::string_view("move"), ImU32{0}},
                                std::pair{std::string_view("edit"), IM_COL32(120, 160, 220, 255)},
                                std::pair{std::string_view("door"), IM_COL32(120, 190, 120, 255)}};
  for (const auto& [kind, colour] : kColours)
    if (kind == type) return colour;
  return IM_COL32(240, 90, 80, 255);
}

void mark_events(const scene::Timeline& timeline, const TimeMark& mark) {
  const auto marks = [&](const auto& events, ImU32 colour) {
    for (const auto& event : events) mark(event.time, colour);
  };
  for (const scene::Carrier& carrier : timeline.carriers) marks(carrier.keys, IM_COL32(180, 130, 240, 255));
  scene::for_each_event_list(timeline, [&](const char* type, const auto& events) {
    if (const ImU32 colour = colour_of(type); colour != 0) marks(events, colour);
  });
}

void lay_out_level_buttons(const Session& session, UiRequests& requests) {
  const auto act = [&](const char* label, const char* tooltip, Action action) {
    if (bar_button(label, tooltip)) requests.actions.push_back(action);
  };
  act(session.paused() ? "resume###pause" : "pause###pause", "stop the time, or let it run (P)",
      Action::pause);
  act("to start", "back to the start: all actions happen again while you walk (R)", Action::rewind);
  if (bar_button("replay", "from the start, with all actions, along the recorded camera path"))
    requests.play = true;
  act("undo", "take back the last action or setting (Ctrl+Z)", Action::undo);
  act("redo", "do again what was undone (Ctrl+Y)", Action::redo);
  act("remove all", "remove all actions of this session (Shift+R); undo brings them back", Action::empty);
  act("save", "save the session as a timeline (F5)", Action::save_recording);
}

}  // namespace brume::viewer
