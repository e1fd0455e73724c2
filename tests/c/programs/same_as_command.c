/* The arrays of the command's take in, the same transfer: bit for bit what the command wrote. */
#include <mimetra/plugins/c/mimetra.h>

#include "tests/c/programs/take.h"

/* The arrays of a value as a host holds them: in memory of its own. */
static mimetra_data* rebuilt(const mimetra_interface* m, mimetra_context* context,
                             const mimetra_data* data, const char* const* names) {
  mimetra_array copies[8];
  const mimetra_array* list[9] = {NULL};
  for (int i = 0; names[i]; ++i) {
    const mimetra_array* shown = NULL;
    OK(context, m->data_array(context, data, names[i], &shown));
    size_t bytes = shown->type == MIMETRA_F64 ? 8 : 4;
    for (int d = 0; d < shown->rank; ++d) bytes *= (size_t)shown->shape[d];
    void* values = malloc(bytes);
    memcpy(values, shown->values, bytes);
    copies[i] = *shown;
    copies[i].values = values;
    list[i] = &copies[i];
  }
  mimetra_data* made = NULL;
  OK(context, m->new_data(context, m->data_kind(data), "take", list, &made));
  for (int i = 0; list[i]; ++i) free((void*)list[i]->values);
  return made;
}

static void check_equal(const mimetra_interface* m, mimetra_context* context, const mimetra_data* a,
                        const mimetra_data* b, const char* name) {
  const mimetra_array *left = NULL, *right = NULL;
  OK(context, m->data_array(context, a, name, &left));
  OK(context, m->data_array(context, b, name, &right));
  size_t count = 1;
  CHECK(left->rank == right->rank && left->type == MIMETRA_F64 && right->type == MIMETRA_F64);
  for (int d = 0; d < left->rank; ++d) {
    CHECK(left->shape[d] == right->shape[d]);
    count *= (size_t)left->shape[d];
  }
  CHECK(count > 0 && memcmp(left->values, right->values, count * sizeof(double)) == 0);
}

/* argv: take.npy, a target, what the command made of them with -k 5, and its components. */
int main(int argc, char** argv) {
  CHECK(argc == 5);
  const mimetra_interface* m = mimetra_get_interface(MIMETRA_INTERFACE_VERSION);
  mimetra_context* context = NULL;
  CHECK(m && m->new_context(NULL, NULL, &context) == MIMETRA_OK);
  mimetra_data *read = NULL, *expected = NULL, *components = NULL;
  OK(context, m->load_data(context, MIMETRA_SEQUENCE, argv[1], NULL, &read));
  OK(context, m->load_data(context, MIMETRA_SEQUENCE, argv[3], NULL, &expected));
  OK(context, m->load_data(context, MIMETRA_COMPONENTS, argv[4], NULL, &components));
  const char* const names[] = {"positions", "times", "rest", "face_sizes", "corners", NULL};
  mimetra_data* take = rebuilt(m, context, read, names);

  mimetra_call* call = NULL;
  OK(context, m->new_call(context, "transfer", &call));
  OK(context, m->call_give(call, "source", take));
  OK(context, m->call_read(call, "target", argv[2]));
  OK(context, m->call_set(call, "k", "5"));
  OK(context, m->call_want(call, "components-out"));
  OK(context, m->call_run(call));
  CHECK(m->call_output_count(call, "out") == 1);
  mimetra_data *result = NULL, *found = NULL;
  OK(context, m->call_output(call, "out", 0, &result));
  OK(context, m->call_output(call, "components-out", 0, &found));
  m->free_call(call); /* values outlive it */
  check_equal(m, context, result, expected, "positions");
  check_equal(m, context, result, expected, "rest");
  check_equal(m, context, found, components, "displacements");
  check_equal(m, context, found, components, "weights");
  mimetra_data* all[] = {read, expected, components, take, result, found};
  for (int i = 0; i < 6; ++i) m->free_data(all[i]);
  m->free_context(context);
  return 0;
}
