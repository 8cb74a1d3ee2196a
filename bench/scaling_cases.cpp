// Whether the frame time depends on what is visible only: increasing numbers of smokes in view and out of
// view, and increasing size of the world.
#include "bench/frames.hpp"
#include "scene/files/stand_ins.hpp"

namespace brume::bench {
namespace {

constexpr double kBloomed = 2;      // [s]: the smokes have bloomed
constexpr float kCourt = 24;        // edge of a court [m]
constexpr float kApart = 14;        // distance between smokes [m]
constexpr int kHiddenColumns = 32;  // columns of smokes behind the camera

/// Adds a box from low to high.
void add_box(scene::Scene& scene, glm::vec3 low, glm::vec3 high) {
  glm::mat4 place(1);
  for (int axis = 0; axis < 3; ++axis) place[axis][axis] = high[axis] - low[axis];
  place[3] = glm::vec4(0.5f * (low + high), 1);
  scene.objects.push_back({"box", 0, 0, place});
}

/// Adds a court, the unit of the world: ground, two walls, crates, eight lights.
void add_court(scene::Scene& scene, glm::vec3 corner) {
  add_box(scene, corner - glm::vec3(0, 0.3f, 0), corner + glm::vec3(kCourt, 0, kCourt));
  add_box(scene, corner + glm::vec3(1, 0, 2), corner + glm::vec3(1.4f, 3, 20));
  add_box(scene, corner + glm::vec3(1, 0, 2), corner + glm::vec3(18, 3, 2.4f));
  for (int i = 0; i < 12; ++i) {
    const glm::vec3 at = corner + glm::vec3(4 + 5 * (i % 4), 0, 5 + 6 * (i / 4));
    add_box(scene, at, at + glm::vec3(0.7f, 0.5f + 0.1f * static_cast<float>(i), 0.7f));
  }
  for (int i = 0; i < 8; ++i) {
    scene::Light light;
    light.position_world = corner + glm::vec3(3 + 6 * (i % 4), 2.6f, 6 + 12 * (i / 4));
    light.intensity = glm::vec3(1.0f, 0.8f, 0.5f + 0.05f * static_cast<float>(i));
    scene.lights.push_back(light);
  }
}

/// `count` courts side by side: the first at the origin, the others behind it (+z) in rows of `across`. The
/// camera of the cases stands at the far edge of the first one and looks over it along -z.
scene::Scene world_of_courts(int count, int across) {
  scene::Scene scene;
  scene.meshes = {scene::unit_cube()};
  scene.materials.resize(1);
  scene.materials[0].base_color = glm::vec3(0.5f);
  add_court(scene, {-0.5f * kCourt, 0, -kCourt});
  for (int i = 0; i + 1 < count; ++i) {
    const int column = i % across - across / 2, row = i / across;
    add_court(scene, {kCourt * (static_cast<float>(column) - 0.5f), 0, kCourt * static_cast<float>(row)});
  }
  return scene;
}

/// A scenario with a smoke at each of `smokes` and half-metre voxels from `low` to `high`.
Result<scenario::Scenario> scenario_of(scene::Scene scene, const std::vector<glm::vec3>& smokes,
                                       glm::vec3 low, glm::vec3 high, const scene::Camera& camera) {
  scene::Timeline timeline;
  timeline.sky = {glm::vec3(0.01f), glm::vec3(0.02f), glm::vec3(0.01f)};
  timeline.smoke.bloom = 1;
  for (const glm::vec3 place : smokes) timeline.smokes.push_back({0, place + glm::vec3(0, 2, 0), place});
  constexpr float kVoxel = 0.5f;
  // Offset from the surfaces, which lie at multiples of half a metre.
  const voxel::GridLayout frame{glm::ivec3(glm::ceil((high - low) / kVoxel)), kVoxel, low - 0.1f};
  auto voxels = scenario::load_or_voxelize(scene, frame, {});
  if (!voxels) return voxels.failure();
  return scenario::Scenario{std::move(timeline), std::move(scene), camera, std::move(*voxels)};
}

Result<Measurement> time_scenario(Bench& bench, const std::string& name,
                                  const Result<scenario::Scenario>& scenario) {
  if (!scenario) return scenario.failure();
  const bool slow = bench.is_slow();
  render::RendererOptions options;
  options.size_px = slow ? glm::uvec2(480, 270) : glm::uvec2(1920, 1080);
  Measurement m = time_frames(bench, name, *scenario, options, kBloomed).all;
  m.details["smokes"] = static_cast<double>(scenario->timeline.smokes.size());
  m.details["lights"] = static_cast<double>(scenario->scene.lights.size());
  m.details["objects"] = static_cast<double>(scenario->scene.objects.size());
  return m;
}

/// Collects measurements and adds the ratio of each to the first.
class Series {
 public:
  Result<void> add(Result<Measurement> measured) {
    if (!measured) return measured.failure();
    results_.push_back(*std::move(measured));
    results_.back().details["times_first"] = results_.back().median / results_.front().median;
    return {};
  }
  std::vector<Measurement> take() { return std::move(results_); }

