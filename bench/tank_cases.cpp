#include <algorithm>
#include <cmath>

#include "bench/bench.hpp"
#include "bench/lens_points.h"
#include "brume_bench_shaders.hpp"
#include "passes/blue_noise.hpp"
#include "planning/tank_plan.hpp"
#include "render/parts/tanks.hpp"
#include "render/tank_picture.hpp"
#include "scenario/tank.hpp"
#include "scene/files/tank_reader.hpp"
#include "spheres/brick_lists.hpp"
#include "spheres/pack.hpp"

namespace brume::bench {
namespace {

/// The size of the tanks that the figures are for.
constexpr glm::uvec3 kSize(600, 600, 200);
constexpr glm::uvec2 kPicture(1920, 1080);

spheres::PackOptions pack_options(std::uint32_t count, float opacity = 1) {
  spheres::PackOptions options;
  options.size = kSize;
  options.count = count;
  options.opacity = opacity;
  // Sphere for sphere the same share of the tank.
  options.radius *= std::cbrt(65535.0f / static_cast<float>(count));
  return options;
}

const spheres::Tank& tank_of(std::uint32_t count, float opacity = 1) {
  static std::map<std::pair<std::uint32_t, float>, spheres::Tank> tanks;
  auto& tank = tanks[{count, opacity}];
  if (tank.spheres.empty()) tank = spheres::pack(pack_options(count, opacity)).value_or_throw();
  return tank;
}

/// GPU time of a pass over many recordings.
Measurement time_pass(Bench& bench, gpu::CommandRunner& runner, const std::string& name,
                      const std::vector<std::string>& passes,
                      const std::function<void(gpu::Recorder&)>& record) {
  const bool slow = bench.is_slow();
  for (unsigned i = 0; i < (slow ? 1u : 20u); ++i) runner.run(record);
  std::vector<double> times;
  for (unsigned i = 0; i < bench.repetitions(slow ? 3 : 100); ++i) {
    runner.run(record);
    double sum = 0;
    for (const auto& scope : runner.timings())
      if (std::ranges::find(passes, scope.name) != passes.end()) sum += scope.milliseconds;
    times.push_back(sum);
  }
  return summarize(name, "ms", "gpu", std::move(times));
}

Result<std::vector<Measurement>> pack_case(Bench& bench, std::uint32_t count) {
  std::size_t packed = 0;
  Measurement m = bench.time_calls("tank/pack/" + std::to_string(count), 3, [&] {
    packed = spheres::pack(pack_options(count)).value_or_throw().spheres.size();
  });
  m.details = {{"spheres", static_cast<double>(packed)}};
  return std::vector{m};
}

Result<std::vector<Measurement>> voxels_case(Bench& bench, bool painted) {
  const spheres::Tank& tank = tank_of(65535);
  gpu::CommandRunner runner(bench.context());
  const spheres::BrickLists lists = spheres::list_bricks(tank);
  passes::TankVolume volume(bench.context(), runner, tank, lists);
  volume.add_ids(bench.context());
  if (painted) volume.add_colors(bench.context());
  const passes::SphereVoxelsPass pass(bench.context());
  Measurement m = time_pass(bench, runner, painted ? "tank/ids_and_colors" : "tank/ids", {"voxels"},
                            [&](gpu::Recorder& recorder) {
                              const gpu::Scope scope(recorder, "voxels");
                              pass.record(recorder, volume);
                            });
  m.details = {{"voxels", double{kSize.x} * kSize.y * kSize.z}};
  return std::vector{m};
}

Result<std::vector<Measurement>> light_case(Bench& bench, float opacity, scene::TankLighting lighting,
                                            const std::string& name) {
  const spheres::Tank& tank = tank_of(65535, opacity);
  gpu::CommandRunner runner(bench.context());
  const spheres::BrickLists lists = spheres::list_bricks(tank);
  passes::TankVolume volume(bench.context(), runner, tank, lists);
  volume.add_colors(bench.context());
  const passes::SphereVoxelsPass voxels(bench.context());
  const gpu::Image light = passes::make_voxel_light(bench.context(), kSize);
  passes::TankLightPass pass(bench.context());
  const std::vector<shared::TankLight> lights{{{-180, 940, 760}, 0, glm::vec3(1e6f)}};
  pass.reserve(volume, lights, lighting);
  runner.run([&](gpu::Recorder& recorder) { voxels.record(recorder, volume); });
  Measurement m =
      time_pass(bench, runner, name, {"tank_light_map", "tank_light"},
                [&](gpu::Recorder& recorder) { pass.record(recorder, volume, light, glm::vec3(0)); });
  for (const auto& scope : runner.timings()) m.details[std::string(scope.name)] = scope.milliseconds;
  return std::vector{m};
}

struct Picture {
  std::string name;
  scene::TankView view = scene::TankView::spheres;
  std::uint32_t bounces = 0;
  bool optics = false;
  float opacity = 1;
  std::uint32_t spheres = 65535;
  bool ids = false;
  std::uint32_t photons = 0;
};

Result<std::vector<Measurement>> picture_case(Bench& bench, const Picture& picture) {
  const glm::uvec2 size = bench.is_slow() ? glm::uvec2(640, 360) : kPicture;
  const spheres::Tank& tank = tank_of(picture.spheres, picture.opacity);
  scene::TankScene scene = scene::scene_of_tank_file({});
  scene.view = picture.view;
  scene.bounces = picture.bounces;
  scene::Camera camera;
  camera.position_world = {0, 0, 1.6f};  // The tank fills the picture.
  camera.target_world = {0, 0, 0};
  camera.vertical_fov = 0.7f;
  if (picture.optics) {
    scene.glass.emplace();
    scene.glass->position_world = {0, 0, 0.8f};
    scene.glass->radii = {0.4f, 0.4f, 0.2f};
    camera.lens.aperture = 0.03f;
    camera.lens.blades = 6;
  }
  gpu::CommandRunner runner(bench.context());
  render::TankPicture drawn(bench.context(), runner, tank, picture.ids);
  const planning::TankPlan plan = planning::plan_tank(scene, tank, 0, size, camera);
  drawn.show(plan, planning::plan_tank_display(scene, size));
  if (picture.photons > 0) {
    spheres::LightPathOptions options;
    options.count = picture.photons;
    drawn.set_photons(spheres::trace_light_paths(tank, spheres::list_bricks(tank),
                                                 planning::light_path_scene(plan), options));
  }
  Measurement m = time_pass(bench, runner, picture.name, {"tank"},
                            [&](gpu::Recorder& recorder) { drawn.record(recorder, {1}); });
  m.details = {{"width", double(size.x)}, {"height", double(size.y)}};
  for (const auto& scope : runner.timings()) m.details[std::string(scope.name)] = scope.milliseconds;
  return std::vector{m};
}

/// The same in a frame, over its surfaces, of which there are none.
Result<std::vector<Measurement>> frame_case(Bench& bench, const Picture& picture) {
  const glm::uvec2 size = bench.is_slow() ? glm::uvec2(640, 360) : kPicture;
  const spheres::Tank& tank = tank_of(picture.spheres, picture.opacity);
  planning::FrameInput frame;
  planning::TankInput& input = frame.tanks.emplace_back();
  input.content =
      std::make_shared<const scene::TankContent>(scene::TankContent{tank, spheres::list_bricks(tank)});
  scene::TankScene scene = scene::scene_of_tank_file({});
  scene.bounces = picture.bounces;
  input.light = std::make_shared<const scene::TankIllumination>(scene::TankIllumination{scene, {}});
  input.view = picture.view;
  scene::Camera& camera = frame.view.camera;
  camera.position_world = {0, 0, 1.6f};
  camera.vertical_fov = 0.7f;
  gpu::CommandRunner runner(bench.context());
  const auto image = [&](VkFormat format) {
    return gpu::Image(bench.context(), gpu::storage_image(size, format, VK_IMAGE_USAGE_TRANSFER_DST_BIT));
  };
  const gpu::Image depth = image(VK_FORMAT_R32_SFLOAT), media = image(VK_FORMAT_R16G16B16A16_SFLOAT);
  gpu::Image blue_noise;
  runner.run([&](gpu::Recorder& recorder) {
    blue_noise = passes::make_blue_noise(bench.context(), recorder);
    recorder.clear(media, {});
  });
  render::TanksPart tanks(bench.context(), runner, size, render::TanksPart::Over::host);
  tanks.prepare(frame, size);
  Measurement m =
      time_pass(bench, runner, picture.name, {"tank", "tank_layers"}, [&](gpu::Recorder& recorder) {
        recorder.clear(depth, {});
        tanks.record_surfaces(recorder, depth, blue_noise);
        tanks.record_layers(recorder, media);
      });
  m.details = {{"width", double(size.x)}, {"height", double(size.y)}};
  for (const auto& scope : runner.timings()) m.details[std::string(scope.name)] = scope.milliseconds;
  return std::vector{m};
}

Result<std::vector<Measurement>> lens_case(Bench& bench, std::uint32_t blades) {
  constexpr std::uint32_t kThreads = 1u << 20, kPoints = 64;
  gpu::CommandRunner runner(bench.context());
  gpu::Buffer sums;
  gpu::grow(bench.context(), sums, kThreads * sizeof(glm::vec2));
  std::vector<Measurement> measured;
  for (const bool rejects : {false, true}) {
    const gpu::ComputePipeline pipeline(bench.context(), shaders::lens_points_comp, {rejects ? 1u : 0u});
    const std::string name =
        std::string(rejects ? "lens/rejection/" : "lens/remap/") + std::to_string(blades);
    measured.push_back(time_pass(bench, runner, name, {"points"}, [&](gpu::Recorder& recorder) {
      const gpu::Scope scope(recorder, "points");
      recorder.bind(pipeline, {{shared::kBindLensSums, gpu::write(sums)}},
                    shared::LensPointsParams{kPoints, blades});
      recorder.dispatch_threads(pipeline, bench.is_slow() ? kThreads / 64 : kThreads);
    }));
  }
  return measured;
}

}  // namespace

std::vector<Case> tank_cases() {
  std::vector<Case> cases;
  for (const std::uint32_t count : {65535u, 100000u, 1000000u})
    cases.push_back({"tank/pack/" + std::to_string(count),
                     "packing of as many spheres in 600 x 600 x 200 voxels",
                     [count](Bench& b) { return pack_case(b, count); }});
  cases.push_back({"tank/ids", "ids of 65,535 spheres in 600 x 600 x 200 voxels",
                   [](Bench& b) { return voxels_case(b, false); }});
  cases.push_back(
      {"tank/ids_and_colors", "the same with painting", [](Bench& b) { return voxels_case(b, true); }});
  const auto add_light = [&](const char* name, const char* what, float opacity,
                             scene::TankLighting lighting) {
    cases.push_back({name, what, [=](Bench& b) { return light_case(b, opacity, lighting, name); }});
  };
  add_light("tank/light", "one light on all voxels of opaque spheres", 1, scene::TankLighting::maps);
  add_light("tank/light_exact", "the same voxel by voxel", 1, scene::TankLighting::exact);
  add_light("tank/light_clear", "one light on all voxels of spheres that light passes", 0.05f,
            scene::TankLighting::maps);
  add_light("tank/light_clear_exact", "the same voxel by voxel", 0.05f, scene::TankLighting::exact);
  const std::vector<std::pair<Picture, const char*>> pictures{
      {{"tank/spheres"}, "exact spheres at 1080p, direct light; 640x360 without a GPU"},
      {{"tank/spheres_scattered", scene::TankView::spheres, 2}, "the same with two bounces"},
      {{"tank/spheres_with_ids", scene::TankView::spheres, 0, false, 1, 65535, true},
       "the same by ids of voxels"},
      {{"tank/glass", scene::TankView::spheres, 0, true}, "through lens and glass, direct light"},
      {{"tank/glass_scattered", scene::TankView::spheres, 2, true}, "the same with two bounces"},
      {{"tank/photons", scene::TankView::spheres, 2, true, 1, 65535, false, 1u << 20},
       "the same with a million light paths"},
      {{"tank/media", scene::TankView::spheres, 1, false, 0.1f}, "spheres that light passes, one bounce"},
      {{"tank/million", scene::TankView::spheres, 0, false, 1, 1000000}, "a million spheres, direct light"},
      {{"tank/voxels", scene::TankView::voxels}, "painted voxels"}};
  for (const auto& one : pictures)
    cases.push_back(
        {one.first.name, one.second, [picture = one.first](Bench& b) { return picture_case(b, picture); }});
  const std::vector<std::pair<Picture, const char*>> frames{
      {{"tank/frame"}, "exact spheres in a host's frame at 1080p, direct light"},
      {{"tank/frame_scattered", scene::TankView::spheres, 2}, "the same with two bounces"},
      {{"tank/frame_voxels", scene::TankView::voxels}, "painted voxels in a host's frame"}};
  for (const auto& one : frames)
    cases.push_back(
        {one.first.name, one.second, [picture = one.first](Bench& b) { return frame_case(b, picture); }});
  for (const std::uint32_t blades : {6u, 5u, 9u})
    cases.push_back({"lens/" + std::to_string(blades), "2^26 points of a lens by the remap and by rejection",
                     [blades](Bench& b) { return lens_case(b, blades); }});
  return cases;
}

}  // namespace brume::bench
