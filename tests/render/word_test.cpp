// A word that is shot through smoke, read off the images of both sides.
#include <cmath>

#include "film/playback.hpp"
#include "image/font.hpp"
#include "scenario/shot_masks.hpp"
#include "tests/gpu/gpu_test.hpp"
#include "tests/render/boxes.hpp"

namespace brume::render {
namespace {

constexpr glm::uvec2 kWordImage{192, 64};
constexpr float kMetresHigh = 1.2f,
                kFar = 240;  ///< What the images show of the word's plane; the cameras from it.
constexpr float kCapital = 0.62f;
const std::string kWord = "BRUME";

/// Black smoke in front of a white sky on both sides, and a word that is shot through it along -z, as large
/// and as rough as in scenes/letters.toml, open from about 2.3 s to 3.6 s.
scenario::Scenario smoke_and_word() {
  scene::Timeline timeline;
  timeline.sky = {glm::vec3(1), glm::vec3(1), glm::vec3(0), 0};
  timeline.smoke.albedo = glm::vec3(0);
  timeline.smoke.voxels = 12000;
  timeline.smoke.extinction = 4;
  timeline.smoke.hole_rim = 0.02f;
  timeline.smokes = {{0, {0, 2, 0}, {0, 2, 0}}};
  scene::TextEvent event;
  event.time = 2;
  event.text = kWord;
  event.from_world = {0, 2, 6};
  event.toward_world = {0, 2, 0};
  event.size = kCapital;
  event.times = {0.25f, 0.05f, 1, 0.35f};
  timeline.texts = {event};
  scene::Scene scene;
  scene.meshes.resize(1);
  add_box(scene.meshes[0], glm::vec3(-0.2f), glm::vec3(0.2f));
  scene.materials.resize(1);
  scene.grenade = {"grenade", 0, 0, glm::mat4(1), Role::ghost};
  const voxel::GridLayout frame{{36, 20, 20}, 0.25f, {-4.5f, -0.5f, -2.5f}};
  auto masks = scenario::load_masks(timeline).value_or_throw();
  return {std::move(timeline),         std::move(scene),       {},
          {voxel::BitGrid(frame), {}}, std::move(masks.atlas), std::move(masks.of_shots)};
}

/// From so far away that rays at the image's rim, 1.8 m aside, leave a pixel, 19 mm, by no more than one
/// while they are in the smoke, 2.5 m before and behind the word.
scene::Camera camera(bool from_behind) {
  return {{0, 2, from_behind ? -kFar : kFar}, {0, 2, 0}, 2 * std::atan(0.5f * kMetresHigh / kFar)};
}

/// Letters, each at its place in a row whose middle is the image's.
class Row {
 public:
  Row() : font_(image::Font::load(image::default_font()).value_or_throw()) {
    float low = 1e9f, high = -1e9f;
    for (const image::PlacedLetter& placed : font_.row(kWord, 0).value_or_throw()) {
      const image::Glyph glyph = font_.glyph(placed.character).value_or_throw();
      pens_.push_back(placed.pen);
      low = std::min(low, placed.pen + glyph.centre_x - glyph.half_side);
      high = std::max(high, placed.pen + glyph.centre_x + glyph.half_side);
    }
    middle_ = 0.5f * (low + high);
  }
  std::size_t count() const { return pens_.size(); }
  image::Glyph glyph(char letter) { return font_.glyph(static_cast<unsigned char>(letter)).value_or_throw(); }

  /// How alike the image is, around the place of a letter of the word, to this letter standing there:
  /// Pearson's correlation of brightness and coverage, [-1, 1].
  double likeness(const image::Image8& image, std::size_t place, char letter, bool mirrored) {
    const image::Glyph glyph = this->glyph(letter), there = this->glyph(kWord[place]);
    double n = 0, sum_a = 0, sum_b = 0, sum_aa = 0, sum_bb = 0, sum_ab = 0;
    for (std::uint32_t y = 0; y < kWordImage.y; ++y)
      for (std::uint32_t x = 0; x < kWordImage.x; ++x) {
        const std::uint32_t column = mirrored ? kWordImage.x - 1 - x : x;
        const glm::vec2 at = capitals(x, y) - glm::vec2(pens_[place], 0);
        if (std::abs(at.x - there.centre_x) > there.half_side) continue;
        const double a = image.rgba[4 * (column + std::size_t{kWordImage.x} * y)], b = coverage(glyph, at);
        n += 1;
        sum_a += a;
        sum_b += b;
        sum_aa += a * a;
        sum_bb += b * b;
        sum_ab += a * b;
      }
    const double spread = (n * sum_aa - sum_a * sum_a) * (n * sum_bb - sum_b * sum_b);
    return spread > 0 ? (n * sum_ab - sum_a * sum_b) / std::sqrt(spread) : 0;
  }

  /// What stands there: at each place the most alike of the alphabet.
  std::string read(const image::Image8& image, bool mirrored) {
    std::string text;
    for (std::size_t place = 0; place < count(); ++place) {
      char best = '?';
      double most = 0;
      for (char letter = 'A'; letter <= 'Z'; ++letter)
        if (const double alike = likeness(image, place, letter, mirrored); alike > most) {
          most = alike;
          best = letter;
        }
      text += best;
    }
    return text;
  }

 private:
  /// Where a pixel's middle is, in capital heights from the begin of the row and its base line.
  glm::vec2 capitals(std::uint32_t x, std::uint32_t y) const {
    const glm::vec2 from_middle = glm::vec2(x, y) + 0.5f - 0.5f * glm::vec2(kWordImage);
    const float scale = kMetresHigh / static_cast<float>(kWordImage.y) / kCapital;
    return {from_middle.x * scale + middle_, 0.5f - from_middle.y * scale};
  }
  static double coverage(const image::Glyph& glyph, glm::vec2 at) {
    const float texels = static_cast<float>(glyph.side) / (2 * glyph.half_side);
    const glm::vec2 texel((at.x - glyph.centre_x + glyph.half_side) * texels,
                          (glyph.centre_y + glyph.half_side - at.y) * texels);
    if (texel.x < 0 || texel.y < 0) return 0;
    const auto column = static_cast<std::size_t>(texel.x), row = static_cast<std::size_t>(texel.y);
    return column < glyph.side && row < glyph.side ? glyph.coverage[row * glyph.side + column] : 0;
  }

  image::Font font_;
  std::vector<float> pens_;
  float middle_ = 0;
};

class WordTest : public gpu::GpuTest {};

TEST_F(WordTest, ReadsFromTheFrontMirroredFromBehindAndNotAfterItsTime) {
  const scenario::Scenario scene = smoke_and_word();
  film::Playback playback(context(), scene, kWordImage);
  const auto image_at = [&](double seconds, bool from_behind) {
    playback.set_camera(camera(from_behind));
    return playback.draw(seconds, 0);
  };
  Row row;
  const auto front = image_at(3, false), behind = image_at(3, true);
  EXPECT_EQ(row.read(front, false), kWord);
  EXPECT_EQ(row.read(behind, true), kWord) << "in a mirror";
  EXPECT_NE(row.read(front, true), kWord);
  EXPECT_NE(row.read(behind, false), kWord);
  // Before the shots and after the holes: optical depth 20, e^-20 of a white sky, and the noise against
  // bands.
  for (const double seconds : {1.9, 3.9}) {
    const image::Image8 closed = image_at(seconds, false);
    for (std::size_t i = 0; i < closed.rgba.size(); i += 4) ASSERT_LE(closed.rgba[i], 1) << seconds;
  }
}

}  // namespace
}  // namespace brume::render
