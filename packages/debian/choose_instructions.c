/* The command of a package: becomes the build of it for the instructions of this processor. */
#include <stdio.h>
#include <unistd.h>

int main(int argc, char** argv) {
  (void)argc;
  const char* program = __builtin_cpu_supports("x86-64-v3") ? COMMANDS "/x86-64-v3/mimetra"
                                                            : COMMANDS "/x86-64/mimetra";
  execv(program, argv);
  perror(program);
  return 1;
}
