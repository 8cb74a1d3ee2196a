// What moves while the shutter is open: the mean of what it is at each time.
#include <numbers>

#include "planning/device_camera.hpp"
#include "reference/render.hpp"
#include "tests/path_tracer/box_medium.hpp"
#include "tests/path_tracer/squares.hpp"

namespace brume::reference {
namespace {

/// Fraction of the shutter's time in which a point is covered by what is `half` wide around `at(time)`.
template <typename At>
double covered(double point, double half, const At& at) {
  constexpr int kSteps = 10000;
  int inside = 0;
  for (int i = 0; i < kSteps; ++i) inside += std::abs(point - at((i + 0.5) / kSteps)) < half;
  return inside / double{kSteps};
}

/// The picture's middle row: brightness by place at a distance of 4 m, from -4 to 4 m.
std::vector<float> row_of(const Scene& scene, std::vector<Eye> eyes) {
  RenderSettings settings;
  settings.size_px = {64, 3};
  settings.eyes = std::move(eyes);
  settings.samples = 1024;
  Render render(scene, settings);
  while (!render.advance(10, [] { return false; })) {
  }
  std::vector<float> row;
  for (std::size_t x = 0; x < 64; ++x) row.push_back(render.radiance()[64 + x].r);
  return row;
}
Eye eye_at(float x) {
  return {planning::device_camera({{x, 0, 0}, {x, 0, -1}, 2 * std::atan(3.0f / 64)}, {64, 3})};
}
double place_of(std::size_t pixel) {
  return (static_cast<double>(pixel) + 0.5) / 8 - 4;
}

// Pixels at edges aside, which are as wide as 1/8 m.
template <typename At>
void expect_row(const std::vector<float>& row, const At& at, double depth_of_one) {
  int bright = 0;
  for (std::size_t i = 0; i < row.size(); ++i) {
    const double p = place_of(i), here = covered(p, 0.5, at);
    const double around = std::abs(covered(p - 0.0625, 0.5, at) - covered(p + 0.0625, 0.5, at));
    EXPECT_NEAR(double{row[i]}, depth_of_one * here, depth_of_one * (around + 0.02)) << i;
    bright += here > 0.1;
  }
  EXPECT_GT(bright, 8);
}

TEST(MotionTest, ObjectsSpreadOverTheirWay) {
  const scene::Scene scene = lit_square(-4, 0.5f);
  std::vector<planning::LevelState> levels(5);
  for (std::size_t i = 0; i < levels.size(); ++i) {
    levels[i].hidden_objects = {0};
    levels[i].moved = {{0, glm::translate(glm::mat4(1), {-1 + 0.5f * static_cast<float>(i), 0, 0})}};
  }
  std::unique_ptr<Scene> moving(new Scene{{scene, levels}, {}, {}, {}});
  sum_emitters(*moving);
  expect_row(
      row_of(*moving, {eye_at(0), eye_at(0)}), [](double t) { return 2 * t - 1; }, 1);
}

TEST(MotionTest, CamerasSpreadWhatRests) {
  const scene::Scene scene = lit_square(-4, 0.5f);
  const auto resting = scene_of(scene, {});
  expect_row(
      row_of(*resting, {eye_at(1), eye_at(0), eye_at(-1)}), [](double t) { return 2 * t - 1; }, 1);
}

TEST(MotionTest, MediaSpreadOverTheirWay) {
  const scene::Scene nothing;
  const BoxMedium::Matter glow{[](const glm::vec3&) { return 0.0f; }, 8, glm::vec3(0),
                               [](const glm::vec3&) { return glm::vec3(4); }};
  auto medium = std::make_unique<BoxMedium>(Box<float>{{-0.5f, -0.5f, -4.125f}, {0.5f, 0.5f, -3.875f}}, glow,
                                            shared::phase_of_hg(0));
  std::vector<glm::mat4> motion;
  for (int i = 0; i < 5; ++i)
    motion.push_back(glm::translate(glm::mat4(1), {0.5f * static_cast<float>(i), 0, 0}));
  medium->set_motion(motion);
  const auto scene = scene_of(nothing, media_of(std::move(medium)));
  // A quarter of a metre of 4 per metre; its possible collisions are two on average.
  const std::vector<float> row = row_of(*scene, {eye_at(0), eye_at(0)});
  double sum = 0, expected = 0;
  for (std::size_t i = 0; i < row.size(); ++i) {
    // Paths through the box are longer where they are oblique.
    const double p = place_of(i), oblique = std::hypot(1.0, p / 4);
    const double here = oblique * covered(p, 0.5, [](double t) { return 2 * t; });
    EXPECT_NEAR(double{row[i]}, here, 0.3);
    sum += double{row[i]};
    expected += here;
  }
  EXPECT_NEAR(sum, expected, 0.04 * expected);
}

TEST(MotionTest, GlowOfMovingMediaIsSampledWhereItIs) {
  // A floor below a glowing box that moves: rays alone, and both together, agree.
  scene::Scene floor;
  scene::Mesh& mesh = floor.meshes.emplace_back();
  for (const glm::vec2 at : {glm::vec2(-1, 1), glm::vec2(1, 1), glm::vec2(1, -1), glm::vec2(-1, -1)}) {
    scene::Vertex vertex;
    vertex.position = {9 * at.x, 0, 9 * at.y};
    mesh.vertices.push_back(vertex);
  }
  mesh.indices = {0, 1, 2, 0, 2, 3};
  floor.materials.resize(1);
  floor.objects.push_back({"floor", 0, 0});
  const BoxMedium::Matter glow{[](const glm::vec3&) { return 0.0f; }, 8, glm::vec3(0),
                               [](const glm::vec3&) { return glm::vec3(4); }};
  const Box<float> box{{-0.2f, 0.5f, -0.2f}, {0.2f, 0.9f, 0.2f}};
  std::vector<glm::mat4> motion;
  for (int i = 0; i < 3; ++i)
    motion.push_back(glm::translate(glm::mat4(1), {0.8f * static_cast<float>(i), 0, 0}));
  auto moving = std::make_unique<BoxMedium>(box, glow, shared::phase_of_hg(0));
  moving->set_motion(motion);
  const auto scene = scene_of(floor, media_of(std::move(moving)));
  Mean at_times, at_rest;
  for (std::uint32_t i = 0; i < (1u << 16) / kFewer; ++i) {
    Sampler sampler({i & 255u, i >> 8u}, 0);
    Ray ray{{0.03f, 0.2f, 0.02f}, glm::normalize(glm::vec3(-0.3f, -2, -0.2f))};
    ray.time = sampler.random();
    at_times.add(sum_of(trace_path(*scene, ray, {.max_bounces = 1}, sampler)));
    // The same place of one that rests: the floor and the eye move the other way.
    const float moved = ray.time;
    static const auto resting =
        scene_of(floor, media_of(std::make_unique<BoxMedium>(box, glow, shared::phase_of_hg(0))));
    ray.origin.x -= 1.6f * moved;
    at_rest.add(sum_of(trace_path(*resting, ray, {.max_bounces = 1}, sampler)));
  }
  EXPECT_NEAR(at_times.value(), at_rest.value(), 4 * std::hypot(at_times.error(), at_rest.error()));
  EXPECT_LT(std::hypot(at_times.error(), at_rest.error()), kLooser * 0.02 * at_rest.value());
}

}  // namespace
}  // namespace brume::reference
