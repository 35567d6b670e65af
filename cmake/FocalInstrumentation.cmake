# How focal_core is compiled where it is watched: by sanitizers, by libFuzzer, or to count the branches that tests take. Paths are
# relative to the project's folder, which includes this file.
if(FOCAL_SANITIZE)  # the compiler takes more of the time than the tests
  target_compile_options(focal_core PRIVATE -O1)
endif()
if(FOCAL_FUZZ)  # guided by the branches of what reads foreign bytes; libFuzzer is slow where all is counted
  file(GLOB guiding_sources CONFIGURE_DEPENDS src/base/archive.cpp src/gltf/*.cpp src/analysis/*_file.cpp src/model/*_file.cpp)
  set_property(SOURCE ${guiding_sources} APPEND PROPERTY COMPILE_OPTIONS -fsanitize=fuzzer-no-link)
  set_property(SOURCE ${guiding_sources} PROPERTY SKIP_PRECOMPILE_HEADERS ON)
  target_link_options(focal_core INTERFACE -fsanitize=fuzzer-no-link)
endif()
if(FOCAL_COVERAGE)  # of what reads foreign bytes, and in capi/; the rest is as always
  if(NOT CMAKE_CXX_COMPILER_ID STREQUAL "Clang")
    message(FATAL_ERROR "FOCAL_COVERAGE counts by clang: see tests/coverage/run.sh")
  endif()
  set(coverage_flags -fprofile-instr-generate -fcoverage-mapping)
  file(GLOB covered_sources CONFIGURE_DEPENDS src/base/archive.cpp src/gltf/*.cpp src/analysis/*_file.cpp src/model/*_file.cpp)
  set_source_files_properties(${covered_sources} PROPERTIES
    COMPILE_OPTIONS "${coverage_flags}" SKIP_PRECOMPILE_HEADERS ON)
  target_link_options(focal_core INTERFACE ${coverage_flags})
endif()
