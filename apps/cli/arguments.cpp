#include "apps/cli/arguments.hpp"

#include <CLI/CLI.hpp>
#include <cmath>
#include <cstdlib>
#include <sstream>

#include "core/error.hpp"

namespace brume::cli {
namespace {

constexpr double kUnlimited = 1e300, kMostWhole = 4294967295.0;

/// Lists commands with the first line of their description only.
class BriefFormatter : public CLI::Formatter {
 public:
  std::string make_subcommand(const CLI::App* command) const override {
    const std::string text = command->get_description();
    return "  " + command->get_name() + std::string(12 - command->get_name().size(), ' ') +
           text.substr(0, text.find('\n')) + "\n";
  }
  std::string make_description(const CLI::App* app) const override {
    return CLI::Formatter::make_description(app) + "\n";
  }
};

/// A number in [low, high]. CLI11's own check accepts NaN, and names ranges with six decimals.
CLI::Validator number_check(double low, double high, bool whole) {
  return CLI::Validator(
      [=](std::string& text) -> std::string {
        char* end = nullptr;
        const double value = std::strtod(text.c_str(), &end);
        const bool is_number = !text.empty() && *end == '\0' && (!whole || value == std::floor(value));
        if (is_number && value >= low && value <= high) return "";
        const std::string kind = whole ? "a whole number" : "a number";
        if (low <= -kUnlimited || high >= kMostWhole) return "expected " + kind + ", found '" + text + "'";
        std::ostringstream range;
        range.precision(10);
        range << "expected " << kind << " from " << low << " to " << high << ", found '" << text << "'";
        return range.str();
      },
      "");
}

/// A finite number.
CLI::Validator any_number() {
  return number_check(-kUnlimited, kUnlimited, false);
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
  option_->check(number_check(low, high, false));
  return *this;
}

const Argument& Argument::range(std::uint32_t low, std::uint32_t high) const {
  option_->check(number_check(low, high, true));
  return *this;
}

const Argument& Argument::one_of(const std::vector<std::string>& values) const {
  option_->check(CLI::IsMember(values));
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
  return Argument(app_->add_option(name, value, help));
}

Argument Arguments::add_option(const std::string& name, std::vector<std::string>& value,
                               const std::string& help) const {
  return Argument(app_->add_option(name, value, help));
}

Argument Arguments::add_option(const std::string& name, std::uint32_t& value, const std::string& help) const {
  return Argument(app_->add_option(name, value, help)->check(number_check(0, kMostWhole, true)));
}

Argument Arguments::add_option(const std::string& name, std::optional<std::uint32_t>& value,
                               const std::string& help) const {
  return Argument(app_->add_option(name, value, help)->check(number_check(0, kMostWhole, true)));
}

Argument Arguments::add_option(const std::string& name, float& value, const std::string& help) const {
  return Argument(app_->add_option(name, value, help)->check(any_number()));
}

Argument Arguments::add_option(const std::string& name, double& value, const std::string& help) const {
  return Argument(app_->add_option(name, value, help)->check(any_number()));
}

Argument Arguments::add_option(const std::string& name, std::optional<double>& value,
                               const std::string& help) const {
  return Argument(app_->add_option(name, value, help)->check(any_number()));
}

Argument Arguments::add_flag(const std::string& name, bool& value, const std::string& help) const {
  return Argument(app_->add_flag(name, value, help));
}

bool Arguments::parsed() const {
  return app_->parsed();
}

CommandLine::CommandLine(const std::string& about, const std::string& name, const std::string& version)
    : app_(std::make_unique<CLI::App>(about, name)) {
  app_->formatter(std::make_shared<BriefFormatter>());
  app_->set_version_flag("--version", version);
  app_->require_subcommand(1);
}

CommandLine::~CommandLine() = default;

Arguments CommandLine::add_command(const std::string& name, const std::string& description) {
  return Arguments(app_->add_subcommand(name, description));
}

bool CommandLine::parse(int argc, char** argv) {
  try {
    app_->parse(argc, argv);
    return true;
  } catch (const CLI::Success& help) {
    app_->exit(help);
    return false;
  } catch (const CLI::ParseError& error) {
    const auto chosen = app_->get_subcommands();
    const std::string name = chosen.empty() ? "" : " " + chosen.front()->get_name();
    if (chosen.empty() && !app_->remaining().empty())
      throw Error(ErrorCode::usage, "unknown command '" + app_->remaining().front() + "'; see brume --help");
    throw Error(ErrorCode::usage, std::string(error.what()) + "; see brume" + name + " --help");
  }
}

}  // namespace brume::cli
