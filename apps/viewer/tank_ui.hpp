// The user interface over the picture of a tank: overlay, marks and panels.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "apps/viewer/palette_list.hpp"
#include "apps/viewer/tank_state.hpp"
#include "apps/viewer/ui_parts.hpp"

namespace brume::viewer {

/// What is shown besides the picture.
struct TankChoices : WindowChoices {
  std::optional<TankHandle> selected;  ///< What is dragged, or was last.
  PaletteListState palettes;
  PaletteSelection palette;  ///< What `palette_text`, the scene's, chooses.
  std::string palette_text;
};

/// What overlay and panels of a tank say besides.
struct TankFigures {
  std::uint32_t samples;  ///< Samples of each pixel so far.
  double seconds;         ///< Device time of those samples.
  bool moves;             ///< The picture is a preview.
  glm::uvec2 picture_px;
  std::size_t spheres;
};

/// `hovered`: what a click would drag.
void lay_out_tank_marks(const TankState& state, const TankChoices& choices,
                        const std::optional<TankHandle>& hovered);
void lay_out_tank_status(const TankState& state, const TankFigures& figures);
void lay_out_tank_sections(TankState& state, TankChoices& choices, const TankFigures& figures,
                           const Status& status, UiRequests& requests);
void lay_out_tank_buttons(const TankState& state, UiRequests& requests);
/// The keys of camera, lights and glass.
void mark_keys(const scene::TankScene& scene, const TimeMark& mark);

// Some of the sections.
void lay_out_lights(TankState& state, TankChoices& choices);
void lay_out_glass(TankState& state);
void lay_out_lens(TankState& state, UiRequests& requests);

}  // namespace brume::viewer
