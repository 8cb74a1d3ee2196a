// The sheets of a flipbook as files.
#pragma once

#include "apps/cli/flipbook_options.hpp"
#include "apps/command_line/json.hpp"

namespace brume::cli {

/// All that is drawn: sheets of linear numbers, premultiplied.
struct FlipbookSheets {
  image::Texels color, emission;
  image::Texels motion;  ///< R and G: to where it moves up to the next tile [parts of a tile], y down.
  image::SixWayLight light;
  image::Display display;
};

/// The luminance of a linear colour, by the weights of ITU-R BT.709.
float luminance(glm::vec4 texel);

/// Writes the colours, and the maps that the plan asks for; returns what 1 stands for in them. Throws Error.
Json save_sheets(const FlipbookPlan& plan, const FlipbookSheets& sheets);

}  // namespace brume::cli
