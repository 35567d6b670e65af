#include "handles.h"

#include <mutex>
#include <string>
#include <unordered_map>

#include "base/error.h"

namespace focal {
namespace {

struct Entry {
  HandleType type;
  std::shared_ptr<HandleBase> object;
};
using Entries = std::unordered_map<uintptr_t, Entry>;

// On 64-bit systems tags lie where no address of a program can, so a host's own pointer is never mistaken for
// one and a followed tag faults at once.
constexpr uintptr_t first_tag = sizeof(uintptr_t) == 8 ? static_cast<uintptr_t>(0xF0CA'0000'0000'0001u) : 1;

// Trivially destructible, so that a handle destroyed while the process ends is still answered.
std::mutex table_mutex;
constinit Entries* entries = nullptr;
constinit uintptr_t next_tag = first_tag;

// Gives the memory back when the library is unloaded.
struct TableCloser {
  ~TableCloser() {
    Entries* closing = nullptr;
    {
      const std::scoped_lock lock(table_mutex);
      std::swap(closing, entries);
    }
    delete closing;
  }
};
const TableCloser closer;

// In the order of HandleType.
constexpr const char* type_names[] = {
    "focal_context",   "focal_mesh",     "focal_training_set",   "focal_model", "focal_analysis",
    "focal_detection", "focal_skeleton", "focal_correspondence", "focal_task",  "focal_blob"};
const char* name_of(HandleType type) { return type_names[static_cast<size_t>(type)]; }

[[noreturn]] void refuse(uintptr_t tag, HandleType wanted, const Entry* found) {
  const std::string name = name_of(wanted);
  if (tag == 0)
    throw Error(Status::invalid_handle, "the " + name + " is NULL", "pass the handle that was created");
  if (found)
    throw Error(Status::invalid_handle, "a " + name + " is needed, this is a " + name_of(found->type),
                "check the order of the arguments");
  if (tag >= first_tag && tag < next_tag)
    throw Error(Status::invalid_handle, "the " + name + " has been destroyed",
                "keep the handle until the last call that uses it");
  throw Error(Status::invalid_handle, "this " + name + " was not made by this library",
              "pass a handle as focal returned it, not the address of the variable that holds it");
}

}  // namespace

const void* insert_handle(HandleType type, std::shared_ptr<HandleBase> object) {
  const std::scoped_lock lock(table_mutex);
  if (!entries) entries = new Entries;
  entries->emplace(next_tag, Entry{type, std::move(object)});
  return reinterpret_cast<const void*>(next_tag++);
}

std::shared_ptr<HandleBase> find_handle(const void* handle, HandleType type) {
  const auto tag = reinterpret_cast<uintptr_t>(handle);
  const std::scoped_lock lock(table_mutex);
  const auto at = entries ? entries->find(tag) : Entries::iterator{};
  const Entry* const found = entries && at != entries->end() ? &at->second : nullptr;
  if (!found || found->type != type) refuse(tag, type, found);
  return found->object;
}

focal_status remove_handle(const void* handle, HandleType type) noexcept {
  if (!handle) return FOCAL_OK;
  std::shared_ptr<HandleBase> last;  // freed after the lock is given back
  const std::scoped_lock lock(table_mutex);
  if (!entries) return FOCAL_ERROR_INVALID_HANDLE;
  const auto at = entries->find(reinterpret_cast<uintptr_t>(handle));
  if (at == entries->end() || at->second.type != type) return FOCAL_ERROR_INVALID_HANDLE;
  last = std::move(at->second.object);
  entries->erase(at);
  return FOCAL_OK;
}

}  // namespace focal
