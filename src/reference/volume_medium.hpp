// A volume of a frame as a medium.
#pragma once

#include <functional>
#include <vector>

#include "planning/frame_input.hpp"
#include "reference/brick_field.hpp"
#include "reference/medium.hpp"
#include "smoke/noise_tile.hpp"

namespace brume::reference {

/// The curves of a transfer function, and their upper bounds.
class TransferCurve {
 public:
  TransferCurve() = default;
  TransferCurve(const planning::TransferInput& transfer, const glm::vec3& albedo);

  bool has_opacity() const { return kind_ == shared::kTransferOpacity; }
  bool empty() const { return kind_ == shared::kTransferNone; }
  /// Colour times opacity, and opacity, of a value: their mean over a cell of the table around it.
  glm::vec4 at(float value) const;
  /// At least the opacity of any value from `low` to `high`.
  float largest_opacity(float low, float high) const;
  float scattered() const { return device_.scattered; }
  float emitted() const { return device_.emitted; }

 private:
  std::uint32_t kind_ = shared::kTransferNone;
  shared::VolumeTransfer device_{};
  std::vector<glm::vec4> table_;
  std::vector<std::vector<float>> largest_;  // by level and cell: over 2^level cells from it on
};

class VolumeMedium final : public Medium {
 public:
  /// `volume` and the noise must outlive it. Asks for the noise if the volume is disturbed or has detail.
  VolumeMedium(const planning::VolumeInput& volume, const std::function<const smoke::SmokeNoise&()>& noise);

  float extinction(const glm::vec3& p_world) const override;
  glm::vec3 albedo(const glm::vec3& p_world) const override;
  glm::vec3 emission(const glm::vec3& p_world) const override;
  bool emits() const override { return emits_; }

 private:
  /// Where the volume is sampled for a point, or nothing.
  bool sample_point(const glm::vec3& p_world, glm::vec3& p_voxel) const;
  float density_at(const glm::vec3& p_voxel) const;
  /// What detail leaves of a density.
  float left_of(float density, const glm::vec3& p_voxel) const;
  float density_bound(float low, float high) const;
  glm::vec4 masks_at(const glm::vec3& p_voxel) const;
  int cell_voxels() const;
  void find_majorants();
  /// Divides cells in which few voxels are far above the rest: every ray through them would have possible
  /// collisions as densely as in those.
  void divide_cells(const Box<int>& all, float edge);
  void lower_least(const Box<int>& part, const Box<int>& all, float low);
  bool glows_in(const Box<int>& voxels) const;

  const planning::VolumeInput& input_;
  const smoke::SmokeNoise* noise_ = nullptr;
  shared::VolumeEffect effect_;
  shared::VolumeDetail detail_;
  BrickField<1> values_, heat_;
  BrickField<2> mask_pair_;
  BrickField<4> colors_;  // or masks
  bool has_colors_ = false, has_masks_ = false, is_pair_ = false, emits_ = false;
  TransferCurve transfer_;
  glm::mat4 heat_from_world_{1};
  std::vector<glm::vec3> heat_colors_;  // per metre, from a value of 0 to HeatInput::high; empty: no heat
};

}  // namespace brume::reference
