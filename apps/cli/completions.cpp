// Completions of bash, zsh and fish. All have the same shape: which command the words name, then its options,
// and what follows an option.
#include <algorithm>

#include "apps/cli/manual.hpp"
#include "apps/command_line/help.hpp"

namespace brume::cli {
namespace {

constexpr const char* kHead = " The build writes this file from the options of the program.\n";

/// 'text' for a shell: a quote ends the string, follows alone, and a string begins again.
std::string quoted(const std::string& text) {
  std::string result = "'";
  for (const char c : text) result += c == '\'' ? "'\\''" : std::string(1, c);
  return result + "'";
}

std::string joined(const std::vector<std::string>& words) {
  std::string result;
  for (const std::string& word : words) result += (result.empty() ? "" : " ") + word;
  return result;
}

/// The first statement of a description.
std::string brief(std::string text) {
  for (const char* end : {"\n", "; ", ". "}) text.erase(std::min(text.find(end), text.size()));
  if (text.ends_with('.')) text.pop_back();
  return text;
}

/// The words after `first` of commands of two words, such as slices for bake, and the choices of its own
/// argument.
std::vector<std::string> second_words(const CLI::App& program, const std::string& first) {
  std::vector<std::string> words;
  for (const CLI::App* command : commands_of(program))
    if (command->get_name().starts_with(first + " "))
      words.push_back(command->get_name().substr(first.size() + 1));
  return words;
}
std::vector<std::string> argument_choices(const CLI::App& command) {
  for (const CLI::Option* option : command.get_options())
    if (option->get_positional()) return choices_of(*option);
  return {};
}

/// Null: the word begins commands of two words only.
const CLI::App* find_command(const CLI::App& program, const std::string& name) {
  for (const CLI::App* command : commands_of(program))
    if (command->get_name() == name) return command;
  return nullptr;
}

std::vector<std::string> first_words(const CLI::App& program) {
  std::vector<std::string> words;
  for (const CLI::App* command : commands_of(program)) {
    const std::string word = command->get_name().substr(0, command->get_name().find(' '));
    if (std::ranges::find(words, word) == words.end()) words.push_back(word);
  }
  return words;
}

std::vector<std::string> option_names(const CLI::App& command) {
  std::vector<std::string> names;
  for (const CLI::Option* option : options_of(command))
    for (const std::string& name : names_of(*option)) names.push_back(name);
  return names;
}

/// Text within [] and between : of zsh.
std::string zsh_text(const std::string& text) {
  std::string result;
  for (const char c : text)
    result += (c == '[' || c == ']' || c == ':' || c == '\\' ? "\\" : "") + std::string(1, c);
  return result;
}

/// What zsh and fish complete the value of an option to.
std::string zsh_value(const CLI::Option& option) {
  if (!takes_value(option)) return "";
  const std::vector<std::string> choices = choices_of(option);
  const std::string type = option.get_positional() ? option.get_name(true) : option.get_type_name();
  return ":" + zsh_text(type) + ":" +
         (!choices.empty()     ? "(" + joined(choices) + ")"
          : takes_file(option) ? "_files"
                               : " ");
}

std::string zsh_option(const CLI::Option& option) {
  const std::vector<std::string> names = names_of(option);
  const bool repeats = option.get_multi_option_policy() == CLI::MultiOptionPolicy::TakeAll;
  std::string result;
  for (const std::string& name : names)
    result += " \\\n        " + quoted((repeats ? "*" : "(" + joined(names) + ")") + name + "[" +
                                       zsh_text(brief(option.get_description())) + "]" + zsh_value(option));
  return result;
}

std::string zsh_arguments(const CLI::App& command) {
  std::string result = "      _arguments -s";
  for (const CLI::Option* option : options_of(command)) result += zsh_option(*option);
  for (const CLI::Option* option : command.get_options())
    if (option->get_positional())
      result +=
          " \\\n        " + quoted((option->get_items_expected_max() > 1 ? "*" : "") + zsh_value(*option));
  return result + "\n";
}

std::string fish_option(const CLI::Option& option, const std::string& condition) {
  std::string line = "complete -c brume -n " + quoted(condition);
  for (const std::string& name : option.get_snames()) line += " -s " + name;
  for (const std::string& name : option.get_lnames()) line += " -l " + name;
  const std::vector<std::string> choices = choices_of(option);
  if (!choices.empty())
    line += " -x -a " + quoted(joined(choices));
  else if (takes_file(option))
    line += " -r -F";
  else if (takes_value(option))
    line += " -x";
  return line + " -d " + quoted(brief(option.get_description())) + "\n";
}

constexpr const char* kBash = R"(
_brume() {
  local word=${COMP_WORDS[COMP_CWORD]} before=("${COMP_WORDS[@]:1:COMP_CWORD-1}") words command last
  command=${before[*]:0:2}
  _brume_options "$command" > /dev/null || command=${before[*]:0:1}
  last=${before[*]: -1:1}
  if ((${#before[@]} == 0)) && [[ $word != -* ]]; then
    words="$(_brume_second '') help"
  elif [[ ${before[*]} == help ]]; then
    words=$(_brume_second '')
  elif [[ ${before[0]} == help ]]; then
    words=$(_brume_second "${before[*]:1}")
  elif words=$(_brume_values "$command $last"); then
    :
  elif [[ $word == -* ]]; then
    words=$(_brume_options "$command")
  else
    words=$(_brume_second "${before[*]}"; _brume_values "${before[*]} ")
  fi
  if [[ -z $words ]]; then
    mapfile -t COMPREPLY < <(compgen -f -- "$word")
    return
  fi
  mapfile -t COMPREPLY < <(compgen -W "$words" -- "$word")
}
complete -o filenames -F _brume brume
)";

constexpr const char* kFish = R"(
# Whether the words before the cursor name this command: '' for none yet.
function __brume_in --argument-names command
    set -l words (commandline -opc)
    set -e words[1]
    set -l named "$words[1]"
    contains -- "$words[1..2]" $__brume_pairs
    and set named "$words[1..2]"
    test "$named" = "$command"
end
# Whether the word of a command is the only one.
function __brume_after --argument-names word
    set -l words (commandline -opc)
    test (count $words) -eq 2
    and test "$words[2]" = "$word"
end
)";

std::string bash_case(const std::string& pattern, const std::vector<std::string>& words) {
  return "    " + quoted(pattern) + ") echo " + quoted(joined(words)) + " ;;\n";
}

std::string bash_function(const std::string& name, const std::string& cases) {
  return "_brume_" + name + "() {\n  case $1 in\n" + cases + "    *) return 1 ;;\n  esac\n}\n";
}

}  // namespace

std::string bash_completion(const CLI::App& program) {
  std::string options, values, second = bash_case("", first_words(program));
  options += bash_case("", option_names(program));
  for (const std::string& first : first_words(program))
    if (const auto words = second_words(program, first); !words.empty()) second += bash_case(first, words);
  for (const CLI::App* command : commands_of(program)) {
    const std::string& name = command->get_name();
    options += bash_case(name, option_names(*command));
    for (const CLI::Option* option : options_of(*command)) {
      const auto choices = choices_of(*option);
      if (choices.empty()) continue;
      for (const std::string& word : names_of(*option)) values += bash_case(name + " " + word, choices);
    }
    if (const auto choices = argument_choices(*command); !choices.empty())
      values += bash_case(name + " ", choices);
  }
  return "# Completes the commands, options and files of brume in bash." + std::string(kHead) +
         bash_function("second", second) + bash_function("options", options) +
         bash_function("values", values) + kBash;
}

std::string zsh_completion(const CLI::App& program) {
  // Commands of one word, and the second words of the others.
  std::string commands, pairs, cases;
  for (const std::string& word : first_words(program)) {
    const auto second = second_words(program, word);
    const CLI::App* command = find_command(program, word);
    commands +=
        "    " + quoted(word + ":" + zsh_text(command ? brief(command->get_description()) : "")) + "\n";
    if (second.empty()) continue;
    std::vector<std::string> words = second;
    if (command) std::ranges::copy(argument_choices(*command), std::back_inserter(words));
    pairs += "  if (( CURRENT == 3 )) && [[ $words[2] == " + word +
             " && $words[3] != -* ]]; then\n    compadd " + joined(words) + "\n    return\n  fi\n";
  }
  // The options and arguments of each command.
  for (const CLI::App* command : commands_of(program))
    cases += "    " + quoted(command->get_name()) + ")\n" + zsh_arguments(*command) + "      ;;\n";
  // The script: the first word, the second word, then what the command takes.
  return "#compdef brume\n# Completes the commands, options and files of brume in zsh." + std::string(kHead) +
         "_brume() {\n  local -a commands=(\n" + commands + "    'help:Print the help of a command'\n  )\n" +
         "  if (( CURRENT == 2 )); then\n    if [[ $words[2] == -* ]]; then\n      compadd -- " +
         joined(option_names(program)) +
         "\n    else\n      _describe command commands\n    fi\n    return\n  fi\n" + pairs +
         "  local command=$words[2]\n  case \"$words[2] $words[3]\" in\n" +
         [&] {
           std::string lines;
           for (const CLI::App* command : commands_of(program))
             if (command->get_name().find(' ') != std::string::npos)
               lines += "    " + quoted(command->get_name()) + ") command=" + quoted(command->get_name()) +
                        " ;;\n";
           return lines;
         }() +
         "  esac\n  local count=${#${=command}}\n  shift $count words\n  (( CURRENT -= count ))\n" +
         "  case $command in\n" + cases + "  esac\n}\n_brume \"$@\"\n";
}

std::string fish_completion(const CLI::App& program) {
  std::string pairs, lines;
  for (const CLI::Option* option : options_of(program)) lines += fish_option(*option, "__brume_in ''");
  for (const std::string& word : first_words(program)) {
    const CLI::App* command = find_command(program, word);
    lines += "complete -c brume -n \"__brume_in ''\" -f -a " + word + " -d " +
             quoted(command ? brief(command->get_description()) : "") + "\n";
    std::vector<std::string> second = second_words(program, word);
    if (second.empty()) continue;
    if (command) std::ranges::copy(argument_choices(*command), std::back_inserter(second));
    lines += "complete -c brume -n '__brume_after " + word + "' -f -a " + quoted(joined(second)) + "\n";
  }
  for (const CLI::App* command : commands_of(program)) {
    if (command->get_name().find(' ') != std::string::npos) pairs += " " + quoted(command->get_name());
    for (const CLI::Option* option : options_of(*command))
      lines += fish_option(*option, "__brume_in \"" + command->get_name() + "\"");
  }
  return "# Completes the commands, options and files of brume in fish." + std::string(kHead) +
         "set -g __brume_pairs" + pairs + kFish + lines;
}

}  // namespace brume::cli