 private:
  std::vector<Measurement> results_;
};

/// 1 to 64 smokes on open ground, all completely in view of a camera above them.
Result<std::vector<Measurement>> in_view(Bench& bench) {
  Series series;
  for (const int count : {1, 4, 16, 64}) {
    scene::Scene scene = world_of_courts(1, 1);
    add_box(scene, {-120, -0.5f, -140}, {120, -0.31f, 0});
    std::vector<glm::vec3> places;
    for (int i = 0; i < count; ++i)
      places.push_back(
          {kApart * (static_cast<float>(i % 8) - 3.5f), 0.3f, -30 - kApart * static_cast<float>(i / 8)});
    const auto scenario = scenario_of(std::move(scene), places, {-120, -1, -148}, {120, 15, 8},
                                      {{0, 40, 40}, {0, 0, -70}, 1.1f});
    if (auto done = series.add(time_scenario(bench, "scaling/in_view/" + std::to_string(count), scenario));
        !done)
      return done.failure();
  }
  return series.take();
}

/// One smoke in front of the camera, and 0 to 1,000 behind it.
Result<std::vector<Measurement>> out_of_view(Bench& bench) {
  Series series;
  for (const int count : {0, 10, 100, 1000}) {
    std::vector<glm::vec3> places{{0, 0.3f, -12}};
    for (int i = 0; i < count; ++i) {
      const int column = i % kHiddenColumns - kHiddenColumns / 2, line = i / kHiddenColumns;
      places.push_back(
          {kApart * (static_cast<float>(column) + 0.5f), 0.3f, 20 + kApart * static_cast<float>(line)});
    }
    const auto scenario = scenario_of(world_of_courts(1, 1), places, {-240, -1, -32}, {240, 15, 480},
                                      {{0, 1.8f, 1}, {0, 1.8f, -12}, 1.0472f});
    if (auto done =
            series.add(time_scenario(bench, "scaling/out_of_view/" + std::to_string(count), scenario));
        !done)
      return done.failure();
  }
  return series.take();
}

/// One smoke in front of the camera; the rest of the world, with its walls, crates and lights, behind it.
Result<std::vector<Measurement>> world(Bench& bench) {
  Series series;
  for (const int count : {1, 10, 100}) {
    const int across = count > 10 ? 11 : 3, rows = (count - 1 + across - 1) / across;
    const float half = kCourt * 0.5f * static_cast<float>(across) + 4;
    const auto scenario = scenario_of(
        world_of_courts(count, across), {{0, 0.3f, -12}}, {-half, -1, -kCourt - 8},
        {half, 15, kCourt * static_cast<float>(rows) + 8}, {{0, 1.8f, 1}, {0, 1.8f, -12}, 1.0472f});
    if (auto done = series.add(time_scenario(bench, "scaling/world/" + std::to_string(count), scenario));
        !done)
      return done.failure();
  }
  return series.take();
}

}  // namespace

std::vector<Case> scaling_cases() {
  return {
      {"scaling/in_view", "a frame with 1 to 64 smokes in view; 480x270 without a GPU", in_view},
      {"scaling/out_of_view", "a frame with one smoke in view and 0 to 1,000 behind the camera", out_of_view},
      {"scaling/world", "a frame with one smoke in a world of 1, 10 and 100 courts", world},
  };
}

}  // namespace brume::bench
