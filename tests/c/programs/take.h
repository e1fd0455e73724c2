/* What the programs have in common: checks, and a take to work on. */
#ifndef MIMETRA_TESTS_TAKE_H
#define MIMETRA_TESTS_TAKE_H

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define CHECK(condition)                                                      \
  do {                                                                        \
    if (!(condition)) {                                                       \
      fprintf(stderr, "%s:%d: failed: %s\n", __FILE__, __LINE__, #condition); \
      exit(1);                                                                \
    }                                                                         \
  } while (0)

/* The function succeeds; if not, the context says why. */
#define OK(context, call)                                                               \
  do {                                                                                  \
    const mimetra_status status_ = (call);                                              \
    if (status_ != MIMETRA_OK) {                                                        \
      fprintf(stderr, "%s:%d: %s is %d: %s\n", __FILE__, __LINE__, #call, (int)status_, \
              m->message(context));                                                     \
      exit(1);                                                                          \
    }                                                                                   \
  } while (0)

/* The function fails with a status, and the message holds some words. */
#define FAILS(context, status, words, call)                                               \
  do {                                                                                    \
    const mimetra_status status_ = (call);                                                \
    if (status_ != (status) || !strstr(m->message(context), words)) {                     \
      fprintf(stderr, "%s:%d: %s is %d: '%s'\n", __FILE__, __LINE__, #call, (int)status_, \
              m->message(context));                                                       \
      exit(1);                                                                            \
    }                                                                                     \
  } while (0)

enum { SIDE = 9, VERTICES = SIDE * SIDE, TRIANGLES = 2 * (SIDE - 1) * (SIDE - 1), FRAMES = 8 };

typedef struct {
  double positions[FRAMES * VERTICES * 3];
  int32_t triangles[TRIANGLES * 3];
} take_arrays;

/* A square sheet with two bumps that rise in their own time; the first frame is flat. */
static inline take_arrays sheet(void) {
  take_arrays take;
  const double centers[2][2] = {{2, 2}, {6, 5}};
  for (int f = 0; f < FRAMES; ++f) {
    for (int v = 0; v < VERTICES; ++v) {
      double* p = take.positions + 3 * (f * VERTICES + v);
      p[0] = v % SIDE;
      p[1] = v / SIDE;
      p[2] = 0;
      for (int bump = 0; bump < 2; ++bump) {
        const double x = p[0] - centers[bump][0], y = p[1] - centers[bump][1];
        const double height = 1 - (x * x + y * y) / 6;
        if (height > 0) p[2] += height * fabs(sin(0.7 * f * (bump + 1)));
      }
    }
  }
  int32_t* corner = take.triangles;
  for (int y = 0; y + 1 < SIDE; ++y) {
    for (int x = 0; x + 1 < SIDE; ++x) {
      const int32_t v = y * SIDE + x;
      const int32_t corners[] = {v, v + 1, v + SIDE + 1, v, v + SIDE + 1, v + SIDE};
      for (int i = 0; i < 6; ++i) *corner++ = corners[i];
    }
  }
  return take;
}

static inline mimetra_array positions_of(const take_arrays* take) {
  const mimetra_array array = {sizeof array, MIMETRA_F64,    3, 0, {FRAMES, VERTICES, 3},
                               "positions",  take->positions};
  return array;
}

static inline mimetra_array triangles_of(const take_arrays* take) {
  const mimetra_array array = {sizeof array, MIMETRA_I32,    2, 0, {TRIANGLES, 3},
                               "triangles",  take->triangles};
  return array;
}

static inline mimetra_data* take_of(const mimetra_interface* m, mimetra_context* context) {
  const take_arrays take = sheet();
  const mimetra_array positions = positions_of(&take), triangles = triangles_of(&take);
  const mimetra_array* arrays[] = {&positions, &triangles, NULL};
  mimetra_data* data = NULL;
  OK(context, m->new_data(context, MIMETRA_SEQUENCE, "sheet", arrays, &data));
  return data;
}

#endif
