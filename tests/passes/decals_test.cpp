// Decals without scatter: each pixel against double precision.
#include "passes/decals.hpp"

#include "tests/passes/decal_fixture.hpp"

namespace brume::passes {
namespace {

using planning::DecalInput;
using reference::Interval;

class DecalsTest : public DecalFixture {
 protected:
  /// Somewhere before the camera, rotated, scaled by other factors along each axis.
  DecalInput random_decal(std::size_t volume) {
    DecalInput decal;
    decal.world_from_box = glm::translate(glm::mat4(1), 2.0f * random_vector()) *
                           glm::rotate(glm::mat4(1), 3 * unit(), glm::normalize(random_vector())) *
                           glm::scale(glm::mat4(1), 0.7f + 1.5f * glm::abs(random_vector()));
    decal.volume = volume;
    decal.strength = 0.2f + 0.8f * unit();
    decal.gamma = 0.3f + 3 * unit();
    decal.correction = unit();
    decal.falloff = 3 * unit();
    decal.fade = 0.5f * unit();
    if (unit() < 0.5f) {
      decal.middle = 0.5f * random_vector();
      decal.radius = 0.3f + unit();
    }
    return decal;
  }
  void add_awkward_volumes() {
    add_random_volume({1, 1, 1}, {glm::dvec3(-1), glm::dvec3(1)});
    add_random_volume({7, 3, 5}, {{-1.5, -0.25, -1}, {0.5, 1.75, 2}});
    add_random_volume({16, 33, 9}, {glm::dvec3(-1.25), glm::dvec3(1.5)});
    add_random_volume({64, 2, 3}, {{-2, -1, -0.5}, {2, 1, 0.5}});
  }

