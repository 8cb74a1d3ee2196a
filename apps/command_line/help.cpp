#include "apps/command_line/help.hpp"

#include <algorithm>
#include <sstream>

#include "apps/command_line/console.hpp"
#include "core/platform/console.hpp"

namespace brume::cli {
namespace {

constexpr std::size_t kColumn = 30, kNarrowest = 60, kWidest = 100;

std::size_t help_width() {
  return std::clamp(terminal_width(platform::kOutput), kNarrowest, kWidest);
}

// The words in lines of at most `width` characters, each but the first indented by `indent`.
std::string wrapped(const std::string& text, std::size_t indent, std::size_t width) {
  std::istringstream words(text);
  std::string result, line;
  for (std::string word; words >> word;) {
    if (!line.empty() && indent + line.size() + 1 + word.size() > width) {
      result += line + "\n" + std::string(indent, ' ');
      line.clear();
    }
    line += (line.empty() ? "" : " ") + word;
  }
  return result + line + "\n";
}

}  // namespace

std::string shown_name(const CLI::Option& option) {
  const std::string type = option.get_type_name();
  if (option.get_positional()) return option.get_name(true);
  return option.get_name(false, true) +
         (type.empty() || option.get_items_expected_max() == 0 ? "" : " " + type);
}

HelpFormatter::HelpFormatter() {
  label("Positionals", "Arguments");
  label("SUBCOMMAND", "COMMAND");
}

std::string HelpFormatter::make_subcommand(const CLI::App* command) const {
  const std::string text = command->get_description();
  return "  " + command->get_name() + std::string(17 - command->get_name().size(), ' ') +
         text.substr(0, text.find('\n')) + "\n";
}

std::string HelpFormatter::make_description(const CLI::App* app) const {
  return CLI::Formatter::make_description(app) + "\n";
}

std::string HelpFormatter::make_option(const CLI::Option* option, bool) const {
  std::string name = "  " + shown_name(*option);
  name +=
      name.size() + 2 > kColumn ? "\n" + std::string(kColumn, ' ') : std::string(kColumn - name.size(), ' ');
  return name + wrapped(option->get_description(), kColumn, help_width());
}

bool takes_value(const CLI::Option& option) {
  return option.get_items_expected_max() > 0;
}

}  // namespace brume::cli
