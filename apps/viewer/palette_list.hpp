// A list to choose a palette and a part of it from.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "palettes/palette.hpp"

namespace brume::viewer {

/// What is chosen: as --palette NAME:LOW-HIGH (palettes/choice.hpp).
struct PaletteSelection {
  std::string name;         ///< Empty: none yet.
  float low = 0, high = 1;  ///< Each in [0, 1]; low > high: backwards.
  bool operator==(const PaletteSelection&) const = default;
};

/// What the widgets of the list are set to, between frames.
struct PaletteListState {
  std::string words;               ///< As palettes::Filter::words.
  std::uint32_t least_colors = 2;  ///< Shown at most kMostShownColors, which stands for any number.
  std::uint32_t most_colors = 64;
  bool has_hue = false;
  float hue = 210;  ///< [degrees]

  /// Indices of what the settings let through; the search runs only when they change.
  std::vector<std::uint32_t> found;
  std::optional<palettes::Filter> searched;  ///< What `found` is of.
  std::size_t searched_count = 0;            ///< Number of palettes that were searched.
};
constexpr std::uint32_t kMostShownColors = 64;

/// What the settings search for.
palettes::Filter filter_of(const PaletteListState& state);

/// Lays out in the current window: a search field, sliders for the number of colours and the hue, a
/// scrolling list `height` high [px], and two sliders for the range. Each row is a strip of the palette's
/// colours, those outside of the chosen range dimmed, and its name; a click chooses it. Only rows that are
/// visible are laid out. Returns whether `chosen` changed.
bool lay_out_palettes(PaletteListState& state, std::span<const palettes::Palette> palettes,
                      PaletteSelection& chosen, float height);

}  // namespace brume::viewer
