// Panes: what they let through, reflect and scatter, where it is known.
#include "tests/path_tracer/box_medium.hpp"
#include "tests/path_tracer/squares.hpp"

namespace brume::reference {
namespace {

/// A square across the z axis, as a pane.
void add_pane(scene::Scene& scene, float z, const scene::Material& material) {
  const scene::Scene square = square_at(z, 50);
  scene.meshes.push_back(square.meshes[0]);
  scene.materials.push_back(material);
  scene::Object object{"pane", static_cast<std::uint32_t>(scene.meshes.size() - 1),
                       static_cast<std::uint32_t>(scene.materials.size() - 1)};
  object.role = Role::glass;
  scene.objects.push_back(object);
}

scene::Material glass(const glm::vec3& tint) {
  scene::Material material;
  material.base_color = tint;
  material.roughness = 0;
  return material;
}

/// Blended over what is behind it.
scene::Material film(float albedo, float opacity) {
  scene::Material material = glass(glm::vec3(albedo));
  material.roughness = 1;
  material.transmission = 0;
  material.blended = true;
  material.opacity = opacity;
  return material;
}

const Ray kAhead{{0.1f, 0.2f, 5}, {0, 0, -1}};
/// What clear glass reflects of light that falls straight on it.
constexpr double kStraight = 0.04;

// What is lost neither to the glass nor to a surface is as bright as all around, at any angle and through any
// number of panes. At 80 degrees the reflection of a rough lobe begins to lose some: that of the smoothest
// that there is 2 %.
TEST(PanesTest, InAFurnaceClearGlassIsNotSeen) {
  for (const int panes : {1, 2, 5}) {
    scene::Scene scene;
    for (int i = 0; i < panes; ++i) add_pane(scene, -static_cast<float>(i), glass(glm::vec3(1)));
    const auto made = scene_of(scene, {});
    made->environment = uniform_sky(1);
    for (const float sine : {0.0f, 0.5f, 0.9f}) {
      const Ray ray{{0, 0, 3}, {sine, 0, -std::sqrt(1 - sine * sine)}};
      const Mean mean = radiance(*made, ray, 1u << 13);
      EXPECT_NEAR(mean.value(), 1, 4 * mean.error() + 0.01) << panes << " panes, " << sine;
    }
  }
}

TEST(PanesTest, TintsWhatIsBehind) {
  scene::Scene scene = lit_square(-3, 50);
  add_pane(scene, 0, glass({0.6f, 0.3f, 0.1f}));
  const auto made = scene_of(scene, {});
  expect_mean(radiance(*made, kAhead, 1u << 14), 0.6 * (1 - kStraight), 0.01);
  add_pane(scene, -1, glass({0.5f, 0.3f, 0.1f}));
  const auto two = scene_of(scene, {});
  // What is reflected between them adds less than 0.2 %.
  const Mean both = radiance(*two, kAhead, 1u << 14);
  EXPECT_NEAR(both.value() / (0.6 * 0.5 * (1 - kStraight) * (1 - kStraight)), 1,
              4 * both.error() / both.value() + 0.003);
}

TEST(PanesTest, AlphaIsTheFractionThatScatters) {
  scene::Scene scene = lit_square(-3, 50);
  add_pane(scene, 0, film(0, 0.25f));
  expect_mean(radiance(*scene_of(scene, {}), kAhead, 1u << 14), 0.75 * (1 - kStraight), 0.01);
  // Of the vertices, too, which also says how much of it is there to reflect.
  for (scene::Vertex& vertex : scene.meshes[1].vertices) vertex.color.a = 0.5f;
  expect_mean(radiance(*scene_of(scene, {}), kAhead, 1u << 14), 0.875 * (1 - 0.5 * kStraight), 0.01);
}

// Light that a point light sends through a pane to a floor, and a light behind one that is no pane.
TEST(PanesTest, LightPassesThrough) {
  shared::Light light{};
  light.kind = shared::kLightPoint;
  light.position_world = {0, 0, -4};
  light.intensity = glm::vec3(8);
  light.range = 1000;
  scene::Scene scene = square_at(0, 50);
  scene.materials[0].base_color = glm::vec3(0.5f);
  scene.materials[0].roughness = 1;
  // Seen from the light's side, beside the pane.
  const Ray ray{{0, 0, -1}, {0, 0, 1}};
  const auto lit = [&] { return radiance(*scene_of(scene, {}, {light}, true), ray, 1u << 12).value(); };
  const double open = lit();
  add_pane(scene, -2, glass(glm::vec3(0.5f)));
  EXPECT_NEAR(lit(), open * 0.5 * (1 - kStraight), 0.01 * open);
  scene.objects[1].role = Role::wall;
  EXPECT_EQ(lit(), 0);
}

// A light behind a pane is found by paths and by sampling: both share it, whatever the distance up to the
// pane.
TEST(PanesTest, EmittersBehindAPaneLightAFloor) {
  scene::Scene scene = lit_square(-2, 1);
  const scene::Scene floor = square_at(2, 50);
  scene.meshes.push_back(floor.meshes[0]);
  scene.materials.push_back(floor.materials[0]);
  scene.materials[1].base_color = glm::vec3(0.5f);
  scene.materials[1].roughness = 0.3f;
  scene.objects.push_back({"floor", 1, 1});
  const Ray ray{{3, 0, 1}, glm::normalize(glm::vec3(-1.5f, 0, 1))};
  const Mean open = radiance(*scene_of(scene, {}), ray, 1u << 16);
  add_pane(scene, 0, glass(glm::vec3(0.5f)));
  // Between straight on and 60 degrees 4 to 8 % are reflected.
  const Mean through = radiance(*scene_of(scene, {}), ray, 1u << 16);
  EXPECT_GT(through.value(), 0.5 * 0.90 * (open.value() - 4 * open.error()) - 4 * through.error());
  EXPECT_LT(through.value(), 0.5 * 0.97 * (open.value() + 4 * open.error()) + 4 * through.error());
}

TEST(PanesTest, APaneOfARoleThatStopsSightIsAWall) {
  scene::Scene scene = lit_square(-3, 50);
  add_pane(scene, 0, glass(glm::vec3(1)));
  scene.objects[1].see_through = true;
  for (const Role role : {Role::glass, Role::grille, Role::ghost, Role::wall}) {
    scene.objects[1].role = role;
    const auto made = scene_of(scene, {});
    EXPECT_EQ(made->surfaces.hit(kAhead)->is_pane, role != Role::wall);
    EXPECT_EQ(made->surfaces.occluded({kAhead.origin, kAhead.direction, 6}), role == Role::wall);
  }
}

}  // namespace
}  // namespace brume::reference
