# meshoptimizer, compiled into the library with the library's own flags: a build with fused multiply-adds collapses other edges, so
# landmarks would depend on the processor. .ci/bootstrap.sh fetches its sources through apt; without that, CMake downloads them.
# For sources of your own: -DFETCHCONTENT_SOURCE_DIR_MESHOPTIMIZER=FOLDER.
include(FetchContent)
set(FOCAL_MESHOPTIMIZER SOURCE CACHE STRING
  "meshoptimizer: SOURCE, compiled in, or PACKAGE, the one that find_package finds (results and the memory budget then depend on it)")
set_property(CACHE FOCAL_MESHOPTIMIZER PROPERTY STRINGS SOURCE PACKAGE)

if(FOCAL_MESHOPTIMIZER STREQUAL "PACKAGE")
  find_package(meshoptimizer REQUIRED)
  add_library(focal_meshoptimizer INTERFACE)
  target_link_libraries(focal_meshoptimizer INTERFACE meshoptimizer::meshoptimizer)
  return()
endif()

# Debian's source package is upstream's 0.18 without the files of others.
set(archive meshoptimizer_0.18+dfsg.orig.tar.xz)
set(places ${PROJECT_SOURCE_DIR}/build/third_party/${archive})
if(NOT EXISTS ${places})
  set(places https://deb.debian.org/debian/pool/main/m/meshoptimizer/${archive}
    https://snapshot.debian.org/file/fb3986a35b823ef68910611ab12442c858509aaa)
endif()
FetchContent_Declare(meshoptimizer
  URL ${places}
  URL_HASH SHA256=881ea2cc687f1fef5ce70484e0ca6504e13856dd856677749f3763bc685956d3
  DOWNLOAD_NAME ${archive} DOWNLOAD_EXTRACT_TIMESTAMP OFF
  SOURCE_SUBDIR none)  # its own CMakeLists.txt stays unused
FetchContent_MakeAvailable(meshoptimizer)

set(sources allocator indexcodec indexgenerator simplifier vertexcodec vertexfilter)
list(TRANSFORM sources PREPEND ${meshoptimizer_SOURCE_DIR}/src/)
list(TRANSFORM sources APPEND .cpp)
add_library(focal_meshoptimizer STATIC EXCLUDE_FROM_ALL ${sources})
target_include_directories(focal_meshoptimizer SYSTEM PUBLIC ${meshoptimizer_SOURCE_DIR}/src)
target_link_libraries(focal_meshoptimizer PRIVATE focal_flags)
set_target_properties(focal_meshoptimizer PROPERTIES
  POSITION_INDEPENDENT_CODE ON CXX_VISIBILITY_PRESET hidden VISIBILITY_INLINES_HIDDEN ON
  UNITY_BUILD OFF)  # its files define the same names
