// Shaders that are edited while the window is open: compiled again when a file changes, and put into the
// pipelines that use them. One that does not compile, or asks for other resources than the program binds, is
// refused, and the version before goes on.
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

/// Compiles one shader file of `folder`, with its includes from there, as the build does. Fails with what the
/// compiler says: file, line, and what is wrong.
Result<std::vector<std::uint32_t>> compile_shader(const std::filesystem::path& folder,
                                                  const std::string& name);

/// Fails when a shader does not fit a pipeline: bindings, push constants, size of the workgroup.
Result<void> check_fit(const std::vector<std::uint32_t>& words, const gpu::Pipeline& pipeline,
                       const std::string& name);

class ShaderReload {
 public:
  static constexpr std::chrono::milliseconds kLookEvery{300};

  /// Watches the shader files of a folder; one that is not there is watched in vain.
  explicit ShaderReload(std::filesystem::path folder);

  /// Looks after the files every now and then, and puts what was compiled so far into the pipelines that do
  /// not have it yet. When the device is done with the frame before. True when there is a new version.
  bool follow(gpu::Context& context);

  /// What is wrong with shaders now, by file: what the compiler says.
  const std::map<std::string, std::string>& errors() const { return errors_; }
  std::size_t reloads() const { return reloads_; }

 private:
  using Words = std::vector<std::uint32_t>;
  struct Compiled {
    std::string name;
    Result<Words> words;
  };
  void look();
  bool take(gpu::Context& context, Compiled compiled);
  /// Gives a pipeline this version of its shader, unless it has it or another shader.
  static Result<void> replace(gpu::Pipeline& pipeline, const std::string& name, const Words& words);

  std::filesystem::path folder_;
  std::chrono::steady_clock::time_point looked_at_{};
  std::map<std::string, std::filesystem::file_time_type> newest_;  ///< Of a shader and all that it includes.
  std::deque<std::string> changed_;                                ///< To be compiled.
  std::future<Compiled> compiling_;
  std::deque<Words> kept_;  ///< Pipelines refer to them.
  std::map<std::string, const Words*> in_use_;
  std::map<std::string, std::string> errors_;
  std::size_t reloads_ = 0;
};

}  // namespace brume::viewer
