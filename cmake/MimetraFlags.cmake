# Flags of mimetra's own code; never handed to users of the libraries.
add_library(mimetra_flags INTERFACE)
target_compile_options(mimetra_flags INTERFACE -Wall -Wextra -Wpedantic -Wshadow -Wnon-virtual-dtor)
# GCC 12 sees overlapping copies in every `"text" + string` (its bug 105651), and takes OpenMesh's
# property vectors and std::regex for uninitialised.
target_compile_options(
  mimetra_flags INTERFACE $<$<CXX_COMPILER_ID:GNU>:-Wno-restrict -Wno-maybe-uninitialized>)
if(MIMETRA_WARNINGS_AS_ERRORS)
  target_compile_options(mimetra_flags INTERFACE -Werror)
endif()
if(MIMETRA_SANITIZE)
  set(MIMETRA_SANITIZER_FLAGS -fsanitize=address,undefined -fno-sanitize-recover=undefined
                              -fno-omit-frame-pointer)
  add_compile_options(${MIMETRA_SANITIZER_FLAGS})
  add_link_options(-fsanitize=address,undefined)
endif()
