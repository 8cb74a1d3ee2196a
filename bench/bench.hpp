// Measures what the project claims: each case by its name, median of many repetitions after a warm-up.
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "core/error.hpp"
#include "gpu/context.hpp"

namespace brume::bench {

struct BenchOptions {
  std::string device;        ///< As gpu::choose_device takes it.
  unsigned repetitions = 0;  ///< 0: as many as suit the case.
};

/// One measured quantity.
struct Measurement {
  std::string name;   ///< "march/1080p"
  std::string unit;   ///< "ms"
  std::string clock;  ///< "gpu" (timestamp queries), "wall" or "cpu" (seconds of processor time)
  double median = 0, min = 0, max = 0;
  unsigned repetitions = 0;
  std::map<std::string, double> details;  ///< What was worked on: triangles, texture samples...
};

struct Report {
  std::string device, driver;  ///< Of the GPU cases; empty when none ran.
  std::string processor;
  unsigned threads = 1;
  std::string commit;
  std::vector<Measurement> results;
  std::vector<std::string> skipped;  ///< A line each: which case and why.
};

/// What a case measures with.
class Bench {
 public:
  explicit Bench(const BenchOptions& options) : options_(options) {}

  /// The device, made at the first call.
  gpu::Context& context();
  /// Calls `body` for warm-up, then `repetitions` times (or as the options say); the seconds that each call
  /// took on the wall clock become the measurement, in milliseconds.
  Measurement time_calls(const std::string& name, unsigned repetitions,
                         const std::function<void()>& body) const;
  unsigned repetitions(unsigned usual) const {
    return options_.repetitions > 0 ? options_.repetitions : usual;
  }
  bool has_context() const { return context_ != nullptr; }

 private:
  BenchOptions options_;
  std::unique_ptr<gpu::Context> context_;
};

/// Processor time of this thread [ms], from any moment on.
double thread_cpu_ms();

/// Median, least and most of `values`, which must not be empty.
Measurement summarize(const std::string& name, const std::string& unit, const std::string& clock,
                      std::vector<double> values);

struct Case {
  std::string name, what;
  /// What was measured; bad_input when its data is not there: the case is skipped.
  std::function<Result<std::vector<Measurement>>(Bench&)> run;
};
std::vector<Case> cpu_cases();
std::vector<Case> volume_cases();
std::vector<Case> edit_cases();
std::vector<Case> live_cases();
std::vector<Case> sight_cases();
std::vector<Case> sim_cases();
std::vector<Case> gpu_cases();
std::vector<Case> scaling_cases();
/// All, in the order in which they run.
std::vector<Case> all_cases();

/// Runs the cases whose name is, or begins with one of `names` and a slash; all for an empty list. Fails with
/// usage for a name that fits none, listing what there is. Throws no_device when a GPU case finds none.
Result<Report> run(const std::vector<std::string>& names, const BenchOptions& options,
                   const std::function<void(const std::string&)>& starting);

/// The Scene.txt of the motel: $BRUME_MOTEL, else beside the checkout in shared/data/motel; bad_input when
/// absent.
Result<std::string> motel_scene();

}  // namespace brume::bench
