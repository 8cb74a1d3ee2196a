// The user interface over the picture of a tank: overlay, marks, panels and time slider.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "apps/viewer/keys.hpp"
#include "apps/viewer/palette_list.hpp"
#include "apps/viewer/tank_state.hpp"
#include "core/progress.hpp"
#include "gpu/timings.hpp"

namespace brume::viewer {

/// What is shown besides the picture.
struct TankChoices {
  bool panels = false, overlay = true, help = false;
  bool vertical_sync = true;
  std::optional<TankHandle> selected;  ///< What is dragged, or was last.
  PaletteListState palettes;
  PaletteSelection palette;  ///< What `palette_text`, the scene's, chooses.
  std::string palette_text;
};

/// Work of another thread.
struct TankWork {
  std::string title;   ///< "packing spheres"
  double seconds = 0;  ///< Since its begin.
  std::optional<Progress::State> progress;
  bool can_stop = false, stops = false;
};

/// Messages and figures for overlay and panels.
struct TankStatus {
  std::vector<std::string> lines;  ///< Recent messages, the newest last.
  std::optional<TankWork> work;
  std::uint32_t samples = 0;  ///< Of each pixel, so far.
  double seconds = 0;         ///< That the device took for them.
  bool moves = false;         ///< The picture is a preview.
  glm::uvec2 picture_px{0};
  std::size_t spheres = 0;
  std::optional<TankHandle> hovered;
  std::string device;
  std::uint64_t device_bytes = 0;
  std::vector<gpu::Timings::Scope> timings;  ///< Of the last frame.
  std::string shader_errors;                 ///< Empty: none.
};

/// Requests from the widgets, applied after the layout.
struct TankRequests {
  std::optional<double> seek;  ///< [s]
  std::vector<Action> actions;
  bool pack = false, stop = false;
};

/// Lays out everything; ImGui::GetDrawData() holds the result until the next frame begins.
TankRequests lay_out_tank(TankState& state, TankChoices& choices, const TankStatus& status);
/// The same while the first tank is made: its name, and the work that goes on.
TankRequests lay_out_tank_loading(const std::string& name, const TankWork& work);

/// "65,535"
std::string grouped(std::uint64_t number);
/// How much of some work is done, as wide as its window and so high [px].
void lay_out_bar(double fraction, float height);

// The parts of lay_out_tank.
void lay_out_tank_marks(const TankState& state, const TankChoices& choices, const TankStatus& status);
void lay_out_tank_overlay(const TankState& state, const TankChoices& choices, const TankStatus& status);
void lay_out_tank_work(const TankWork& work, TankRequests& requests);
void lay_out_tank_time_bar(TankState& state, TankRequests& requests);
void lay_out_tank_panels(TankState& state, TankChoices& choices, const TankStatus& status,
                         TankRequests& requests);
// Sections of the panels.
void lay_out_packing(TankState& state, const TankStatus& status, TankRequests& requests);
void lay_out_palette(TankState& state, TankChoices& choices, const TankStatus& status,
                     TankRequests& requests);
void lay_out_lights(TankState& state, TankChoices& choices);
void lay_out_glass(TankState& state);
void lay_out_lens(TankState& state, TankRequests& requests);

}  // namespace brume::viewer
