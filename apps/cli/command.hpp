// The commands of the program, one source file each: declares the arguments and runs the command.
#pragma once

#include <atomic>
#include <functional>
#include <initializer_list>
#include <memory>
#include <string>

#include "apps/command_line/arguments.hpp"
#include "apps/command_line/outputs.hpp"

namespace brume::cli {

/// Options that every command accepts.
struct CommonOptions {
  unsigned threads = 0;           ///< 0: one per core.
  bool quiet = false;             ///< Suppresses progress and warnings, but not results and errors.
  std::string progress = "line";  ///< "line", on terminals only, or "json".
  bool force = false;             ///< Outputs may replace files of another kind.
  /// Time that a command has to stop by itself after a signal, before it is ended [s].
  std::atomic<double> grace_seconds = 0.5;
  Outputs outputs;  ///< Declared by the command while it runs.
};

/// A command for main to run. `run` throws Error on failure and Interrupted when a signal stops it.
struct Command {
  Arguments arguments;
  std::shared_ptr<CommonOptions> common;
  std::function<void()> run;
};

/// Declares a command with the common options. Its --help begins with `what` and the examples.
Command declare(CommandLine& program, const std::string& name, const std::string& what,
                const std::string& examples);

/// Declares --json, which writes `what`.
void declare_json(const Arguments& arguments, std::string& file, const std::string& what = "the result");

/// Declares --device.
void declare_device(const Arguments& arguments, std::string& device);

/// Throws Error (usage) unless a file's suffix, in any case, is one of these, such as ".glb".
void expect_suffix(const std::string& argument, const std::string& file,
                   std::initializer_list<const char*> suffixes);

Command add_demo(CommandLine& program);
Command add_render(CommandLine& program);
Command add_sim(CommandLine& program);
Command add_voxelize(CommandLine& program);
Command add_bake(CommandLine& program);
Command add_bake_slices(CommandLine& program);
Command add_bake_occlusion(CommandLine& program);
Command add_bake_spheres(CommandLine& program);
Command add_info(CommandLine& program);
Command add_convert(CommandLine& program);
Command add_diff(CommandLine& program);
Command add_query(CommandLine& program);
Command add_palettes(CommandLine& program);
Command add_devices(CommandLine& program);
Command add_bench(CommandLine& program);
#ifdef BRUME_VIEWER
Command add_view(CommandLine& program);
#endif

}  // namespace brume::cli
