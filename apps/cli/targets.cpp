#include "apps/cli/targets.hpp"

#include <optional>
#include <string>

#include "apps/cli/console.hpp"
#include "core/error.hpp"
#include "core/progress.hpp"
#include "image/png.hpp"
#include "image/video.hpp"

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

}  // namespace

TargetKind target_kind(const std::filesystem::path& path) {
  const std::string name = path.filename().string();
  if (path.extension() == ".mp4") return TargetKind::film;
  if (path.extension() != ".png") {
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
  Progress progress("frames", std::uint64_t{last} - first + 1, progress_display());
  for (std::uint32_t i = first; i <= last; ++i) {
    writer.add_frame(draw(i)).value_or_throw();
    progress.advance();
  }
  writer.finish().value_or_throw();
}

void write_sequence(const std::filesystem::path& pattern, std::uint32_t first, std::uint32_t last,
                    const std::function<image::Image8(std::uint32_t)>& draw) {
  Progress progress("frames", std::uint64_t{last} - first + 1, progress_display());
  for (std::uint32_t i = first; i <= last; ++i) {
    image::save_png(sequence_name(pattern, i), draw(i)).value_or_throw();
    progress.advance();
  }
}

}  // namespace brume::cli
