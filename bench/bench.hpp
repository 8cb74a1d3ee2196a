// Benchmarks behind the performance claims of the project: named cases, median of many repetitions after a
// warm-up.
#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "core/error.hpp"
#include "gpu/context.hpp"

namespace brume::bench {

struct BenchOptions {
  std::string device;        ///< As for gpu::choose_device.
  unsigned repetitions = 0;  ///< 0: the default of each case.
};

/// One measured quantity.
struct Measurement {
  std::string name;   ///< "march/1080p"
  std::string unit;   ///< "ms"
  std::string clock;  ///< "gpu" (timestamp queries), "wall" or "cpu" (CPU time)
  double median = 0, min = 0, max = 0;
  unsigned repetitions = 0;
  std::map<std::string, double>
      details;  ///< Problem size and secondary results: triangles, texture samples...
};

/// A file of the scenes that the program comes with; its name alone if it is missing.
std::filesystem::path scene_file(const std::string& name);

/// The commit of the source tree, "unknown" outside of git.
std::string commit();

struct Report {
  std::string device, driver;  ///< What GPU cases ran on; empty when none ran.
  std::string processor;
  unsigned threads = 1;
  std::string commit;
  std::vector<Measurement> results;
  std::vector<std::string> skipped;  ///< One line per skipped case with the reason.
};

/// Tools for a case: options, timer and device.
class Bench {
 public:
  explicit Bench(const BenchOptions& options) : options_(options) {}

  /// The device, created by the first call.
  gpu::Context& context();
  /// Calls `body` for warm-up, then `repetitions` times (the options override it), and measures the
  /// wall-clock time of each call [ms].
  Measurement time_calls(const std::string& name, unsigned repetitions,
                         const std::function<void()>& body) const;
  unsigned repetitions(unsigned standard) const {
    return options_.repetitions > 0 ? options_.repetitions : standard;
  }
  bool has_context() const { return context_ != nullptr; }
  /// Whether the device is a processor, on which cases are smaller and repeated less often.
  bool is_slow() { return context().info().kind == gpu::DeviceKind::cpu; }

 private:
  BenchOptions options_;
  std::unique_ptr<gpu::Context> context_;
};

/// CPU time of this thread [ms], since an arbitrary time.
double thread_cpu_ms();

/// Median, minimum and maximum of `values`, which must not be empty.
Measurement summarize(const std::string& name, const std::string& unit, const std::string& clock,
                      std::vector<double> values);

struct Case {
  std::string name, what;
  /// Returns the measurements; bad_input if its data is missing, which skips the case.
  std::function<Result<std::vector<Measurement>>(Bench&)> run;
  bool on_device = false;  ///< Whether it calls Bench::context.
};
std::vector<Case> cpu_cases();
std::vector<Case> volume_cases();
std::vector<Case> edit_cases();
std::vector<Case> live_cases();
std::vector<Case> sight_cases();
std::vector<Case> sim_cases();
std::vector<Case> server_cases();
std::vector<Case> wire_cases();
std::vector<Case> gpu_cases();
std::vector<Case> cloud_cases();
std::vector<Case> particle_cases();
std::vector<Case> decal_cases();
std::vector<Case> tank_cases();
std::vector<Case> scaling_cases();
/// All cases in execution order.
std::vector<Case> all_cases();

/// Runs the cases whose name equals one of `names` or begins with it and a slash; all cases if the list is
/// empty. `starting` is called with the name of each case before it runs. Fails with usage, listing all
/// cases, for a name that matches none, and for a device where no case is on one; with no_device where all
/// are skipped. Throws no_device before the first case
/// where a GPU case would find no device.
Result<Report> run(const std::vector<std::string>& names, const BenchOptions& options,
                   const std::function<void(const std::string&)>& starting);

/// Path of the motel's Scene.txt, in $BRUME_MOTEL or else in ../shared/data/motel; bad_input if it is
/// missing.
Result<std::filesystem::path> motel_scene();

}  // namespace brume::bench
