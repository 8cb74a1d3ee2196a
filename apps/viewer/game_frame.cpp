#include "apps/viewer/game_frame.hpp"

namespace brume::viewer {

render::FrameInput frame_input(const Game& game, std::vector<shared::Hole>& holes,
                               scenario::VolumeWait wait) {
  const Session& session = game.session();
  const auto steered = game.steered_carriers();
  render::FrameInput input =
      planning::frame_input(session.live().scenario(), session.simulation(), session.seconds(), holes,
                            {wait, steered ? &*steered : nullptr});
  if (!game.choices().decals) input.decals.clear();
  input.view.camera = game.player().camera();
  input.debug = {game.choices().view, game.choices().slice};
  return input;
}

}  // namespace brume::viewer
