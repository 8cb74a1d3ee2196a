#include "apps/command_line/arguments.hpp"

#include <algorithm>
#include <map>

#include "apps/command_line/console.hpp"
#include "apps/command_line/help.hpp"
#include "apps/command_line/number.hpp"
#include "core/error.hpp"
#include "core/similar.hpp"
#include "core/utf8.hpp"
#include "scene/files/load.hpp"

namespace brume::cli {
namespace {

constexpr double kMostWhole = 4294967295.0;

/// Numbers of a range. Replaces the text by one that CLI11 converts: it reads no fractions.
CLI::Validator number_check(const NumberRange& range) {
  return CLI::Validator(
      [=](std::string& text) -> std::string {
        std::string fault;
        const auto value = checked_number(text, range, fault);
        if (!value) return fault;
        char exact[40];
        std::snprintf(exact, sizeof exact, range.whole ? "%.0f" : "%.17g", *value);
        text = exact;
        return "";
      },
      "");
}

CLI::Option* number_option(CLI::Option* option, const NumberRange& range) {
  return option->transform(number_check(range));
}

/// An empty text is no value, although a shell can give it: it would count as an option that is not given.
CLI::Option* text_option(CLI::Option* option) {
  return option->check(CLI::Validator(
      [](const std::string& text) -> std::string { return text.empty() ? "expected a value, found ''" : ""; },
      ""));
}

[[noreturn]] void refuse(const std::string& message, const CLI::App* command) {
  const CLI::App* const program = command ? command->get_parent() : nullptr;
  throw Error(ErrorCode::usage, message + "; see " + (program ? program->get_name() : "brume") + " " +
                                    (command ? command->get_name() + " " : "") + "--help");
}

/// The long names of a command's options, with dashes.
std::vector<std::string> long_option_names(const CLI::App& command) {
  std::vector<std::string> names;
  for (const CLI::Option* option : command.get_options()) {
    if (option->get_group().empty()) continue;
    for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
  }
  return names;
}

/// Checks the words of a command line before CLI11 does, whose messages name neither the place nor the fix.
class WordCheck {
 public:
  WordCheck(const CLI::App& command, const std::vector<std::string>& words)
      : command_(command), words_(words) {}

  void run() {
    for (; next_ < words_.size(); ++next_) {
      const std::string& word = words_[next_];
      if (!options_ended_ && word == "--") {
        options_ended_ = true;
      } else if (!options_ended_ && word.starts_with("--")) {
        check_long(word);
      } else if (!options_ended_ && word.size() > 1 && word[0] == '-' && !parse_number(word.substr(0, 2)) &&
                 word[1] != '.') {
        check_short(word);
      } else {
        check_positional(word);
      }
    }
    if (!help_) check_missing();
  }

 private:
  void check_long(const std::string& word) {
    const std::size_t equals = word.find('=');
    const std::string name = word.substr(0, equals);
    const CLI::Option* option = command_.get_option_no_throw(name);
    if (option == nullptr) refuse("unknown option " + name + nearest(name), &command_);
    const bool has_value = equals != std::string::npos;
    if (has_value && !takes_value(*option)) refuse(name + ": takes no value", &command_);
    if (has_value && equals + 1 == word.size()) refuse(missing_value(name, *option), &command_);
    take(name, *option, has_value);
  }
  void check_short(const std::string& word) {
    for (std::size_t i = 1; i < word.size(); ++i) {
      const std::string name = "-" + word.substr(i, 1);
      const CLI::Option* option = command_.get_option_no_throw(name);
      if (option == nullptr)
        refuse("unknown option " + (i == 1 ? word : name) + nearest("-" + word), &command_);
      if (!takes_value(*option)) {
        take(name, *option, true);
        continue;
      }
      return take(name, *option, i + 1 < word.size());
    }
  }
  void check_positional(const std::string& word) {
    std::size_t most = 0;
    for (const CLI::Option* option : command_.get_options())
      if (option->get_positional()) most += static_cast<std::size_t>(option->get_items_expected_max());
    if (++positionals_ <= most) return;
    std::string message = "unexpected argument '" + word + "'";
    if (word.find(',') != std::string::npos || parse_number(word))
      message += "; put a value with blanks into quotes, such as --camera \"0,1.7,5 0,1.5,0 60\"";
    refuse(message, &command_);
  }
  /// Skips the value in the next word unless the option's own word has it.
  void take(const std::string& name, const CLI::Option& option, bool has_value) {
    help_ = help_ || &option == command_.get_help_ptr();
    const bool once = option.get_multi_option_policy() == CLI::MultiOptionPolicy::Throw;
    if (++given_[&option] > 1 && once && takes_value(option))
      refuse(name + ": is given twice; remove one", &command_);
    if (has_value || !takes_value(option)) return;
    if (next_ + 1 == words_.size()) refuse(missing_value(name, option), &command_);
    ++next_;
  }
  void check_missing() const {
    std::size_t positionals = 0;
    for (const CLI::Option* option : command_.get_options()) {
      const bool missing =
          option->get_positional() ? positionals++ >= positionals_ : !given_.contains(option);
      if (option->get_required() && missing)
        refuse("expected " + shown_name(*option) + ": " + option->get_description(), &command_);
    }
  }
  static std::string missing_value(const std::string& name, const CLI::Option& option) {
    return name + ": expected a value, " + option.get_type_name();
  }
  std::string nearest(const std::string& name) const {
    const auto similar = similar_name(name, long_option_names(command_));
    return similar ? "; did you mean " + *similar + "?" : "";
  }

