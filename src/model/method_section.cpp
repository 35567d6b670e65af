#include "model/method_section.h"

#include <algorithm>

#include "base/error.h"
#include "descriptors/descriptor.h"
#include "geodesics/distance.h"

namespace focal {
namespace {

template <class Kind>
int32_t number_of(std::span<const Kind> kinds, const std::string& name, const char* what) {
  const auto found = std::find_if(kinds.begin(), kinds.end(), [&](const Kind& k) { return k.name == name; });
  if (found == kinds.end())
    throw Error(Status::unsupported_version,
                std::string("the file was made with the ") + what + " '" + name.substr(0, 80) +
                    "', which this library does not have",
                "use the library that made it, or train again");
  return static_cast<int32_t>(found - kinds.begin());
}

}  // namespace

std::vector<std::byte> write_method(const Method& method) {
  ByteWriter out;
  out.text(descriptor_kinds()[method.descriptor].name);
  out.text(distance_kinds()[method.distance].name);
  return out.take();
}

Method read_method(const Archive& archive) {
  if (!archive.has(method_section)) return {};
  ByteReader in = archive.section(method_section);
  const std::string descriptor = in.text("descriptor"), distance = in.text("distance");
  in.expect_end();
  return {number_of(descriptor_kinds(), descriptor, "descriptor"),
          number_of(distance_kinds(), distance, "distance")};
}

}  // namespace focal
