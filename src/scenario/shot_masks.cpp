#include "scenario/shot_masks.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "image/decode.hpp"
#include "image/font.hpp"

namespace brume::scenario {
namespace {

Failure at_place(const std::string& place, const Failure& failure) {
  return {failure.code, (place.empty() ? "" : place + ": ") + failure.message};
}

/// Collects masks, each once.
class Collector {
 public:
  Result<void> add(const scene::ShotEvent& shot) {
    const std::string file = shot.mask.string();
    if (shot.shape != scene::ShotShape::mask || of_shots_.pictures.contains(file)) return {};
    const auto picture = image::load_image(shot.mask);
    if (!picture) return at_place(shot.place, picture.failure());
    auto mask = make_mask(*picture, file);
    if (!mask) return at_place(shot.place, mask.failure());
    of_shots_.pictures[file] = take(std::move(*mask));
    last_place_ = shot.place;
    return {};
  }

  Result<void> add(const scene::TextEvent& event) {
    const ShotMasks::Text key = ShotMasks::key(event);
    if (of_shots_.texts.contains(key)) return {};
    const std::filesystem::path& file = event.font.empty() ? image::default_font() : event.font;
    auto letters = letters_of(event, file);
    if (!letters) return at_place(event.place, letters.failure());
    of_shots_.texts[key] = std::move(*letters);
    last_place_ = event.place;
    return {};
  }

  Result<LoadedMasks> finish() && {
    auto atlas = smoke::MaskAtlas::pack(masks_);
    if (!atlas) return at_place(last_place_, atlas.failure());
    return LoadedMasks{std::move(*atlas), std::move(of_shots_)};
  }

 private:
  struct LoadedGlyph {
    std::uint32_t mask = 0;
    image::Glyph shape;  // without its coverage
  };
  struct LoadedFont {
    image::Font font;
    std::map<char32_t, LoadedGlyph> glyphs;
  };

  /// Returns the number of a mask; masks with identical texels share one, whatever their files.
  std::uint32_t take(smoke::Mask mask) {
    const auto number = static_cast<std::uint32_t>(masks_.size());
    const auto [known, is_new] = numbers_.emplace(std::pair(mask.width, mask.texels), number);
    if (is_new) masks_.push_back(std::move(mask));
    return known->second;
  }

  Result<LoadedFont*> font_at(const std::filesystem::path& file) {
    const auto known = fonts_.find(file.string());
    if (known != fonts_.end()) return &known->second;
    auto font = image::Font::load(file);
    if (!font) return font.failure();
    return &fonts_.emplace(file.string(), LoadedFont{std::move(*font), {}}).first->second;
  }

  Result<const LoadedGlyph*> glyph_of(LoadedFont& font, char32_t character) {
    const auto known = font.glyphs.find(character);
    if (known != font.glyphs.end()) return &known->second;
    auto glyph = font.font.glyph(character);
    if (!glyph) return glyph.failure();
    LoadedGlyph loaded;
    if (glyph->side > 0) loaded.mask = take({glyph->side, glyph->side, std::move(glyph->coverage)});
    glyph->coverage.clear();
    loaded.shape = std::move(*glyph);
    return &font.glyphs.emplace(character, std::move(loaded)).first->second;
  }

  Result<std::vector<Letter>> letters_of(const scene::TextEvent& event, const std::filesystem::path& file) {
    // Lay out the row.
    const auto font = font_at(file);
    if (!font) return font.failure();
    const auto row = (*font)->font.row(event.text, event.spacing);
    if (!row) return row.failure();

    // The mask of each visible letter.
    std::vector<Letter> letters;
    float low = 0, high = 0;
    for (const image::PlacedLetter& placed : *row) {
      const auto glyph = glyph_of(**font, placed.character);
      if (!glyph) return glyph.failure();
      const image::Glyph& shape = (*glyph)->shape;
      if (shape.side == 0) continue;
      const Letter letter{(*glyph)->mask, placed.pen + shape.centre_x, shape.centre_y - 0.5f,
                          shape.half_side};
      low =
          letters.empty() ? letter.right - letter.half_side : std::min(low, letter.right - letter.half_side);
      high =
          letters.empty() ? letter.right + letter.half_side : std::max(high, letter.right + letter.half_side);
      letters.push_back(letter);
    }
    if (letters.empty())
      return Failure{ErrorCode::bad_input, "the text has no visible letter; expected at least one"};

    // Measure from the middle of the row.
    for (Letter& letter : letters) letter.right -= 0.5f * (low + high);
    return letters;
  }

  std::vector<smoke::Mask> masks_;
  std::map<std::pair<std::uint32_t, std::vector<std::uint8_t>>, std::uint32_t> numbers_;
  std::string last_place_;  // place of the last event that added a mask
  std::map<std::string, LoadedFont> fonts_;
  ShotMasks of_shots_;
};

}  // namespace

Result<smoke::Mask> make_mask(const image::Image8& picture, const std::string& name) {
  const std::uint32_t side = std::max(picture.width, picture.height);
  if (side > smoke::kMaxMaskAxis)
    return Failure{ErrorCode::resource_limit, name + ": " + std::to_string(picture.width) + " x " +
                                                  std::to_string(picture.height) + " texels, at most " +
                                                  std::to_string(smoke::kMaxMaskAxis) +
                                                  " per axis are possible for a mask; make it smaller"};
  smoke::Mask mask{side, side, std::vector<std::uint8_t>(std::size_t{side} * side, 0)};
  const std::uint32_t left = (side - picture.width) / 2, top = (side - picture.height) / 2;
  for (std::uint32_t y = 0; y < picture.height; ++y)
    for (std::uint32_t x = 0; x < picture.width; ++x) {
      const std::uint8_t* rgba = &picture.rgba[4 * (std::size_t{y} * picture.width + x)];
      // Rec. 709 weights of red, green and blue, in 1/65536.
      const std::uint64_t luminance = 13933u * rgba[0] + 46871u * rgba[1] + 4732u * rgba[2];
      constexpr std::uint64_t kWhole = 65536u * 255u;
      mask.texels[std::size_t{top + y} * side + left + x] =
          static_cast<std::uint8_t>((luminance * rgba[3] + kWhole / 2) / kWhole);
    }
  return mask;
}

Result<LoadedMasks> load_masks(const scene::Timeline& timeline) {
  Collector collector;
  auto text = timeline.texts.begin();
  const auto add_texts_before = [&](double time) {
    Result<void> added;
    for (; text != timeline.texts.end() && text->time < time && added; ++text) added = collector.add(*text);
    return added;
  };
  for (const scene::ShotEvent& shot : timeline.shots) {
    if (auto added = add_texts_before(shot.time); !added) return added.failure();
    if (auto added = collector.add(shot); !added) return added.failure();
  }
  if (auto added = add_texts_before(INFINITY); !added) return added.failure();
  return std::move(collector).finish();
}

}  // namespace brume::scenario
