// What a command takes on the command line. CLI11 stays behind it, in arguments.cpp: its header costs each
// file that sees it seven seconds of compiler.
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

/// An option that was declared: what its value must be and how the help shows it.
class Argument {
 public:
  explicit Argument(CLI::Option* option) : option_(option) {}

  const Argument& type_name(const std::string& name) const;  ///< Of its value, in the help.
  const Argument& required() const;
  const Argument& range(double low, double high) const;  ///< Both ends are in it.
  const Argument& range(std::uint32_t low, std::uint32_t high) const;
  const Argument& one_of(const std::vector<std::string>& values) const;
  const Argument& take_last() const;  ///< Of several, the last one counts.
  const Argument& take_all() const;   ///< Given several times, with one value each.
  const Argument& hidden() const;     ///< Not in the help.

 private:
  CLI::Option* option_;
};

/// The arguments of one command. The values are written when the command line is parsed and have to live
/// until then.
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

  /// Whether the command line names this command.
  bool parsed() const;

 private:
  CLI::App* app_ = nullptr;
};

/// The command line: the name of one command and its arguments.
class CommandLine {
 public:
  CommandLine(const std::string& about, const std::string& name, const std::string& version);
  ~CommandLine();

  /// In the list of commands, only the first line of the description; all of it in the command's own help.
  Arguments add_command(const std::string& name, const std::string& description);

  /// Whether a command shall run: not where help or the version was asked for, which is said. Throws Error
  /// (usage).
  bool parse(int argc, char** argv);

 private:
  std::unique_ptr<CLI::App> app_;
};

}  // namespace brume::cli
