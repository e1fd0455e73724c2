# Flags of mimetra's own code; never handed to users of the libraries.
add_library(mimetra_flags INTERFACE)
target_compile_options(mimetra_flags INTERFACE -Wall -Wextra -Wpedantic -Wshadow -Wnon-virtual-dtor)
# What GCC 12 concludes from inlined code is wrong too often: overlapping copies in every `"text" +
# string` (its bug 105651), small matrices of Eigen's read beyond their end, std::fill of 2^64 bytes.
# Clang and the sanitizers look for the same faults.
target_compile_options(
  mimetra_flags
  INTERFACE $<$<CXX_COMPILER_ID:GNU>:-Wno-restrict -Wno-maybe-uninitialized -Wno-use-after-free
            -Wno-array-bounds -Wno-stringop-overflow>)

# Where files are compiled together, GCC takes their classes for those of a header.
if(CMAKE_UNITY_BUILD)
  target_compile_options(mimetra_flags
                         INTERFACE $<$<CXX_COMPILER_ID:GNU>:-Wno-subobject-linkage>)
endif()

# A product and a sum are rounded one after the other, also where a processor could do both at once:
# with GCC so they are in standard C++, and results are those of Clang, too.
target_compile_options(mimetra_flags INTERFACE -ffp-contract=off)

# Products of matrices are two and a half times faster with AVX2 and FMA.
set(MIMETRA_INSTRUCTIONS "" CACHE STRING
    "What the compiler may use (-march); by default AVX2 and FMA where this machine has them")
set(MIMETRA_BUILT_FOR ${CMAKE_SYSTEM_PROCESSOR})
if(MIMETRA_INSTRUCTIONS)
  set(MIMETRA_BUILT_FOR ${MIMETRA_INSTRUCTIONS})
  target_compile_options(mimetra_flags INTERFACE -march=${MIMETRA_INSTRUCTIONS})
elseif(NOT CMAKE_CROSSCOMPILING)
  include(CheckCXXSourceRuns)
  # What -march=x86-64-v3 stands for, as far as all compilers can ask for it.
  set(features avx2 fma bmi bmi2 popcnt)
  list(TRANSFORM features REPLACE "(.+)" "__builtin_cpu_supports(\"\\1\")")
  list(JOIN features " && " features)
  check_cxx_source_runs("int main() { return ${features} ? 0 : 1; }" MIMETRA_CPU_HAS_AVX2)
  if(MIMETRA_CPU_HAS_AVX2)
    set(MIMETRA_BUILT_FOR x86-64-v3)
    target_compile_options(mimetra_flags INTERFACE -march=x86-64-v3)
  endif()
endif()

if(MIMETRA_WARNINGS_AS_ERRORS)
  target_compile_options(mimetra_flags INTERFACE -Werror)
endif()
if(MIMETRA_SANITIZE)
  set(MIMETRA_SANITIZER_FLAGS -fsanitize=address,undefined -fno-sanitize-recover=undefined
                              -fno-omit-frame-pointer)
  # Checks of every pointer that Eigen passes on are a third of the build. AddressSanitizer finds
  # most of these faults when memory is accessed; ./dev fuzz keeps the checks.
  if(NOT MIMETRA_FUZZING)
    list(APPEND MIMETRA_SANITIZER_FLAGS
         -fno-sanitize=null,alignment,object-size,vptr,pointer-overflow)
  endif()
  add_compile_options(${MIMETRA_SANITIZER_FLAGS})
  add_link_options(-fsanitize=address,undefined)
  # Their tables hold millions of addresses: at a place that is fixed, programs start in half of the
  # time.
  target_link_options(mimetra_flags INTERFACE
                      $<$<STREQUAL:$<TARGET_PROPERTY:TYPE>,EXECUTABLE>:-no-pie>)
endif()
if(MIMETRA_SANITIZE_THREADS)
  add_compile_options(-fsanitize=thread -fno-omit-frame-pointer)
  add_link_options(-fsanitize=thread)
endif()
if(MIMETRA_FUZZING)
  # All that is fuzzed counts the branches it takes; libFuzzer's main comes with tests/fuzz.
  add_compile_options(-fsanitize=fuzzer-no-link)
endif()
