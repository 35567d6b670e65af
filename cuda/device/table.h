// The table of a module, made of a Queue. It also offers:
//   static int32_t open(int32_t index, char* name, int32_t name_size);   throws DeviceFailure; returns the device's number
//   struct Scope { explicit Scope(int32_t device); };     while it lives, the calling thread works on that device
//   explicit Queue(int32_t device);
#pragma once
#include <cstring>
#include <exception>
#include <memory>
#include <mutex>
#include <new>
#include <vector>

#include "compute/backend.h"
#include "device/maps.h"
#include "device/spectrum.h"
#include "device/surface.h"
#include "device/votes.h"

namespace focal {

// A device with the queues that nobody uses just now: to make one takes longer than a detection.
template <class Queue>
class Device {
 public:
  explicit Device(int32_t number) : number_(number) {}
  int32_t number() const { return number_; }
  std::unique_ptr<Queue> take_queue() {
    {
      const std::scoped_lock lock(mutex_);
      if (!idle_.empty()) {
        auto queue = std::move(idle_.back());
        idle_.pop_back();
        return queue;
      }
    }
    return std::make_unique<Queue>(number_);
  }
  void give_back(std::unique_ptr<Queue> queue) {
    const std::scoped_lock lock(mutex_);
    idle_.push_back(std::move(queue));
  }

 private:
  int32_t number_;
  std::mutex mutex_;
  std::vector<std::unique_ptr<Queue>> idle_;
};

// A value on a device with the queue that it was made by.
template <class Queue, class Value>
class OnDevice {
 public:
  template <class From>
  OnDevice(Device<Queue>& device, const From& from) : device_(device), queue_(device.take_queue()) {
    value_ = std::make_unique<Value>(*queue_, from);
  }
  ~OnDevice() {
    value_.reset();
    if (queue_->works()) device_.give_back(std::move(queue_));
  }
  Device<Queue>& device() { return device_; }
  Value& value() { return *value_; }

 private:
  Device<Queue>& device_;
  std::unique_ptr<Queue> queue_;
  std::unique_ptr<Value> value_;
};

template <class Queue>
class TableOf {
 public:
  static const ComputeTable* table() {
    static const ComputeTable all{sizeof(ComputeTable),
                                  compute_version,
                                  device_open,
                                  device_close,
                                  surface_create,
                                  surface_destroy,
                                  spectrum_of,
                                  signatures_of,
                                  distances_of,
                                  forest_create,
                                  forest_destroy,
                                  votes_of,
                                  peaks_of,
                                  isoline_votes_of,
                                  zoom_out_of,
                                  stages_of};
    return &all;
  }

 private:
  using Surface = OnDevice<Queue, DeviceSurface<Queue>>;
  using Forest = OnDevice<Queue, DeviceForest<Queue>>;

  // No exception crosses the table.
  template <class Work>
  static int32_t guarded(ComputeFailure* failure, const Work& work) noexcept {
    const auto failed = [&](bool lasting, const char* reason) {
      *failure = {};
      failure->lasting = lasting;
      std::strncpy(failure->reason, reason, sizeof failure->reason - 1);
      return 1;
    };
    try {
      work();
      return 0;
    } catch (const DeviceFailure& error) {
      return failed(error.lasting, error.reason.c_str());
    } catch (const std::exception& error) {
      return failed(false, error.what());
    }
  }
  static Surface& surface_of(void* handle) { return *static_cast<Surface*>(handle); }

  static int32_t device_open(int32_t index, void** device, char* name, int32_t name_size,
                             ComputeFailure* failure) {
    return guarded(failure, [&] { *device = new Device<Queue>(Queue::open(index, name, name_size)); });
  }
  // What cannot be given back in an orderly way, as when the driver has gone before, stays.
  template <class Value>
  static void give_up(int32_t device, Value* value) noexcept {
    ComputeFailure ignored;
    guarded(&ignored, [&] {
      const typename Queue::Scope scope(device);
      delete value;
    });
  }
  static void device_close(void* handle) {
    auto* device = static_cast<Device<Queue>*>(handle);
    give_up(device->number(), device);
  }
  template <class Value, class From>
  static int32_t create(void* handle, const From* from, void** out, ComputeFailure* failure) {
    return guarded(failure, [&] {
      auto& device = *static_cast<Device<Queue>*>(handle);
      const typename Queue::Scope scope(device.number());
      *out = new Value(device, *from);
    });
  }
  template <class Value>
  static void destroy(void* handle) {
    auto* value = static_cast<Value*>(handle);
    give_up(value->device().number(), value);
  }
  static int32_t surface_create(void* device, const ComputeSurface* surface, void** out,
                                ComputeFailure* failure) {
    return create<Surface>(device, surface, out, failure);
  }
  static void surface_destroy(void* surface) { destroy<Surface>(surface); }
  static int32_t forest_create(void* device, const ComputeForest* forest, void** out,
                               ComputeFailure* failure) {
    return create<Forest>(device, forest, out, failure);
  }
  static void forest_destroy(void* forest) { destroy<Forest>(forest); }

  template <class Work>
  static int32_t on_surface(void* handle, ComputeFailure* failure, const Work& work) {
    return guarded(failure, [&] {
      const typename Queue::Scope scope(surface_of(handle).device().number());
      work(surface_of(handle).value());
    });
  }
  static int32_t spectrum_of(void* surface, int32_t count, double tolerance, double* lambda, double* phi,
                             ComputeFailure* failure) {
    return on_surface(surface, failure, [&](auto& on) { spectrum(on, count, tolerance, lambda, phi); });
  }
  static int32_t signatures_of(void* surface, const ComputeSignature* signature, const int32_t* vertex,
                               int32_t count, float* out, ComputeFailure* failure) {
    return on_surface(surface, failure, [&](auto& on) { signatures(on, *signature, vertex, count, out); });
  }
  static int32_t distances_of(void* surface, const ComputeSource* source, int32_t count, float* out,
                              ComputeFailure* failure) {
    return on_surface(surface, failure, [&](auto& on) { distances(on, source, count, out); });
  }
  static int32_t votes_of(void* surface, void* forest, const int32_t* vertex, const float* descriptor,
                          int32_t count, int32_t stride, float* out, ComputeFailure* failure) {
    return on_surface(surface, failure, [&](auto& on) {
      votes(on, static_cast<Forest*>(forest)->value(), vertex, descriptor, count, stride, out);
    });
  }
  static int32_t peaks_of(void* surface, int32_t count, double radius, int32_t* out,
                          ComputeFailure* failure) {
    return on_surface(surface, failure, [&](auto& on) { peaks(on, count, radius, out); });
  }
  static int32_t isoline_votes_of(void* surface, const ComputeIsolines* isolines, float* out,
                                  ComputeFailure* failure) {
    return on_surface(surface, failure, [&](auto& on) { isoline_votes(on, *isolines, out); });
  }
  static int32_t zoom_out_of(void* surface, const ComputeMap* map, int32_t* image, float* weight, float* C,
                             double* error, ComputeFailure* failure) {
    return on_surface(surface, failure, [&](auto& on) { zoom_out(on, *map, image, weight, C, error); });
  }
  static int32_t stages_of(void* surface, ComputeStage* out, int32_t room) {
    int32_t count = 0;
    ComputeFailure ignored;
    on_surface(surface, &ignored, [&](auto& on) { count = on.clock.report(out, room); });
    return count;
  }
};

}  // namespace focal
