// Which directions from which lights the smoke can dim, and the resolution that each is worth.
#pragma once

#include <span>

#include "core/box.hpp"
#include "planning/smoke_visibility.hpp"
#include "shared/frame.h"
#include "shared/light.h"
#include "shared/smoke_shadow.h"

namespace brume::planning {

struct SmokeShadowPlan {
  FrameVector<shared::SmokeShadowFace> faces;  ///< kFacesPerLight for each light, in their order.
  std::uint32_t blocks = 0;                    ///< Blocks of all faces together.
  bool operator==(const SmokeShadowPlan& other) const;
  /// The same with blocks of every `spread`th texel along both axes.
  SmokeShadowPlan spread_by(std::uint32_t spread, Allocator memory = {}) const;
};

/// The lights, and the camera that sees what they light.
struct SmokeShadowScene {
  std::span<const shared::Light> lights;
  glm::mat4 sun_clip_from_world{1};
  shared::Camera camera;
};

/// Edge of a texel at the far end of the smoke that is never undercut [m].
constexpr float kFinestSmokeShadow = 0.04f;

/// Gives each light that can reach smoke, and surfaces in view, rectangles of an atlas of this size,
/// disjoint, with texels of about one size in the world: as small as all of them fit, larger for what is
/// dim. When they do not fit at any size, the last lights get none.
SmokeShadowPlan plan_smoke_shadows(const SmokeShadowScene& scene, std::span<const Box<float>> smoke,
                                   glm::uvec2 atlas_size, Allocator memory = {});

}  // namespace brume::planning
