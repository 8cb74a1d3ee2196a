#include "planning/decal_plan.hpp"

#include <cmath>

namespace brume::planning {
namespace {

/// From the world to [0, 1]^3.
glm::dmat4 uvw_from_world(const glm::dmat4& world_from_uvw) {
  const glm::dmat4 inverse = glm::inverse(world_from_uvw);
  for (int column = 0; column < 4; ++column)
    for (int row = 0; row < 4; ++row)
      if (!std::isfinite(inverse[column][row]))
        throw Error(ErrorCode::bad_input, "the transform of a decal has no inverse; give it a scale above 0");
  return inverse;
}

}  // namespace

FrameVector<PlacedDecal> plan_decals(const FrameInput& input, const ViewFrustum& frustum, Allocator memory) {
  if (input.decals.size() > shared::kMaxDecals)
    throw Error(ErrorCode::bad_input, "a frame of " + std::to_string(input.decals.size()) +
                                          " decals; at most " + std::to_string(shared::kMaxDecals));
  FrameVector<PlacedDecal> placed(memory);
  placed.reserve(input.decals.size());
  for (const DecalInput& in : input.decals) {
    BRUME_ASSERT(input.slices && in.volume < input.slices->size(), std::to_string(in.volume));
    const grids::DenseGrid& grid = (*input.slices)[in.volume]->front();
    glm::dmat4 box_from_uvw(1);
    for (int axis = 0; axis < 3; ++axis) box_from_uvw[axis][axis] = grid.box.high[axis] - grid.box.low[axis];
    box_from_uvw[3] = glm::dvec4(grid.box.low, 1);
    const glm::dmat4 world_from_uvw = glm::dmat4(in.world_from_box) * box_from_uvw;

    Box<float> bounds = kEmptyBox;
    for (int corner = 0; corner < 8; ++corner) {
      const glm::dvec3 at(corner & 1, corner >> 1 & 1, corner >> 2);
      const glm::vec3 p(world_from_uvw * glm::dvec4(at, 1));
      bounds = united(bounds, {p, p});
    }
    if (in.strength <= 0 || !frustum.may_intersect(bounds)) continue;
    shared::Decal decal{};
    decal.uvw_from_world = shared::affine_of(glm::mat4x3(glm::mat4(uvw_from_world(world_from_uvw))));
    decal.low_world = bounds.low;
    decal.high_world = bounds.high;
    // Normals keep their angles to the planes under any affine transform by its inverse, transposed.
    const glm::dmat3 box{glm::dmat4(in.world_from_box)}, normal = glm::transpose(glm::inverse(box));
    decal.up_world = glm::vec3(glm::normalize(normal * glm::dvec3(0, 1, 0)));
    decal.middle_world = glm::vec3(glm::dmat4(in.world_from_box) * glm::dvec4(in.middle, 1));
    decal.radius = in.radius * static_cast<float>(std::cbrt(std::abs(glm::determinant(box))));
    decal.scatter = in.scatter / glm::vec3(grid.size);
    decal.strength = in.strength;
    decal.gamma_off = (in.gamma - 1) * in.correction;
    decal.falloff = in.falloff;
    decal.fade = in.fade;
    placed.push_back({decal, in.volume});
  }
  return placed;
}

}  // namespace brume::planning
