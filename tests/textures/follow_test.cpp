// Textures that follow a field: what regions leave behind is what new textures get at once; wrong calls are
// refused.
#include <gtest/gtest.h>

#include <brume/brume_textures.hpp>
#include <cmath>
#include <cstring>
#include <glm/glm.hpp>
#include <map>

#include "tests/api/match.hpp"

namespace brume::textures {
namespace {

constexpr std::uint8_t kPoison = 0xee;
constexpr std::array<std::size_t, 10> kTexelBytes{0, 1, 2, 4, 8, 16, 2, 4, 8, 16};

/// Textures as a renderer holds them.
class Held {
 public:
  void follow(const api::Textures& textures) {
    const auto list = textures.list();
    for (std::uint32_t kind = 0; kind < list.size(); ++kind)
      if (list[kind].generation != list_[kind].generation)
        texels_[kind].assign(std::size_t{list[kind].width} * list[kind].height * list[kind].depth *
                                 kTexelBytes[list[kind].format],
                             kPoison);
    list_ = list;
    for (const brume_region& region : textures.regions()) apply(region);
    constants_ = textures.constants();
  }
  /// Bricks with density or cells at walls whose displacement or light was never written.
  int unwritten() const {
    const auto edge = [&](std::uint32_t kind) { return kind == BRUME_TEXTURE_CELLS ? 9u : 10u; };
    const glm::uvec3 atlas(constants_[12], constants_[13], constants_[14]);
    int count = 0;
    const auto page_count = texels_[BRUME_TEXTURE_PAGES].size() / 2;
    for (std::size_t i = 0; i < page_count; ++i) {
      std::uint16_t page = 0;
      std::memcpy(&page, texels_[BRUME_TEXTURE_PAGES].data() + 2 * i, 2);
      if (page == 0) continue;
      const std::uint32_t slot = page - 1u;
      const glm::uvec3 place(slot % atlas.x, slot / atlas.x % atlas.y, slot / (atlas.x * atlas.y));
      // The texel in the middle of the brick, and whether any byte of the brick is above 0.
      const auto any = [&](std::uint32_t kind, std::uint32_t step, std::uint32_t first) {
        const std::uint32_t n = edge(kind);
        const std::size_t texel = kTexelBytes[list_[kind].format];
        for (std::uint32_t t = 0; t < n * n * n; ++t) {
          const glm::uvec3 at = n * place + glm::uvec3(t % n, t / n % n, t / (n * n));
          const std::size_t from = texel * (at.x + std::size_t{list_[kind].width} *
                                                       (at.y + std::size_t{list_[kind].height} * at.z));
          for (std::size_t b = first; b < texel; b += step)
            if (texels_[kind][from + b] != 0) return true;
        }
        return false;
      };
      if (!any(BRUME_TEXTURE_DENSITY, 2, 0) && !any(BRUME_TEXTURE_CELLS, 1, 0)) continue;
      for (const std::uint32_t kind : {BRUME_TEXTURE_DISPLACEMENT, BRUME_TEXTURE_LIGHT}) {
        const glm::uvec3 at = 10u * place + 5u;
        const std::size_t from =
            kTexelBytes[list_[kind].format] *
            (at.x + std::size_t{list_[kind].width} * (at.y + std::size_t{list_[kind].height} * at.z));
        if (texels_[kind][from] == kPoison && texels_[kind][from + 1] == kPoison) ++count;
      }
    }
    return count;
  }
  /// Whether it holds all that regions of new textures write; prints the first texture that does not.
  bool has(const api::Textures& fresh) const {
    const auto list = fresh.list();
    for (const brume_region& region : fresh.regions()) {
      if (region.texture == BRUME_TEXTURE_PAGES) {
        if (!has_pages(fresh, region)) return false;
        continue;
      }
      const brume_texture& theirs = list[region.texture];
      const brume_texture& mine = list_[region.texture];
      if (mine.format != theirs.format || mine.width != theirs.width) return false;
      bool same = true;
      rows(region, [&](std::size_t at, const std::uint8_t* row, std::size_t bytes) {
        same = same && at + bytes <= texels_[region.texture].size() &&
               std::memcmp(texels_[region.texture].data() + at, row, bytes) == 0;
      });
      if (!same) {
        std::printf("texture %u differs\n", region.texture);
        return false;
      }
    }
    return true;
  }

