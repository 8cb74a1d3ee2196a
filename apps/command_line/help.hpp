// How --help looks. Only files that include CLI11 include this.
#pragma once

#include <CLI/CLI.hpp>

namespace brume::cli {

/// Lists commands with the first line of their description only, and wraps the help of options to the width
/// of the terminal.
class HelpFormatter : public CLI::Formatter {
 public:
  HelpFormatter();
  std::string make_subcommand(const CLI::App* command) const override;
  std::string make_description(const CLI::App* app) const override;
  std::string make_option(const CLI::Option* option, bool is_positional) const override;
};

/// Between the words of an option's choices in the name of its validator.
inline constexpr char kChoiceSeparator = '|';

/// "-o,--output FILE" of an option.
std::string shown_name(const CLI::Option& option);

/// Whether an option is followed by a value.
bool takes_value(const CLI::Option& option);

}  // namespace brume::cli
