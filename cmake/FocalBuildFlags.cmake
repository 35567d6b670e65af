# The flags of everything focal builds, carried by one interface target, so that nothing leaks into a host project.
# focal_core hands them on: Eigen is header only, so code linked together must agree on the instruction set.
include(CheckCXXCompilerFlag)

set(FOCAL_ARCH "x86-64-v2" CACHE STRING "Oldest x86-64 processor level to run on (-march); empty: the compiler's own")
set(FOCAL_SANITIZE "" CACHE STRING "Sanitizers to build with: address,undefined or thread; empty: none")
set(FOCAL_SANITIZE_SKIP "" CACHE STRING "Checks of these sanitizers to leave out, such as null,alignment; empty: none")
option(FOCAL_COVERAGE "Count the branches taken in the readers and the C interface (tests/coverage)" OFF)
option(FOCAL_FUZZ "Fuzz targets of libFuzzer's (needs clang; with FOCAL_SANITIZE they find more)" OFF)
option(FOCAL_WERROR "Treat warnings as errors" OFF)

add_library(focal_flags INTERFACE)
target_compile_features(focal_flags INTERFACE cxx_std_20)
# A fused multiply-add rounds once where a product and a sum round twice: results would hang on the processor.
target_compile_options(focal_flags INTERFACE -ffp-contract=off)
target_compile_definitions(focal_flags INTERFACE EIGEN_MPL2_ONLY)  # no LGPL part of Eigen, ever
if(FOCAL_ARCH AND CMAKE_SYSTEM_PROCESSOR MATCHES "^(x86_64|AMD64|amd64)$")
  check_cxx_compiler_flag(-march=${FOCAL_ARCH} FOCAL_HAS_ARCH_${FOCAL_ARCH})
  if(FOCAL_HAS_ARCH_${FOCAL_ARCH})
    target_compile_options(focal_flags INTERFACE -march=${FOCAL_ARCH})
  endif()
endif()
if(WIN32)
  target_compile_definitions(focal_flags INTERFACE NOMINMAX=1 WIN32_LEAN_AND_MEAN=1)  # of windows.h
endif()
if(MINGW)
  # Programs and the library stand alone: no DLL of the compiler beside them.
  target_link_options(focal_flags INTERFACE -static)
endif()
add_library(focal_sanitize INTERFACE)  # of programs in C too, that call a library that is watched
if(FOCAL_SANITIZE)
  set(sanitize -fsanitize=${FOCAL_SANITIZE} -fno-sanitize-recover=all -fno-omit-frame-pointer)
  if(FOCAL_SANITIZE_SKIP)
    list(APPEND sanitize -fno-sanitize=${FOCAL_SANITIZE_SKIP})
  endif()
  target_compile_options(focal_sanitize INTERFACE ${sanitize})
  target_compile_definitions(focal_sanitize INTERFACE FOCAL_SANITIZED)  # tests do less, all is many times slower
  target_link_options(focal_sanitize INTERFACE ${sanitize} $<$<CXX_COMPILER_ID:Clang>:-fsanitize-link-c++-runtime>)
  target_link_libraries(focal_sanitize INTERFACE $<$<CXX_COMPILER_ID:Clang>:stdc++>)
endif()
target_link_libraries(focal_flags INTERFACE focal_sanitize)

# Our own files only, never those of a project that links them.
add_library(focal_warnings INTERFACE)
target_compile_options(focal_warnings INTERFACE -Wall -Wextra $<$<BOOL:${FOCAL_WERROR}>:-Werror>)
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
  # At -O3 GCC 12 and 13 see overlaps and overruns in std::string's own code and in Eigen's 3-vectors that are not there
  # (GCC bugs 105651, 106247); the address sanitizer watches for the real ones.
  target_compile_options(focal_warnings INTERFACE -Wno-restrict -Wno-array-bounds -Wno-stringop-overflow
    -Wno-stringop-overread)
endif()

# For targets where the compiler takes most of the time and the program next to none: the command and the tests.
add_library(focal_quick_build INTERFACE)
target_compile_options(focal_quick_build INTERFACE $<$<NOT:$<CONFIG:Debug>>:-O1>)
