#include "terminal.h"

#include <signal.h>
#include <unistd.h>

namespace focal_cli {
namespace {

std::atomic<bool>* flag = nullptr;
static_assert(std::atomic<bool>::is_always_lock_free);  // a signal handler may touch nothing else

}  // namespace

bool draws_on_terminal() { return ::isatty(STDERR_FILENO) != 0; }

void catch_interrupts(std::atomic<bool>& interrupted) {
  flag = &interrupted;
  struct sigaction action = {};
  action.sa_handler = [](int) { *flag = true; };
  action.sa_flags = static_cast<int>(SA_RESETHAND);
  sigaction(SIGINT, &action, nullptr);
  sigaction(SIGTERM, &action, nullptr);
}

}  // namespace focal_cli
