#include "render/playback.hpp"

#include <cmath>
#include <cstring>
#include <glm/gtc/matrix_transform.hpp>

#include "scene/load.hpp"
#include "voxel/voxelize.hpp"

namespace brume::render {
namespace {

std::uint32_t tick_at(const sim::World& world, double seconds) {
  return static_cast<std::uint32_t>(
      std::floor(std::max(0.0, seconds) * world.settings().ticks_per_second + 1e-9));
}

std::uint32_t milliseconds(float seconds) {
  return static_cast<std::uint32_t>(std::lround(seconds * 1000));
}

Result<voxel::GridFrame> grid_frame(const scene::Timeline& timeline, const scene::Scene& scene) {
  // Room around the scene for a whole smoke in open air: a ball of its voxels, and its soft rim.
  const auto& grid = timeline.grid;
  const int margin =
      2 + static_cast<int>(std::cbrt(static_cast<float>(timeline.smoke.voxels) * 0.75f / 3.14159f) * 1.2f);
  auto frame = voxel::frame_around(scene::world_bounds(scene), grid.voxel, margin);
  if (!frame && !(grid.size && grid.origin_world)) return frame;
  voxel::GridFrame chosen = frame ? *frame : voxel::GridFrame{glm::ivec3(1), grid.voxel, glm::vec3(0)};
  if (grid.size) chosen.size = *grid.size;
  if (grid.origin_world) chosen.origin_world = *grid.origin_world;
  return chosen;
}

glm::mat4 grenade_matrix(const sim::Grenade& grenade) {
  const glm::mat4 moved = glm::translate(glm::mat4(1), grenade.position_world);
  // It tumbles: about one and a half turns a second, around an axis askew.
  return glm::rotate(moved, 9.0f * grenade.flight_seconds, glm::normalize(glm::vec3(1.0f, 0.35f, 0.2f)));
}

Result<void> append_events(const scene::Timeline& timeline, sim::World& world) {
  for (const scene::SmokeEvent& event : timeline.smokes) {
    sim::ThrowSmoke thrown;
    thrown.tick = tick_at(world, event.time);
    thrown.from = sim::position_from_metres(glm::dvec3(event.from_world));
    thrown.at = sim::position_from_metres(glm::dvec3(event.at_world));
    thrown.smoke.voxels = timeline.smoke.voxels;
    thrown.smoke.bloom_ticks = std::max(1u, tick_at(world, timeline.smoke.bloom));
    if (auto done = world.append(thrown); !done) return done;
  }
  for (const scene::ShotEvent& event : timeline.shots) {
    sim::Shot shot;
    shot.tick = tick_at(world, event.time);
    shot.origin = sim::position_from_metres(glm::dvec3(event.from_world));
    shot.toward = sim::position_from_metres(glm::dvec3(event.toward_world));
    shot.radius = static_cast<std::uint32_t>(std::lround(event.radius * sim::kUnitsPerMetre));
    shot.timing = {milliseconds(event.reach), milliseconds(event.expand), milliseconds(event.stay),
                   milliseconds(event.fade)};
    if (auto done = world.append(shot); !done) return done;
  }
  return {};
}

}  // namespace

Result<Stage> load_stage(const std::filesystem::path& input, const std::filesystem::path& cache_folder) {
  if (input.extension() == ".toml") {
    auto timeline = scene::load_timeline(input);
    if (!timeline) return timeline.failure();
    return make_stage(std::move(*timeline), cache_folder);
  }
  auto scene = scene::load_scene(input);
  if (!scene) return scene.failure();
  return make_stage(scene::timeline_for_scene(input, *scene), cache_folder);
}

Result<Stage> make_stage(scene::Timeline timeline, const std::filesystem::path& cache_folder) {
  auto scene = scene::load_scene(timeline.scene);
  if (!scene) return scene.failure();
  // A scene without any lamp is shown by day.
  if (scene->lights.empty()) {
    scene::Light sun;
    sun.kind = scene::LightKind::directional;
    sun.direction_world = glm::normalize(glm::vec3(-0.5f, -0.75f, -0.4f));
    sun.intensity = {2.6f, 2.4f, 2.1f};
    scene->lights.push_back(sun);
  }
  const auto frame = grid_frame(timeline, *scene);
  if (!frame) return frame.failure();
  std::filesystem::path cache;
  if (!cache_folder.empty()) cache = cache_folder / timeline.scene.filename().replace_extension(".vxl");
  auto voxels = voxel::load_or_voxelize(*scene, *frame, cache);
  if (!voxels) return voxels.failure();
  const scene::Camera camera = scene->camera ? *scene->camera : scene::default_camera(*scene);
  return Stage{std::move(timeline), std::move(*scene), camera, std::move(*voxels)};
}

Simulation::Simulation(const Stage& stage)
    : world_(stage.voxels.grid), volume_(stage.voxels.grid, [&planes = stage.voxels.planes](glm::ivec3 cell) {
        return planes.at(cell);
      }) {}

Result<std::unique_ptr<Simulation>> Simulation::create(const Stage& stage) {
  std::unique_ptr<Simulation> simulation(new Simulation(stage));
  if (auto done = append_events(stage.timeline, simulation->world_); !done) return done.failure();
  return simulation;
}

void Simulation::advance_to(double seconds) {
  world_.advance_to(tick_at(world_, seconds));
  volume_.update(world_);
}

FrameInput frame_input(const Stage& stage, const Simulation& simulation, double seconds,
                       std::vector<shared::Hole>& holes) {
  const scene::Timeline& timeline = stage.timeline;
  FrameInput input;
  input.camera = scene::camera_at(timeline, stage.camera, seconds);
  input.sky = {timeline.sky.zenith, timeline.sky.horizon, timeline.sky.ambient, timeline.sky.stars};
  const scene::SmokeOptions& smoke = timeline.smoke;
  input.look.albedo = smoke.albedo;
  input.look.extinction = smoke.extinction;
  input.look.anisotropy = smoke.anisotropy;
  input.look.step_length = 0.4f * stage.voxels.grid.frame().voxel_size;
  input.look.stop = 0.01f;
  input.look.erosion = smoke.noise;
  input.look.noise_period = static_cast<float>(passes::kSmokeNoise.coarse_cells) * smoke.noise_size;
  input.look.noise_drift = 0.35f;
  input.look.scatter_octaves = 3;
  input.look.hole_rim = 0.06f;
  input.exposure = std::exp2(timeline.exposure);
  input.time = static_cast<float>(seconds);
  input.volume = &simulation.volume();
  holes = simulation.world().holes();
  input.holes = holes;
  for (const sim::Grenade& grenade : simulation.world().grenades())
    input.grenades.push_back(grenade_matrix(grenade));
  return input;
}

Playback::Playback(gpu::Context& context, const Stage& stage, glm::uvec2 size_px)
    : stage_(stage),
      simulation_(Simulation::create(stage).value_or_throw()),
      runner_(context),
      renderer_(context, runner_, stage.scene, {size_px, false}),
      pixels_(context, std::size_t{4} * size_px.x * size_px.y, VK_BUFFER_USAGE_TRANSFER_DST_BIT,
              gpu::MemoryUse::readback) {}

image::Image8 Playback::draw(double seconds, std::uint32_t frame_index) {
  simulation_->advance_to(seconds);
  std::vector<shared::Hole> holes;
  FrameInput input = frame_input(stage_, *simulation_, seconds, holes);
  input.frame_index = frame_index;
  if (camera_) input.camera = *camera_;
  renderer_.prepare(input);
  runner_.run([&](gpu::Recorder& recorder) {
    renderer_.record_frame(recorder, input);
    recorder.read_back(renderer_.display(), pixels_);
  });
  image::Image8 picture;
  picture.width = renderer_.size_px().x;
  picture.height = renderer_.size_px().y;
  picture.rgba.resize(pixels_.size());
  std::memcpy(picture.rgba.data(), pixels_.mapped(), picture.rgba.size());
  return picture;
}

}  // namespace brume::render
