// Both forms of raycasting against each other, against a march in double precision, and where the result is
// known exactly.
#include "passes/raycast.hpp"

#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <random>

#include "tests/passes/raycast_fixture.hpp"
#include "tests/reference/raycast.hpp"

namespace brume::passes {
namespace {

/// What interpolation may add to the length between points on faces, which are a few metres apart [m].
constexpr double kInterpolation = 1e-3;

/// Density 1 everywhere in its bounds.
SparseVolume solid_block(glm::ivec3 bricks) {
  return make_volume(
      bricks, [](glm::ivec3) { return true; }, [](glm::ivec3) { return 1.0f; });
}

/// Billows with absent bricks between them. Density is 0 beside absent bricks, so that it is continuous.
SparseVolume billows(glm::ivec3 bricks) {
  const auto has = [=](glm::ivec3 b) {
    return glm::all(glm::greaterThanEqual(b, glm::ivec3(0))) && glm::all(glm::lessThan(b, bricks)) &&
           (b.x * 5 + b.y * 3 + b.z * 7) % 4 != 1;
  };
  return make_volume(bricks, has, [=](glm::ivec3 v) {
    bool inside = true;
    for_each_in(Box<int>{v - 1, v + 2}, [&](glm::ivec3 near) { inside = inside && has(near >> 3); });
    const glm::vec3 p(v);
    return inside ? 0.5f + 0.5f * std::sin(0.9f * p.x) * std::cos(0.7f * p.y + 0.3f * p.z) : 0.0f;
  });
}

class RaycastTest : public RaycastFixture {
 protected:
  RaycastTest() : RaycastFixture({37, 21}) {}

  /// Unit direction of the ray through a point of the image.
  glm::dvec3 direction(glm::dvec2 position_px) const {
    const shared::Camera camera = device_camera();
    const glm::dvec2 ndc = position_px / glm::dvec2(size_) * 2.0 - 1.0;
    return glm::normalize(glm::dvec3(camera.forward) + ndc.x * glm::dvec3(camera.right) -
                          ndc.y * glm::dvec3(camera.up));
  }
  glm::dvec2 centre_px(std::size_t pixel) const { return glm::dvec2(pixel % size_.x, pixel / size_.x) + 0.5; }
  reference::RaycastScene scene_of(const Placed& placed) const {
    const shared::RaycastVolume steps =
        planning::plan_raycast(device_camera(), size_, visible({placed}), light_, steps_).volumes[0];
    return {*placed.volume,
            glm::inverse(glm::dmat4(placed.world_from_voxel)),
            placed.look,
            glm::dvec3(light_.to_sun),
            glm::dvec3(light_.sun_irradiance),
            glm::dvec3(light_.ambient),
            light_.phase,
            double{steps.step_length},
            double{steps.light_step_length},
            double{steps_.opaque_transmittance}};
  }
  /// Length of a ray inside of a box, in double precision [m].
  double chord(const Placed& placed, glm::dvec2 position_px) const {
    const reference::RaycastScene scene = scene_of(placed);
    const glm::dvec3 origin(scene.voxel_from_world * glm::dvec4(glm::dvec3(device_camera().eye_world), 1));
    const glm::dvec2 inside = reference::chord(
        scene, origin, glm::dvec3(scene.voxel_from_world * glm::dvec4(direction(position_px), 0)));
    return std::max(inside.y - inside.x, 0.0);
  }
  /// The extent of chords around a pixel's centre, as rasterizers snap vertices.
  std::array<double, 2> chords_around(const Placed& placed, std::size_t pixel) const {
    std::array<double, 2> extent{1e30, 0};
    for (int i = 0; i < 25; ++i) {
      const double c = chord(placed, centre_px(pixel) + snapping_px() * glm::dvec2(i % 5 - 2, i / 5 - 2));
      extent = {std::min(extent[0], c), std::max(extent[1], c)};
    }
    return extent;
  }

