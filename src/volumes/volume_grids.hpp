// Which grids of a file are drawn.
#pragma once

#include <array>
#include <span>
#include <string>
#include <vector>

#include "core/error.hpp"
#include "grids/grid.hpp"
#include "scene/volume_options.hpp"

namespace brume::volumes {

/// In the place of a name: of a heat, nothing glows; of colours, the volume has none.
inline constexpr const char* kNoGrid = "none";

using GridList = std::span<const grids::Grid* const>;

/// Red, green and blue as a grid of numbers each.
using ColorParts = std::array<const grids::Grid*, 3>;

/// What is rendered of a file.
struct ChosenGrids {
  const grids::Grid* density = nullptr;
  const grids::Grid* heat = nullptr;   ///< Null: nothing glows.
  const grids::Grid* fire = nullptr;   ///< A grid that says where it burns; null: none.
  bool names_heat = false;             ///< Whether the options do.
  const grids::Grid* color = nullptr;  ///< Null: no colours, or in channels.
  ColorParts channels = {};            ///< Channels of colours; null: none.
  std::vector<const grids::Grid*> masks = {};
  /// Where another grid might have been meant, and which colours are not drawn: sentences.
  std::vector<std::string> notes = {};

  /// Calls use(pointer) for all grids, in an order that depends on nothing but how many masks there are.
  template <typename Use>
  void each(Use use) {
    use(density), use(heat), use(fire), use(color);
    for (const grids::Grid*& channel : channels) use(channel);
    for (const grids::Grid*& mask : masks) use(mask);
  }
};

bool is_number_grid(const grids::Grid* grid);
bool is_color_vectors(const grids::Grid* grid);

/// The names of a list's grids that fit, as options name them: of several of one name those after the first
/// with a number, "density[1]" the second. Colours in channels are none of these.
std::vector<std::string> titles_of(GridList grids, bool (*fits)(const grids::Grid*));

/// Whether three grids are the usual channels of a colour, which options name as kChannelName.
bool has_color_channels(GridList grids);
inline constexpr const char* kChannelName = "color";

/// By the names of the options, or the usual ones; uses no values. Fails with bad_input for names that no
/// grid has, and where nothing can be rendered.
Result<ChosenGrids> choose_grids(GridList grids, const scene::VolumeOptions& options);

}  // namespace brume::volumes
