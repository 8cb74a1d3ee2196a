#include "image/font.hpp"

#include <algorithm>
#include <cstdio>
#include <optional>
#include <utility>

#include <ft2build.h>
#include FT_FREETYPE_H
#include FT_OUTLINE_H

#include "core/data_files.hpp"
#include "core/file.hpp"
#include "core/utf8.hpp"

namespace brume::image {
namespace {

constexpr std::uint64_t kMaxFontBytes = std::uint64_t{1} << 26;
/// The stroke of a bold letter is about 20 texels wide at this size.
constexpr FT_UInt kTexelsPerEm = 96;
/// Largest side of a glyph: some fonts have ornaments many ems wide.
constexpr std::uint32_t kMaxGlyphSide = 1024;

std::string name_of(char32_t character) {
  char text[16];
  std::snprintf(text, sizeof text, "U+%04X", static_cast<unsigned>(character));
  return text;
}

/// Centres a FreeType bitmap in a square.
void centre(const FT_GlyphSlot slot, Glyph& glyph, float texels_per_cap) {
  const FT_Bitmap& bitmap = slot->bitmap;
  glyph.side = std::max(bitmap.width, bitmap.rows) + 2;
  glyph.coverage.assign(std::size_t{glyph.side} * glyph.side, 0);
  const std::uint32_t left = (glyph.side - bitmap.width) / 2, top = (glyph.side - bitmap.rows) / 2;
  for (std::uint32_t y = 0; y < bitmap.rows; ++y) {
    const unsigned char* row = bitmap.buffer + static_cast<std::ptrdiff_t>(y) * bitmap.pitch;
    const std::size_t to = std::size_t{top + y} * glyph.side + left;
    std::copy_n(row, bitmap.width, glyph.coverage.begin() + static_cast<std::ptrdiff_t>(to));
  }
  const float half = 0.5f * static_cast<float>(glyph.side);
  glyph.centre_x = (static_cast<float>(slot->bitmap_left) - static_cast<float>(left) + half) / texels_per_cap;
  glyph.centre_y = (static_cast<float>(slot->bitmap_top) + static_cast<float>(top) - half) / texels_per_cap;
  glyph.half_side = half / texels_per_cap;
}

}  // namespace

struct Font::Face {
  std::vector<std::byte> bytes;  // read by FreeType during the face's lifetime
  std::string name;
  FT_Library library = nullptr;
  FT_Face face = nullptr;
  float texels_per_cap = 0;

  Face() = default;
  Face(const Face&) = delete;
  Face& operator=(const Face&) = delete;
  ~Face() {
    if (face) FT_Done_Face(face);
    if (library) FT_Done_FreeType(library);
  }

  Failure bad(const std::string& what) const { return {ErrorCode::bad_input, name + ": " + what}; }

