#include <windows.h>

#include "terminal.h"

namespace focal_cli {
namespace {

std::atomic<bool>* flag = nullptr;

// Runs on a thread of its own. FALSE passes the event on, and the default handler ends the process.
BOOL WINAPI on_event(DWORD event) {
  if (event != CTRL_C_EVENT && event != CTRL_BREAK_EVENT) return FALSE;
  return flag->exchange(true) ? FALSE : TRUE;
}

}  // namespace

bool draws_on_terminal() {
  const HANDLE error = ::GetStdHandle(STD_ERROR_HANDLE);
  DWORD mode = 0;
  return ::GetConsoleMode(error, &mode) &&
         ::SetConsoleMode(error, mode | ENABLE_PROCESSED_OUTPUT | ENABLE_VIRTUAL_TERMINAL_PROCESSING);
}

void catch_interrupts(std::atomic<bool>& interrupted) {
  flag = &interrupted;
  ::SetConsoleCtrlHandler(on_event, TRUE);
}

}  // namespace focal_cli
