#include "base/task.h"

#include <doctest/doctest.h>

#include <string>

using focal::Task;

TEST_CASE("a task's progress runs over the stages and never falls") {
  Task task;
  CHECK(task.progress() == 0);
  CHECK(std::string(task.stage()).empty());
  task.begin_stage("spectrum", 0.0, 0.4);
  task.report(0.5);
  CHECK(task.progress() == doctest::Approx(0.2));
  task.report(0.25);  // a slower thread reports late
  CHECK(task.progress() == doctest::Approx(0.2));
  task.begin_stage("votes", 0.4, 1.0);
  CHECK(std::string(task.stage()) == "votes");
  CHECK(task.progress() == doctest::Approx(0.4));
  task.report(1);
  CHECK(task.progress() == doctest::Approx(1.0));
}

TEST_CASE("a cancelled task stays cancelled until it is reset") {
  Task task;
  CHECK_FALSE(task.cancelled());
  task.cancel();
  task.report(0.7);
  CHECK(task.cancelled());
  task.reset();
  CHECK_FALSE(task.cancelled());
  CHECK(task.progress() == 0);
}
