// Progress of long calls on a terminal, and Ctrl-C as a clean cancel.
#include "progress.h"

#include <atomic>
#include <cmath>
#include <cstdio>

#include "command_error.h"
#include "terminal.h"

namespace focal_cli {
namespace {

constexpr std::chrono::milliseconds poll_seconds(20);  // how late a Ctrl-C may reach the task
constexpr int polls_per_draw = 5;
constexpr double enough_to_extrapolate = 0.02;

std::atomic<bool> interrupted{false};

std::string clock_text(double seconds) {
  const long whole = std::lround(seconds);
  char text[32];
  std::snprintf(text, sizeof text, "%ld:%02ld", whole / 60, whole % 60);
  return text;
}

}  // namespace

Progress::Progress(bool quiet) : draws_(!quiet && draws_on_terminal()) {
  catch_interrupts(interrupted);
  watcher_ = std::thread([this] { watch(); });
}

Progress::~Progress() {
  {
    const std::lock_guard lock(mutex_);
    done_ = true;
  }
  wake_.notify_one();
  watcher_.join();
  clear();
}

focal_task* Progress::begin(const std::string& what, size_t index, size_t count) {
  if (interrupted) throw CommandError("cancelled", "what was not finished was not written");
  Task task = owned<Task>(focal_task_create);
  const std::lock_guard lock(mutex_);
  task_ = std::move(task);
  what_ = what, index_ = index, count_ = count;
  return task_.get();
}

void Progress::watch() {
  std::unique_lock lock(mutex_);
  for (int polls = 0; !wake_.wait_for(lock, poll_seconds, [this] { return done_; }); ++polls) {
    if (interrupted && task_) focal_task_cancel(task_.get());
    if (draws_ && task_ && polls % polls_per_draw == 0) draw();
  }
}

void Progress::draw() {
  const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - start_;
  const double part = focal_task_progress(task_.get());
  const double fraction = (static_cast<double>(index_) + part) / static_cast<double>(count_);
  std::string line = what_;
  if (count_ > 1) line += " (" + std::to_string(index_ + 1) + " of " + std::to_string(count_) + ")";
  line += std::string(" - ") + focal_task_stage(task_.get());
  char percentage[16];
  std::snprintf(percentage, sizeof percentage, "%3.0f %%  ", 100 * fraction);
  if (fraction > enough_to_extrapolate) {
    line += "  " + clock_text(elapsed.count() * (1 - fraction) / fraction) + " left";
  }
  std::fprintf(stderr, "\r\x1b[K%s%s", percentage, line.substr(0, 90).c_str());
  std::fflush(stderr);
  drawn_ = true;
}

void Progress::clear() {
  const std::lock_guard lock(mutex_);
  if (drawn_) std::fputs("\r\x1b[K", stderr);
  drawn_ = false;
}

}  // namespace focal_cli
