#include "scenario/shot_masks.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>

#include "image/font.hpp"
#include "image/png.hpp"
#include "scenario/simulation.hpp"
#include "smoke/holes.hpp"
#include "tests/work_folder.hpp"

namespace brume::scenario {
namespace {

/// Open air, 12 x 6 x 8 m, with a smoke in its middle that fills much of it, and the shots of a
/// timeline.
Scenario air(scene::Timeline timeline) {
  timeline.smoke.voxels = 60000;
  timeline.smokes = {{0.0, {0, 2, 0}, {0, 2, 0}}};
  const voxel::GridLayout layout{{60, 30, 40}, 0.2f, glm::vec3(-6, -1, -4)};
  auto masks = load_masks(timeline).value_or_throw();
  return {std::move(timeline),      {}, {}, Voxels{voxel::BitGrid(layout), {}}, std::move(masks.atlas),
          std::move(masks.of_shots)};
}

scene::TextEvent text_event(const std::string& text) {
  scene::TextEvent event;
  event.time = 2;
  event.text = text;
  event.from_world = {0.3f, 2, 6};
  event.toward_world = {0.3f, 2, 0};
  event.size = 0.5f;
  event.times = {0.25f, 0.05f, 1, 0.35f};
  return event;
}

/// The expected row of letters: the glyph texel at a point, in capital heights from the middle.
class ExpectedRow {
 public:
  explicit ExpectedRow(const std::string& text) {
    image::Font font = image::Font::load(image::default_font()).value_or_throw();
    float low = 1e9f, high = -1e9f;
    for (const image::PlacedLetter& placed : font.row(text, 0).value_or_throw()) {
      image::Glyph glyph = font.glyph(placed.character).value_or_throw();
      glyph.centre_x += placed.pen;
      low = std::min(low, glyph.centre_x - glyph.half_side);
      high = std::max(high, glyph.centre_x + glyph.half_side);
      glyphs_.push_back(std::move(glyph));
    }
    middle_ = 0.5f * (low + high);
    half_width_ = 0.5f * (high - low);
  }
  float half_width() const { return half_width_; }
  /// Minimum and maximum coverage within a texel of the point.
  std::pair<int, int> coverage_around(float right, float up) const {
    int least = 255, greatest = 0;
    for (int i = 0; i < 9; ++i) {
      const float aside = static_cast<float>(i % 3 - 1), above = static_cast<float>(i / 3 - 1);
      int covered = 0;
      for (const image::Glyph& g : glyphs_) {
        const float texels = static_cast<float>(g.side) / (2 * g.half_side);
        const float x = (right + middle_ - g.centre_x + g.half_side) * texels + aside;
        const float y = (g.centre_y + g.half_side - up - 0.5f) * texels + above;
        if (x < 0 || y < 0 || x >= static_cast<float>(g.side) || y >= static_cast<float>(g.side)) continue;
        const auto at = static_cast<std::size_t>(y) * g.side + static_cast<std::size_t>(x);
        covered = std::max(covered, int{g.coverage[at]});
      }
      least = std::min(least, covered);
      greatest = std::max(greatest, covered);
    }
    return {least, greatest};
  }

