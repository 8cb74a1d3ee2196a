// Plays a timeline: loads its scene, floods its rooms, draws any moment of it.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>

#include "core/progress.hpp"
#include "image/image.hpp"
#include "render/renderer.hpp"
#include "scene/timeline.hpp"
#include "sim/world.hpp"
#include "voxel/vxl_file.hpp"

namespace brume::render {

/// What a timeline needs before a device is asked for: nothing here touches Vulkan.
struct Stage {
  scene::Timeline timeline;
  scene::Scene scene;
  scene::Camera camera;  ///< Where the timeline has no camera keys.
  voxel::Voxels voxels;
};

/// Loads a timeline (.toml), or a scene file with the timeline that fits it. Voxels are kept beside the
/// scene's name in `cache_folder` (empty: not kept).
Result<Stage> load_stage(const std::filesystem::path& input, const std::filesystem::path& cache_folder);

/// The same for a timeline that is already there; its scene is loaded from Timeline::scene.
Result<Stage> make_stage(scene::Timeline timeline, const std::filesystem::path& cache_folder);

/// The simulation of a stage at any time.
class Simulation {
 public:
  /// `stage` must outlive it. Fails with bad_input when an event cannot be.
  static Result<std::unique_ptr<Simulation>> create(const Stage& stage);

  /// Moves to the tick at or before a time [s].
  void advance_to(double seconds);
  const sim::World& world() const { return world_; }
  const sim::SmokeVolume& volume() const { return volume_; }

 private:
  explicit Simulation(const Stage& stage);
  sim::World world_;
  sim::SmokeVolume volume_;
};

/// What a renderer shows of a stage at a time. `holes` keeps the holes that the result refers to.
FrameInput frame_input(const Stage& stage, const Simulation& simulation, double seconds,
                       std::vector<shared::Hole>& holes);

/// A stage on a device, frame after frame.
class Playback {
 public:
  /// `stage` must outlive it. Throws what Renderer and Simulation::create throw.
  Playback(gpu::Context& context, const Stage& stage, glm::uvec2 size_px);

  /// The picture at a time [s]: the same for the same time and frame index, whatever came before.
  image::Image8 draw(double seconds, std::uint32_t frame_index);
  /// Where the camera is instead of on the timeline's path; empty: on the path.
  void set_camera(const std::optional<scene::Camera>& camera) { camera_ = camera; }
  /// GPU times of the passes of the last frame.
  std::vector<gpu::Timings::Scope> timings() const { return runner_.timings(); }
  const Simulation& simulation() const { return *simulation_; }

 private:
  const Stage& stage_;
  std::unique_ptr<Simulation> simulation_;
  gpu::CommandRunner runner_;
  Renderer renderer_;
  gpu::Buffer pixels_;
  std::optional<scene::Camera> camera_;
};

}  // namespace brume::render
