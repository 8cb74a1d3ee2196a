#include "scenario/frame.hpp"

#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>

#include "planning/smoke_look.hpp"
#include "scenario/flashes.hpp"
#include "scenario/frame_volumes.hpp"
#include "smoke/holes.hpp"

namespace brume::scenario {
namespace {

glm::mat4 grenade_matrix(const sim::Grenade& grenade) {
  const glm::mat4 moved = glm::translate(glm::mat4(1), grenade.position_world);
  // It tumbles: about one and a half turns a second, around an oblique axis.
  return glm::rotate(moved, 9.0f * grenade.flight_seconds, glm::normalize(glm::vec3(1.0f, 0.35f, 0.2f)));
}

scene::Camera camera_of(const Scenario& scenario, double seconds, const FrameOptions& options) {
  return options.camera ? options.camera(seconds)
                        : scene::camera_at(scenario.timeline, scenario.camera, seconds);
}

std::span<const scene::Carrier> carriers_of(const Scenario& scenario, const FrameOptions& options) {
  return options.steered ? *options.steered : scenario.timeline.carriers;
}

/// Objects with carriers, which are not where the scene has them.
void add_moved_objects(const Scenario& scenario, std::span<const scene::Carrier> carriers, double seconds,
                       planning::FrameInput& input) {
  std::vector<std::uint32_t>& hidden = input.level.hidden_objects;
  for (scene::MovedObject& moved : scene::moved_objects(carriers, scenario.scene, seconds)) {
    const auto at = std::lower_bound(hidden.begin(), hidden.end(), moved.object);
    if (at != hidden.end() && *at == moved.object) continue;  // A door that is open.
    hidden.insert(at, moved.object);
    input.level.moved.push_back(moved);
  }
}

void add_decals(const Scenario& scenario, std::span<const scene::Carrier> carriers, double seconds,
                planning::FrameInput& input) {
  input.slices = scenario.slices.volumes;
  for (std::size_t i = 0; i < scenario.slices.of_decals.size(); ++i) {
    const scene::DecalOptions& options = scenario.timeline.decals[i];
    const SliceVolume& volume = scenario.slices.of_decals[i];
    input.decals.push_back({world_from_file(carriers, options, seconds) * volume.file_from_box, volume.volume,
                            options.strength, options.gamma, options.correction, options.falloff,
                            options.fade, options.scatter, volume.middle, volume.radius});
  }
}

/// Where a tank is, moved by its carrier.
planning::TankPlacement placement_of(std::span<const scene::Carrier> carriers, const scene::TankOptions& tank,
                                     double seconds) {
  const glm::mat4 pose = scene::pose_of(carriers, tank.carrier, seconds);
  return {glm::mat3(pose) * glm::mat3(scene::rotation_of(tank.rotation)),
          glm::vec3(pose * glm::vec4(tank.position_world, 1)), tank.scale};
}

/// Paths of a tank in a sample of a picture with that many; the first one's number is unique to the frame.
void set_samples(std::uint32_t samples, std::uint32_t frame_index, planning::TankInput& tank) {
  tank.samples = std::max(samples, 1u);
  tank.index = frame_index * tank.samples;
}

void add_tanks(const Scenario& scenario, std::span<const scene::Carrier> carriers, double seconds,
               const FrameOptions& options, planning::FrameInput& input) {
  for (std::size_t i = 0; i < scenario.tanks.size(); ++i) {
    const scene::TankOptions& tank = scenario.timeline.tanks[i];
    const LitTank& lit = scenario.tanks[i];
    planning::TankInput& shown = input.tanks.emplace_back();
    shown.content = lit.content;
    shown.light = lit.light;
    shown.placement = placement_of(carriers, tank, seconds);
    shown.view = tank.view.value_or(lit.light->scene.view);
    shown.continues = options.tank_samples.has_value();
    set_samples(options.tank_samples.value_or(tank.samples), input.view.frame_index, shown);
  }
}

/// Steps of the jitter's golden-ratio sequence a second. Of eight successive frames at 24, 25, 30, 48, 50, 60
/// or 120 frames per second, and the rates of television, the jitters leave no gap above 0.28 on average:
/// 0.15 is the least possible, 0.34 with random numbers, 0.65 with the simulation's ticks at 24.
constexpr double kJitterRate = 360;
/// So that a time that is rounded down belongs to its own step.
constexpr double kRounding = 1e-3;

}  // namespace

planning::FrameInput frame_input(const Scenario& scenario, const Simulation& simulation, double seconds,
                                 std::vector<shared::Hole>& holes, const FrameOptions& options) {
  const scene::Timeline& timeline = scenario.timeline;
  const std::span<const scene::Carrier> carriers = carriers_of(scenario, options);
  planning::FrameInput input;
  input.view.camera = camera_of(scenario, seconds, options);
  // Jitter and dither follow time, not the frame's number: the same time is the same image at any rate.
  input.view.frame_index = static_cast<std::uint32_t>(std::floor(seconds * kJitterRate + kRounding));
  input.environment.sky = {timeline.sky.zenith, timeline.sky.stars, timeline.sky.horizon, timeline.sky.bounce,
                           timeline.sky.ambient};
  input.environment.bounces = timeline.bounces;
  const scene::SmokeOptions& smoke = timeline.smoke;
  input.smoke.look = planning::smoke_look(smoke, scenario.voxels.grid.layout().voxel_size);
  input.smoke.swirl_period = double{smoke.swirl_period};
  input.smoke.state = &simulation.world().state();
  input.view.exposure = std::exp2(timeline.exposure);
  input.view.tone = timeline.tone;
  input.smoke.time = static_cast<float>(seconds);
  input.level.voxels = {&simulation.world().grid(), simulation.world().state().edits,
                        &simulation.world().solids().sight};
  input.smoke.volume = &simulation.volume();
  holes = smoke::make_holes(simulation.world().state(), &scenario.masks);
  input.smoke.holes = holes;
  input.environment.flashes = flashes_of(timeline, seconds);
  for (const sim::Grenade& grenade : sim::grenades_of(simulation.world().state()))
    input.level.grenades.push_back(grenade_matrix(grenade));
  add_volumes(scenario, carriers, seconds, options, input);
  const auto hidden = simulation.hidden_objects();
  input.level.hidden_objects.assign(hidden.begin(), hidden.end());
  add_moved_objects(scenario, carriers, seconds, input);
  // Where what moves will be is unknown.
  if (input.environment.bounces > 0 && carriers.empty()) input.level.next = simulation.next_level();
  add_decals(scenario, carriers, seconds, input);
  add_tanks(scenario, carriers, seconds, options, input);
  return input;
}

void move_frame(const Scenario& scenario, double from_seconds, double to_seconds, const FrameOptions& options,
                planning::FrameInput& input) {
  input.view.camera = camera_of(scenario, to_seconds, options);
  const std::span<const scene::Carrier> carriers = carriers_of(scenario, options);
  if (carriers.empty()) return;
  const std::vector<scene::MovedObject> moved = scene::moved_objects(carriers, scenario.scene, to_seconds);
  for (scene::MovedObject& object : input.level.moved)
    object = *std::ranges::lower_bound(moved, object.object, {}, &scene::MovedObject::object);
  // How a carrier moves between the two times.
  const auto moves = [&](const std::string& carrier) {
    const glm::dmat4 before(scene::pose_of(carriers, carrier, from_seconds));
    return glm::dmat4(scene::pose_of(carriers, carrier, to_seconds)) * glm::inverse(before);
  };
  const auto move = [](const glm::dmat4& by, std::initializer_list<glm::mat4*> matrices) {
    for (glm::mat4* matrix : matrices) *matrix = glm::mat4(by * glm::dmat4(*matrix));
  };
  for (planning::VolumeInput& volume : input.volumes)
    move(moves(scenario.timeline.volumes[volume.index].carrier),
         {&volume.world_from_voxel, &volume.world_from_preview, &volume.heat.world_from_voxel,
          &volume.heat.world_from_preview});
  for (planning::ParticleInput& particles : input.particles)
    move(moves(scenario.timeline.volumes[particles.index].carrier), {&particles.world_from_uvw});
  for (std::size_t i = 0; i < input.decals.size(); ++i)
    move(moves(scenario.timeline.decals[i].carrier), {&input.decals[i].world_from_box});
  for (std::size_t i = 0; i < input.tanks.size(); ++i)
    input.tanks[i].placement = placement_of(carriers, scenario.timeline.tanks[i], to_seconds);
}

FrameSamples::FrameSamples(const Scenario& scenario, double seconds, const FrameOptions& options,
                           planning::FrameInput frame, std::optional<std::uint32_t> count)
    : scenario_(scenario), seconds_(seconds), options_(options), frame_(std::move(frame)) {
  const scene::Camera& camera = frame_.view.camera;
  const std::uint32_t usual = frame_.debug.view == planning::DebugView::none ? usual_samples(camera) : 1;
  samples_ =
      camera_samples(count.value_or(usual), camera.lens, opening_of(scenario.lens_openings, camera.lens));
}

planning::FrameInput FrameSamples::seen(std::uint32_t i, planning::FrameInput frame) const {
  const CameraSample& sample = samples_[i];
  const float shutter = frame.view.camera.shutter;
  if (shutter > 0 && sample.time > 0)
    move_frame(scenario_, seconds_, seconds_ + double{shutter * sample.time}, options_, frame);
  frame.view.sample = sample.view;
  frame.view.frame_index += i;
  for (planning::TankInput& tank : frame.tanks)
    set_samples((tank.samples + count() - 1) / count(), frame.view.frame_index, tank);
  return frame;
}

}  // namespace brume::scenario
