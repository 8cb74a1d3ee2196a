#include "apps/cli/manual.hpp"

#include <algorithm>
#include <sstream>

#include "apps/command_line/help.hpp"
#include "core/error.hpp"
#include "core/file.hpp"
#include "core/utf8.hpp"

namespace brume::cli {
namespace {

constexpr const char* kFiles =
    ".SH FILES\n.TP\n.I share/brume/scenes\n"
    "The scenes of\n.B brume demo\nand\n.BR \"brume view\" ,\nrelative to the folder that the program is "
    "installed in.\n";

constexpr const char* kExitStatus =
    ".SH EXIT STATUS\n"
    ".TP\n.B 0\nDone.\n"
    ".TP\n.B 1\nInternal: a fault in the program or in a program that it calls.\n"
    ".TP\n.B 2\nUsage: an invalid option, argument or name of an output.\n"
    ".TP\n.B 3\nBad input: a file that is missing, invalid or may not be read or written.\n"
    ".TP\n.B 4\nA limit: memory, a full disk, a file larger than the system allows.\n"
    ".TP\n.B 5\nMissing: a device, a display or a program.\n"
    ".TP\n.B 6\nPartial: interrupted with some of the results written.\n"
    ".TP\n.B 7\nA comparison failed.\n"
    ".TP\n.B 130, 143\nInterrupted or terminated without results.\n";

/// Text for roff, which gives a meaning to backslashes, dashes, and dots and quotes at the begin of a line.
std::string roff(const std::string& text) {
  std::string result;
  for (const char c : text) {
    if (c == '\\')
      result += "\\(rs";
    else if (c == '-')
      result += "\\-";
    else if (c == '\'')
      result += "\\(aq";
    else if (c == '^')
      result += "\\(ha";
    else if (c == '~')
      result += "\\(ti";
    else if (c == '`')
      result += "\\(ga";
    else
      result += c;
  }
  return result.empty() || result[0] == '.' ? "\\&" + result : result;
}

/// What a description says before and after its line "Examples:".
struct Description {
  std::string text, examples;
};
Description description_of(const CLI::App& app) {
  const std::string all = app.get_description(), title = "\n\nExamples:\n";
  const std::size_t at = all.find(title);
  if (at == all.npos) return {all, ""};
  return {all.substr(0, at), all.substr(at + title.size())};
}

std::string first_line(const CLI::App& app) {
  std::string line = app.get_description();
  line.erase(std::min(line.find('\n'), line.size()));
  if (line.ends_with('.')) line.pop_back();
  return line;
}

std::string page_name(const CLI::App& command) {
  std::string name = "brume-" + command.get_name();
  std::ranges::replace(name, ' ', '-');
  return name;
}

std::string head(const std::string& name, const std::string& what) {
  std::string title = name;
  std::ranges::transform(title, title.begin(),
                         [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
  return ".TH " + roff(title) + " 1 \"\" \"brume " BRUME_VERSION "\" \"Brume\"\n.SH NAME\n" + roff(name) +
         " \\- " + roff(what) + "\n";
}

/// Paragraphs, one a line.
std::string paragraphs(const std::string& text) {
  std::string result;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);)
    result += line.empty() ? ".PP\n" : roff(line.substr(line.find_first_not_of(' '))) + "\n";
  return result;
}

std::string option_entry(const CLI::Option& option) {
  std::string names;
  for (const std::string& name : names_of(option))
    names += (names.empty() ? "\\fB" : ", \\fB") + roff(name) + "\\fR";
  if (option.get_positional()) names = "\\fI" + roff(option.get_name(true)) + "\\fR";
  if (takes_value(option) && !option.get_positional() && !option.get_type_name().empty())
    names += " \\fI" + roff(option.get_type_name()) + "\\fR";
  std::string entry = ".TP\n" + names + "\n" + roff(option.get_description()) + "\n";
  std::string choices;
  for (const std::string& choice : choices_of(option)) choices += (choices.empty() ? "" : ", ") + choice;
  // Choices that the text names already need no list.
  if (!choices.empty() && option.get_description().find(choices_of(option).front()) == std::string::npos)
    entry += ".br\nOne of: " + roff(choices) + "\n";
  return entry;
}

std::string options_section(const CLI::App& app) {
  std::string section = ".SH OPTIONS\n";
  for (const CLI::Option* option : options_of(app)) section += option_entry(*option);
  return section;
}

std::string examples_section(const std::string& examples) {
  if (examples.empty()) return "";
  std::string section = ".SH EXAMPLES\n.nf\n";
  std::istringstream lines(examples);
  for (std::string line; std::getline(lines, line);) {
    const std::size_t begin = line.find_first_not_of(' ');
    section += (begin == line.npos ? "" : roff(line.substr(begin))) + "\n";
  }
  return section + ".fi\n";
}

std::string command_page(const CLI::App& command) {
  const Description description = description_of(command);
  std::string page = head(page_name(command), first_line(command));
  page += ".SH SYNOPSIS\n.B brume " + roff(command.get_name()) + "\n.RI [ OPTIONS ]\n";
  std::string arguments;
  for (const CLI::Option* option : command.get_options()) {
    if (!option->get_positional()) continue;
    const std::string name = "\\fI" + roff(option->get_name(true)) + "\\fR";
    page += (option->get_required() ? name : "[" + name + "]") +
            (option->get_items_expected_max() > 1 ? "..." : "") + "\n";
    arguments += option_entry(*option);
  }
  page += ".SH DESCRIPTION\n" + paragraphs(description.text);
  if (!arguments.empty()) page += ".SH ARGUMENTS\n" + arguments;
  page += options_section(command);
  page += ".SH EXIT STATUS\nAs of\n.BR brume (1).\n";
  return page + examples_section(description.examples) + ".SH SEE ALSO\n.BR brume (1)\n";
}

std::string main_page(const CLI::App& program) {
  const Description description = description_of(program);
  std::string page = head("brume", first_line(program));
  page += ".SH SYNOPSIS\n.B brume\n.RB [ \\-V | \\-h ]\n.I COMMAND\n.RI [ ARGUMENTS ]\n";
  page += ".SH DESCRIPTION\n" + paragraphs(description.text) +
          ".PP\nRenders on any device with Vulkan 1.3, or on the processor; most commands require none.\n"
          ".SH COMMANDS\n";
  for (const CLI::App* command : commands_of(program))
    page += ".TP\n\\fBbrume " + roff(command->get_name()) + "\\fR\n" + roff(first_line(*command)) +
            "; see\n.BR " + roff(page_name(*command)) + " (1).\n";
  page += options_section(program) + kFiles + kExitStatus + examples_section(description.examples);
  page += ".SH SEE ALSO\n";
  const auto commands = commands_of(program);
  for (const CLI::App* command : commands)
    page += ".BR " + roff(page_name(*command)) + (command == commands.back() ? " (1)\n" : " (1),\n");
  return page;
}

void write(const std::filesystem::path& file, const std::string& text) {
  write_file_atomic(file, text).value_or_throw();
}

}  // namespace

std::vector<const CLI::App*> commands_of(const CLI::App& program) {
  return program.get_subcommands([](const CLI::App* command) { return !command->get_group().empty(); });
}

std::vector<const CLI::Option*> options_of(const CLI::App& command) {
  return command.get_options(
      [](const CLI::Option* option) { return !option->get_group().empty() && !option->get_positional(); });
}

std::vector<std::string> choices_of(const CLI::Option& option) {
  // Argument::one_of names its validator by them; others have no name. CLI11 finds a validator only in an
  // option that may be changed, and throws behind the last one.
  std::string names;
  try {
    for (int i = 0; names.empty(); ++i) names = const_cast<CLI::Option&>(option).get_validator(i)->get_name();
  } catch (const CLI::OptionNotFound&) {
  }
  std::vector<std::string> choices;
  std::istringstream words(names);
  for (std::string word; std::getline(words, word, kChoiceSeparator);) choices.push_back(word);
  return choices;
}

std::vector<std::string> names_of(const CLI::Option& option) {
  std::vector<std::string> names;
  for (const std::string& name : option.get_snames()) names.push_back("-" + name);
  for (const std::string& name : option.get_lnames()) names.push_back("--" + name);
  return names;
}

bool takes_file(const CLI::Option& option) {
  const std::string type = option.get_type_name();
  return takes_value(option) &&
         (type.find("FILE") != type.npos || type == "FOLDER" || option.get_positional());
}

void write_manual(const CLI::App& program, const std::filesystem::path& folder) {
  std::error_code failed;
  std::filesystem::create_directories(folder / "man1", failed);
  if (failed)
    throw Error(ErrorCode::bad_input, folder.string() + ": cannot create man1: " + failed.message());
  write(folder / "man1/brume.1", main_page(program));
  for (const CLI::App* command : commands_of(program))
    write(folder / "man1" / to_path(page_name(*command) + ".1"), command_page(*command));
  write(folder / "brume.bash", bash_completion(program));
  write(folder / "_brume", zsh_completion(program));
  write(folder / "brume.fish", fish_completion(program));
}

}  // namespace brume::cli
