// Pictures of a tank on a device: samples are added until it is as smooth as wanted.
#pragma once

#include <functional>

#include "image/image.hpp"
#include "passes/display.hpp"
#include "passes/tank.hpp"
#include "passes/tank_light.hpp"
#include "planning/tank_plan.hpp"
#include "spheres/light_paths.hpp"

namespace brume::render {

class TankRenderer {
 public:
  /// Of a workgroup: what parts of a sample are multiples of.
  static constexpr std::uint32_t kRows = 8;

  /// Uploads the tank and finds its voxels. `context` and `stream` must outlive it, `tank` need not. Throws
  /// resource_limit when the device has too little memory.
  /// `with_ids`: finds the ids of all voxels and traces those instead of the spheres of bricks: more memory,
  /// and slower on every device so far (docs/performance.md).
  TankRenderer(gpu::Context& context, gpu::CommandStream& stream, const spheres::Tank& tank,
               glm::uvec2 size_px, bool with_ids = false);

  /// What stands for the spheres from the next picture on; voxels need more memory. When the device is done
  /// with what was recorded before. Throws resource_limit.
  void set_kind(scene::TankView kind);
  /// How voxels are lit from the next picture on.
  void set_lighting(scene::TankLighting lighting);
  /// What the samples from the next one on show: the picture begins again. When the device is done with what
  /// was recorded before.
  void set_view(const planning::TankPlan& plan, const planning::TankDisplay& display);
  /// Light that comes through the glass, from the next picture on: that of the view's lights. When the device
  /// is done with what was recorded before. Throws resource_limit.
  void set_photons(const spheres::LightPaths& paths);
  /// Other paths of the same light, for the samples from now on: the picture goes on. Otherwise as
  /// set_photons.
  void replace_photons(const spheres::LightPaths& paths);
  /// Light paths are traced again for every few samples, with this number as their seed: what their noise
  /// leaves in one batch averages out over all.
  static constexpr std::uint32_t kSamplesOfBatch = 16;
  static constexpr std::uint32_t batch_of(std::uint32_t samples) { return samples / kSamplesOfBatch; }
  /// Pictures of another size from the next one on. When the device is done with what was recorded before.
  void resize(glm::uvec2 size_px);
  /// Exposure, tone curve and dither alone: the picture goes on.
  void set_display(const planning::TankDisplay& display) { display_ = display; }

  /// Records `count` more samples of each pixel, and the picture so far.
  void record_samples(gpu::Recorder& recorder, std::uint32_t count);
  /// Records a part of one more sample of each pixel: as many rows, from the top to the bottom; with the last
  /// ones the sample and the picture are complete.
  void record_rows(gpu::Recorder& recorder, std::uint32_t rows);
  /// Records the picture so far with the exposure and the tone curve that it has now. Not before the first
  /// sample.
  void record_display(gpu::Recorder& recorder);
  /// So far, of every pixel.
  std::uint32_t samples() const { return samples_; }
  /// Of one more sample.
  std::uint32_t rows() const { return rows_; }

  const gpu::Image& radiance() const { return radiance_; }  ///< Half floats.
  const gpu::Image& sum() const { return sum_; }            ///< Floats: of the radiance of all samples.
  const gpu::Image& display() const { return shown_; }      ///< RGBA8, sRGB.
  const passes::TankVolume& volume() const { return volume_; }

 private:
  void find_voxels();
  void record_upload(gpu::Recorder& recorder);
  void record_light(gpu::Recorder& recorder);
  void record_dispatch(gpu::Recorder& recorder, std::uint32_t count, std::uint32_t rows);

  /// What the voxel view needs besides the tank's volume.
  struct Voxels {
    Voxels(gpu::Context& context, const glm::ivec3& size)
        : light_pass(context), pass(context), light(passes::make_voxel_light(context, glm::uvec3(size))) {}
    passes::TankLightPass light_pass;
    passes::TankVoxelsPass pass;
    gpu::Image light;
    bool is_lit = false;
  };

  gpu::Context& context_;
  gpu::CommandStream& stream_;
  passes::TankVolume volume_;
  passes::TankSpheresPass spheres_pass_;
  passes::SphereVoxelsPass sphere_voxels_pass_;
  std::optional<Voxels> voxels_;  ///< From the first picture of voxels on.
  passes::DisplayPass display_pass_;
  gpu::Image blue_noise_, sum_, radiance_, shown_;
  gpu::Buffer constants_, lights_, frame_, photons_, photon_cells_;
  planning::TankPlan plan_;
  shared::PhotonGrid photon_grid_{0, 0};
  planning::TankDisplay display_;
  scene::TankView kind_ = scene::TankView::spheres;
  scene::TankLighting lighting_ = scene::TankLighting::maps;
  std::uint32_t samples_ = 0, rows_ = 0;
};

}  // namespace brume::render
