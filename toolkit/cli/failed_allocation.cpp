#include "toolkit/cli/failed_allocation.h"

#include <atomic>
#include <new>

namespace {

std::atomic<std::size_t> failed = 0;

void* noted(void* memory, std::size_t bytes) {
  if (!memory) failed = bytes;
  return memory;
}

}  // namespace

// std::bad_alloc does not say how much was asked for. The linker sends the program's calls here
// (--wrap, in CMakeLists.txt); __real_NAME is the function itself.
// NOLINTBEGIN(bugprone-reserved-identifier,readability-identifier-naming): the linker's names
extern "C" {
void* __real_malloc(std::size_t bytes);
void* __real_realloc(void* memory, std::size_t bytes);
void* __real__Znwm(std::size_t bytes);
void* __real__ZnwmSt11align_val_t(std::size_t bytes, std::align_val_t alignment);

void* __wrap_malloc(std::size_t bytes);
void* __wrap_malloc(std::size_t bytes) {
  return noted(__real_malloc(bytes), bytes);
}

void* __wrap_realloc(void* memory, std::size_t bytes);
void* __wrap_realloc(void* memory, std::size_t bytes) {
  return noted(__real_realloc(memory, bytes), bytes);
}

void* __wrap__Znwm(std::size_t bytes);
void* __wrap__Znwm(std::size_t bytes) {
  try {
    return __real__Znwm(bytes);
  } catch (const std::bad_alloc&) {
    failed = bytes;
    throw;
  }
}

void* __wrap__ZnwmSt11align_val_t(std::size_t bytes, std::align_val_t alignment);
void* __wrap__ZnwmSt11align_val_t(std::size_t bytes, std::align_val_t alignment) {
  try {
    return __real__ZnwmSt11align_val_t(bytes, alignment);
  } catch (const std::bad_alloc&) {
    failed = bytes;
    throw;
  }
}
}
// NOLINTEND(bugprone-reserved-identifier,readability-identifier-naming)

namespace mimetra::cli {

std::size_t failed_allocation() {
  return failed;
}

}  // namespace mimetra::cli
