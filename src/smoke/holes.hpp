// The holes of a state in the world: what renderer and line of sight cut out of the smoke.
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

/// A hole as the shaders read it (shared/hole.h), without the rectangle of a mask: the same bits on every
/// machine.
shared::Hole make_hole(const sim::BulletHole& open, const sim::State& state);
/// All holes of a state, with their rectangles. `masks` belong to the state's timeline; null: it has none.
/// Throws Error(bad_input) where a hole is a mask and `masks` are others.
std::vector<shared::Hole> make_holes(const sim::State& state, const MaskAtlas* masks = nullptr);

}  // namespace brume::smoke