 private:
  template <typename Body>
  void rows(const brume_region& region, Body body) const {
    const brume_texture& texture = list_[region.texture];
    const std::size_t texel = kTexelBytes[texture.format], bytes = texel * region.width;
    const auto* from = static_cast<const std::uint8_t*>(region.texels);
    for (std::uint32_t z = 0; z < region.depth; ++z)
      for (std::uint32_t y = 0; y < region.height; ++y, from += bytes)
        body(texel * (region.x + std::size_t{texture.width} *
                                     (region.y + y + std::size_t{texture.height} * (region.z + z))),
             from, bytes);
  }
  /// Pages by their bricks: the windows may differ.
  bool has_pages(const api::Textures& fresh, const brume_region& region) const {
    const auto theirs = fresh.constants();
    const auto* page = static_cast<const std::uint16_t*>(region.texels);
    for (std::uint32_t z = region.z; z < region.z + region.depth; ++z)
      for (std::uint32_t y = 0; y < region.height; ++y)
        for (std::uint32_t x = 0; x < region.width; ++x, ++page) {
          const glm::ivec3 brick = glm::ivec3(x, y, z) + glm::ivec3(theirs[4], theirs[5], theirs[6]);
          const glm::ivec3 at = brick - glm::ivec3(constants_[4], constants_[5], constants_[6]);
          const glm::ivec3 size(constants_[8], constants_[9], constants_[10]);
          const bool inside =
              glm::all(glm::greaterThanEqual(at, glm::ivec3(0))) && glm::all(glm::lessThan(at, size));
          std::uint16_t mine = 0;
          if (inside)
            std::memcpy(
                &mine, texels_[BRUME_TEXTURE_PAGES].data() + 2 * (at.x + size.x * (at.y + size.y * at.z)), 2);
          if (mine != *page) return false;
        }
    return true;
  }
  void apply(const brume_region& region) {
    const brume_texture& texture = list_[region.texture];
    ASSERT_LE(region.x + region.width, texture.width);
    ASSERT_LE(region.y + region.height, texture.height);
    ASSERT_LE(region.z + region.depth, texture.depth);
    ASSERT_EQ(region.byte_count,
              std::size_t{region.width} * region.height * region.depth * kTexelBytes[texture.format]);
    ASSERT_EQ(reinterpret_cast<std::uintptr_t>(region.texels) % 4, 0u);
    rows(region, [&](std::size_t at, const std::uint8_t* row, std::size_t bytes) {
      std::memcpy(texels_[region.texture].data() + at, row, bytes);
    });
  }

  std::array<brume_texture, BRUME_TEXTURE_COUNT> list_{};
  std::array<std::vector<std::uint8_t>, BRUME_TEXTURE_COUNT> texels_;
  std::array<float, BRUME_CONSTANTS> constants_{};
};

class FollowTest : public testing::Test {
 protected:
  FollowTest() {
    brume_world_params of_world = brume_world_defaults();
    of_world.masks = masks_.get();
    world_.emplace(level_, of_world);
    world_->append(match_.events);
    brume_field_params of_field = brume_field_defaults();
    of_field.masks = masks_.get();
    field_.emplace(level_, of_field);
  }
  double show(std::uint32_t tick) {
    world_->advance_to(tick);
    field_->update(world_->state());
    return tick / 64.0;
  }

