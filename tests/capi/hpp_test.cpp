// focal.hpp owns, moves and throws as it says.
#include <focal/focal.hpp>
#include <utility>

extern "C" {
#include "shapes.h"
}
#include "check.h"

namespace {

void check_errors() {
  const focal::Context context;
  try {
    const focal::Mesh mesh(context, "no/such/file.glb");
    CHECK(false);
  } catch (const focal::Error& error) {
    CHECK(error.status() == FOCAL_ERROR_FILE_NOT_FOUND);
    CHECK(std::string(error.what()).find("hint: ") != std::string::npos);
  }
}

void check_ownership() {
  focal::Task task;
  focal_task* handle = task.get();
  focal::Task moved(std::move(task));
  CHECK(!task && moved.get() == handle);
  task = std::move(moved);
  CHECK(task.get() == handle);
  task.cancel();
  CHECK(task.is_cancelled());
  { const focal::Task last(std::move(task)); }
  CHECK(focal_task_cancel(handle) == FOCAL_ERROR_INVALID_HANDLE);
}

void check_mesh() {
  const focal::Context context;
  shape body = shape_create(8, 0);
  const focal::Mesh mesh(context, shape_desc(&body));
  CHECK(mesh.info().vertex_count == body.vertex_count);
  CHECK(mesh.warnings().size() == mesh.info().warning_count);
  const focal::TrainingSet set(context, {"nose", "tail"});
  CHECK(focal_training_set_landmark_count(set.get()) == 2);
  shape_destroy(&body);
}

}  // namespace

int main() {
  check_errors();
  check_ownership();
  check_mesh();
  FINISH();
}
