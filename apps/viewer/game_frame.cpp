#include "apps/viewer/game_frame.hpp"

namespace brume::viewer {
namespace {

/// The frame of a game with options that say what is steered.
render::FrameInput input_of(const Game& game, const scenario::FrameOptions& options,
                            std::vector<shared::Hole>& holes) {
  const Session& session = game.session();
  render::FrameInput input = scenario::frame_input(session.live().scenario(), session.simulation(),
                                                   session.seconds(), holes, options);
  if (!game.choices().decals) input.decals.clear();
  input.debug = {game.choices().view, game.choices().slice};
  return input;
}

/// Where the camera is around the time of a game: on its path as long as it follows that, else at rest.
scenario::CameraAt camera_of(const Game& game) {
  return [&game, still = game.player().camera()](double seconds) {
    const Session& session = game.session();
    if (!session.follows_path() || seconds == session.seconds()) return still;
    return with_optics(session.path_camera(seconds), optics_of(still));
  };
}

}  // namespace

render::FrameInput frame_input(const Game& game, std::vector<shared::Hole>& holes, volumes::VolumeWait wait) {
  const auto steered = game.steered_carriers();
  return input_of(
      game,
      {.wait = wait, .steered = steered ? &*steered : nullptr, .camera = camera_of(game), .tank_samples = 1},
      holes);
}

StillFrame::StillFrame(const Game& game) : steered_(game.steered_carriers()) {
  const scenario::FrameOptions options{.steered = steered_ ? &*steered_ : nullptr, .camera = camera_of(game)};
  render::FrameInput input = input_of(game, options, holes_);
  // Edges stay as smooth as they are in motion.
  constexpr std::uint32_t kSmooth = 4;
  const bool smooth = game.choices().temporal && input.debug.view == planning::DebugView::none;
  const std::uint32_t count = std::max(scenario::usual_samples(input.view.camera), smooth ? kSmooth : 1);
  samples_.emplace(game.session().live().scenario(), game.session().seconds(), options, std::move(input),
                   count);
}

}  // namespace brume::viewer
