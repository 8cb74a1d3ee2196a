#include "apps/cli/convert_film.hpp"

#include <optional>

#include "apps/command_line/console.hpp"
#include "apps/command_line/parse.hpp"
#include "apps/command_line/targets.hpp"
#include "apps/command_line/unit_key.hpp"
#include "core/error.hpp"
#include "core/file.hpp"
#include "core/utf8.hpp"
#include "image/decode.hpp"
#include "image/png.hpp"
#include "scene/files/load.hpp"

namespace brume::cli {
namespace {

namespace fs = std::filesystem;

// The key without the frame's number; empty: the frame has none.
std::string key_text(std::span<const std::byte> bytes) {
  const std::string text = image::find_png_text(bytes, kFrameKeyword).value_or("");
  const std::size_t blank = text.find(' ');
  return blank == text.npos ? "" : text.substr(blank + 1);
}

UnitKey key_of(const std::string& text) {
  UnitKey key;
  const auto part = [&](const std::string& name) {
    const std::size_t at = text.find(name + ":");
    if (at == text.npos) return std::string();
    const std::size_t begin = at + name.size() + 1;
    return text.substr(begin, text.find(' ', begin) - begin);
  };
  return {part("inputs"), part("settings"), part("device"), part("program")};
}

// The frames, each of which must be like the first one.
class Frames {
 public:
  explicit Frames(const FilmConversion& conversion) : pattern_(to_path(conversion.input)) {}

  image::Image8 load(std::uint32_t frame) {
    const fs::path file = sequence_name(pattern_, frame);
    const auto bytes = read_file(file).value_or_throw();
    image::Image8 image = image::decode_image(bytes, file.string()).value_or_throw();
    const std::string key = key_text(bytes);
    if (!first_) {
      first_ = First{frame, key, {image.width, image.height}};
    } else if (glm::uvec2(image.width, image.height) != first_->size_px) {
      throw unlike(file, "is of another size");
    } else if (key != first_->key) {
      throw unlike(file, "is " + difference(std::to_string(frame) + " " + key, key_of(first_->key), frame));
    }
    return image;
  }
  glm::uvec2 size_px() const { return first_->size_px; }

 private:
  struct First {
    std::uint32_t frame;
    std::string key;
    glm::uvec2 size_px;
  };
  Error unlike(const fs::path& file, const std::string& how) const {
    return {ErrorCode::bad_input, file.string() + ": " + how + " than " +
                                      sequence_name(pattern_, first_->frame).filename().string() +
                                      "; render it again with --resume"};
  }

  fs::path pattern_;
  std::optional<First> first_;
};

}  // namespace

void convert_film(const FilmConversion& conversion, CommonOptions& common) {
  // What is converted.
  expect_suffix("", conversion.input, {".png"});
  if (!is_numbered("INPUT", to_path(conversion.input)))
    throw Error(ErrorCode::usage,
                conversion.input + ": a film is made of numbered frames, such as f_%04d.png");
  if (is_numbered("OUTPUT", to_path(conversion.output)))
    throw Error(ErrorCode::usage, conversion.output + ": a film is a single file; remove the number");
  if (conversion.frames.empty())
    throw Error(ErrorCode::usage, conversion.output + ": requires --frames, such as --frames 0-119");
  const FrameRange range = parse_frames("--frames", conversion.frames);
  const FrameRate rate = parse_rate("--fps", conversion.fps);
  const fs::path output = plain_name(to_path(conversion.output));
  for (std::uint32_t i = range.first; i <= range.last; ++i)
    common.outputs.reads(sequence_name(to_path(conversion.input), i));
  common.outputs.writes("", output, FileKind::mp4);

  // The film. A frame is checked before it is encoded, all of them before the film appears.
  Frames frames(conversion);
  frames.load(range.first);
  write_film(output, {frames.size_px(), rate, common.threads, 0}, range.first, range.last, common.outputs,
             [&](std::uint32_t i) { return frames.load(i); });
}

}  // namespace brume::cli