  api::Match match_;
  api::Context context_;
  api::Level level_ = match_.level(context_);
  api::Masks masks_ = match_.masks(context_);
  std::optional<api::World> world_;
  std::optional<api::Field> field_;
};

TEST_F(FollowTest, RegionsAddUpToNewTextures) {
  for (const std::uint32_t spacing : {1u, 2u}) {
    brume_textures_params params = brume_textures_defaults();
    params.noise_spacing = spacing;
    params.light_count = 1;
    params.sky = 1;
    api::Textures textures(*field_, params);
    const brume_texture_light light{0, {6, 3, 6}};
    brume_textures_frame frame = brume_textures_frame_defaults();
    frame.lights = &light;
    Held held;
    // Forwards, backwards, and past updates that the textures did not see.
    std::uint32_t number = 0;
    for (const std::uint32_t tick : {0u, 30u, 31u, 32u, 120u, 121u, 60u, 61u, 250u, 251u, 252u, 400u}) {
      frame.seconds = show(tick);
      if (number++ % 5 == 4) continue;
      textures.update(*field_, frame);
      held.follow(textures);
      api::Textures fresh(*field_, params);
      fresh.update(*field_, frame);
      EXPECT_TRUE(held.has(fresh)) << "tick " << tick << ", spacing " << spacing;
      const auto constants = textures.constants(), expected = fresh.constants();
      for (std::size_t i = 12; i < 15; ++i) EXPECT_EQ(constants[i], expected[i]) << "bricks of the textures";
    }
  }
}

TEST_F(FollowTest, AllThatShadersReadIsWritten) {
  brume_textures_params params = brume_textures_defaults();
  params.light_count = 1;
  const brume_texture_light light{0, {6, 3, 6}};
  brume_textures_frame frame = brume_textures_frame_defaults();
  frame.lights = &light;
  for (const std::uint32_t tick : {20u, 90u, 130u, 250u, 400u}) {
    frame.seconds = show(tick);
    const api::Field& field = *field_;
    api::Textures textures(field, params);
    textures.update(field, frame);
    Held held;
    held.follow(textures);
    EXPECT_EQ(held.unwritten(), 0) << tick;
  }
}

TEST_F(FollowTest, AFieldAtRestChangesDisplacementAlone) {
  api::Textures textures(*field_);
  const double seconds = show(200);
  textures.update(*field_, seconds);
  textures.update(*field_, seconds + 0.005);
  ASSERT_FALSE(textures.regions().empty());
  for (const brume_region& region : textures.regions())
    EXPECT_TRUE(region.texture == BRUME_TEXTURE_DISPLACEMENT || region.texture == BRUME_TEXTURE_HOLES);
}

TEST_F(FollowTest, LightFoundInTurnsIsThatFoundAtOnce) {
  brume_textures_params params = brume_textures_defaults();
  params.light_count = 2;
  const std::array lights{brume_texture_light{0, {6, 3, 6}}, brume_texture_light{1, {0.6f, 0.8f, 0}}};
  brume_textures_frame frame = brume_textures_frame_defaults();
  frame.lights = lights.data();
  api::Textures textures(*field_, params);
  Held held;
  for (const std::uint32_t tick : {30u, 300u}) {
    // Two rounds of four turns at rest: the second meets the densities of the first everywhere.
    frame.seconds = show(tick);
    frame.light_update_fraction = 0.25f;
    for (int i = 0; i < 8; ++i) {
      textures.update(*field_, frame);
      held.follow(textures);
    }
    api::Textures at_once(*field_, params);
    frame.light_update_fraction = 0;
    at_once.update(*field_, frame);
    EXPECT_TRUE(held.has(at_once)) << tick;
  }
}

// What walls hide is remembered, until a light moves or a door does.
TEST_F(FollowTest, LightFollowsLightsAndDoorsThatMove) {
  brume_textures_params params = brume_textures_defaults();
  params.light_count = 2;
  params.sky = 1;
  std::array lights{brume_texture_light{0, {6, 3, 6}}, brume_texture_light{1, {0.6f, 0.8f, 0}}};
  brume_textures_frame frame = brume_textures_frame_defaults();
  frame.lights = lights.data();
  api::Textures textures(*field_, params);
  Held held;
  for (const std::uint32_t tick : {89u, 91u, 91u, 91u}) {
    frame.seconds = show(tick);
    textures.update(*field_, frame);
    held.follow(textures);
    api::Textures fresh(*field_, params);
    fresh.update(*field_, frame);
    EXPECT_TRUE(held.has(fresh)) << tick;
    // Into the next room, and the numbers exchanged.
    for (brume_texture_light& light : lights)
      if (light.directional == 0) light.at.x += 9;
    std::swap(lights[0], lights[1]);
  }
}

TEST_F(FollowTest, WrongCallsAreRefused) {
  api::Textures textures(*field_);
  brume_textures* none = nullptr;
  brume_textures_params params = brume_textures_defaults();
  params.noise_spacing = 3;
  EXPECT_EQ(brume_textures_create(field_->get(), &params, &none), BRUME_ERROR_ARGUMENT);
  params = brume_textures_defaults();
  params.light_count = BRUME_MAX_TEXTURE_LIGHTS + 1;
  EXPECT_EQ(brume_textures_create(field_->get(), &params, &none), BRUME_ERROR_ARGUMENT);
  params = brume_textures_defaults();
  params.swirl_seconds = std::nanf("");
  EXPECT_EQ(brume_textures_create(field_->get(), &params, &none), BRUME_ERROR_ARGUMENT);
  EXPECT_EQ(none, nullptr);

  brume_textures_frame frame = brume_textures_frame_defaults();
  frame.seconds = -1;
  EXPECT_EQ(brume_textures_update(textures.get(), field_->get(), &frame), BRUME_ERROR_ARGUMENT);
  frame.seconds = std::nan("");
  EXPECT_EQ(brume_textures_update(textures.get(), field_->get(), &frame), BRUME_ERROR_ARGUMENT);
  EXPECT_EQ(brume_textures_update(textures.get(), field_->get(), nullptr), BRUME_ERROR_ARGUMENT);
  EXPECT_EQ(brume_textures_update(textures.get(), nullptr, &frame), BRUME_ERROR_HANDLE);

  // Lights.
  params = brume_textures_defaults();
  params.light_count = 1;
  api::Textures lit(*field_, params);
  frame = brume_textures_frame_defaults();
  EXPECT_EQ(brume_textures_update(lit.get(), field_->get(), &frame), BRUME_ERROR_ARGUMENT);
  brume_texture_light sun{1, {0, 2, 0}};
  frame.lights = &sun;
  EXPECT_EQ(brume_textures_update(lit.get(), field_->get(), &frame), BRUME_ERROR_ARGUMENT);
  sun.at.y = 1;
  EXPECT_EQ(brume_textures_update(lit.get(), field_->get(), &frame), BRUME_OK);
  frame.light_update_fraction = 2;
  EXPECT_EQ(brume_textures_update(lit.get(), field_->get(), &frame), BRUME_ERROR_ARGUMENT);

  // A field of another level.
  const api::Level other = match_.level(context_);
  const api::Field foreign(other);
  frame = brume_textures_frame_defaults();
  EXPECT_EQ(brume_textures_update(textures.get(), foreign.get(), &frame), BRUME_ERROR_MISMATCH);

  std::array<brume_texture, BRUME_TEXTURE_COUNT> list;
  EXPECT_EQ(brume_textures_list(textures.get(), list.data(), 3), BRUME_ERROR_ARGUMENT);
  std::array<float, BRUME_CONSTANTS> constants;
  EXPECT_EQ(brume_textures_constants(textures.get(), constants.data(), 7), BRUME_ERROR_ARGUMENT);
  EXPECT_EQ(brume_textures_regions(textures.get(), nullptr, nullptr), BRUME_ERROR_ARGUMENT);
}

}  // namespace
}  // namespace brume::textures
