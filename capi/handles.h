// The table behind every handle: what the host holds is a tag that is looked up, never a followed address.
#pragma once
#include <cstdint>
#include <memory>

#include "base/memory_budget.h"
#include "focal/focal.h"

namespace focal {

enum class HandleType : int32_t {
  context,
  mesh,
  training_set,
  model,
  analysis,
  detection,
  skeleton,
  correspondence,
  task,
  blob
};

// What all objects behind handles have in common.
struct HandleBase {
  std::shared_ptr<const MemoryBudget> memory_budget;  // of the object's context; null: none
};
template <class H, HandleType t>
struct HandleObject : HandleBase {
  using Handle = H;
  static constexpr HandleType type = t;
};

// Each tag is given out once in the life of the process, so a stale one can never name a newer object.
const void* insert_handle(HandleType type, std::shared_ptr<HandleBase> object);

// Throws invalid_handle: NULL, stale, of another type, or not from here at all.
std::shared_ptr<HandleBase> find_handle(const void* tag, HandleType type);

// The object is freed here, or by the last call or result that still uses it. NULL is fine.
focal_status remove_handle(const void* tag, HandleType type) noexcept;

template <class Object>
typename Object::Handle* publish(std::shared_ptr<Object> object) {
  const void* tag = insert_handle(Object::type, std::move(object));
  return static_cast<typename Object::Handle*>(const_cast<void*>(tag));
}
// owner: whose memory budget the object keeps to.
template <class Object>
typename Object::Handle* publish(std::shared_ptr<Object> object, const HandleBase& owner) {
  object->memory_budget = owner.memory_budget;
  return publish(std::move(object));
}

// Shared ownership for the time of the call: another thread may destroy the handle meanwhile. From here on the call
// keeps to the memory budget of the object's context.
template <class Object>
std::shared_ptr<Object> resolve(const typename Object::Handle* handle) {
  auto object = std::static_pointer_cast<Object>(find_handle(handle, Object::type));
  ScopedMemoryBudget::adopt(object->memory_budget);
  return object;
}

}  // namespace focal
