// The rules of the architecture, as functions of a file's text.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace brume::house {

/// The folders from bottom to top: a file may include its own folder and those before it.
std::span<const std::string_view> folders();

/// "core" for src/core/file.hpp and core/file.hpp, "scene/files" for src/scene/files/load.hpp, "apps/cli" for
/// apps/cli/main.cpp; empty for a file in none.
std::string_view folder_of(std::string_view path);

/// The includes of a file of a folder that point up in folders() or to a folder that is not in
/// it.
std::vector<std::string> upward_includes(std::string_view folder, std::string_view text);

/// The calls of Vulkan functions, `vkName(`, and includes of its headers.
std::vector<std::string> vulkan_calls(std::string_view text);

/// The conditions on a system, includes of its headers and paths in /proc, which belong to src/core/platform.
std::vector<std::string> platform_code(std::string_view text);

/// The structs of a shared header without SHARED_SIZE or SHARED_LOCAL.
std::vector<std::string> unsized_structs(std::string_view text);

/// A length that a file or function has, and where it begins.
struct Length {
  std::size_t line = 0;  ///< From 1.
  std::size_t lines = 0;
  std::string name;  ///< First line of the function.
};

/// The lines of a text, without their line breaks.
std::vector<std::string_view> lines_of(std::string_view text);

/// Paths that a file includes in quotes.
std::vector<std::string> quoted_includes(std::string_view text);

/// Number of lines; a last line without a line break counts.
std::size_t line_count(std::string_view text);

/// Lines of more than `limit` characters (UTF-8 code points), from 1.
std::vector<std::size_t> wide_lines(std::string_view text, std::size_t limit);

/// Functions of at least `limit` lines, signature and closing brace included. Expects clang-format's layout:
/// a function begins and ends in the same column, 0 at namespace level or 2 in a class.
std::vector<Length> long_functions(std::string_view text, std::size_t limit);

/// The words of a glossary's last column that stand in backticks: names that nothing may use any more.
std::vector<std::string> replaced_words(std::string_view glossary);

/// Which of the words occur in a text as whole words, alone or as a part of snake_case and CamelCase names.
std::vector<std::string> occurring(std::span<const std::string> words, std::string_view text);

}  // namespace brume::house
