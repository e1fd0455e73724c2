/* A library that holds nothing: it needs the one that does, and the loader takes the build of that
   one for the instructions of this processor. Whoever opens this one by its path finds all symbols
   of the other. */
extern int mimetra_is_empty;
