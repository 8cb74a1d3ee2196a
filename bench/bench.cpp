#include "bench/bench.hpp"

#include "bench/names.hpp"

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <ctime>
#include <filesystem>

#include "core/data_files.hpp"
#include "core/platform/machine.hpp"
#include "core/platform/process.hpp"
#include "core/tasks.hpp"
#include "core/utf8.hpp"

namespace brume::bench {
namespace {

bool matches(const std::string& name, const std::vector<std::string>& names) {
  return names.empty() || std::any_of(names.begin(), names.end(), [&](const std::string& n) {
           return name == n || name.starts_with(n + "/");
         });
}

}  // namespace

gpu::Context& Bench::context() {
  if (!context_) context_ = std::make_unique<gpu::Context>(gpu::ContextOptions{options_.device, false});
  return *context_;
}

Measurement Bench::time_calls(const std::string& name, unsigned standard,
                              const std::function<void()>& body) const {
  using Clock = std::chrono::steady_clock;
  const unsigned count = repetitions(standard);
  for (unsigned i = 0; i < std::max(1u, count / 8); ++i) body();
  std::vector<double> milliseconds;
  for (unsigned i = 0; i < count; ++i) {
    const auto start = Clock::now();
    body();
    milliseconds.push_back(std::chrono::duration<double, std::milli>(Clock::now() - start).count());
  }
  return summarize(name, "ms", "wall", std::move(milliseconds));
}

double thread_cpu_ms() {
  timespec time{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) * 1e3 + static_cast<double>(time.tv_nsec) * 1e-6;
}

Measurement summarize(const std::string& name, const std::string& unit, const std::string& clock,
                      std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const std::size_t n = values.size();
  Measurement m;
  m.name = name;
  m.unit = unit;
  m.clock = clock;
  m.median = n % 2 ? values[n / 2] : 0.5 * (values[n / 2 - 1] + values[n / 2]);
  m.min = values.front();
  m.max = values.back();
  m.repetitions = static_cast<unsigned>(n);
  return m;
}

std::vector<Case> all_cases() {
  std::vector<Case> cases;
  for (const auto& of_processor :
       {cpu_cases, edit_cases, live_cases, volume_cases, sight_cases, sim_cases, server_cases, wire_cases})
    for (Case& one : of_processor()) cases.push_back(std::move(one));
  for (const auto& of_device :
       {gpu_cases, cloud_cases, particle_cases, decal_cases, tank_cases, scaling_cases})
    for (Case& one : of_device()) {
      one.on_device = !one.name.starts_with("tank/pack/");
      cases.push_back(std::move(one));
    }
  return cases;
}

std::vector<std::string> names() {
  std::vector<std::string> names;
  for (const Case& one : all_cases()) names.push_back(one.name);
  return names;
}

Result<Report> run(const std::vector<std::string>& names, const BenchOptions& options,
                   const std::function<void(const std::string&)>& starting) {
  const std::vector<Case> cases = all_cases();
  for (const std::string& name : names) {
    if (std::any_of(cases.begin(), cases.end(), [&](const Case& one) { return matches(one.name, {name}); }))
      continue;
    std::string message = "no benchmark \"" + name + "\"; expected one of";
    for (const Case& one : cases) message.append(" ").append(one.name);
    return Failure{ErrorCode::usage, message};
  }
  const bool on_device = std::any_of(
      cases.begin(), cases.end(), [&](const Case& one) { return one.on_device && matches(one.name, names); });
  if (!options.device.empty() && !on_device)
    return Failure{ErrorCode::usage, "--device: these benchmarks run on the processor; remove the option"};
  // A device that is missing ends the run before minutes of measurements, not after them.
  if (on_device) Bench(options).context();

  Bench bench(options);
  Report report;
  for (const Case& one : cases) {
    if (!matches(one.name, names)) continue;
    if (starting) starting(one.name);
    const bool had_context = bench.has_context();
    auto measured = one.run(bench);
    BRUME_ASSERT(one.on_device || bench.has_context() == had_context, one.name);
    if (!measured) {
      if (measured.failure().code != ErrorCode::bad_input) return measured.failure();
      report.skipped.push_back(one.name + ": " + measured.failure().message);
      continue;
    }
    for (Measurement& m : *measured) report.results.push_back(std::move(m));
  }
  if (report.results.empty())
    return Failure{ErrorCode::no_device, "nothing is measured: " + report.skipped.front()};
  if (bench.has_context()) {
    report.device = bench.context().info().name;
    report.driver = bench.context().info().driver;
  }
  report.processor = platform::processor_name();
  report.threads = thread_count();
  report.commit = commit();
  return report;
}

std::filesystem::path scene_file(const std::string& name) {
  return find_data_file("scenes/" + name).value_or(to_path(name));
}

std::string commit() {
  return BRUME_COMMIT;
}

Result<std::filesystem::path> motel_scene() {
  const std::string folder = platform::environment("BRUME_MOTEL");
  const std::filesystem::path path = to_path(folder.empty() ? "../shared/data/motel" : folder) / "Scene.txt";
  std::error_code ignored;
  if (std::filesystem::is_regular_file(path, ignored)) return path;
  return Failure{ErrorCode::bad_input,
                 path.string() + ": not found; set BRUME_MOTEL to the folder of the motel"};
}

}  // namespace brume::bench