  const CLI::App& command_;
  const std::vector<std::string>& words_;
  std::map<const CLI::Option*, int> given_;
  std::size_t next_ = 0, positionals_ = 0;
  bool options_ended_ = false, help_ = false;
};

[[noreturn]] void refuse_command(const std::string& word, const std::vector<std::string>& commands) {
  const std::string extension = scene::lower_extension(to_path(word));
  if (word.starts_with("-")) refuse("unknown option " + word, nullptr);
  if (extension == ".toml" || extension == ".glb" || extension == ".gltf" || extension == ".obj")
    refuse("expected a command before " + word + ", such as brume render " + word + " -o a.png", nullptr);
  const auto similar = similar_name(word, commands);
  refuse("unknown command '" + word + "'" + (similar ? "; did you mean brume " + *similar + "?" : ""),
         nullptr);
}

void print_help(const CLI::App& app, const std::string& prefix) {
  std::string text = app.help(prefix);
  text.erase(text.find_last_not_of('\n') + 1);
  print(text + "\n");
}

}  // namespace

const Argument& Argument::type_name(const std::string& name) const {
  option_->type_name(name);
  return *this;
}

const Argument& Argument::required() const {
  option_->required();
  return *this;
}

const Argument& Argument::range(double low, double high) const {
  number_option(option_, {low, high});
  return *this;
}

const Argument& Argument::range(std::uint32_t low, std::uint32_t high) const {
  number_option(option_, {static_cast<double>(low), static_cast<double>(high), true});
  return *this;
}

const Argument& Argument::one_of(const std::vector<std::string>& values) const {
  const auto same_but_for_dashes = [](const std::string& a, const std::string& b) {
    return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](char x, char y) {
      return x == y || (x == '-' && y == '_') || (x == '_' && y == '-');
    });
  };
  std::string names;
  for (const std::string& value : values)
    names += (names.empty() ? "" : std::string(1, kChoiceSeparator)) + value;
  option_->transform(CLI::Validator(
      [values, same_but_for_dashes](std::string& text) -> std::string {
        for (const std::string& value : values) {
          if (!same_but_for_dashes(value, text)) continue;
          text = value;
          return "";
        }
        return "unknown value '" + text + "'" + suggestion(text, values, "");
      },
      "", names));
  return *this;
}

const Argument& Argument::take_last() const {
  option_->multi_option_policy(CLI::MultiOptionPolicy::TakeLast);
  return *this;
}

const Argument& Argument::take_all() const {
  option_->expected(1)->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
  return *this;
}

const Argument& Argument::hidden() const {
  option_->group("");
  return *this;
}

Argument Arguments::add_option(const std::string& name, std::string& value, const std::string& help) const {
  return Argument(text_option(app_->add_option(name, value, help)));
}

Argument Arguments::add_option(const std::string& name, std::vector<std::string>& value,
                               const std::string& help) const {
  return Argument(text_option(app_->add_option(name, value, help)));
}

Argument Arguments::add_option(const std::string& name, std::uint32_t& value, const std::string& help) const {
  return Argument(number_option(app_->add_option(name, value, help), {0, kMostWhole, true}));
}

Argument Arguments::add_option(const std::string& name, std::optional<std::uint32_t>& value,
                               const std::string& help) const {
  return Argument(number_option(app_->add_option(name, value, help), {0, kMostWhole, true}));
}

Argument Arguments::add_option(const std::string& name, float& value, const std::string& help) const {
  return Argument(number_option(app_->add_option(name, value, help), {}));
}

Argument Arguments::add_option(const std::string& name, double& value, const std::string& help) const {
  return Argument(number_option(app_->add_option(name, value, help), {}));
}

