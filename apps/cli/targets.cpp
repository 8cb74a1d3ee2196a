#include "apps/cli/targets.hpp"

#include <algorithm>
#include <array>
#include <cstdio>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "apps/cli/console.hpp"
#include "core/error.hpp"
#include "core/file.hpp"
#include "core/hash.hpp"
#include "core/progress.hpp"
#include "image/decode.hpp"
#include "image/png.hpp"
#include "image/video.hpp"
#include "scene/load.hpp"

namespace brume::cli {
namespace {

// Position of the frame number in a file name, and its minimum number of digits.
struct Placeholder {
  std::size_t begin = 0, length = 0, digits = 1;
};

std::optional<Placeholder> find_placeholder(const std::string& name) {
  const std::size_t begin = name.find('%');
  if (begin == std::string::npos) return std::nullopt;
  const std::string after = name.substr(begin + 1, 3);
  if (after.rfind("d", 0) == 0) return Placeholder{begin, 2, 1};
  if (after.size() == 3 && after[0] == '0' && after[1] >= '1' && after[1] <= '9' && after[2] == 'd') {
    return Placeholder{begin, 4, static_cast<std::size_t>(after[1] - '0')};
  }
  return std::nullopt;
}

// Names what the frame was made from.
image::PngText frame_text(std::uint64_t key, std::uint32_t frame) {
  const std::array<std::uint64_t, 2> parts{key, frame};
  char text[17];
  std::snprintf(text, sizeof text, "%016llx",
                static_cast<unsigned long long>(hash_values(std::span<const std::uint64_t>(parts))));
  return {"Brume frame", text};
}

// Whether the file of the frame is complete and made from the same inputs.
bool is_frame(const SequenceSettings& settings, std::uint32_t frame) {
  const std::filesystem::path path = sequence_name(settings.pattern, frame);
  const auto bytes = read_file(path);
  if (!bytes) return false;
  const image::PngText text = frame_text(settings.key, frame);
  if (image::find_png_text(*bytes, text.keyword) != text.text) return false;
  const auto image = image::decode_image(*bytes, path.string());
  return image && image->width == settings.size_px.x && image->height == settings.size_px.y;
}

}  // namespace

TargetKind target_kind(const std::filesystem::path& path) {
  const std::string name = path.filename().string();
  const std::string extension = scene::lower_extension(path);
  if (extension == ".mp4") return TargetKind::film;
  if (extension != ".png") {
    throw Error(ErrorCode::usage, path.string() + ": cannot write this file type; expected .png or .mp4");
  }
  if (name.find('%') == std::string::npos) return TargetKind::picture;
  const auto place = find_placeholder(name);
  if (!place || name.find('%', place->begin + 1) != std::string::npos) {
    throw Error(ErrorCode::usage,
                path.string() + ": expected one %d or %04d in the name, for the frame number");
  }
  return TargetKind::sequence;
}

std::filesystem::path sequence_name(const std::filesystem::path& pattern, std::uint32_t number) {
  std::string name = pattern.filename().string();
  const auto place = find_placeholder(name);
  BRUME_ASSERT(place.has_value(), name);
  std::string digits = std::to_string(number);
  if (digits.size() < place->digits) digits.insert(0, place->digits - digits.size(), '0');
  return pattern.parent_path() / name.replace(place->begin, place->length, digits);
}

void write_film(const std::filesystem::path& path, const FilmSettings& settings, std::uint32_t first,
                std::uint32_t last, const std::function<image::Image8(std::uint32_t)>& draw) {
  image::VideoWriter writer = image::VideoWriter::open(path, {settings.size_px.x, settings.size_px.y,
                                                              settings.frames_per_second, settings.threads})
                                  .value_or_throw();
  const std::uint32_t count = last - first + 1;
  std::uint32_t drawn = 0;
  try {
    Progress progress("frames", count, progress_display());
    for (; drawn < count; ++drawn) {
      writer.add_frame(draw(first + drawn)).value_or_throw();
      progress.advance();
    }
  } catch (Interrupted& interrupted) {
    interrupted.state = " after " + std::to_string(drawn) + " of " + std::to_string(count) + " frames; " +
                        path.string() +
                        " is not written (only numbered frames, such as -o f_%04d.png, can be "
                        "continued)";
    throw;
  }
  writer.finish().value_or_throw();
}

void write_sequence(const SequenceSettings& settings, Outputs& outputs,
                    const std::function<image::Image8(std::uint32_t)>& draw) {
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
  Progress progress("frames", missing, progress_display());
  for (std::uint32_t i = 0; i < end; ++i) {
    stop_if_interrupted();
    const std::uint32_t frame = settings.first + i;
    if (done[i] && !settings.frames_depend) continue;
    const image::Image8 image = draw(frame);
    if (done[i]) continue;
    image::save_png(sequence_name(settings.pattern, frame), image, frame_text(settings.key, frame))
        .value_or_throw();
    outputs.frame_done(frame);
    progress.advance();
  }
}

}  // namespace brume::cli
