// What pages of documentation must keep to, as functions of their text.
#pragma once

#include <set>
#include <string>
#include <string_view>
#include <vector>

namespace brume::house {

/// The text without fenced code blocks; its lines keep their numbers.
std::string without_code(std::string_view markdown);

struct Link {
  std::size_t line = 0;  ///< From 1.
  std::string target;    ///< "page.md#heading", or an address.
};

/// Links and images, as Markdown and as HTML have them.
std::vector<Link> links_of(std::string_view markdown);

/// The anchors that GitHub-like pages give to headings: lower case, hyphens for spaces, no punctuation; a
/// heading that occurs again has a number.
std::set<std::string> anchors_of(std::string_view markdown);

/// What a comment of a source refers the reader to.
struct Reference {
  std::size_t line = 0;  ///< From 1.
  std::string
      file;  ///< "docs/how/smoke.md" or "CONTRIBUTING.md" of the project, "lib/noise.glsl" of shaders.
  std::string heading;  ///< That follows in quotes; empty: none.
};
std::vector<Reference> references_in(std::string_view source);

/// Phrases that make a reader search for their noun: "that of", "those of", and "Of" at the beginning of a
/// line, a sentence or a cell. Each as "line: phrase".
std::vector<std::string> vague_phrases(std::string_view text);

}  // namespace brume::house
