// The terminal that the command runs in.
#pragma once
#include <atomic>

namespace focal_cli {

// Whether stderr is a terminal that understands the control sequences of `Progress`.
bool draws_on_terminal();

// Sets `interrupted` at the first Ctrl-C (or SIGTERM); the second one ends the process.
void catch_interrupts(std::atomic<bool>& interrupted);

}  // namespace focal_cli
