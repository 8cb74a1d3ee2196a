// The console that a program is started from, and the signals that stop it.
#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <thread>
#include <vector>

namespace brume::platform {

/// The words of the command line in UTF-8.
std::vector<std::string> command_line(int count, char** words);

/// The standard descriptors.
inline constexpr int kInput = 0, kOutput = 1, kErrors = 2;

bool is_terminal(int descriptor);
/// Characters of a line of the terminal that a descriptor leads to; 0 where it leads to none.
std::size_t terminal_columns(int descriptor);
/// Whether a terminal shows colours that escape sequences choose, as far as the environment says.
bool shows_escape_sequences(int descriptor);

/// Opens the standard descriptors that the caller closed, without access: otherwise the next file that is
/// opened would get what is printed. On Windows, text is UTF-8, and its line breaks stay as they are.
void prepare_standard_descriptors();

/// The first SIGINT, SIGTERM, SIGHUP (unless the caller ignores it, as nohup does) or SIGXCPU calls
/// `on_signal`, the second ends the process. A file that reaches the size limit fails to be written
/// (SIGXFSZ is ignored). Windows has SIGINT for Ctrl-C, SIGBREAK for Ctrl-Break, and SIGTERM.
void catch_stops(void (*on_signal)(int));

/// A thread that no signal interrupts.
std::thread start_without_signals(std::function<void()> run);

}  // namespace brume::platform
