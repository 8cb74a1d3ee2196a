// The commands of the program, one file each: how its arguments are declared and what it does with them.
#pragma once

#include <functional>
#include <memory>
#include <string>

#include "apps/cli/arguments.hpp"

namespace brume::cli {

/// What every command takes.
struct CommonOptions {
  unsigned threads = 0;  ///< 0: one a core.
  bool quiet = false;    ///< No progress and no warnings; results and errors stay.
};

/// A command as main runs it. `run` throws Error when it fails and Interrupted when a signal ends it.
struct Command {
  Arguments arguments;
  std::shared_ptr<CommonOptions> common;
  std::function<void()> run;
};

/// Declares a command with its common options. Its help begins with `what` and the examples.
Command declare(CommandLine& program, const std::string& name, const std::string& what,
                const std::string& examples);

Command add_demo(CommandLine& program);
Command add_render(CommandLine& program);
Command add_sim(CommandLine& program);
Command add_voxelize(CommandLine& program);
Command add_info(CommandLine& program);
Command add_diff(CommandLine& program);
Command add_query(CommandLine& program);
Command add_devices(CommandLine& program);
Command add_bench(CommandLine& program);
#ifdef BRUME_VIEWER
Command add_view(CommandLine& program);
#endif

}  // namespace brume::cli
