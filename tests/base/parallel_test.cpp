#include "base/parallel.h"

#include <doctest/doctest.h>

#include <atomic>
#include <chrono>
#include <cmath>
#include <mutex>
#include <set>
#include <thread>
#include <vector>

#include "base/error.h"
#include "base/random.h"

using focal::Execution;

namespace {

Execution on(int threads) {
  Execution execution;
  execution.thread_count = threads;
  return execution;
}

std::vector<double> work(const Execution& execution) {
  std::vector<double> result(500);
  focal::parallel_for(execution, 500, [&](int64_t i) {
    focal::Random random(11, static_cast<uint64_t>(i));
    for (int k = 0; k < 50; ++k) result[i] += std::sin(random.normal()) / (k + 1);
  });
  return result;
}

}  // namespace

TEST_CASE("1, 2 and 8 threads and the host's loop give the same bits") {
  const auto one = work(on(1));
  CHECK(work(on(2)) == one);
  CHECK(work(on(8)) == one);
  Execution hosted;
  hosted.host_parallel_for = [](int64_t count, const std::function<void(int64_t)>& body) {
    for (int64_t i = count; i-- > 0;) body(i);  // any order is allowed
  };
  CHECK(work(hosted) == one);
}

TEST_CASE("every index is visited once and ranges cover the whole") {
  for (const int threads : {1, 2, 8}) {
    std::vector<std::atomic<int>> visits(1003);
    focal::parallel_for(on(threads), 1003, [&](int64_t i) { ++visits[i]; });
    std::vector<std::atomic<int>> covered(1003);
    std::atomic<bool> too_long{false};
    focal::parallel_for_ranges(on(threads), 1003, 100, [&](int64_t begin, int64_t end) {
      if (end - begin > 100) too_long = true;
      for (int64_t i = begin; i < end; ++i) ++covered[i];
    });
    CHECK_FALSE(too_long);
    for (int i = 0; i < 1003; ++i) REQUIRE((visits[i] == 1 && covered[i] == 1));
  }
  focal::parallel_for(on(4), 0, [](int64_t) { FAIL("nothing to do"); });
}

TEST_CASE("asked for several threads it uses several") {
  std::mutex mutex;
  std::set<std::thread::id> threads;
  focal::parallel_for(on(4), 4, [&](int64_t) {
    const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(20);
    for (;;) {  // each body waits for the others: only as many threads as bodies can finish
      {
        const std::scoped_lock lock(mutex);
        threads.insert(std::this_thread::get_id());
        if (threads.size() == 4) return;
      }
      if (std::chrono::steady_clock::now() > deadline) return;
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
  });
  CHECK(threads.size() == 4);
}

TEST_CASE("a body's exception comes out as itself and ends the loop early") {
  for (const int threads : {1, 3}) {
    std::atomic<int> visited{0};
    const auto throwing = [&](int64_t i) {
      ++visited;
      if (i == 5) throw focal::Error(focal::Status::invalid_mesh, "five", "not five");
    };
    try {
      focal::parallel_for(on(threads), 1'000'000, throwing);
      FAIL("the exception was lost");
    } catch (const focal::Error& error) {
      CHECK(error.status() == focal::Status::invalid_mesh);
      CHECK(error.hint() == "not five");
    }
    CHECK(visited < 1'000'000);
  }
}

TEST_CASE("an exception does not pass through the host's loop, which may be C") {
  Execution hosted;
  bool returned = false;
  hosted.host_parallel_for = [&](int64_t count, const std::function<void(int64_t)>& body) {
    for (int64_t i = 0; i < count; ++i) body(i);
    returned = true;
  };
  CHECK_THROWS_AS(focal::parallel_for(hosted, 10, [](int64_t) { throw std::bad_alloc(); }), std::bad_alloc);
  CHECK(returned);
}

TEST_CASE("cancelling a task stops the loop with status cancelled") {
  for (const int threads : {1, 2}) {
    focal::Task task;
    Execution execution = on(threads);
    execution.task = &task;
    std::atomic<int> visited{0};
    try {
      focal::parallel_for(execution, 1'000'000, [&](int64_t) {
        if (++visited == 10) task.cancel();
      });
      FAIL("not cancelled");
    } catch (const focal::Error& error) {
      CHECK(error.status() == focal::Status::cancelled);
    }
    CHECK(visited < 100);
  }
}
