#include "blob.h"

#include "boundary.h"

using namespace focal;

const void* focal_blob_data(const focal_blob* blob) {
  return guarded_value<const void*>(nullptr, [&] { return resolve<BlobObject>(blob)->bytes.data(); });
}

uint64_t focal_blob_size(const focal_blob* blob) {
  return guarded_value<uint64_t>(0, [&] { return resolve<BlobObject>(blob)->bytes.size(); });
}

focal_status focal_blob_destroy(focal_blob* blob) { return remove_handle(blob, HandleType::blob); }
