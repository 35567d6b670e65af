// Version, status names and the last error; and the proof that both sides of the border count alike.
#include "base/error.h"
#include "base/system.h"
#include "boundary.h"
#include "landmarks/detect.h"

using namespace focal;

namespace {

struct StatusName {
  focal_status value;
  Status inside;
  const char* name;
};

constexpr StatusName status_names[] = {
    {FOCAL_OK, Status::ok, "FOCAL_OK"},
    {FOCAL_ERROR_INVALID_ARGUMENT, Status::invalid_argument, "FOCAL_ERROR_INVALID_ARGUMENT"},
    {FOCAL_ERROR_INVALID_MESH, Status::invalid_mesh, "FOCAL_ERROR_INVALID_MESH"},
    {FOCAL_ERROR_INVALID_FILE, Status::invalid_file, "FOCAL_ERROR_INVALID_FILE"},
    {FOCAL_ERROR_IO, Status::io, "FOCAL_ERROR_IO"},
    {FOCAL_ERROR_OUT_OF_MEMORY, Status::out_of_memory, "FOCAL_ERROR_OUT_OF_MEMORY"},
    {FOCAL_ERROR_UNSUPPORTED, Status::unsupported, "FOCAL_ERROR_UNSUPPORTED"},
    {FOCAL_ERROR_NOT_CONVERGED, Status::not_converged, "FOCAL_ERROR_NOT_CONVERGED"},
    {FOCAL_ERROR_CANCELLED, Status::cancelled, "FOCAL_ERROR_CANCELLED"},
    {FOCAL_ERROR_INTERNAL, Status::internal, "FOCAL_ERROR_INTERNAL"},
    {FOCAL_ERROR_INVALID_HANDLE, Status::invalid_handle, "FOCAL_ERROR_INVALID_HANDLE"},
    {FOCAL_ERROR_MESH_TOO_SMALL, Status::mesh_too_small, "FOCAL_ERROR_MESH_TOO_SMALL"},
    {FOCAL_ERROR_FILE_NOT_FOUND, Status::file_not_found, "FOCAL_ERROR_FILE_NOT_FOUND"},
    {FOCAL_ERROR_UNSUPPORTED_VERSION, Status::unsupported_version, "FOCAL_ERROR_UNSUPPORTED_VERSION"},
    {FOCAL_ERROR_INVALID_LANDMARK, Status::invalid_landmark, "FOCAL_ERROR_INVALID_LANDMARK"},
    {FOCAL_ERROR_TOO_FEW_SHAPES, Status::too_few_shapes, "FOCAL_ERROR_TOO_FEW_SHAPES"},
};

constexpr bool statuses_agree() {
  for (const StatusName& status : status_names)
    if (status.value != static_cast<focal_status>(status.inside)) return false;
  return true;
}
static_assert(statuses_agree());
static_assert(static_cast<int>(Preset::default_preset) == FOCAL_PRESET_DEFAULT);
static_assert(static_cast<int>(Preset::paper) == FOCAL_PRESET_PAPER);
static_assert(static_cast<int>(Quality::best) == FOCAL_QUALITY_BEST);
static_assert(static_cast<int>(Quality::interactive) == FOCAL_QUALITY_INTERACTIVE);
static_assert(static_cast<int>(LandmarkStatus::found) == FOCAL_LANDMARK_FOUND);
static_assert(static_cast<int>(LandmarkStatus::uncertain) == FOCAL_LANDMARK_UNCERTAIN);
static_assert(static_cast<int>(LandmarkStatus::absent) == FOCAL_LANDMARK_ABSENT);

#define FOCAL_TEXT_OF(x) #x
#define FOCAL_TEXT(x) FOCAL_TEXT_OF(x)

}  // namespace

uint32_t focal_version(void) {
  return FOCAL_VERSION_MAJOR << 16 | FOCAL_VERSION_MINOR << 8 | FOCAL_VERSION_PATCH;
}

const char* focal_version_string(void) {
  return FOCAL_TEXT(FOCAL_VERSION_MAJOR) "." FOCAL_TEXT(FOCAL_VERSION_MINOR) "." FOCAL_TEXT(
      FOCAL_VERSION_PATCH);
}

const char* focal_status_name(focal_status status) {
  for (const StatusName& known : status_names)
    if (known.value == status) return known.name;
  return "FOCAL_ERROR_UNKNOWN";
}

const char* focal_last_error(void) { return last_error(); }

uint64_t focal_peak_memory_bytes(void) { return peak_memory_bytes(); }