  /// A box of about `size` m around the origin, turned, sheared, stretched, and flipped every other time.
  glm::mat4 random_transform(glm::vec3 voxels, int round) {
    const glm::vec3 axis = glm::normalize(glm::vec3(number(-1, 1), number(-1, 1), number(-1, 1)) + 0.01f);
    glm::mat4 shear(1);
    shear[1][0] = number(-0.5f, 0.5f);
    shear[2][1] = number(-0.5f, 0.5f);
    shear[2][0] = number(-0.5f, 0.5f);
    const glm::vec3 size(number(1, 4), number(1, 4), number(1, 4));
    const glm::vec3 scale = size / voxels * glm::vec3(round % 2 ? -1 : 1, 1, 1);
    return glm::rotate(glm::mat4(1), number(0, 6), axis) * shear *
           glm::translate(glm::scale(glm::mat4(1), scale), -0.5f * voxels);
  }
  /// Every fifth from inside.
  scene::Camera random_camera(int round) {
    const glm::vec3 out = glm::normalize(glm::vec3(number(-1, 1), number(-1, 1), number(-1, 1)) + 0.01f);
    const glm::vec3 eye = round % 5 == 4 ? 0.1f * out : number(2.5f, 5) * out;
    const glm::vec3 aim(number(-0.5f, 0.5f), number(-0.5f, 0.5f), number(-0.5f, 0.5f));
    return {eye, aim, number(0.4f, 1)};
  }
  float number(float low, float high) { return std::uniform_real_distribution<float>(low, high)(random_); }

  /// Compares a drawn image with a march in double precision.
  void expect_reference(const std::vector<glm::vec4>& pixels, const Placed& placed) {
    const reference::RaycastScene scene = scene_of(placed);
    const glm::dvec3 eye(device_camera().eye_world);
    int visible = 0;
    double difference = 0;
    for (std::size_t i = 0; i < pixels.size(); ++i) {
      // Coverage of the box's outline depends on how vertices snap.
      const auto [shortest, longest] = chords_around(placed, i);
      if (shortest == 0 && longest > 0) continue;
      // Positions are sums of a few floats of up to 100 voxels.
      const reference::RaycastResult expected =
          reference::raycast(scene, eye, direction(centre_px(i)), 1e30, 1e-4);
      const double half = 2.0 / 2048, t = expected.transmittance;
      ASSERT_NEAR(double{pixels[i].w}, t, expected.transmittance_error + half * t + 1e-6) << i;
      for (int c = 0; c < 3; ++c)
        ASSERT_NEAR(double{pixels[i][c]}, expected.radiance[c],
                    expected.radiance_error[c] + half * expected.radiance[c] + 1e-6)
            << i;
      difference += std::abs(double{pixels[i].w} - t);
      visible += t < 0.9;
    }
    EXPECT_GT(visible, 25);
    // Filtering errs to both sides, so the mean is closer: two roundings to half floats.
    EXPECT_LT(difference / static_cast<double>(pixels.size()), 2.0 / 2048);
  }

