#include "apps/cli/units.hpp"

#include <algorithm>
#include <charconv>
#include <iterator>
#include <map>
#include <set>
#include <sstream>
#include <string_view>

#include "apps/command_line/console.hpp"
#include "apps/command_line/targets.hpp"
#include "apps/command_line/unit_key.hpp"
#include "core/error.hpp"
#include "core/file.hpp"
#include "core/log.hpp"
#include "core/numbered_files.hpp"
#include "core/progress.hpp"
#include "core/utf8.hpp"

namespace brume::cli {
namespace {

namespace fs = std::filesystem;

constexpr const char* kKeyMagic = "BRUMEKEY 1";

// Hidden: engines that import a folder skip it.
fs::path key_path(const std::string& output) {
  const fs::path path = to_path(output);
  return path.parent_path() / to_path("." + path.filename().string() + ".key");
}

// "input HEX PATH" or "output HEX NAME".
std::string line_of(const char* kind, const fs::path& file, const std::string& name) {
  return std::string(kind) + " " + hash_of_files({file}) + " " + name + "\n";
}

void save_key(const Unit& unit, const UnitKey& key, const Outputs& outputs) {
  std::string text = std::string(kKeyMagic) + "\n" + to_text(key, *unit.number) + "\n";
  for (const fs::path& file : outputs.files_read()) text += line_of("input", file, file.string());
  for (const fs::path& file : outputs.files_written())
    if (file != key_path(unit.output)) text += line_of("output", file, file.filename().string());
  write_file_atomic(key_path(unit.output), text).value_or_throw();
}

// Why a file is not the one of a line of the key; empty: it is.
std::string fault_of(const std::string& line, const fs::path& folder) {
  std::istringstream words(line);
  std::string kind, hash, name;
  words >> kind >> hash >> std::ws;
  std::getline(words, name);
  const bool is_output = kind == "output";
  const fs::path file = is_output ? folder / to_path(name) : to_path(name);
  std::error_code ignored;
  if (!fs::is_regular_file(file, ignored)) return is_output ? "missing" : "of other inputs";
  if (hash_of_files({file}) == hash) return "";
  return is_output ? "damaged" : "of other inputs";
}

// Why a unit is to be made again; empty: it is complete.
std::string reason_of(const Unit& unit, const UnitKey& key) {
  std::error_code ignored;
  if (!fs::exists(to_path(unit.output), ignored)) return "missing";
  const auto text = read_text_file(key_path(unit.output));
  if (!text) return "without a key";
  std::istringstream lines(*text);
  std::string line;
  if (!std::getline(lines, line) || line != kKeyMagic || !std::getline(lines, line)) return "without a key";
  if (const std::string fault = difference(line, key, *unit.number); !fault.empty()) return fault;
  std::size_t outputs = 0;
  while (std::getline(lines, line)) {
    if (const std::string fault = fault_of(line, to_path(unit.output).parent_path()); !fault.empty())
      return fault;
    if (line.starts_with("output ")) ++outputs;
  }
  return outputs > 0 ? "" : "without a key";
}

// The files of the input by their numbers.
using Inputs = std::map<std::int64_t, fs::path>;
Inputs inputs_of(const UnitJob& job) {
  if (job.input.empty()) return {};
  if (!numbered_name(to_path(job.input).filename().string()))
    throw Error(ErrorCode::usage, job.output_option + " " + job.output +
                                      ": has a number; INPUT requires one, too, such as f_%04d" +
                                      to_path(job.input).extension().string());
  Inputs files = numbered_files(to_path(job.input));
  // Frames go as far.
  std::erase_if(files, [](const auto& one) { return one.first < 0 || one.first > 1'000'000; });
  if (files.empty()) throw Error(ErrorCode::bad_input, job.input + ": no such files");
  return files;
}

fs::path input_of(const UnitJob& job, const Inputs& inputs, std::uint32_t number) {
  const auto after = inputs.upper_bound(number);
  if (after != inputs.begin() && (job.holds_missing || std::prev(after)->first == number))
    return std::prev(after)->second;
  if (job.holds_missing) return after->second;
  const fs::path pattern = to_path(job.input);
  return pattern.parent_path() / to_path(numbered_name(pattern.filename().string())->with(number));
}

Unit unit_of(const UnitJob& job, const Inputs& inputs, std::uint32_t number) {
  Unit unit{number, {}, sequence_name(to_path(job.output), number).string()};
  if (!job.input.empty()) unit.input = input_of(job, inputs, number).string();
  return unit;
}

// What a command line says about every unit. The names of files count by their suffixes and, as descriptions
// name what lies beside them, the output's by its last part.
UnitKey key_of(const Arguments& arguments, const UnitJob& job) {
  std::vector<std::string> settings = arguments.given_texts(
      {"--frames", "--shard", "--resume", "--threads", "--force", "--progress", "--quiet", "--output"});
  settings.push_back(to_path(job.output).filename().string());
  settings.push_back(to_path(job.input).extension().string());
  settings.insert(settings.end(), job.depends_on.begin(), job.depends_on.end());
  UnitKey key{"", hash_of_texts(settings), "", program_hash()};
  if (!job.device.empty()) key.device = hash_of_texts(job.device);
  return key;
}

void refuse_of_one(const Arguments& arguments, const UnitJob& job) {
  const fs::path input = to_path(job.input), output = to_path(job.output);
  std::error_code ignored;
  if (numbered_name(input.filename().string()) && !fs::exists(input, ignored))
    throw Error(ErrorCode::usage, job.output_option + " " + job.output +
                                      ": requires a number, as INPUT has one, such as " +
                                      output.stem().string() + "_%04d" + output.extension().string());
  for (const char* option : {"--frames", "--shard", "--resume"})
    arguments.refuse(option, "requires a number in " + job.output_option + ", such as f_%04d" +
                                 to_path(job.output).extension().string());
}

// The units of the command line. Throws Error (usage).
std::optional<FrameRange> units_of(const Arguments& arguments, const UnitOptions& options, const UnitJob& job,
                                   const Inputs& inputs) {
  arguments.refuse("--json", "is for a single output");
  if (options.frames.empty() && inputs.empty())
    throw Error(ErrorCode::usage,
                job.output_option + " " + job.output + ": requires --frames, such as --frames 0-119");
  const FrameRange range = options.frames.empty()
                               ? FrameRange{static_cast<std::uint32_t>(inputs.begin()->first),
                                            static_cast<std::uint32_t>(inputs.rbegin()->first)}
                               : parse_frames("--frames", options.frames);
  return options.shard.empty() ? range : part_of(range, parse_shard("--shard", options.shard));
}

// Declares all units at once: the outputs of one must not be the inputs of another, and no work is done
// before all of them can be written.
void declare_files(const UnitJob& job, const Inputs& inputs, FrameRange range, Outputs& outputs) {
  if (!job.input.empty())
    for (std::uint32_t i = range.first; i <= range.last; ++i) outputs.reads(input_of(job, inputs, i));
  const std::string option = job.output_option == "OUTPUT" ? "" : job.output_option;
  outputs.writes_frames(option, to_path(job.output), job.kind, range.first, range.last);
  for (std::uint32_t i = range.first; i <= range.last; ++i) {
    const std::string output = sequence_name(to_path(job.output), i).string();
    outputs.will_write("", key_path(output), FileKind::unit_key);
    for (const auto& [suffix, kind] : job.beside)
      outputs.will_write("", to_path(output).replace_extension(to_path(suffix)), kind);
    stop_if_interrupted();
  }
  outputs.set_frames_depend(true);
}

// The numbers of a range that are no units.
std::set<std::uint32_t> skipped_numbers(const UnitOptions& options, const UnitJob& job, const Inputs& inputs,
                                        FrameRange range) {
  std::set<std::uint32_t> skipped;
  if (!job.skips_missing || !options.frames.empty()) return skipped;
  for (std::uint32_t i = range.first; i <= range.last; ++i)
    if (!inputs.contains(i)) skipped.insert(i);
  if (!skipped.empty())
    log_warning(job.input + ": " + std::to_string(skipped.size()) + " of the numbers " +
                std::to_string(range.first) + "-" + std::to_string(range.last) +
                (skipped.size() == 1 ? " has no file and is skipped" : " have no file and are skipped"));
  return skipped;
}

// Only digits.
std::optional<std::uint32_t> whole_number(std::string_view text) {
  std::uint32_t value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return value;
}

}  // namespace

Shard parse_shard(const std::string& option, const std::string& text) {
  constexpr std::uint32_t kMost = 1'000'000;
  const std::size_t slash = text.find('/');
  if (slash != std::string::npos) {
    const auto number = whole_number(std::string_view(text).substr(0, slash));
    const auto count = whole_number(std::string_view(text).substr(slash + 1));
    if (number && count && *number >= 1 && *number <= *count && *count <= kMost) return {*number, *count};
  }
  throw Error(ErrorCode::usage,
              option + " '" + text + "': expected PART/PARTS, from 1/" + "N to N/N, such as 3/16");
}

std::optional<FrameRange> part_of(FrameRange range, Shard shard) {
  const std::uint64_t units = std::uint64_t{range.last} - range.first + 1;
  const std::uint64_t begin = units * (shard.number - 1) / shard.count;
  const std::uint64_t end = units * shard.number / shard.count;
  if (begin == end) return std::nullopt;
  return FrameRange{static_cast<std::uint32_t>(range.first + begin),
                    static_cast<std::uint32_t>(range.first + end - 1)};
}

void declare_shard(const Arguments& arguments, std::string& shard) {
  arguments
      .add_option("--shard", shard,
                  "Only part I of N, such as 3/16; N commands with all parts, on as many machines, make the "
                  "same files as one without this option")
      .type_name("I/N");
}

void declare_units(const Arguments& arguments, UnitOptions& options, const std::string& numbered) {
  arguments.add_option("--frames", options.frames, "First and last number of " + numbered)
      .take_last()
      .type_name("A-B");
  declare_shard(arguments, options.shard);
  arguments.add_flag("--resume", options.resume,
                     "Skip numbers whose files are complete and made from the same inputs");
}

void run_units(const Arguments& arguments, const UnitOptions& options, CommonOptions& common,
               const UnitJob& job, const RunUnit& run) {
  if (!is_numbered(job.output_option, to_path(job.output))) {
    refuse_of_one(arguments, job);
    return run({{}, job.input, plain_name(to_path(job.output)).string()}, common.outputs);
  }
  const Inputs inputs = inputs_of(job);
  const auto part = units_of(arguments, options, job, inputs);
  if (!part) return;
  declare_files(job, inputs, *part, common.outputs);

  // What is there already.
  const UnitKey key = key_of(arguments, job);
  const std::set<std::uint32_t> skipped = skipped_numbers(options, job, inputs, *part);
  std::vector<std::string> reasons(std::size_t{part->last} - part->first + 1, "to do");
  for (std::size_t i = 0; i < reasons.size(); ++i) {
    const auto number = static_cast<std::uint32_t>(part->first + i);
    stop_if_interrupted();
    const bool is_skipped = skipped.contains(number);
    if (is_skipped) common.outputs.frame_skipped(number);
    if (is_skipped || options.resume)
      reasons[i] = is_skipped ? "" : reason_of(unit_of(job, inputs, number), key);
    if (reasons[i].empty() && !is_skipped) common.outputs.frame_done(number);
  }
  if (options.resume) print_reasons(part->first, reasons);

  // The rest. A key is written last: a unit that was interrupted has none, or one that is not its own.
  Progress progress("frames", reasons.size() - static_cast<std::size_t>(std::ranges::count(reasons, "")));
  for (std::size_t i = 0; i < reasons.size(); ++i) {
    if (reasons[i].empty()) continue;
    stop_if_interrupted();
    const Unit unit = unit_of(job, inputs, static_cast<std::uint32_t>(part->first + i));
    const auto outputs = std::make_shared<Outputs>();
    outputs->set_force(common.force);
    common.outputs.begin_unit(outputs);
    outputs->writes("", key_path(unit.output), FileKind::unit_key);
    run(unit, *outputs);
    save_key(unit, key, *outputs);
    common.outputs.frame_done(*unit.number);
    progress.advance();
  }
}

}  // namespace brume::cli