 private:
  std::vector<image::Glyph> glyphs_;
  float middle_ = 0, half_width_ = 0;
};

/// Fraction of the smoke that remains after all holes at a point.
float remaining_at(const Scenario& scenario, const std::vector<shared::Hole>& holes, glm::vec3 p,
                   float time) {
  float left = 1;
  for (const shared::Hole& hole : holes)
    left *= 1 - smoke::hole_strength_masked(hole, p, time, 0, scenario.masks);
  return left;
}

struct Comparison {
  int ink = 0, paper = 0, wrong = 0;
};

/// Compares the row, viewed along its shots (mirrored: from behind), with the glyphs of the font, except at
/// their edges.
Comparison compare(const Scenario& scenario, const std::vector<shared::Hole>& holes, float time,
                   bool from_behind, bool mirror_expected) {
  const ExpectedRow expected(scenario.timeline.texts[0].text);
  const scene::TextEvent& event = scenario.timeline.texts[0];
  Comparison result;
  for (float right = -expected.half_width(); right < expected.half_width(); right += 0.01f)
    for (float up = -0.9f; up < 0.9f; up += 0.01f) {
      const auto [least, greatest] = expected.coverage_around(mirror_expected ? -right : right, up);
      if (least < 250 && greatest > 5) continue;
      // The shooter looks along -z: x is to the right. From behind it is to the left.
      const glm::vec3 p = event.toward_world + event.size * glm::vec3(from_behind ? -right : right, up, 0);
      const bool open = remaining_at(scenario, holes, p, time) < 0.5f;
      (least >= 250 ? result.ink : result.paper) += 1;
      result.wrong += open != (least >= 250);
    }
  return result;
}

TEST(Text, MatchesItsGlyphsMirroredFromBehindAndCloses) {
  scene::Timeline timeline;
  timeline.texts = {text_event("BRUME")};
  const Scenario scenario = air(timeline);
  const auto simulation = Simulation::create(scenario).value_or_throw();
  simulation->advance_to(2.8);
  const auto& world = simulation->world();
  const auto holes = smoke::make_holes(world.state(), &scenario.masks);
  ASSERT_EQ(holes.size(), 5u);
  const float time = world.state().seconds(world.tick());

  const Comparison front = compare(scenario, holes, time, false, false);
  EXPECT_GT(front.ink, 5000);
  EXPECT_GT(front.paper, 20000);
  EXPECT_EQ(front.wrong, 0);
  const Comparison behind = compare(scenario, holes, time, true, true);
  EXPECT_EQ(behind.wrong, 0);
  const Comparison unmirrored = compare(scenario, holes, time, true, false);
  EXPECT_GT(unmirrored.wrong, 1000) << "BRUME does not read from behind";

  // 0.25 s of flight, 0.05 s opening, 1 s open, 0.35 s closing.
  simulation->advance_to(3.7);
  EXPECT_TRUE(simulation->world().state().holes.empty());
  for (const shared::Hole& hole : holes)
    EXPECT_EQ(shared::hole_strength(hole, glm::vec3(0.3f, 2, 0), 3.66f, 0), 0);
}

TEST(Text, BecomesParallelShotsOfTheRightSizesAndTimes) {
  scene::Timeline timeline;
  timeline.texts = {text_event("A mi")};
  timeline.texts[0].from_world = {3, 1, 4};
  timeline.texts[0].toward_world = {0, 2, 0};
  timeline.texts[0].interval = 0.25f;
  const Scenario scenario = air(timeline);
  std::vector<sim::Shot> shots;
  for (const sim::Event& event : events_of(scenario).value_or_throw())
    if (const auto* shot = std::get_if<sim::Shot>(&event)) shots.push_back(*shot);
  ASSERT_EQ(shots.size(), 3u) << "the blank is none";
  for (std::size_t i = 0; i < shots.size(); ++i) {
    EXPECT_EQ(shots[i].toward - shots[i].origin, shots[0].toward - shots[0].origin);
    EXPECT_EQ(shots[i].tick, 128 + 16 * i);
    EXPECT_EQ(shots[i].shape, sim::HoleShape::mask);
  }
  const smoke::ShotAxes axes = smoke::axes_of(shots[0]);
  const glm::dvec3 apart(shots[2].origin - shots[0].origin);
  EXPECT_GT(glm::dot(apart, axes.right), 0);
  EXPECT_NEAR(glm::dot(apart, axes.forward), 0, 2) << "side by side";
  // m: lower than A, and 0.5 * 0.547 / 0.729 m high: x height and capital height of the font, in ems.
  EXPECT_LT(glm::dot(glm::dvec3(shots[1].origin - shots[0].origin), axes.up), -0.05 * 1024);
}

TEST(Text, RollRotatesTheWholeRow) {
  scene::Timeline timeline;
  timeline.texts = {text_event("II")};
  timeline.texts[0].roll = 0.5f * 3.14159265f;
  const Scenario scenario = air(timeline);
  std::vector<sim::Shot> shots;
  for (const sim::Event& event : events_of(scenario).value_or_throw())
    if (const auto* shot = std::get_if<sim::Shot>(&event)) shots.push_back(*shot);
  ASSERT_EQ(shots.size(), 2u);
  EXPECT_EQ(shots[0].roll, sim::kFullTurn / 4);
  const glm::ivec3 apart = shots[1].origin - shots[0].origin;
  EXPECT_LT(apart.y, -100) << "a quarter turn clockwise: to the right is down";
  EXPECT_LE(std::abs(apart.x), 1);
}

TEST(Text, ErrorsNameTheText) {
  const auto failure_of = [](const std::string& text, const std::string& font) {
    scene::Timeline timeline;
    timeline.texts = {text_event(text)};
    timeline.texts[0].font = font;
    timeline.texts[0].place = "t.toml:7:1";
    return load_masks(timeline).failure().message;
  };
  EXPECT_EQ(failure_of("  ", ""), "t.toml:7:1: the text has no visible letter; expected at least one");
  EXPECT_EQ(failure_of("\xe6\xbc\xa2", "").rfind("t.toml:7:1: ", 0), 0u);
  EXPECT_EQ(failure_of("A", "/no/such.ttf").rfind("t.toml:7:1: /no/such.ttf: ", 0), 0u);
}

TEST(ShotMasks, AreTheLuminanceTimesAlphaCentredInASquare) {
  image::Image8 picture{4, 2, {}};
  const std::uint8_t rgba[8][4] = {{255, 255, 255, 255}, {0, 0, 0, 255},       {255, 255, 255, 0},
                                   {255, 255, 255, 128}, {128, 128, 128, 255}, {255, 0, 0, 255},
                                   {0, 255, 0, 255},     {0, 0, 255, 255}};
  for (const auto& texel : rgba) picture.rgba.insert(picture.rgba.end(), texel, texel + 4);
  const smoke::Mask mask = make_mask(picture, "x.png").value_or_throw();
  ASSERT_EQ(mask.width, 4u);
  ASSERT_EQ(mask.height, 4u);
  const std::vector<std::uint8_t> expected{0,   0,  0,   0,  255, 0, 0, 128,
                                           128, 54, 182, 18, 0,   0, 0, 0};  // 0.2126, 0.7152, 0.0722 of 255
  EXPECT_EQ(mask.texels, expected);
  EXPECT_EQ(make_mask({4095, 1, std::vector<std::uint8_t>(4 * 4095)}, "wide.png").failure().message,
            "wide.png: 4095 x 1 texels, at most 4094 per axis are possible for a mask; make it smaller");
}

TEST(ShotMasks, AreLoadedOnceEach) {
  const cli::WorkFolder work_folder;
  const std::filesystem::path folder = work_folder.path();
  image::Image8 picture{8, 8, std::vector<std::uint8_t>(256, 255)};
  ASSERT_TRUE(image::save_png(folder / "a.png", picture));
  picture.rgba[0] = 0;
  ASSERT_TRUE(image::save_png(folder / "b.png", picture));
  scene::Timeline timeline;
  for (const char* name : {"a.png", "b.png", "a.png"}) {
    scene::ShotEvent shot;
    shot.shape = scene::ShotShape::mask;
    shot.mask = folder / name;
    shot.place = "t.toml:3:1";
    timeline.shots.push_back(shot);
  }
  timeline.texts = {text_event("ANNA"), text_event("NAN")};
  const LoadedMasks masks = load_masks(timeline).value_or_throw();
  EXPECT_EQ(masks.atlas.count(), 4u) << "two pictures, A and N";
  // In the order of their first use, shots before texts, without duplicates.
  ASSERT_TRUE(image::save_png(folder / "like_a.png", {8, 8, std::vector<std::uint8_t>(256, 255)}));
  scene::Timeline later = timeline;
  later.shots[0].time = later.shots[1].time = later.shots[2].time = 3;
  later.shots.push_back(later.shots[0]);
  later.shots.back().mask = folder / "like_a.png";
  const LoadedMasks others = load_masks(later).value_or_throw();
  EXPECT_EQ(others.atlas.count(), 4u);
  EXPECT_EQ(others.of_shots.texts.begin()->second[0].mask, 0u) << "the texts are at 2 s";
  EXPECT_EQ(others.of_shots.pictures.at((folder / "a.png").string()), 2u);
  EXPECT_EQ(others.of_shots.pictures.at((folder / "b.png").string()), 3u);
  EXPECT_EQ(others.of_shots.pictures.at((folder / "like_a.png").string()), 2u);
  timeline.shots[1].mask = folder / "c.png";
  const auto failed = load_masks(timeline);
  EXPECT_EQ(failed.failure().code, ErrorCode::bad_input);
  EXPECT_EQ(failed.failure().message.rfind("t.toml:3:1: " + (folder / "c.png").string(), 0), 0u);
}

}  // namespace
}  // namespace brume::scenario
