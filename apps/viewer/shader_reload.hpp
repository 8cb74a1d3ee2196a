// Hot reload of shaders: recompiles a file when it changes and replaces it in the pipelines that use it. A
// shader that does not compile, or whose interface differs from what the program binds, is rejected, and the
// previous version stays in use.
#pragma once

#include <chrono>
#include <deque>
#include <filesystem>
#include <future>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "core/error.hpp"
#include "gpu/pipeline.hpp"

namespace brume::viewer {

/// Compiles a shader of `folder` as the build does, with includes relative to that folder. Fails with the
/// compiler's message, which names file and line.
Result<std::vector<std::uint32_t>> compile_shader(const std::filesystem::path& folder,
                                                  const std::string& name);

/// Fails if the interface of a shader does not match a pipeline: bindings, push constants, workgroup size.
Result<void> check_fit(const std::vector<std::uint32_t>& words, const gpu::Pipeline& pipeline,
                       const std::string& name);

class ShaderReload {
 public:
  static constexpr std::chrono::milliseconds kPollInterval{300};

  /// Watches the shader files of a folder. A folder that does not exist is no error.
  explicit ShaderReload(std::filesystem::path folder);

  /// Polls the files every kPollInterval and installs the compiled shaders in pipelines that lack them. Call
  /// it when the device has finished the previous frame. Returns whether a new version was installed.
  bool update(gpu::Context& context);

  /// Current compiler and interface errors by file name.
  const std::map<std::string, std::string>& errors() const { return errors_; }
  std::size_t reloads() const { return reloads_; }

 private:
  using Words = std::vector<std::uint32_t>;
  struct Compiled {
    std::string name;
    Result<Words> words;
  };
  void poll_files();
  bool install(gpu::Context& context, Compiled compiled);
  /// Replaces the shader `name` of a pipeline, unless it does not use that shader or is up to date.
  static Result<void> replace(gpu::Pipeline& pipeline, const std::string& name, const Words& words);

  std::filesystem::path folder_;
  std::chrono::steady_clock::time_point polled_at_{};
  std::map<std::string, std::filesystem::file_time_type>
      newest_;                       ///< Latest change of a shader and its includes.
  std::deque<std::string> changed_;  ///< To be compiled.
  std::future<Compiled> compiling_;
  std::deque<Words> installed_;  ///< Referenced by pipelines.
  std::map<std::string, const Words*> in_use_;
  std::map<std::string, std::string> errors_;
  std::size_t reloads_ = 0;
};

}  // namespace brume::viewer