  /// Height of a capital letter, or without one, the ascender.
  float cap_height() const {
    if (FT_Load_Char(face, 'H', FT_LOAD_NO_HINTING) == 0 && face->glyph->metrics.horiBearingY > 0)
      return static_cast<float>(face->glyph->metrics.horiBearingY) / 64;
    return static_cast<float>(face->size->metrics.ascender) / 64;
  }
  Result<FT_UInt> index_of(char32_t character) const {
    const FT_UInt index = FT_Get_Char_Index(face, character);
    if (index != 0) return index;
    return bad("the font has no glyph for " + name_of(character) +
               "; choose another font or another character");
  }
};

const std::filesystem::path& default_font() {
  static const std::filesystem::path path =
      find_data_file("fonts/DejaVuSans-Bold.ttf")
          .value_or("/usr/share/fonts/truetype/dejavu/DejaVuSans-Bold.ttf");
  return path;
}

Font::Font(std::unique_ptr<Face> face) : face_(std::move(face)) {}
Font::Font(Font&&) noexcept = default;
Font& Font::operator=(Font&&) noexcept = default;
Font::~Font() = default;

Result<Font> Font::open(std::vector<std::byte> bytes, const std::string& name) {
  auto face = std::make_unique<Face>();
  face->bytes = std::move(bytes);
  face->name = name;
  if (FT_Init_FreeType(&face->library) != 0)
    return Failure{ErrorCode::internal, name + ": cannot initialize FreeType"};
  const auto* data = reinterpret_cast<const FT_Byte*>(face->bytes.data());
  if (FT_New_Memory_Face(face->library, data, static_cast<FT_Long>(face->bytes.size()), 0, &face->face) != 0)
    return face->bad("not a font that FreeType reads, or damaged; expected a TrueType or OpenType file");
  if (!FT_IS_SCALABLE(face->face) || FT_Select_Charmap(face->face, FT_ENCODING_UNICODE) != 0 ||
      FT_Set_Pixel_Sizes(face->face, 0, kTexelsPerEm) != 0)
    return face->bad("expected a font with outlines and a table of Unicode characters");
  face->texels_per_cap = face->cap_height();
  if (!(face->texels_per_cap >= 1)) return face->bad("a font whose capital letters have no height");
  return Font(std::move(face));
}

Result<Font> Font::load(const std::filesystem::path& path) {
  auto bytes = read_file(path, kMaxFontBytes);
  if (!bytes) return bytes.failure();
  return open(std::move(*bytes), path.string());
}

Result<Glyph> Font::glyph(char32_t character) {
  const auto index = face_->index_of(character);
  if (!index) return index.failure();
  FT_Face face = face_->face;
  Glyph glyph;
  if (FT_Load_Glyph(face, *index, FT_LOAD_NO_HINTING | FT_LOAD_NO_BITMAP) != 0 ||
      face->glyph->format != FT_GLYPH_FORMAT_OUTLINE)
    return face_->bad("the glyph of " + name_of(character) + " is damaged or not an outline");
  // FreeType rasterizes glyphs of any size: check it first.
  FT_BBox box;
  FT_Outline_Get_CBox(&face->glyph->outline, &box);
  constexpr FT_Pos kMost = FT_Pos{kMaxGlyphSide - 4} * 64;
  if (box.xMax - box.xMin > kMost || box.yMax - box.yMin > kMost)
    return face_->bad("the glyph of " + name_of(character) + " is more than " +
                      std::to_string(kMaxGlyphSide / kTexelsPerEm) + " ems large");
  if (FT_Render_Glyph(face->glyph, FT_RENDER_MODE_NORMAL) != 0)
    return face_->bad("the glyph of " + name_of(character) + " is damaged");
  if (face->glyph->bitmap.width > 0 && face->glyph->bitmap.rows > 0)
    centre(face->glyph, glyph, face_->texels_per_cap);
  return glyph;
}

Result<std::vector<PlacedLetter>> Font::row(std::string_view text, float spacing) {
  FT_Face face = face_->face;
  std::vector<PlacedLetter> letters;
  FT_UInt before = 0;
  float pen = 0;
  while (!text.empty()) {
    const auto character = take_character(text);
    if (!character) return Failure{ErrorCode::bad_input, "the text is not valid UTF-8"};
    if (*character < 0x20 || *character == 0x7f)
      return Failure{ErrorCode::bad_input, "the text has the control character " + name_of(*character) +
                                               "; expected one line of letters"};
    const auto index = face_->index_of(*character);
    if (!index) return index.failure();
    FT_Vector kerning{0, 0};
    if (before != 0 && FT_Get_Kerning(face, before, *index, FT_KERNING_UNFITTED, &kerning) != 0)
      kerning.x = 0;
    if (FT_Load_Glyph(face, *index, FT_LOAD_NO_HINTING | FT_LOAD_NO_BITMAP) != 0)
      return face_->bad("the glyph of " + name_of(*character) + " is damaged");
    if (before != 0) pen += static_cast<float>(kerning.x) / 64 / face_->texels_per_cap + spacing;
    letters.push_back({*character, pen});
    // Unhinted advances in 1/65536 texel: FT_GlyphSlot::advance is rounded to whole texels.
    pen += static_cast<float>(face->glyph->linearHoriAdvance) / 65536 / face_->texels_per_cap;
    before = *index;
  }
  return letters;
}

}  // namespace brume::image