Argument Arguments::add_option(const std::string& name, std::optional<double>& value,
                               const std::string& help) const {
  return Argument(number_option(app_->add_option(name, value, help), {}));
}

Argument Arguments::add_flag(const std::string& name, bool& value, const std::string& help) const {
  return Argument(app_->add_flag(name, value, help));
}

bool Arguments::parsed() const {
  return app_->parsed();
}

bool Arguments::given(const std::string& option) const {
  const CLI::Option* const found = app_->get_option_no_throw(option);
  return found != nullptr && found->count() > 0;
}

std::vector<std::string> Arguments::given_texts(const std::vector<std::string>& except) const {
  std::vector<std::string> texts;
  for (const CLI::Option* option : app_->get_options()) {
    if (option->get_positional() || option->empty() || option->get_lnames().empty()) continue;
    const std::string name = "--" + option->get_lnames().front();
    if (std::find(except.begin(), except.end(), name) != except.end()) continue;
    texts.push_back(name);
    for (const std::string& value : option->results()) texts.push_back(value);
  }
  return texts;
}

void Arguments::refuse(const std::string& option, const std::string& why) const {
  // "--march is for ...", but "--progress: there is none ...".
  constexpr std::string_view kPredicates[] = {"is ", "cannot ", "requires ", "shows ", "turns ", "would "};
  const bool is_predicate =
      std::ranges::any_of(kPredicates, [&](std::string_view verb) { return why.starts_with(verb); });
  if (given(option)) throw Error(ErrorCode::usage, option + (is_predicate ? " " : ": ") + why);
}

std::string Arguments::name() const {
  return app_->get_name();
}

CommandLine::CommandLine(const std::string& about, const std::string& name, const std::string& version)
    : app_(std::make_unique<CLI::App>(about, name)) {
  app_->allow_windows_style_options(false);  // "/name" is a path everywhere; commands inherit it.
  app_->formatter(std::make_shared<HelpFormatter>());
  app_->require_subcommand(0, 1);  // In `brume bench sim`, sim is a value.
  app_->set_version_flag("-V,--version", version, "Print the version and how the program was built");
  app_->set_help_flag("-h,--help", "Print this help; " + name + " COMMAND --help prints that of a command");
}

CommandLine::~CommandLine() = default;

Arguments CommandLine::add_command(const std::string& name, const std::string& description) {
  // A name of two words: CLI11 takes it only afterwards.
  CLI::App* command = app_->add_subcommand("new", description)->name(name);
  command->set_help_flag("-h,--help", "Print this help");
  command->group("Commands");
  return Arguments(command);
}

bool CommandLine::parse(int argc, const char* const* argv) {
  std::vector<std::string> words(argv + std::min(argc, 1), argv + argc);
  std::vector<std::string> commands;
  for (const CLI::App* command : app_->get_subcommands([](const CLI::App*) { return true; }))
    commands.push_back(command->get_name());

  // `brume`, `brume help` and `brume help COMMAND`. A command may have two words.
  const bool is_help = !words.empty() && words[0] == "help";
  if (is_help) words.erase(words.begin());
  if (words.size() > 1 && std::ranges::find(commands, words[0] + " " + words[1]) != commands.end()) {
    words[0] += " " + words[1];
    words.erase(words.begin() + 1);
  }
  if (is_help) {
    words.resize(std::min<std::size_t>(words.size(), 1));
    words.emplace_back("--help");
  }
  if (words.empty()) words.emplace_back("--help");
  if (words[0] == "--help" || words[0] == "-h") {
    print_help(*app_, "");
    return false;
  }
  if (words[0] == "--version" || words[0] == "-V") {
    print(app_->version() + "\n");
    return false;
  }

  // A command.
  if (std::find(commands.begin(), commands.end(), words[0]) == commands.end())
    refuse_command(words[0], commands);
  const CLI::App* command = app_->get_subcommand(words[0]);
  WordCheck(*command, {words.begin() + 1, words.end()}).run();
  try {
    app_->parse(std::vector<std::string>(words.rbegin(), words.rend()));
    return true;
  } catch (const CLI::Success&) {
    print_help(*command, app_->get_name());
    return false;
  } catch (const CLI::ParseError& error) {
    refuse(error.what(), command);
  }
}

std::string value_of(int argc, const char* const* argv, const std::string& option) {
  for (int i = 1; i < argc; ++i) {
    const std::string word = argv[i];
    if (word == option && i + 1 < argc) return argv[i + 1];
    if (word.starts_with(option + "=")) return word.substr(option.size() + 1);
  }
  return "";
}

}  // namespace brume::cli
