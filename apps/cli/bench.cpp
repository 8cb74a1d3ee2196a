#include "bench/bench.hpp"

#include <cstdio>
#include <optional>

#include "apps/cli/command.hpp"
#include "apps/command_line/console.hpp"
#include "apps/command_line/json.hpp"
#include "bench/names.hpp"
#include "core/error.hpp"
#include "core/progress.hpp"
#include "core/utf8.hpp"

namespace brume::cli {
namespace {

struct BenchOptions {
  std::vector<std::string> names;
  std::string json;
  bench::BenchOptions bench;
};

Json to_json(const bench::Report& report) {
  Json results = Json::list({});
  for (const bench::Measurement& m : report.results) {
    Json result{
        {"name", m.name},   {"median", m.median},          {"min", m.min}, {"max", m.max}, {"unit", m.unit},
        {"clock", m.clock}, {"repetitions", m.repetitions}};
    if (!m.details.empty()) {
      Json details = Json::object();
      for (const auto& [name, value] : m.details) details.set(name, value);
      result.set("details", details);
    }
    results.push_back(result);
  }
  return {{"device", report.device},   {"driver", report.driver}, {"processor", report.processor},
          {"threads", report.threads}, {"commit", report.commit}, {"results", results},
          {"skipped", report.skipped}};
}

void print_report(const bench::Report& report) {
  char line[200];
  for (const bench::Measurement& m : report.results) {
    std::snprintf(line, sizeof line, "%-24s median %10.4g  min %10.4g  max %10.4g %s (%s, %u repetitions)\n",
                  m.name.c_str(), m.median, m.min, m.max, m.unit.c_str(), m.clock.c_str(), m.repetitions);
    print(line);
  }
  for (const std::string& skipped : report.skipped) print("skipped: " + skipped + "\n");
}

std::string names() {
  std::string list;
  for (const std::string& name : bench::names()) list += (list.empty() ? "" : ", ") + name;
  return list;
}

void measure(const BenchOptions& options, Outputs& outputs) {
  outputs.writes("--json", to_path(options.json), FileKind::json);
  std::optional<Progress> job;
  const auto starting = [&](const std::string& name) {
    stop_if_interrupted();
    job.emplace(name);
  };
  const bench::Report report = bench::run(options.names, options.bench, starting).value_or_throw();
  job.reset();
  stop_if_interrupted();
  if (!options.json.empty()) write_json(options.json, to_json(report));
  if (options.json != "-") print_report(report);
}

}  // namespace

Command add_bench(CommandLine& program) {
  Command command = declare(program, "bench", "Measures the performance of the simulation and the renderer.",
                            "  brume bench\n"
                            "  brume bench fill/1800 march --json bench.json --repetitions 31");
  auto options = std::make_shared<BenchOptions>();
  const Arguments& arguments = command.arguments;
  arguments
      .add_option("NAME", options->names,
                  "Benchmarks to run, by name or leading part of it; default: all. They are " + names())
      .type_name("");
  declare_json(arguments, options->json, "the results");
  arguments
      .add_option("--repetitions", options->bench.repetitions,
                  "Samples per benchmark; default: chosen by each")
      .range(1u, 100'000u)
      .type_name("N");
  declare_device(arguments, options->bench.device);
  command.run = [options, common = command.common] { measure(*options, common->outputs); };
  return command;
}

}  // namespace brume::cli
