// Samples of a tank's picture on a device, which are added up: over its own air, or over the surfaces of a
// frame.
#pragma once

#include <optional>

#include "passes/tank.hpp"
#include "passes/tank_light.hpp"
#include "planning/tank_plan.hpp"
#include "scene/tank_scene.hpp"
#include "spheres/light_paths.hpp"

namespace brume::render {

class TankSampler {
 public:
  /// Rows of a workgroup: what parts of a sample are multiples of.
  static constexpr std::uint32_t kRows = 8;

  /// Uploads the tank; resize must follow. `context` and `stream` must outlive it, `tank` and its `lists`
  /// need not. Throws resource_limit when the device has too little memory.
  /// `with_ids`: finds the ids of all voxels and traces those instead of the spheres of bricks: more memory,
  /// and slower on every device so far (bench/LOG.md).
  TankSampler(gpu::Context& context, gpu::CommandStream& stream, const spheres::Tank& tank,
              const spheres::BrickLists& lists, bool with_ids = false);

  // When the device is done with what was recorded before; all throw resource_limit, and the picture begins
  // again but for replace_photons.
  void restart() { done_.change(context_) = {}; }
  /// Pictures of another size.
  void resize(glm::uvec2 size_px);
  /// What the samples from the next one on show; voxels need more memory than spheres. `index`: of the first
  /// one; samples of other indices have other noise.
  void set_view(const planning::TankPlan& plan, std::uint32_t index = 0);
  /// Compiles what samples of the view need, which their recording would otherwise do. `over_surfaces`: they
  /// are recorded with `surfaces`.
  void reserve(bool over_surfaces);
  /// Light of the view's lights that comes through the glass, from the next picture on.
  void set_photons(const spheres::LightPaths& paths);
  /// Other paths of the same light, for the samples from now on: the picture goes on.
  void replace_photons(const spheres::LightPaths& paths);

  /// Records `count` more samples of each pixel. `surfaces`: as passes::TankTargets.
  void record_samples(gpu::Recorder& recorder, const gpu::Image& blue_noise, std::uint32_t count,
                      const gpu::Image* surfaces = nullptr);
  /// Records a part of one more sample of each pixel: as many rows, from the top to the bottom; with the last
  /// ones the sample is complete.
  void record_rows(gpu::Recorder& recorder, const gpu::Image& blue_noise, std::uint32_t rows);
  /// So far, of every pixel.
  std::uint32_t samples() const { return done_.get(context_).samples; }
  /// Rows of one more sample.
  std::uint32_t rows() const { return done_.get(context_).rows; }

  /// What the samples show.
  const planning::TankPlan& plan() const { return plan_; }
  const gpu::Image& radiance() const { return radiance_; }  ///< Half floats; the mean of all samples.
  const gpu::Image& sum() const { return sum_; }            ///< Floats: of the radiance of all samples.
  const passes::TankVolume& volume() const { return volume_; }

 private:
  void find_voxels();
  void record_upload(gpu::Recorder& recorder);
  void record_light(gpu::Recorder& recorder);
  void record_dispatch(gpu::Recorder& recorder, const gpu::Image& blue_noise, std::uint32_t count,
                       std::uint32_t rows, const gpu::Image* surfaces);

  /// What the voxel view needs besides the tank's volume.
  struct Voxels {
    Voxels(gpu::Context& context, const glm::ivec3& size)
        : light_pass(context), pass(context), light(passes::make_voxel_light(context, glm::uvec3(size))) {}
    passes::TankLightPass light_pass;
    passes::TankVoxelsPass pass;
    gpu::Image light;
    gpu::Recorded<bool> is_lit;
  };

  gpu::Context& context_;
  gpu::CommandStream& stream_;
  passes::TankVolume volume_;
  passes::TankSpheresPass spheres_pass_;
  std::optional<passes::SphereVoxelsPass> sphere_voxels_pass_;  ///< From the first need of voxels on.
  std::optional<Voxels> voxels_;                                ///< From the first picture of voxels on.
  gpu::Image sum_, radiance_;
  gpu::Buffer constants_, lights_, photons_, photon_cells_;
  planning::TankPlan plan_;
  shared::PhotonGrid photon_grid_{0, 0};
  /// What the picture consists of so far.
  struct Done {
    std::uint32_t samples = 0, rows = 0;
  };
  gpu::Recorded<Done> done_;
  std::uint32_t index_ = 0;
};

}  // namespace brume::render
