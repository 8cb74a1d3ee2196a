// Rules of comments and names, as functions of a file's text.
#pragma once

#include <cstddef>
#include <string_view>
#include <vector>

#include "tests/house/house_rules.hpp"

namespace brume::house {

/// Functions of more than `limit` lines without a comment between their first line and their last.
std::vector<Length> uncommented_functions(std::string_view text, std::size_t limit);

/// Lines, from 1, of comments that begin with "Of", "Those of" or "That of": they lack the noun.
std::vector<std::size_t> nounless_comments(std::string_view text);

/// Lines, from 1, on which something is named `of`.
std::vector<std::size_t> lines_with_of(std::string_view text);

}  // namespace brume::house
