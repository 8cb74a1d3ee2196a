// Lenses and shutters: which points of a lens, of a pixel and of a shutter's time a picture is the mean of.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "planning/frame_input.hpp"
#include "scenario/lens_openings.hpp"
#include "shared/optics.h"

namespace brume::scenario {

/// A point of the unit disk, or of the regular polygon of `blades` edges, at least 3, whose corners lie on
/// its edge, one at (0, 1); evenly distributed for evenly distributed `u` in [0, 1)^2.
inline glm::vec2 point_on_lens(std::uint32_t blades, const glm::vec2& u) {
  return shared::lens_point(blades, u);
}
/// The same, or a point of [-1, 1]^2 distributed as an image of the opening says; null: none.
inline glm::vec2 point_on_lens(std::uint32_t blades, const LensOpening* opening, const glm::vec2& u) {
  return opening ? opening->point(u) : point_on_lens(blades, u);
}

/// The opening of a lens, if it is an image; it must be among them.
const LensOpening* opening_of(const LensOpenings& openings, const scene::Lens& lens);

/// What a pinhole sees at a time of the shutter.
struct CameraSample {
  planning::ViewSample view;
  float time = 0;  ///< While the shutter is open, [0, 1].
};

/// The samples whose mean is the picture of a camera with a lens and a shutter, in the order of their times.
/// One: the pinhole in the middle of the lens when the shutter opens. Owen-scrambled Sobol points; the same
/// for the same number.
std::vector<CameraSample> camera_samples(std::uint32_t count, const scene::Lens& lens,
                                         const LensOpening* opening);

/// How many samples a picture has if nothing else is said: one for a pinhole without a shutter.
inline std::uint32_t usual_samples(const scene::Camera& camera) {
  constexpr std::uint32_t kUsual = 64;
  return camera.lens.aperture > 0 || camera.shutter > 0 ? kUsual : 1;
}

}  // namespace brume::scenario
