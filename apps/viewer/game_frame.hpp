// A frame of a game, as a renderer takes it.
#pragma once

#include <vector>

#include "apps/viewer/game.hpp"
#include "render/playback.hpp"

namespace brume::viewer {

/// What a renderer shows of a game: what is steered where it is, and decals only if they are chosen. `holes`
/// keeps the holes that the result refers to.
render::FrameInput frame_input(const Game& game, std::vector<shared::Hole>& holes,
                               scenario::VolumeWait wait = scenario::VolumeWait::until_loaded);

}  // namespace brume::viewer
