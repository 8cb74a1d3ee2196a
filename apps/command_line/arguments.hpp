// Declares and parses command-line arguments: a thin wrapper over CLI11, whose header only arguments.cpp
// includes because it adds seven seconds to the compile time of every file that does.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace brume::cli {

/// A declared option: constrains its value and how --help shows it. Every function returns *this for
/// chaining.
class Argument {
 public:
  explicit Argument(CLI::Option* option) : option_(option) {}

  const Argument& type_name(const std::string& name) const;  ///< Placeholder of the value in --help.
  const Argument& required() const;
  const Argument& range(double low, double high) const;  ///< Inclusive.
  const Argument& range(std::uint32_t low, std::uint32_t high) const;
  const Argument& one_of(const std::vector<std::string>& values) const;  ///< '-' stands for '_', too.
  const Argument& take_last() const;  ///< May be repeated; the last value wins.
  const Argument& take_all() const;   ///< May be repeated with one value each; all values are kept.
  const Argument& hidden() const;     ///< Omitted from --help.

 private:
  CLI::Option* option_;
};

/// The arguments of one command. Parsing writes the referenced values, so they must outlive it. Numbers are
/// checked by checked_number, texts are not empty.
class Arguments {
 public:
  Arguments() = default;
  explicit Arguments(CLI::App* app) : app_(app) {}

  Argument add_option(const std::string& name, std::string& value, const std::string& help) const;
  Argument add_option(const std::string& name, std::vector<std::string>& value,
                      const std::string& help) const;
  Argument add_option(const std::string& name, std::uint32_t& value, const std::string& help) const;
  Argument add_option(const std::string& name, std::optional<std::uint32_t>& value,
                      const std::string& help) const;
  Argument add_option(const std::string& name, float& value, const std::string& help) const;
  Argument add_option(const std::string& name, double& value, const std::string& help) const;
  Argument add_option(const std::string& name, std::optional<double>& value, const std::string& help) const;
  Argument add_flag(const std::string& name, bool& value, const std::string& help) const;

  /// Whether the command line selects this command.
  bool parsed() const;
  /// Whether it gives this option, such as "--fps"; not one that the command does not have.
  bool given(const std::string& option) const;
  /// All options that it gives and their values, in the order of their declarations, but for these. Without
  /// the arguments that are no options.
  std::vector<std::string> given_texts(const std::vector<std::string>& except) const;
  /// Throws Error (usage), "--fps " + why, if it gives this option although it would do nothing; with a colon
  /// unless `why` is a predicate.
  void refuse(const std::string& option, const std::string& why) const;
  std::string name() const;  ///< Name of the command.

 private:
  CLI::App* app_ = nullptr;
};

/// The command line of the program: one command and its arguments.
class CommandLine {
 public:
  CommandLine(const std::string& about, const std::string& name, const std::string& version);
  ~CommandLine();

  /// The list of commands shows the first line of `description`, the command's own --help all of it.
  Arguments add_command(const std::string& name, const std::string& description);

  /// Parses the arguments. Without any, and for `help COMMAND`, --help and --version, prints that and returns
  /// false: no command is to run then. Throws Error (usage), which names what is wrong and what was probably
  /// meant.
  bool parse(int argc, const char* const* argv);

  /// All declarations, for write_manual.
  const CLI::App& declarations() const { return *app_; }

 private:
  std::unique_ptr<CLI::App> app_;
};

/// The value that a command line gives to an option such as "--json", without parsing the rest; empty: none.
std::string value_of(int argc, const char* const* argv, const std::string& option);

}  // namespace brume::cli
