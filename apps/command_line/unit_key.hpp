// What a unit of many is made from: a frame of a sequence, one of many files to convert or to bake. Its
// output carries it as a text.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace brume::cli {

/// Hashes of all that a unit depends on, by cause. An empty one does not apply.
struct UnitKey {
  std::string inputs;    ///< Contents of all files.
  std::string settings;  ///< Options that change the output.
  std::string device;    ///< What computes it.
  std::string program;   ///< program_hash().
};

/// "12 inputs:HEX settings:HEX device:HEX program:HEX".
std::string to_text(const UnitKey& key, std::uint32_t unit);

/// How the text that an output carries differs from the text of this unit: "of other settings"; empty: not
/// at all.
std::string difference(const std::string& text, const UnitKey& key, std::uint32_t unit);

/// The hash of the contents of all files, in this order; empty names count as empty files. Throws Error and
/// Interrupted.
std::string hash_of_files(const std::vector<std::filesystem::path>& files);
std::string hash_of_texts(const std::vector<std::string>& texts);
/// A number as a text that no other number has.
std::string exact_text(double number);
/// The hash of the program with all that is embedded in it, such as its shaders, and of its helper brume-vdb.
/// Throws as hash_of_files.
std::string program_hash();

/// Prints which units are made again, and why, to standard error: a line for all neighbours of one reason.
/// An empty reason is of a unit that stays.
void print_reasons(std::uint32_t first, const std::vector<std::string>& reasons);

}  // namespace brume::cli
