#include "apps/cli/targets.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <cstdio>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "apps/cli/console.hpp"
#include "core/error.hpp"
#include "core/file.hpp"
#include "core/hash.hpp"
#include "core/progress.hpp"
#include "image/decode.hpp"
#include "image/exr.hpp"
#include "image/png.hpp"
#include "image/video.hpp"
#include "scene/load.hpp"

namespace brume::cli {
namespace {

// A file name as literal parts with the frame's number in between.
struct NamePattern {
  std::string before, after;
  std::optional<std::size_t> digits;  // Minimum digits of the number; nothing: there is no number.
};

// %d, %04d: the number. %%: a percent sign, as is one before anything but a letter or digit. Nothing for any
// other use of %.
std::optional<NamePattern> parse_name(const std::string& name) {
  NamePattern pattern;
  for (std::size_t i = 0; i < name.size(); ++i) {
    std::string& part = pattern.digits ? pattern.after : pattern.before;
    const std::string_view rest = std::string_view(name).substr(i + 1);
    if (name[i] != '%') {
      part += name[i];
    } else if (rest.starts_with('%')) {
      part += '%';
      ++i;
    } else if (!pattern.digits && rest.starts_with('d')) {
      pattern.digits = 1;
      ++i;
    } else if (!pattern.digits && rest.size() >= 3 && rest[0] == '0' && rest[1] >= '1' && rest[1] <= '9' &&
               rest[2] == 'd') {
      pattern.digits = static_cast<std::size_t>(rest[1] - '0');
      i += 3;
    } else if (rest.empty() || std::isalnum(static_cast<unsigned char>(rest[0]))) {
      return std::nullopt;
    } else {
      part += '%';
    }
  }
  return pattern;
}

// Names what the frame was made from.
image::ImageText frame_text(std::uint64_t key, std::uint32_t frame) {
  const std::array<std::uint64_t, 2> parts{key, frame};
  char text[17];
  std::snprintf(text, sizeof text, "%016llx",
                static_cast<unsigned long long>(hash_values(std::span<const std::uint64_t>(parts))));
  return {"Brume frame", text};
}

// Whether a PNG has a text and a size, and decodes.
bool is_png_frame(std::span<const std::byte> bytes, const image::ImageText& text, glm::uvec2 size_px) {
  if (image::find_png_text(bytes, text.keyword) != text.text) return false;
  const auto image = image::decode_image(bytes, "");
  return image && image->width == size_px.x && image->height == size_px.y;
}

bool is_exr_frame(std::span<const std::byte> bytes, const image::ImageText& text, glm::uvec2 size_px) {
  const auto parts = image::decode_exr_parts(bytes, "");
  if (!parts || parts->size() != 1) return false;
  const image::ExrPart& part = parts->front();
  const bool made_from_it = std::any_of(part.texts.begin(), part.texts.end(), [&](const image::ImageText& t) {
    return t.keyword == text.keyword && t.text == text.text;
  });
  return made_from_it && part.width == size_px.x && part.height == size_px.y &&
         static_cast<bool>(image::decode_exr(bytes, ""));
}

// Whether the file of the frame is complete and made from the same inputs.
bool is_frame(const SequenceSettings& settings, std::uint32_t frame) {
  const auto bytes = read_file(sequence_name(settings.pattern, frame));
  if (!bytes) return false;
  const image::ImageText text = frame_text(settings.key, frame);
  return target_file_kind(settings.pattern) == FileKind::exr ? is_exr_frame(*bytes, text, settings.size_px)
                                                             : is_png_frame(*bytes, text, settings.size_px);
}

}  // namespace

bool is_numbered(const std::string& option, const std::filesystem::path& path) {
  const auto pattern = parse_name(path.filename().string());
  if (!pattern)
    throw Error(ErrorCode::usage,
                option + " " + path.string() +
                    ": expected one %d or %04d in the name, for the frame number, or %% for "
                    "a percent sign");
  return pattern->digits.has_value();
}

TargetKind target_kind(const std::filesystem::path& path) {
  const std::string extension = scene::lower_extension(path);
  if (extension != ".png" && extension != ".exr" && extension != ".mp4")
    throw Error(ErrorCode::usage,
                "-o " + path.string() + ": cannot write this file type; expected .png, .exr or .mp4");
  const bool numbered = is_numbered("-o", path);
  if (extension != ".mp4") return numbered ? TargetKind::sequence : TargetKind::picture;
  if (numbered)
    throw Error(ErrorCode::usage, "-o " + path.string() + ": numbered frames are .png or .exr files");
  return TargetKind::film;
}

FileKind target_file_kind(const std::filesystem::path& path) {
  const std::string extension = scene::lower_extension(path);
  return extension == ".exr" ? FileKind::exr : extension == ".mp4" ? FileKind::mp4 : FileKind::png;
}

void save_picture(const std::filesystem::path& path, const Picture& picture,
                  const std::optional<image::ImageText>& text) {
  if (const auto* colours = std::get_if<image::Image8>(&picture)) {
    image::save_png(path, *colours, text).value_or_throw();
  } else {
    image::save_exr(path, std::get<image::LayeredImage>(picture), text).value_or_throw();
  }
}

std::filesystem::path plain_name(const std::filesystem::path& path) {
  return path.parent_path() / parse_name(path.filename().string()).value().before;
}

std::filesystem::path sequence_name(const std::filesystem::path& path, std::uint32_t number) {
  const NamePattern pattern = parse_name(path.filename().string()).value();
  std::string digits = std::to_string(number);
  if (digits.size() < *pattern.digits) digits.insert(0, *pattern.digits - digits.size(), '0');
  return path.parent_path() / (pattern.before + digits + pattern.after);
}

void write_film(const std::filesystem::path& path, const FilmSettings& settings, std::uint32_t first,
                std::uint32_t last, Outputs& outputs,
                const std::function<image::Image8(std::uint32_t)>& draw) {
  image::VideoWriter writer =
      image::VideoWriter::open(path, {settings.size_px.x, settings.size_px.y, settings.rate.numerator,
                                      settings.threads, settings.rate.denominator})
          .value_or_throw();
  const std::uint32_t count = last - first + 1;
  Progress progress("frames", count + settings.warm_up);
  for (std::uint32_t i = 0; i < settings.warm_up; ++i) {
    stop_if_interrupted();
    draw(first - settings.warm_up + i);
    progress.advance();
  }
  for (std::uint32_t drawn = 0; drawn < count; ++drawn) {
    outputs.film_progress(path, drawn, count);
    stop_if_interrupted();
    writer.add_frame(draw(first + drawn)).value_or_throw();
    progress.advance();
  }
  stop_if_interrupted();
  writer.finish().value_or_throw();
}

void write_sequence(const SequenceSettings& settings, Outputs& outputs,
                    const std::function<Picture(std::uint32_t)>& draw) {
  // What is there already.
  const std::uint32_t count = settings.last - settings.first + 1;
  std::vector<bool> done(count);
  outputs.set_frames_depend(settings.frames_depend);
  for (std::uint32_t i = 0; settings.resume && i < count; ++i) {
    stop_if_interrupted();
    done[i] = is_frame(settings, settings.first + i);
    if (done[i]) outputs.frame_done(settings.first + i);
  }
  const auto missing = static_cast<std::uint64_t>(std::count(done.begin(), done.end(), false));
  const auto end = static_cast<std::uint32_t>(done.rend() - std::find(done.rbegin(), done.rend(), false));
  if (missing < count)
    print_on_terminal(std::to_string(count - missing) + " of " + std::to_string(count) + " frames are there");

  // The rest. Where frames depend on each other, all up to the last missing one are drawn.
  Progress progress("frames", missing + (missing > 0 ? settings.warm_up : 0));
  for (std::uint32_t i = 0; missing > 0 && i < settings.warm_up; ++i) {
    stop_if_interrupted();
    draw(settings.first - settings.warm_up + i);
    progress.advance();
  }
  for (std::uint32_t i = 0; i < end; ++i) {
    stop_if_interrupted();
    const std::uint32_t frame = settings.first + i;
    if (done[i] && !settings.frames_depend) continue;
    const Picture picture = draw(frame);
    if (done[i]) continue;
    save_picture(sequence_name(settings.pattern, frame), picture, frame_text(settings.key, frame));
    outputs.frame_done(frame);
    progress.advance();
  }
}

}  // namespace brume::cli
