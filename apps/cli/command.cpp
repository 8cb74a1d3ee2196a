#include "apps/cli/command.hpp"

#include <algorithm>

#include "core/error.hpp"
#include "core/utf8.hpp"
#include "scene/files/load.hpp"

namespace brume::cli {

Command declare(CommandLine& program, const std::string& name, const std::string& what,
                const std::string& examples) {
  Command command;
  command.common = std::make_shared<CommonOptions>();
  command.arguments = program.add_command(name, what + "\n\nExamples:\n" + examples);
  command.arguments
      .add_option("--threads", command.common->threads,
                  "Threads of the simulation, voxelization and film encoder; default 0: one per core. The "
                  "renderer uses the device's own")
      .range(0u, 1024u)
      .type_name("N");
  command.arguments.add_flag("--force", command.common->force,
                             "Let outputs replace files of another kind; never an input");
  command.arguments
      .add_option("--progress", command.common->progress,
                  "How long jobs report: line, on a terminal (the default), or json, one object a line on "
                  "standard error, twice a second")
      .one_of({"line", "json"})
      .type_name("FORM");
  command.arguments.add_flag("-q,--quiet", command.common->quiet, "Suppress progress and warnings");
  return command;
}

void declare_json(const Arguments& arguments, std::string& file, const std::string& what) {
  arguments.add_option("--json", file, "Write " + what + " as JSON; - for standard output").type_name("FILE");
}

void declare_device(const Arguments& arguments, std::string& device) {
  arguments.add_option("--device", device, "Device by number or part of its name; see brume devices")
      .type_name("N|NAME");
}

void expect_suffix(const std::string& argument, const std::string& file,
                   std::initializer_list<const char*> suffixes) {
  const std::string found = scene::lower_extension(to_path(file));
  if (std::find(suffixes.begin(), suffixes.end(), found) != suffixes.end()) return;
  std::string list;
  for (const char* const* suffix = suffixes.begin(); suffix != suffixes.end(); ++suffix)
    list += std::string(suffix == suffixes.begin()     ? ""
                        : suffix + 1 == suffixes.end() ? " or "
                                                       : ", ") +
            *suffix;
  throw Error(ErrorCode::usage,
              (argument.empty() ? "" : argument + " ") + file + ": unknown file suffix; expected " + list);
}

}  // namespace brume::cli
