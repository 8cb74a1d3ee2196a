// The commands of the program, one file each: how its arguments are declared and what it does with them.
#pragma once

#include <CLI/CLI.hpp>
#include <functional>
#include <memory>
#include <string>

namespace brume::cli {

/// What every command takes.
struct CommonOptions {
  unsigned threads = 0;  ///< 0: one a core.
  bool quiet = false;    ///< No progress and no warnings; results and errors stay.
};

/// A command as main runs it. `run` throws Error when it fails and Interrupted when a signal ends it.
struct Command {
  CLI::App* parser = nullptr;
  std::shared_ptr<CommonOptions> common;
  std::function<void()> run;
};

/// Declares a command with its common options. Its help begins with `what` and the examples.
Command declare(CLI::App& program, const std::string& name, const std::string& what,
                const std::string& examples);

Command add_demo(CLI::App& program);
Command add_render(CLI::App& program);
Command add_sim(CLI::App& program);
Command add_voxelize(CLI::App& program);
Command add_info(CLI::App& program);
Command add_diff(CLI::App& program);
Command add_query(CLI::App& program);
Command add_devices(CLI::App& program);
Command add_bench(CLI::App& program);
#ifdef BRUME_VIEWER
Command add_view(CLI::App& program);
#endif

}  // namespace brume::cli
