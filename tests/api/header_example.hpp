// The example at the top of a public header.
#pragma once

#include <string>

#include "core/file.hpp"

namespace brume::api {

/// The lines of a header's comment between "// ```c" and "// ```", without the comment's slashes; empty where
/// there are none.
inline std::string example_of(const std::string& header) {
  const std::string text = *read_text_file(BRUME_SOURCE_DIR "/include/brume/" + header);
  const std::string begin = "// ```c\n", end = "// ```\n";
  const std::size_t from = text.find(begin), to = text.find(end, from + 1);
  if (from == text.npos || to == text.npos) return {};
  std::string code = text.substr(from + begin.size(), to - from - begin.size());
  for (std::size_t at = 0; at < code.size(); at = code.find('\n', at) + 1) code.erase(at, 2);
  return code;
}

}  // namespace brume::api
