// Light on surfaces, where it is known.
#include <numbers>

#include "tests/path_tracer/box_medium.hpp"
#include "tests/path_tracer/statistics.hpp"

namespace brume::reference {
namespace {

using surfaces::basis_around;
using surfaces::Reflection;

constexpr double kHalfTurn = std::numbers::pi;

/// Adds a square of two triangles around `middle`, spanned by half edges, as an object of its own.
void add_square(scene::Scene& scene, const glm::vec3& middle, const glm::vec3& u, const glm::vec3& v,
                const scene::Material& material) {
  scene::Mesh& mesh = scene.meshes.emplace_back();
  const glm::vec3 normal = glm::normalize(glm::cross(u, v));
  for (const glm::vec2 at : {glm::vec2(-1, -1), glm::vec2(1, -1), glm::vec2(1, 1), glm::vec2(-1, 1)}) {
    scene::Vertex vertex;
    vertex.position = middle + at.x * u + at.y * v;
    vertex.normal = normal;
    vertex.uv = 0.5f * at + 0.5f;
    mesh.vertices.push_back(vertex);
  }
  mesh.indices = {0, 1, 2, 0, 2, 3};
  scene.materials.push_back(material);
  scene.objects.push_back({"square", static_cast<std::uint32_t>(scene.meshes.size() - 1),
                           static_cast<std::uint32_t>(scene.materials.size() - 1)});
}

scene::Material matte(float albedo) {
  scene::Material material;
  material.base_color = glm::vec3(albedo);
  material.roughness = 1;
  return material;
}

scene::Material glowing(float radiance) {
  scene::Material material;
  material.base_color = glm::vec3(0);
  material.emission = glm::vec3(radiance);
  return material;
}

const Ray kDown{{0.3f, 2, 0.2f}, glm::normalize(glm::vec3(-0.3f, -2, -0.2f))};
Reflection reflection_of(const scene::Material& material) {
  return {{0, 1, 0}, material.base_color, material.roughness, material.metallic};
}

scene::Scene floor_of(const scene::Material& material) {
  scene::Scene scene;
  add_square(scene, {0, 0, 0}, {0, 0, 10}, {10, 0, 0}, material);
  return scene;
}

TEST(SurfacesTest, LightsObeyTheInverseSquareLaw) {
  const scene::Scene floor = floor_of(matte(0.6f));
  shared::Light source{};
  source.kind = shared::kLightPoint;
  source.position_world = {1, 1.5f, -0.5f};
  source.intensity = glm::vec3(7);
  const auto scene = scene_of(floor, {}, {source});
  const glm::vec3 to_light = source.position_world;
  const glm::vec3 value = reflection_of(floor.materials[0]).value(-kDown.direction, glm::normalize(to_light));
  // One light: every path has the same.
  EXPECT_NEAR(radiance(*scene, kDown, 64).value(), 7 * double{value.r} / double{glm::dot(to_light, to_light)},
              1e-5);
}

// KHR_lights_punctual, "Inner and Outer Cone Angles": lightAngleScale, lightAngleOffset, and their square.
TEST(SurfacesTest, SpotsFallOffAsGltfRecommends) {
  shared::Light spot{};
  spot.kind = shared::kLightSpot;
  spot.direction = {0, 0, -1};
  spot.intensity = glm::vec3(3);
  for (const auto& [inner, outer] : {std::pair(0.2, 0.5), {0.0, 1.5}, {0.6, 0.6}, {0.7, 2.0}}) {
    spot.cos_inner = static_cast<float>(std::cos(inner));
    spot.cos_outer = static_cast<float>(std::cos(outer));
    const double scale = 1 / std::max(0.001, double{spot.cos_inner} - double{spot.cos_outer}),
                 offset = -double{spot.cos_outer} * scale;
    for (double angle = 0; angle < 3.1; angle += 0.05) {
      const glm::vec3 p(glm::dvec3(2 * std::sin(angle), 0, -2 * std::cos(angle)));
      const double ramp = std::clamp(std::cos(angle) * scale + offset, 0.0, 1.0);
      // Cosines of single precision, divided by a difference of at least 0.001.
      EXPECT_NEAR(double{light_at(spot, p).irradiance.r}, 3.0 / 4 * ramp * ramp, 1e-6 * scale)
          << inner << " " << outer << " " << angle;
    }
  }
}

TEST(SurfacesTest, ManyLightsAddUp) {
  const scene::Scene floor = floor_of(matte(0.6f));
  std::vector<shared::Light> sources;
  double expected = 0;
  for (int i = 0; i < 9; ++i) {
    shared::Light source{};
    source.kind = i % 2 == 0 ? shared::kLightPoint : shared::kLightSpot;
    source.position_world = {static_cast<float>(i - 4), 1 + 0.3f * static_cast<float>(i), 0.5f};
    source.direction = glm::normalize(-source.position_world);
    source.cos_inner = 0.9f;
    source.cos_outer = 0.7f;
    source.intensity = glm::vec3(0.5f + static_cast<float>(i * i % 5));
    sources.push_back(source);
    const Incident incident = light_at(source, glm::vec3(0));
    expected += double{
        (incident.irradiance * reflection_of(floor.materials[0]).value(-kDown.direction, incident.to_light))
            .r};
  }
  const auto scene = scene_of(floor, {}, sources);
  // Chosen in proportion to what they add: without anything in between every choice has the same value.
  EXPECT_NEAR(radiance(*scene, kDown, 64).value(), expected, 1e-4);
}

TEST(SurfacesTest, SurfacesHideLights) {
  scene::Scene floor = floor_of(matte(0.6f));
  add_square(floor, {0.5f, 0.75f, -0.25f}, {0, 0, 0.2f}, {0.2f, 0, 0}, matte(0));
  shared::Light source{};
  source.kind = shared::kLightPoint;
  source.position_world = {1, 1.5f, -0.5f};
  source.intensity = glm::vec3(7);
  EXPECT_EQ(radiance(*scene_of(floor, {}, {source}), kDown, 4, {.max_bounces = 1}).value(), 0);
}

// Where the normals of vertices lean towards a light behind the triangle.
TEST(SurfacesTest, NoLightComesThroughLeaningNormals) {
  scene::Scene floor = floor_of(matte(0.6f));
  for (scene::Vertex& vertex : floor.meshes[0].vertices)
    vertex.normal = glm::normalize(glm::vec3(1, 0.4f, 0));
  shared::Light source{};
  source.kind = shared::kLightPoint;
  source.intensity = glm::vec3(7);
  for (const float height : {0.3f, -0.3f}) {
    source.position_world = {2, height, 0};
    const double found = radiance(*scene_of(floor, {}, {source}), kDown, 4, {.max_bounces = 1}).value();
    EXPECT_EQ(found > 0, height > 0);
  }
}

// As its shadow map in real time, whose near plane is kShadowNear away from it along an axis.
TEST(SurfacesTest, ALightsOwnBulbDoesNotHideIt) {
  shared::Light source{};
  source.kind = shared::kLightPoint;
  source.position_world = {0, 1.5f, 0};
  source.intensity = glm::vec3(7);
  const scene::Scene floor = floor_of(matte(0.6f));
  const double open = radiance(*scene_of(floor, {}, {source}), kDown, 4, {.max_bounces = 1}).value();
  EXPECT_GT(open, 0);
  for (const float away : {0.9f, 1.1f}) {
    scene::Scene scene = floor;
    add_square(scene, {0, 1.5f - away * shared::kShadowNear, 0}, {0, 0, 0.2f}, {0.2f, 0, 0}, matte(0));
    EXPECT_EQ(radiance(*scene_of(scene, {}, {source}), kDown, 4, {.max_bounces = 1}).value(),
              away < 1 ? open : 0);
  }
}

// A square emitter above a floor: next-event estimation and sampled directions join to the integral over it.
TEST(SurfacesTest, EmittersLightAsIntegrated) {
  for (const float roughness : {0.3f, 1.0f})
    for (const float half : {0.1f, 3.0f}) {
      scene::Material material = matte(0.5f);
      material.roughness = roughness;
      scene::Scene scene = floor_of(material);
      add_square(scene, {-0.4f, 1.5f, 0.3f}, {half, 0, 0}, {0, 0, half}, glowing(4));
      double expected = 0;
      constexpr int kSteps = 1500;
      const Reflection floor = reflection_of(material);
      const double cell = 2 * double{half} / kSteps;
      for (int i = 0; i < kSteps * kSteps; ++i) {
        const glm::dvec3 p(-0.4 - double{half} + (i % kSteps + 0.5) * cell, 1.5,
                           0.3 - double{half} + (i / kSteps + 0.5) * cell);
        const double d2 = glm::dot(p, p), distance = std::sqrt(d2);
        expected += double{floor.value(-kDown.direction, glm::vec3(p / distance)).r} * 4 * (1.5 / distance) /
                    d2 * cell * cell;
      }
      // Seen from below the emitter, which hides nothing of the floor.
      const Ray ray{{0.15f, 1, 0.1f}, kDown.direction};
      expect_mean(radiance(*scene_of(scene, {}), ray, 1u << 15, {.max_bounces = 1}), expected, 0.01);
    }
}

// A box of gas that glows above a floor, by numerical integration over it.
TEST(SurfacesTest, GlowingMediaLightAsIntegrated) {
  for (const float extinction : {0.0f, 1.5f}) {
    const scene::Scene floor = floor_of(matte(0.5f));
    const Box<float> box{{-0.6f, 0.4f, -0.2f}, {0.1f, 1.1f, 0.5f}};
    // Brighter upwards, so that cells differ.
    const auto glow = [](const glm::dvec3& p) { return 5 * p.y; };
    const BoxMedium::Matter matter{
        [=](const glm::vec3&) { return extinction; }, std::max(extinction, 2.0f), glm::vec3(0),
        [=](const glm::vec3& p) { return glm::vec3(static_cast<float>(glow(glm::dvec3(p)))); }};
    const auto scene = scene_of(
        floor, media_of(std::make_unique<BoxMedium>(box, matter, shared::phase_of_hg(0), glm::ivec3(5))));
    double expected = 0;
    constexpr int kSteps = 90;
    const glm::dvec3 cell = glm::dvec3(box.high - box.low) / double{kSteps};
    for_each_in(Box<int>{glm::ivec3(0), glm::ivec3(kSteps)}, [&](glm::ivec3 at) {
      const glm::dvec3 p = glm::dvec3(box.low) + (glm::dvec3(at) + 0.5) * cell;
      const double d2 = glm::dot(p, p), distance = std::sqrt(d2);
      // The way within the box: from where the line from the origin enters it.
      double enters = 0;
      for (int axis = 0; axis < 3; ++axis)
        enters =
            std::max(enters, std::min(double{box.low[axis]} / p[axis], double{box.high[axis]} / p[axis]));
      const double value =
          double{reflection_of(floor.materials[0]).value(-kDown.direction, glm::vec3(p / distance)).r};
      expected += value * glow(p) * std::exp(-double{extinction} * (1 - enters) * distance) / d2 * cell.x *
                  cell.y * cell.z;
    });
    // From below the box, which then does not hide the floor.
    const Ray clear{{0.03f, 0.2f, 0.02f}, kDown.direction};
    expect_mean(radiance(*scene, clear, 1u << 16, {.max_bounces = 1}), expected, 0.01);
  }
}

scene::Scene closed_box(const scene::Material& material) {
  scene::Scene scene;
  for (int axis = 0; axis < 3; ++axis)
    for (const float side : {-1.0f, 1.0f}) {
      glm::vec3 middle(0), u(0), v(0);
      middle[axis] = side;
      u[(axis + 1) % 3] = 1;
      v[(axis + 2) % 3] = 1;
      add_square(scene, middle, u, v, material);
    }
  return scene;
}

// By Lambert's law alone, radiance in a closed box that emits E and reflects r is E + r E + r^2 E ...,
// whatever else its material is.
TEST(SurfacesTest, AMatteBoxThatEmitsIsAFurnace) {
  scene::Material material = matte(0.75f);
  material.roughness = 0.2f;
  material.metallic = 0.5f;
  material.emission = glm::vec3(1);
  const scene::Scene scene = closed_box(material);
  const Ray ray{{0.2f, 0.1f, 0.3f}, glm::normalize(glm::vec3(0.5f, -0.7f, 0.2f))};
  expect_mean(radiance(*scene_of(scene, {}, {}, true), ray, 1u << 15), 4, 0.01);
}

// With highlights it is the sum over bounces by the reflectance of the model itself.
TEST(SurfacesTest, AClosedBoxThatEmitsIsAFurnace) {
  scene::Material material = matte(0.5f);
  material.metallic = 0;
  material.emission = glm::vec3(1);
  const scene::Scene scene = closed_box(material);
  // Directly: each path after its bounces, in double precision.
  const auto box = scene_of(scene, {});
  const Ray ray{{0.2f, 0.1f, 0.3f}, glm::normalize(glm::vec3(0.5f, -0.7f, 0.2f))};
  const Mean whole = radiance(*box, ray, 1u << 15);
  Mean plain;
  for (std::uint32_t i = 0; i < (1u << 15) / kFewer; ++i) {
    Sampler sampler({i & 255u, i >> 8u}, 1);
    Ray next = ray;
    double weight = 1, sum = 0;
    for (int bounce = 0; bounce < 40; ++bounce) {
      const auto hit = box->surfaces.hit(next);
      ASSERT_TRUE(hit);
      sum += weight;
      // Evenly over the hemisphere, unlike what is tested.
      glm::vec3 x, y;
      basis_around(hit->reflection.normal, x, y);
      const float c = sampler.random(), turn = 2 * std::numbers::pi_v<float> * sampler.random(),
                  s = std::sqrt(1 - c * c);
      const glm::vec3 direction = c * hit->reflection.normal + s * (std::cos(turn) * x + std::sin(turn) * y);
      weight *= 2 * kHalfTurn * double{hit->reflection.value(-next.direction, direction).r};
      next = {Surfaces::off_surface(*hit, direction), direction};
    }
    plain.add(sum);
  }
  EXPECT_NEAR(whole.value(), plain.value(), 4 * std::hypot(whole.error(), plain.error()));
  EXPECT_LT(std::hypot(whole.error(), plain.error()), kLooser * 0.02);
  EXPECT_GT(whole.value(), 1.5);
}

TEST(SurfacesTest, TheSkyLightsAPlane) {
  // 0.75 + 0.25 normal.y of the ambient light, diffuse alone: of metal there would be none.
  const scene::Scene floor = floor_of(matte(0.5f));
  const auto scene = scene_of(floor, {});
  scene->environment.sky.ambient = glm::vec3(2);
  const Reflection surface = reflection_of(floor.materials[0]);
  double expected = 0;
  constexpr int kSteps = 1000;
  for (int i = 0; i < kSteps; ++i)
    for (int k = 0; k < 360; ++k) {
      const double y = (i + 0.5) / kSteps, turn = 2 * kHalfTurn * (k + 0.5) / 360, s = std::sqrt(1 - y * y);
      expected +=
          double{surface.value(-kDown.direction, glm::vec3(s * std::cos(turn), y, s * std::sin(turn))).r} *
          2 * (0.75 + 0.375 * y) * 2 * kHalfTurn / (kSteps * 360.0);
    }
  expect_mean(radiance(*scene, kDown, 1u << 14), expected, 0.01);
}

TEST(SurfacesTest, CutOutTexelsLetLightThrough) {
  scene::Scene scene = floor_of(matte(0.5f));
  scene::Material leaf = matte(0.3f);
  leaf.alpha_cutoff = 0.5f;
  leaf.base_color_image = 0;
  // Left half opaque, right half cut out.
  scene::Image image;
  image.pixels = {8, 1, {}};
  for (int x = 0; x < 8; ++x)
    image.pixels.rgba.insert(image.pixels.rgba.end(),
                             {255, 255, 255, static_cast<std::uint8_t>(x < 4 ? 255 : 0)});
  scene.images.push_back(image);
  add_square(scene, {0, 1, 0}, {1, 0, 0}, {0, 0, -1}, leaf);
  const auto made = scene_of(scene, {});
  const auto height_under = [&](float x) {
    return made->surfaces.hit({{x, 3, 0.1f}, {0, -1, 0}})->position.y;
  };
  EXPECT_NEAR(height_under(-0.5f), 1, 1e-5f);
  EXPECT_NEAR(height_under(0.5f), 0, 1e-5f);
  EXPECT_TRUE(made->surfaces.occluded({{-0.5f, 3, 0.1f}, {0, -1, 0}, 2.5f}));
  EXPECT_FALSE(made->surfaces.occluded({{0.5f, 3, 0.1f}, {0, -1, 0}, 2.5f}));
}

TEST(SurfacesTest, ImagesContinueAsTheirWrapsSay) {
  // Its left half is opaque, its right half cut out; with an image's width more on each side.
  const auto opaque = [](scene::Wrap wrap) {
    scene::Scene scene = floor_of(matte(0.5f));
    scene::Material painted = matte(1);
    painted.base_color_image = 0;
    scene::Image image{"halves", {4, 1, {}}, {wrap, scene::Wrap::repeat}};
    for (const int alpha : {255, 255, 0, 0})
      image.pixels.rgba.insert(image.pixels.rgba.end(), {255, 255, 255, static_cast<std::uint8_t>(alpha)});
    painted.alpha_cutoff = 0.5f;
    scene.images.push_back(image);
    add_square(scene, {0, 1, 0}, {1, 0, 0}, {0, 0, -1}, painted);
    for (scene::Vertex& vertex : scene.meshes.back().vertices) vertex.uv.x = 3 * vertex.uv.x - 1;
    const auto made = scene_of(scene, {});
    std::string row;
    // In the middle of each half of the image.
    for (int half = 0; half < 6; ++half) {
      const float x = -1 + (static_cast<float>(half) + 0.5f) / 3;
      row += made->surfaces.hit({{x, 3, 0.1f}, {0, -1, 0}})->position.y > 0.5f ? '#' : '.';
    }
    return row;
  };
  EXPECT_EQ(opaque(scene::Wrap::repeat), "#.#.#.");
  EXPECT_EQ(opaque(scene::Wrap::mirror), ".##..#");
  EXPECT_EQ(opaque(scene::Wrap::clamp), "###...");
}

TEST(SurfacesTest, MirroredAndScaledObjectsFaceTheEye) {
  scene::Scene scene = floor_of(matte(0.5f));
  scene.objects[0].world_from_mesh = glm::scale(glm::mat4(1), {-2, 3, 0.5f});
  const auto made = scene_of(scene, {});
  for (const float y : {1.0f, -1.0f}) {
    const auto hit = made->surfaces.hit({{0.1f, y, 0.1f}, {0, -y, 0}});
    ASSERT_TRUE(hit);
    EXPECT_NEAR(hit->geometric_normal.y, y, 1e-6f);
    EXPECT_NEAR(hit->reflection.normal.y, y, 1e-6f);
  }
}

}  // namespace
}  // namespace brume::reference
