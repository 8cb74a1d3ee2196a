// `brume render --flipbook`: frames as the tiles of sheets, for sprites (docs/guides/volume-textures.md).
#pragma once

#include <functional>
#include <memory>

#include "apps/cli/flipbook_options.hpp"
#include "apps/cli/frame_source.hpp"
#include "apps/command_line/number.hpp"
#include "apps/command_line/parse.hpp"
#include "scenario/scenario.hpp"

namespace brume::cli {

/// What lights the frames: the lights of the scenario, one from a direction, or none.
struct FlipbookLight {
  enum class Kind { own, one, none } kind = Kind::own;
  glm::vec3 from_world{0, 1, 0};  ///< Kind::one: unit vector towards it.
  float irradiance = 0;           ///< Kind::one: on a surface that faces it.
};
/// Replaces the lights of a scenario.
void set_light(const FlipbookLight& light, scenario::Scenario& scenario);

/// What a flipbook is drawn of.
struct FlipbookJob {
  const FlipbookPlan& plan;
  FrameRange range;  ///< Its first frame is the first tile, its last one the last.
  FrameRate rate;
  scene::Camera camera;      ///< At the first frame.
  bool is_still = false;     ///< Whether all frames show the same.
  bool is_turn = false;      ///< Whether the camera turns: the last tile comes before the first one.
  bool is_sequence = false;  ///< Whether each frame is a file, so that there is nothing to show between two.
  bool fits_camera =
      false;  ///< Whether the camera may be turned and zoomed so that what is seen fills the tiles.
  /// Frames under a light. The result must be destroyed before the next call.
  std::function<std::unique_ptr<FrameSource>(const FlipbookLight&)> frames_under;
};
/// Draws and writes the sheets and their description; returns the description with statistics. Throws Error
/// and Interrupted.
Json write_flipbook(FlipbookJob job);

}  // namespace brume::cli
