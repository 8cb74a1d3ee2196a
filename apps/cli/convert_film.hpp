// Films of numbered frames, for `brume convert`.
#pragma once

#include <string>

#include "apps/cli/command.hpp"

namespace brume::cli {

struct FilmConversion {
  std::string input;   ///< PNG files with %d or %04d.
  std::string output;  ///< .mp4
  std::string frames;  ///< "0-119"
  std::string fps;
};

/// Encodes the frames as `brume render` encodes a film that it draws: the same frames give the same bytes.
/// Throws Error where a frame is missing, damaged or of another size, or where their keys (UnitKey) differ.
void convert_film(const FilmConversion& conversion, CommonOptions& common);

}  // namespace brume::cli
