// What shaders/export/smoke.glsl draws in a renderer that has the textures of brume_textures.h alone: against
// lines of sight, which integrate the same smoke exactly on the CPU.
#include <gtest/gtest.h>

#include <brume/brume_textures.hpp>
#include <cmath>

#include "tests/api/match.hpp"
#include "tests/textures/gl_engine.hpp"

namespace brume::textures {
namespace {

constexpr float kFar = 40;

class ShaderTest : public testing::Test {
 protected:
  ShaderTest() {
    brume_world_params params = brume_world_defaults();
    params.masks = masks_.get();
    world_.emplace(level_, params);
    world_->append(match_.events);
    brume_field_params of_field = brume_field_defaults();
    of_field.masks = masks_.get();
    field_.emplace(level_, of_field);
  }
  void show(api::Textures& textures, std::uint32_t tick) {
    world_->advance_to(tick);
    const api::State state = world_->state();
    field_->update(state);
    textures.update(*field_, tick / 64.0);
    engine_.follow(textures.get());
  }
  /// The optical depths of all pixels' rays.
  std::vector<float> depths(const Eye& eye, int width, int height, const brume_drawn_params* drawn) const {
    const Picture picture{width, height, {}};
    std::vector<brume_segment> lines;
    for (int y = 0; y < picture.height; ++y)
      for (int x = 0; x < picture.width; ++x) {
        const glm::vec3 a = eye.position, b = a + kFar * eye.direction(picture, x, y);
        lines.push_back({{a.x, a.y, a.z}, {b.x, b.y, b.z}});
      }
    return drawn ? field_->drawn_depths(lines, *drawn) : field_->optical_depths(lines);
  }

  api::Match match_;
  api::Context context_;
  api::Level level_ = match_.level(context_);
  api::Masks masks_ = match_.masks(context_);
  std::optional<api::World> world_;
  std::optional<api::Field> field_;
  GlEngine engine_;
};

const Eye kEye = Eye::looking({1, 2.5f, 1}, {14, 1, 11}, 70);

/// How far two pictures of what smoke lets through are apart.
struct Apart {
  double mean = 0;
  double leak = 0;   // the most that passes where less than 1/1000 should
  double smoky = 0;  // the part of the pixels that have any smoke
};
Apart compare(const Picture& picture, const std::vector<float>& depths) {
  Apart apart;
  for (std::size_t i = 0; i < depths.size(); ++i) {
    const double error = std::abs(std::exp(-double{depths[i]}) - double{picture.texels[i].x});
    apart.mean += error / static_cast<double>(depths.size());
    if (depths[i] > 7) apart.leak = std::max(apart.leak, double{picture.texels[i].x});
    apart.smoky += depths[i] > 0.01f ? 1 / static_cast<double>(depths.size()) : 0;
  }
  return apart;
}

const std::string kWhite =
    "vec3 brume_light(vec3 position, vec3 texel, vec3 direction) { return vec3(1.0); }\n";

TEST_F(ShaderTest, LetsThroughWhatLinesOfSightDo) {
  brume_drawn_params plain = brume_drawn_defaults();
  plain.erosion = plain.hole_rim = 0;
  brume_textures_params params = brume_textures_defaults();
  params.look = &plain;
  api::Textures textures(*field_, params);
  const GLuint program = engine_.program(
      kWhite, "color = vec4(brume_transmittance(origin, origin + 40.0 * direction, 2000, 0.0));");
  for (const std::uint32_t tick : {40u, 130u, 222u, 300u}) {
    show(textures, tick);
    const Apart apart = compare(engine_.draw(program, kEye, 96, 54), depths(kEye, 96, 54, nullptr));
    // Less than a step of a display; and nothing shines through what is opaque.
    EXPECT_LT(apart.mean, 1.0 / 255) << tick;
    EXPECT_LT(apart.leak, 1.0 / 255) << tick;
    EXPECT_GT(apart.smoky, tick < 200 ? 0.02 : 0.3) << tick;
  }
}

TEST_F(ShaderTest, HlslDrawsWhatGlslDoes) {
  brume_textures_params params = brume_textures_defaults();
  params.light_count = 1;
  params.sky = 1;
  api::Textures textures(*field_, params);
  const std::string main = "color = brume_march(origin, direction, 40.0, 0.5, pixel_width);\n";
  const std::string body =
      "return brume_scattered(brume_light_at(texel, 0).x, direction.y, albedo, 0.2, brume_sky_at(texel).x) "
      "+\n"
      "  brume_scattered_sky(brume_sky_at(texel), albedo, 0.2 * albedo, albedo, 0.2); }\n";
  const GLuint glsl = engine_.program(
      "vec3 brume_light(vec3 position, vec3 texel, vec3 direction) { vec3 albedo = vec3(0.9, 0.8, 0.7);\n" +
          body,
      main);
  const GLuint hlsl = engine_.program_of_hlsl(
      "float3 brume_light(float3 position, float3 texel, float3 direction) { float3 albedo = float3(0.9, "
      "0.8, 0.7);\n" +
          body,
      main);
  const brume_texture_light light{0, {6, 3, 6}};
  brume_textures_frame frame = brume_textures_frame_defaults();
  frame.lights = &light;
  for (const std::uint32_t tick : {130u, 222u, 300u}) {
    world_->advance_to(tick);
    field_->update(world_->state());
    frame.seconds = tick / 64.0;
    textures.update(*field_, frame);
    engine_.follow(textures.get());
    const Picture a = engine_.draw(glsl, kEye, 96, 54), b = engine_.draw(hlsl, kEye, 96, 54);
    double apart = 0;
    for (std::size_t i = 0; i < a.texels.size(); ++i)
      apart += double{glm::dot(glm::abs(a.texels[i] - b.texels[i]), glm::vec4(0.25f))};
    EXPECT_LT(apart / static_cast<double>(a.texels.size()), 1e-4) << tick;
  }
}

TEST_F(ShaderTest, LetsThroughWhatDrawnLinesOfSightDo) {
  const brume_drawn_params drawn = brume_drawn_defaults();
  api::Textures textures(*field_);
  const GLuint program = engine_.program(
      kWhite, "color = vec4(brume_transmittance(origin, origin + 40.0 * direction, 2000, 0.0));");
  for (const std::uint32_t tick : {40u, 130u, 222u, 300u}) {
    show(textures, tick);
    const Apart apart = compare(engine_.draw(program, kEye, 48, 27), depths(kEye, 48, 27, &drawn));
    // Where the noise is steep, single rays differ more.
    EXPECT_LT(apart.mean, 2.0 / 255) << tick;
    EXPECT_GT(apart.smoky, tick < 200 ? 0.005 : 0.15) << tick;
  }
}

}  // namespace
}  // namespace brume::textures
