/* Prints the version of the library that it is linked with. */
#include <stdio.h>

#include <mimetra/plugins/c/mimetra.h>

int main(void) {
  const mimetra_interface* m = mimetra_get_interface(MIMETRA_INTERFACE_VERSION);
  if (!m) return 1;
  printf("serves %s\n", m->toolkit_version);
  return 0;
}