  /// Draws the decals, and returns how many pixels they darken.
  int expect_reference(const std::vector<DecalInput>& decals) {
    const std::vector<glm::vec4> drawn = draw(decals);
    std::vector<reference::Decal> models;
    for (const DecalInput& decal : decals) models.push_back(model_of(decal));
    int darkened = 0;
    for (std::size_t i = 0; i < pixels(); ++i) {
      Interval remaining(1, 0);
      if (depth_[i] > 0 && !moves(i))
        for (const reference::Decal& model : models) {
          const Interval one = model.at(model.uvw(p_world(i)), weights(model, i), errors_of(model, i));
          remaining.low *= 1 - std::min(one.high, 1.0);
          remaining.high *= 1 - std::max(one.low, 0.0);
        }
      Interval occlusion;
      occlusion.low = 1 - remaining.high;
      occlusion.high = 1 - remaining.low;
      const Interval bound = stored(occlusion, decals.size());
      EXPECT_GE(drawn[i].x, bound.low) << i;
      EXPECT_LE(drawn[i].x, bound.high) << i;
      darkened += drawn[i].x > 0;
      widest_ = std::max(widest_, bound.high - bound.low);
    }
    return darkened;
  }
  double widest_ = 0;  ///< Of all bounds so far.
};

TEST_F(DecalsTest, EqualAReferenceAtEveryPixel) {
  add_awkward_volumes();
  int darkened = 0;
  for (const glm::uvec2 size : {glm::uvec2(33, 17), glm::uvec2(1, 1), glm::uvec2(8, 8), glm::uvec2(65, 3)})
    for (const std::size_t count : {1u, 2u, 7u, 32u}) {
      resize(size);
      set_random_surfaces();
      std::vector<DecalInput> decals;
      for (std::size_t i = 0; i < count; ++i) decals.push_back(random_decal(i % volumes_.size()));
      darkened += expect_reference(decals);
    }
  // Of some 2,000 surfaces that do not move; random boxes cover part of them.
  EXPECT_GT(darkened, 400);
}

// Without the steps of faces that fade within little, and without powers below 1, which are steep at 0, the
// bounds tell much less than a step of a display's 255 from nothing.
TEST_F(DecalsTest, EqualAReferenceClosely) {
  add_random_volume({16, 33, 9}, {glm::dvec3(-2.25), glm::dvec3(2.5)});
  resize({64, 36});
  set_random_surfaces();
  DecalInput decal = random_decal(0);
  decal.world_from_box = glm::rotate(glm::mat4(1), 0.5f, glm::vec3(0.6f, 0, 0.8f));
  decal.gamma = 1.5f;
  decal.fade = 0.3f;
  decal.radius = 0;
  EXPECT_GT(expect_reference({decal}), 50);
  EXPECT_LT(widest_, 5.0 / 255) << "4 / 256 of it are the 8 bits of a filter, twice, up and down";
}

TEST_F(DecalsTest, AreNothingOutsideOnMovingSurfacesAndInTheSky) {
  add_volume({2, 2, 2}, {glm::dvec3(-1.5), glm::dvec3(1.5)}, [](glm::uvec3) { return glm::vec2(1); });
  set_random_surfaces();
  DecalInput decal;
  decal.world_from_box = glm::rotate(glm::mat4(1), 0.4f, glm::vec3(0, 1, 0));
  const reference::Decal model = model_of(decal);
  for (const float scatter : {0.0f, 4.0f}) {
    decal.scatter = scatter;
    const auto drawn = draw({decal});
    int inside = 0, outside = 0, untouched = 0;
    for (std::size_t i = 0; i < pixels(); ++i) {
      if (depth_[i] == 0 || moves(i)) {
        EXPECT_EQ(drawn[i].x, 0) << i;
        ++untouched;
        continue;
      }
      const glm::dvec3 uvw = model.uvw(p_world(i)), margin = errors_of(model, i).uvw;
      if (!model.contains(uvw, margin)) {
        EXPECT_EQ(drawn[i].x, 0) << i;
        ++outside;
      } else if (model.contains(uvw, -margin) && scatter == 0) {
        EXPECT_EQ(drawn[i].x, 1) << i;
        ++inside;
      }
    }
    EXPECT_GT(outside, 100);
    EXPECT_GT(untouched, 100);
    if (scatter == 0) {
      EXPECT_GT(inside, 20);
    }
  }
}

TEST_F(DecalsTest, ThatMissTheImageOrHaveNoStrengthAreNotPlaced) {
  add_random_volume({3, 3, 3}, {glm::dvec3(-1), glm::dvec3(1)});
  set_random_surfaces();
  DecalInput behind, beside, weightless;
  behind.world_from_box = glm::translate(glm::mat4(1), glm::vec3(0, 1, 9));
  beside.world_from_box = glm::translate(glm::mat4(1), glm::vec3(30, 0, 0));
  weightless.strength = 0;
  EXPECT_TRUE(plan({behind, beside, weightless}).empty());
  EXPECT_EQ(expect_reference({behind, beside, weightless}), 0);
  EXPECT_EQ(plan({behind, DecalInput(), beside}).size(), 1u);
  EXPECT_GT(expect_reference({behind, DecalInput(), beside}), 0);
  EXPECT_THROW((void)plan(std::vector<DecalInput>(shared::kMaxDecals + 1)), Error);
}

// All numbers are sums of few powers of two: nothing rounds. A decal fades out at its faces, without `fade`
// within 1e-4 of the box.
TEST_F(DecalsTest, EndAtTheFacesOfTheBox) {
  resize({32, 16});
  camera_.eye_world = {0, 0, 0};
  camera_.forward = {0, 0, -1};
  camera_.right = {1, 0, 0};
  camera_.up = {0, 0.5f, 0};
  camera_.near_z = 0.0625f;
  for (std::size_t i = 0; i < pixels(); ++i) depth_[i] = 0.0625f / 2;
  add_volume({2, 2, 2}, {glm::dvec3(-4, -4, -1), glm::dvec3(4, 4, 1)},
             [](glm::uvec3) { return glm::vec2(1); });
  for (const float face : {-1.0f, 1.0f})
    for (const float beyond : {-0.0009765625f, 0.0f, 0.0009765625f}) {
      DecalInput decal;
      decal.world_from_box = glm::translate(glm::mat4(1), glm::vec3(0, 0, -2 + face * (1 + beyond)));
      const float expected = beyond < 0 ? 1.0f : 0.0f;
      for (const glm::vec4& texel : draw({decal})) EXPECT_EQ(texel.x, expected) << face << " " << beyond;
    }
}

// A field that is linear along each axis, and a plane that crosses all slices and many texels: the image is
// as linear, also where samples go on in other tiles.
TEST_F(DecalsTest, HaveNoSeamsAtTheBordersOfTiles) {
  resize({160, 90});
  set_plane(1, 0);
  const glm::dvec3 size(32, 24, 40);
  const auto linear = [&](glm::dvec3 uvw) { return 0.1 + 0.2 * uvw.x + 0.25 * uvw.y + 0.4 * uvw.z; };
  add_volume(glm::uvec3(size), {glm::dvec3(-3), glm::dvec3(3)}, [&](glm::uvec3 voxel) {
    return glm::vec2(static_cast<float>(linear((glm::dvec3(voxel) + 0.5) / size)));
  });
  DecalInput decal;
  decal.world_from_box = glm::rotate(glm::mat4(1), 0.7f, glm::normalize(glm::vec3(1, 2, 0.5f)));
  const reference::Decal model = model_of(decal);
  const auto drawn = draw({decal});
  int count = 0;
  for (std::size_t i = 0; i < pixels(); ++i) {
    if (depth_[i] == 0) continue;
    // Beyond the middle of the outermost texels the field is constant.
    const glm::dvec3 uvw = model.uvw(p_world(i));
    if (!model.contains(uvw, -0.5 / size)) continue;
    ++count;
    // As in the bound of any field, but neighbours differ by this much only; texels are rounded to half
    // floats.
    const reference::DecalErrors errors = errors_of(model, i);
    const glm::dvec3 slope(0.2, 0.25, 0.4);
    const double neighbours = std::max({0.2 / size.x, 0.25 / size.y, 0.4 / size.z});
    const double bound =
        errors.value * neighbours + glm::dot(errors.uvw, slope) + 2 * std::ldexp(1.0, -11) + 2e-6;
    EXPECT_NEAR(drawn[i].x, linear(uvw), bound) << i;
  }
  EXPECT_GT(count, 3000);
}

}  // namespace
}  // namespace brume::passes
