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

// Each tag is given out once in the life of the process, so a stale one can never name a newer object.
const void* insert_handle(HandleType type, std::shared_ptr<void> object);

// Throws invalid_handle: NULL, stale, of another type, or not from here at all.
std::shared_ptr<void> find_handle(const void* tag, HandleType type);

// The object is freed here, or by the last call or result that still uses it. NULL is fine.
focal_status remove_handle(const void* tag, HandleType type) noexcept;

// An Object says which handle stands for it: `using Handle = focal_mesh;` and
// `static constexpr HandleType type = HandleType::mesh;`.
template <class Object>
typename Object::Handle* publish(std::shared_ptr<Object> object) {
  const void* tag = insert_handle(Object::type, std::move(object));
  return static_cast<typename Object::Handle*>(const_cast<void*>(tag));
}

// Of the context behind an object; null where the object knows of none.
template <class Object>
std::shared_ptr<const MemoryBudget> memory_budget_of(const Object& object) {
  if constexpr (requires { object.memory_budget; }) {
    return object.memory_budget;
  } else if constexpr (requires { object.context->memory_budget; }) {
    return object.context->memory_budget;
  } else if constexpr (requires { object.model->context; }) {
    return memory_budget_of(*object.model);
  } else if constexpr (requires { object.detection->model; }) {
    return memory_budget_of(*object.detection);
  } else if constexpr (requires { object.mesh->memory_budget; }) {
    return object.mesh->memory_budget;
  } else if constexpr (requires { object.from->memory_budget; }) {
    return object.from->memory_budget;
  } else {
    return nullptr;
  }
}

// Shared ownership for the time of the call: another thread may destroy the handle meanwhile. From here on the call
// keeps to the memory budget of the object's context.
template <class Object>
std::shared_ptr<Object> resolve(const typename Object::Handle* handle) {
  auto object = std::static_pointer_cast<Object>(find_handle(handle, Object::type));
  ScopedMemoryBudget::adopt(memory_budget_of(*object));
  return object;
}

}  // namespace focal
