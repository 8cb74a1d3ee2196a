#include "apps/viewer/shader_reload.hpp"

#include <algorithm>
#include <set>
#include <shaderc/shaderc.hpp>

#include "core/file.hpp"
#include "core/progress.hpp"

namespace brume::viewer {
namespace {

constexpr std::uint64_t kMaxSourceBytes = 1 << 22;

/// The file names in the #include directives of `text`.
std::vector<std::string> includes_of(const std::string& text) {
  constexpr std::string_view kWord = "#include \"";
  std::vector<std::string> names;
  for (std::size_t at = text.find(kWord); at != std::string::npos; at = text.find(kWord, at)) {
    at += kWord.size();
    const std::size_t end = text.find('"', at);
    if (end == std::string::npos) break;
    names.push_back(text.substr(at, end - at));
  }
  return names;
}

/// Latest modification time of a file and everything that it includes; nothing if the file does not exist.
std::optional<std::filesystem::file_time_type> newest_change(const std::filesystem::path& folder,
                                                             const std::string& name,
                                                             std::set<std::string>& visited) {
  std::error_code error;
  auto newest = std::filesystem::last_write_time(folder / name, error);
  if (error) return std::nullopt;
  if (!visited.insert(name).second) return newest;
  const auto text = read_text_file(folder / name, kMaxSourceBytes);
  if (!text) return newest;
  for (const std::string& included : includes_of(*text))
    if (const auto time = newest_change(folder, included, visited)) newest = std::max(newest, *time);
  return newest;
}

/// Resolves includes relative to the shader folder, as -I of the build does.
class FolderIncluder : public shaderc::CompileOptions::IncluderInterface {
 public:
  explicit FolderIncluder(std::filesystem::path folder) : folder_(std::move(folder)) {}

  shaderc_include_result* GetInclude(const char* requested, shaderc_include_type, const char*,
                                     std::size_t) override {
    auto* const include = new Include;
    const auto text = read_text_file(folder_ / requested, kMaxSourceBytes);
    // shaderc reports the content as the error message if the name is empty.
    include->name = text ? requested : "";
    include->text = text ? *text : text.failure().message;
    include->result = {include->name.data(), include->name.size(), include->text.data(), include->text.size(),
                       include};
    return &include->result;
  }
  void ReleaseInclude(shaderc_include_result* result) override {
    delete static_cast<Include*>(result->user_data);
  }

 private:
  struct Include {
    std::string name, text;
    shaderc_include_result result{};
  };
  std::filesystem::path folder_;
};

std::optional<shaderc_shader_kind> kind_of(const std::string& name) {
  const std::string extension = std::filesystem::path(name).extension().string();
  if (extension == ".comp") return shaderc_compute_shader;
  if (extension == ".vert") return shaderc_vertex_shader;
  if (extension == ".frag") return shaderc_fragment_shader;
  return std::nullopt;
}

}  // namespace

Result<std::vector<std::uint32_t>> compile_shader(const std::filesystem::path& folder,
                                                  const std::string& name) {
  const auto text = read_text_file(folder / name, kMaxSourceBytes);
  if (!text) return text.failure();
  const auto kind = kind_of(name);
  if (!kind) return Failure{ErrorCode::bad_input, name + ": expected .comp, .vert or .frag"};
  shaderc::CompileOptions options;
  options.SetTargetEnvironment(shaderc_target_env_vulkan, shaderc_env_version_vulkan_1_2);
  options.SetOptimizationLevel(shaderc_optimization_level_performance);
  options.SetWarningsAsErrors();
  options.SetIncluder(std::make_unique<FolderIncluder>(folder));
  const auto result = shaderc::Compiler().CompileGlslToSpv(*text, *kind, name.c_str(), options);
  if (result.GetCompilationStatus() != shaderc_compilation_status_success)
    return Failure{ErrorCode::bad_input, result.GetErrorMessage()};
  return std::vector<std::uint32_t>(result.cbegin(), result.cend());
}

Result<void> check_fit(const std::vector<std::uint32_t>& words, const gpu::Pipeline& pipeline,
                       const std::string& name) {
  const auto changed = gpu::reflect({name.c_str(), words});
  if (!changed) return changed.failure();
  const auto fits = gpu::check_fit(*changed, pipeline.interface());
  if (!fits)
    return Failure{ErrorCode::bad_input,
                   name + ": " + fits.failure().message + "; rebuild the program to change its interface"};
  return {};
}

ShaderReload::ShaderReload(std::filesystem::path folder) : folder_(std::move(folder)) {}

void ShaderReload::poll_files() {
  std::error_code error;
  for (const auto& entry : std::filesystem::directory_iterator(folder_, error)) {
    const std::string name = entry.path().filename().string();
    if (!kind_of(name)) continue;
    std::set<std::string> visited;
    const auto newest = newest_change(folder_, name, visited);
    if (!newest) continue;
    const auto [known, is_new] = newest_.emplace(name, *newest);
    if (is_new || known->second == *newest) continue;  // The first poll sees the built-in version.
    known->second = *newest;
    if (std::find(changed_.begin(), changed_.end(), name) == changed_.end()) changed_.push_back(name);
  }
}

Result<void> ShaderReload::replace(gpu::Pipeline& pipeline, const std::string& name, const Words& words) {
  for (const gpu::ShaderCode& shader : pipeline.shaders()) {
    if (shader.name != name || shader.words.data() == words.data()) continue;
    if (auto fits = check_fit(words, pipeline, name); !fits) return fits;
    return pipeline.replace_shader({name.c_str(), words});
  }
  return {};
}

bool ShaderReload::install(gpu::Context& context, Compiled compiled) {
  errors_.erase(compiled.name);
  if (!compiled.words) {
    errors_[compiled.name] = compiled.words.failure().message;
    return false;
  }
  installed_.push_back(std::move(*compiled.words));
  const Words& words = installed_.back();
  // Pipelines refer to the key as the name of their shader, so it must outlive them.
  const auto in_use = in_use_.emplace(compiled.name, nullptr).first;
  for (gpu::Pipeline* pipeline : context.pipelines().all()) {
    if (const auto done = replace(*pipeline, in_use->first, words); !done) {
      errors_[compiled.name] = done.failure().message;
      return false;
    }
  }
  in_use->second = &words;
  ++reloads_;
  return true;
}

bool ShaderReload::update(gpu::Context& context) {
  const auto now = std::chrono::steady_clock::now();
  if (now - polled_at_ > kPollInterval) {
    polled_at_ = now;
    poll_files();
  }
  bool changed = false;
  if (compiling_.valid() && compiling_.wait_for(std::chrono::seconds(0)) == std::future_status::ready)
    changed = install(context, compiling_.get());
  // Compile one shader at a time, concurrently with the frames.
  if (!compiling_.valid() && !changed_.empty()) {
    compiling_ = std::async(std::launch::async, [folder = folder_, name = changed_.front()] {
      const Progress job("compile " + name);
      return Compiled{name, compile_shader(folder, name)};
    });
    changed_.pop_front();
  }
  // Pipelines first made after the change, by a debug view or on a new device, still have the built-in
  // shader.
  for (gpu::Pipeline* pipeline : context.pipelines().all()) {
    for (const auto& [name, words] : in_use_) {
      if (!words) continue;
      if (const auto done = replace(*pipeline, name, *words); !done) errors_[name] = done.failure().message;
    }
  }
  return changed;
}

}  // namespace brume::viewer
