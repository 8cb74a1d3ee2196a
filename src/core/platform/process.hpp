// This process.
#pragma once

#include <filesystem>
#include <string>

namespace brume::platform {

int process_id();
/// Whether a process with this number exists.
bool is_running(int process);
/// The file of this program; empty where the system does not say.
std::filesystem::path program_file();
/// Where the bytes of this program are read, on Linux also after its file was replaced.
std::filesystem::path program_image();
/// The file that a program is called: with ".exe" on Windows.
std::string program_name(const std::string& name);
/// A variable of the environment in UTF-8; empty if it is not set.
std::string environment(const char* name);

}  // namespace brume::platform
