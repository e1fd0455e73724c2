/* Third-party operations through the C interface, from the folder in MIMETRA_PLUGIN_PATH: the two
 * samples. */
#include <mimetra/plugins/c/mimetra.h>

#include "tests/c/programs/take.h"

static void fail_on_log(int32_t level, const char* text, void* user) {
  (void)level;
  (void)user;
  fprintf(stderr, "nothing should be logged: %s\n", text);
  exit(1);
}

static mimetra_data* output_of(const mimetra_interface* m, mimetra_context* context,
                               mimetra_call* call) {
  mimetra_data* result = NULL;
  OK(context, m->call_run(call));
  OK(context, m->call_output(call, "out", 0, &result));
  return result;
}

/* No way for the vertices that the strength leaves where they are, and the way of a whole step. */
static void check_smooth(const mimetra_interface* m, mimetra_context* context,
                         const mimetra_data* take) {
  const take_arrays before = sheet();
  mimetra_call* call = NULL;
  OK(context, m->new_call(context, "smooth", &call));
  OK(context, m->call_give(call, "sequence", take));
  FAILS(context, MIMETRA_USAGE, "option 'strength': expected a number from 0 to 1",
        m->call_set(call, "strength", "2"));
  OK(context, m->call_set(call, "strength", "0"));
  mimetra_data* same = output_of(m, context, call);
  OK(context, m->call_set(call, "strength", "1"));
  mimetra_data* moved = output_of(m, context, call);
  const mimetra_array* array = NULL;
  OK(context, m->data_array(context, same, "positions", &array));
  CHECK(memcmp(array->values, before.positions, sizeof before.positions) == 0);
  OK(context, m->data_array(context, moved, "positions", &array));
  /* An inner vertex of frame 1 goes to the mean of its six neighbours. */
  const int v = 3 * SIDE + 3;
  const int neighbours[] = {v - 1, v + 1, v - SIDE, v + SIDE, v - SIDE - 1, v + SIDE + 1};
  double mean = 0;
  for (int i = 0; i < 6; ++i) mean += before.positions[3 * (VERTICES + neighbours[i]) + 2] / 6;
  CHECK(fabs(((const double*)array->values)[3 * (VERTICES + v) + 2] - mean) < 1e-12);
  m->free_data(same);
  m->free_data(moved);
  m->free_call(call);
}

/* The largest step of any vertex between two frames, times 30 frames a second. */
static void check_speed(const mimetra_interface* m, mimetra_context* context,
                        const mimetra_data* take) {
  const take_arrays before = sheet();
  double fastest = 0;
  for (int i = 3 * VERTICES + 2; i < FRAMES * VERTICES * 3; i += 3) {
    fastest = fmax(fastest, fabs(before.positions[i] - before.positions[i - 3 * VERTICES]) * 30);
  }
  mimetra_call* call = NULL;
  OK(context, m->new_call(context, "speed", &call));
  OK(context, m->call_give(call, "sequence", take));
  mimetra_data* fields = output_of(m, context, call);
  CHECK(strstr(m->call_report(call), "\"top_speed\""));
  const mimetra_array* top = NULL;
  OK(context, m->data_array(context, fields, "top_speed", &top));
  CHECK(top->location == MIMETRA_ON_VERTICES && top->shape[0] == VERTICES);
  double found = 0;
  for (int v = 0; v < VERTICES; ++v) found = fmax(found, ((const double*)top->values)[v]);
  CHECK(fabs(found - fastest) < 1e-9 * fastest);
  m->free_call(call);
  /* Where no fields are looked at, a sequence with fields serves too. */
  OK(context, m->new_call(context, "smooth", &call));
  OK(context, m->call_give(call, "sequence", fields));
  mimetra_data* moved = output_of(m, context, call);
  CHECK(m->data_kind(moved) == MIMETRA_SEQUENCE);
  m->free_data(moved);
  m->free_data(fields);
  m->free_call(call);
}

static int32_t never(double share, void* user) {
  (void)share;
  (void)user;
  return 0;
}

int main(void) {
  const mimetra_interface* m = mimetra_get_interface(MIMETRA_INTERFACE_VERSION);
  mimetra_context* context = NULL;
  CHECK(m && m->new_context(fail_on_log, NULL, &context) == MIMETRA_OK);
  const mimetra_operation* smooth = m->find_operation(context, "smooth");
  CHECK(smooth && strcmp(smooth->parameters[0]->name, "strength") == 0);
  CHECK(smooth->parameters[0]->maximum == 1 && smooth->parameters[0]->of_files == 0);
  CHECK(smooth->outputs[0]->flags == 0);
  CHECK(m->find_operation(context, "speed")->outputs[0]->flags == MIMETRA_WITH_FIELDS);
  mimetra_data* take = take_of(m, context);
  check_smooth(m, context, take);
  check_speed(m, context, take);

  mimetra_call* call = NULL;
  OK(context, m->new_call(context, "smooth", &call));
  OK(context, m->call_give(call, "sequence", take));
  OK(context, m->set_progress(context, never, NULL));
  FAILS(context, MIMETRA_CANCELLED, "cancelled", m->call_run(call));
  CHECK(m->call_output_count(call, "out") == 0);
  m->free_call(call);
  m->free_data(take);
  m->free_context(context);
  return 0;
}
