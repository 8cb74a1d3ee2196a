// Commands on many numbered files, each of which is a unit of work: --frames, --shard and --resume.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "apps/cli/command.hpp"
#include "apps/command_line/parse.hpp"

namespace brume::cli {

/// Part `number` of `count`, from 1.
struct Shard {
  std::uint32_t number = 1, count = 1;
};
/// "3/16". Throws Error (usage).
Shard parse_shard(const std::string& option, const std::string& text);
/// The units of a shard, which are neighbours: the shards of a range are disjoint, cover it, and differ by at
/// most one unit. Nothing where there are fewer units than shards.
std::optional<FrameRange> part_of(FrameRange range, Shard shard);

void declare_shard(const Arguments& arguments, std::string& shard);

struct UnitOptions {
  std::string frames, shard;
  bool resume = false;
};
/// Declares --frames, --shard and --resume. `numbered` is what requires them: "a numbered OUTPUT, such as
/// smoke_%04d.brv".
void declare_units(const Arguments& arguments, UnitOptions& options, const std::string& numbered);

/// A file that a unit writes beside its output: of the same name but for the suffix.
struct FileBeside {
  std::string suffix;  ///< ".raw"
  FileKind kind = FileKind::json;
};
/// What a command does many times.
struct UnitJob {
  std::string input;          ///< As core/numbered_files.hpp says if the output has a number; empty: none.
  std::string output_option;  ///< "-o", or "OUTPUT" for an argument.
  std::string output;
  FileKind kind = FileKind::json;        ///< Kind of the output.
  std::vector<std::string> device = {};  ///< Names of what computes it.
  std::vector<FileBeside> beside = {};
  bool holds_missing = false;  ///< A missing input is replaced by the one before it, or by the first.
  bool skips_missing = false;  ///< Without --frames, numbers without an input are skipped, with a warning.
  std::vector<std::string> depends_on = {};  ///< What else each output was made from.
};
struct Unit {
  std::optional<std::uint32_t> number;  ///< Nothing: it is the only one.
  std::string input, output;
};
using RunUnit = std::function<void(const Unit&, Outputs&)>;

/// Runs the command once where the output has no number, otherwise for each number of the shard; without
/// --frames from the first file of the input to the last. The hidden file ".OUTPUT.key" beside each output
/// says what it was made from (UnitKey, the names and hashes of the files read and written). With --resume
/// outputs stay whose key, inputs and contents are right, and the reasons for the others are printed. All
/// files of all units are checked before the first unit. Throws Error, what `run` throws, and Interrupted.
void run_units(const Arguments& arguments, const UnitOptions& options, CommonOptions& common,
               const UnitJob& job, const RunUnit& run);

}  // namespace brume::cli
