// The manual pages and the completions of shells, written from the declared commands and options. The build
// calls this: brume --write-manual FOLDER.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace brume::cli {

/// Writes man1/brume.1, man1/brume-COMMAND.1 of each command, and the completions brume.bash, _brume (zsh)
/// and brume.fish into an existing folder. Throws Error if a file cannot be written.
void write_manual(const CLI::App& program, const std::filesystem::path& folder);

std::string bash_completion(const CLI::App& program);
std::string zsh_completion(const CLI::App& program);
std::string fish_completion(const CLI::App& program);

/// The commands of a program, in the order in which they are declared.
std::vector<const CLI::App*> commands_of(const CLI::App& program);
/// The options that --help shows, without arguments by position.
std::vector<const CLI::Option*> options_of(const CLI::App& command);
/// What an option is completed to, if it is one of a few words.
std::vector<std::string> choices_of(const CLI::Option& option);
/// "-o" and "--output".
std::vector<std::string> names_of(const CLI::Option& option);
/// Whether its value is the name of a file or folder.
bool takes_file(const CLI::Option& option);

}  // namespace brume::cli
