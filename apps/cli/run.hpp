// The whole program as a function.
#pragma once

namespace brume::cli {

/// Runs a command line, whose first word is the name of the program, and returns the exit code. Prints to the
/// standard descriptors of the process. May be called again, one call at a time: each starts afresh, and
/// handles signals only while it runs. Only where a signal does not end the command in time, it ends the
/// process (Attendant).
int run(int argc, const char* const* argv);

}  // namespace brume::cli