  std::mt19937 random_{17};
};

TEST_F(RaycastTest, BothFormsAgreeForAnyCameraAndTransform) {
  const SparseVolume soft = billows({3, 2, 4}), hard = solid_block({2, 3, 1});
  double most = 0;
  for (int round = 0; round < 50; ++round) {
    const SparseVolume& volume = round % 4 == 3 ? hard : soft;
    camera_ = random_camera(round);
    const Placed placed{
        &volume, random_transform(volume.layout().bounds_max, round), {glm::vec3(0.8f), 1.5f, {}, 0, 0}};
    const auto two = draw(RaycastForm::two_pass, {placed}), single = draw(RaycastForm::single_pass, {placed});
    int visible = 0;
    for (std::size_t i = 0; i < two.size(); ++i) {
      const auto [shortest, longest] = chords_around(placed, i);
      const double most_apart = std::max(1.0 / 255, double{placed.look.extinction} * (longest - shortest));
      for (int c = 0; c < 4; ++c) {
        const double apart = std::abs(double{two[i][c]} - double{single[i][c]});
        ASSERT_LE(apart, most_apart) << "round " << round << " pixel " << i << " channel " << c;
        most = std::max(most, apart);
      }
      visible += single[i].w < 0.95f;
    }
    EXPECT_GT(visible, 10) << round;
    if (round % 5 == 4) {
      EXPECT_EQ(std::ranges::count(single, 1.0f, &glm::vec4::w), 0) << "the eye is inside";
    }
  }
  RecordProperty("largest_difference_of_255", std::to_string(255 * most));
}

TEST_F(RaycastTest, BothFormsEqualADoublePrecisionMarch) {
  const SparseVolume volume = billows({3, 2, 4});
  for (int round = 0; round < 10; ++round) {
    camera_ = random_camera(round);
    const Placed placed{
        &volume, random_transform(volume.layout().bounds_max, round), {glm::vec3(0.8f), 1.5f, {}, 0, 0}};
    for (const RaycastForm form : {RaycastForm::two_pass, RaycastForm::single_pass}) {
      SCOPED_TRACE("round " + std::to_string(round) + " form " + std::to_string(int(form)));
      expect_reference(draw(form, {placed}), placed);
    }
  }
}

/// Steps that are clipped to the interval integrate a constant density without error, however long they are.
class ConstantDensityTest : public RaycastTest, public testing::WithParamInterface<RaycastForm> {
 protected:
  /// Transmittance is exp(-extinction * length), where `length` of the chords around a pixel.
  template <typename Length>
  void expect_exact(const Placed& placed, Length length) {
    const auto pixels = draw(GetParam(), {placed});
    const auto sigma = double{placed.look.extinction};
    int inside = 0;
    for (std::size_t i = 0; i < pixels.size(); ++i) {
      const auto [shortest, longest] = chords_around(placed, i);
      const double low = std::exp(-sigma * (length(i, longest) + kInterpolation)),
                   high = std::exp(-sigma * (length(i, shortest) - kInterpolation));
      ASSERT_GE(double{pixels[i].w}, low * (1 - 1.0 / 1024) - 1e-5) << i;
      ASSERT_LE(double{pixels[i].w}, high * (1 + 1.0 / 1024) + 1e-5) << i;
      inside += shortest > 0;
    }
    EXPECT_GT(inside, 40);
  }
};
INSTANTIATE_TEST_SUITE_P(Forms, ConstantDensityTest,
                         testing::Values(RaycastForm::two_pass, RaycastForm::single_pass));

TEST_P(ConstantDensityTest, IsBeerLambert) {
  const SparseVolume volume = solid_block({2, 3, 1});
  for (int round = 0; round < 10; ++round) {
    camera_ = random_camera(round);
    SCOPED_TRACE(round);
    expect_exact({&volume, random_transform({16, 24, 8}, round), {glm::vec3(0.5f), 0.6f, {}, 0, 0}},
                 [](std::size_t, double chord) { return chord; });
  }
}

TEST_P(ConstantDensityTest, AShortBudgetStillReachesTheFarCorner) {
  const SparseVolume volume = solid_block({4, 4, 4});
  // Along the diagonal of a cube, which is sqrt(3) of its edge.
  camera_ = {{4, 4, 4}, {0, 0, 0}, 0.6f};
  const glm::mat4 cube = glm::translate(glm::scale(glm::mat4(1), glm::vec3(1.0f / 8)), glm::vec3(-16));
  for (const std::uint32_t samples : {2u, 5u, 64u}) {
    steps_.samples = samples;
    SCOPED_TRACE(samples);
    expect_exact({&volume, cube, {glm::vec3(0.5f), 0.4f, {}, 0, 0}},
                 [](std::size_t, double chord) { return chord; });
  }
}

TEST_P(ConstantDensityTest, EndsAtTheSceneInPerspectiveDepth) {
  const SparseVolume volume = solid_block({2, 2, 2});
  const Placed placed{&volume, random_transform(glm::vec3(16), 1), {glm::vec3(0.5f), 0.7f, {}, 0, 0}};
  camera_ = {{0.5f, 0.7f, 3}, {0, 0, 0}, 1.3f};  // wide: depth and distance differ by up to 1.6
  // A plane across the view axis through the middle, on the right half of the image only.
  const shared::Camera camera = device_camera();
  const double plane = glm::length(glm::dvec3(camera_.position_world));
  std::vector<float> depth(size_.x * size_.y, 0);
  for (std::size_t i = 0; i < depth.size(); ++i)
    if (i % size_.x > size_.x / 2) depth[i] = static_cast<float>(double{camera.near_z} / plane);
  depth_ = depth_image(depth);
  const reference::RaycastScene scene = scene_of(placed);
  const glm::dvec3 origin(scene.voxel_from_world * glm::dvec4(glm::dvec3(camera.eye_world), 1));
  int shortened = 0;
  expect_exact(placed, [&](std::size_t i, double whole) {
    const glm::dvec3 ray = direction(centre_px(i));
    const glm::dvec2 inside =
        reference::chord(scene, origin, glm::dvec3(scene.voxel_from_world * glm::dvec4(ray, 0)));
    if (depth[i] == 0) return whole;
    const double to_plane = plane / glm::dot(ray, glm::dvec3(camera.forward));
    shortened += inside.x < to_plane && to_plane < inside.y;
    return std::clamp(to_plane - inside.x, 0.0, whole);
  });
  EXPECT_GT(shortened, 30);
}

TEST_P(ConstantDensityTest, DisjointVolumesMultiplyInTheOrderOfTheirDistance) {
  const SparseVolume volume = solid_block({1, 1, 1});
  const auto cube_at = [](glm::vec3 centre) {
    return glm::translate(glm::scale(glm::translate(glm::mat4(1), centre), glm::vec3(0.25f)), glm::vec3(-4));
  };
  // Emission alone, opaque: the nearer one hides the farther one, whatever their order in the list.
  const Placed red{&volume, cube_at({0, 0, 1.5f}), {glm::vec3(0), 50, {1, 0, 0}, 0, 0}};
  const Placed blue{&volume, cube_at({0.3f, 0, -1.5f}), {glm::vec3(0), 50, {0, 0, 1}, 0, 0}};
  const std::size_t middle = size_.x * (size_.y / 2) + size_.x / 2;
  const glm::vec4 one = draw(GetParam(), {red, blue})[middle], other = draw(GetParam(), {blue, red})[middle];
  EXPECT_NEAR(one.x, 1, 2.0f / 1024) << "opaque from a transmittance of 1/1024 on";
  EXPECT_EQ(glm::vec3(one.y, one.z, one.w), glm::vec3(0));
  EXPECT_EQ(other, one);
  // Thin: both count.
  Placed thin_red = red, thin_blue = blue;
  thin_red.look.extinction = thin_blue.look.extinction = 0.4f;
  const float through_red = draw(GetParam(), {thin_red})[middle].w,
              through_blue = draw(GetParam(), {thin_blue})[middle].w;
  const glm::vec4 both = draw(GetParam(), {thin_blue, thin_red})[middle];
  EXPECT_NEAR(both.w, through_red * through_blue, 3.0 / 2048);
  EXPECT_NEAR(both.x, 1 - through_red, 3.0 / 2048);
  EXPECT_NEAR(both.z, through_red * (1 - through_blue), 3.0 / 2048);
}

TEST_P(ConstantDensityTest, LightFallsOffThroughTheWholeVolume) {
  // Lit from above, seen from the side, thin along the view: brightness falls with the depth below the top.
  const SparseVolume volume = solid_block({2, 2, 2});
  light_.to_sun = {0, 1, 0};
  light_.ambient = glm::vec3(0);
  steps_.light_samples = 4;  // as few as make one step 0.87 m long
  camera_ = {{0, 0, 6}, {0, 0, 0}, 0.4f};
  const float sigma = 0.9f;
  const glm::mat4 cube = glm::translate(glm::scale(glm::mat4(1), glm::vec3(0.125f)), glm::vec3(-8));
  const auto pixels = draw(GetParam(), {{&volume, cube, {glm::vec3(1), sigma, {}, 0, 0}}});
  const auto at = [&](std::uint32_t row) { return double{pixels[size_.x * row + size_.x / 2].y}; };
  // Rays of the middle column are level within 1/20 over the cube, so each has one depth within 0.1 m.
  for (std::uint32_t row = 4; row + 5 < size_.y; ++row) {
    const double lower = 6 * std::tan(0.2) * 2 / size_.y;  // of a row [m]
    EXPECT_NEAR(std::log(at(row) / at(row + 1)), double{sigma} * lower, 0.25 * double{sigma} * lower) << row;
  }
}

TEST_P(ConstantDensityTest, PointsBesideThePixelsMiddlesMoveThePicture) {
  const SparseVolume volume = solid_block({1, 1, 1});
  const glm::mat4 cube = glm::translate(glm::scale(glm::mat4(1), glm::vec3(0.25f)), glm::vec3(-4));
  const std::vector<Placed> placed{{&volume, cube, {glm::vec3(0.5f), 0.9f, {0.1f, 0, 0}, 0, 0}}};
  const auto before = draw(GetParam(), placed);
  constexpr std::uint32_t kRight = 3, kDown = 2;
  sample_.pixel = {kRight, kDown};
  const auto moved = draw(GetParam(), placed);
  float brightest = 0;
  for (std::uint32_t y = 0; y + kDown < size_.y; ++y)
    for (std::uint32_t x = 0; x + kRight < size_.x; ++x) {
      const glm::vec4 &expected = before[x + kRight + size_.x * (y + kDown)], &found = moved[x + size_.x * y];
      // Steps on another lattice would be another picture; rounding of rays moves it by less than a step of a
      // half float.
      for (int c = 0; c < 4; ++c) EXPECT_NEAR(found[c], expected[c], 4.0f / 1024) << x << " " << y;
      brightest = std::max(brightest, expected.x);
    }
  EXPECT_GT(brightest, 0.1f);
}

TEST(RaycastPlanTest, StepsReachAcrossTheLongestDiagonal) {
  const shared::Camera camera = planning::device_camera({{0, 0, 6}, {0, 0, 0}, 0.9f}, {40, 20});
  planning::PlacedVolume volume;
  glm::dmat4 sheared(1);
  sheared[1][0] = 3;
  volume.instance.voxel_from_world = shared::affine_of(glm::mat4x3(glm::mat4(glm::inverse(sheared))));
  volume.instance.bounds_max = glm::vec3(1, 1, 1);
  planning::RaycastSteps steps;
  const auto planned = [&] {
    return planning::plan_raycast(camera, {40, 20}, {&volume, 1}, {}, steps).volumes[0];
  };
  EXPECT_FLOAT_EQ(planned().step_length, 0.5f);
  EXPECT_FLOAT_EQ(planned().light_step_length, 2);
  steps = {0.25f, 11, 0.125f, 3};
  const double diagonal = std::sqrt(4.0 * 4 + 1 + 1);
  EXPECT_NEAR(double{planned().step_length}, diagonal / 10, 1e-6);
  EXPECT_NEAR(double{planned().light_step_length}, diagonal / 3, 1e-6);
  steps.samples = steps.light_samples = 1000;
  EXPECT_FLOAT_EQ(planned().step_length, 0.25f);
  EXPECT_FLOAT_EQ(planned().light_step_length, 0.125f);
  volume.instance.voxel_from_world = {};
  EXPECT_THROW(planned(), Error);
}

TEST_F(RaycastTest, IntervalSurfacesHoldThePointsOfTheBox) {
  const SparseVolume volume = solid_block({2, 3, 1});
  const Placed placed{&volume, random_transform({16, 24, 8}, 0), {}};
  draw(RaycastForm::two_pass, {placed});
  const IntervalSurfaces& surfaces = pass(RaycastForm::two_pass).surfaces();
  const auto entries = read_back<glm::vec4>(surfaces.entries), exits = read_back<glm::vec4>(surfaces.exits);
  int inside = 0;
  for (std::size_t i = 0; i < entries.size(); ++i) {
    const auto [shortest, longest] = chords_around(placed, i);
    if (longest == 0) {
      EXPECT_EQ(entries[i], exits[i]);
    }
    if (shortest == 0) continue;
    ++inside;
    for (const glm::vec4& p : {entries[i], exits[i]}) {
      EXPECT_EQ(p.w, 1);
      const glm::vec3 from_faces =
          glm::min(glm::abs(glm::vec3(p)), glm::abs(glm::vec3(p) - glm::vec3(16, 24, 8)));
      EXPECT_LT(std::min({from_faces.x, from_faces.y, from_faces.z}), 1e-3f);
    }
    const double length = glm::length(glm::dvec3(placed.world_from_voxel * (exits[i] - entries[i])));
    EXPECT_GE(length, shortest - kInterpolation);
    EXPECT_LE(length, longest + kInterpolation);
  }
  EXPECT_GT(inside, 60);
}

}  // namespace
}  // namespace brume::passes
