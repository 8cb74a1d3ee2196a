// The holes of a state as points in space: what renderer and line of sight cut out of the smoke.
#pragma once

#include <glm/glm.hpp>
#include <vector>

#include "shared/hole.h"
#include "sim/state.hpp"
#include "smoke/mask_atlas.hpp"

namespace brume::smoke {

/// Axes of a shot's hole, with its roll: unit vectors, right x up = -forward.
struct ShotAxes {
  glm::dvec3 right{0}, up{0}, forward{0};
};
ShotAxes axes_of(const sim::Shot& shot);

/// A hole as points in space ask for it (shared/hole.h), but for the rectangle of a mask: the same bits on
/// every machine.
shared::Hole hole_of(const sim::BulletHole& open, const sim::State& state);
/// All of them, with the rectangles. `masks` are those that the state was made with; null: it has none.
/// Throws Error(bad_input) where one is a mask and `masks` are others.
std::vector<shared::Hole> holes_of(const sim::State& state, const MaskAtlas* masks = nullptr);

}  // namespace brume::smoke
