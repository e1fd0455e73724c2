/* Compiled against version 1 of the header as it was; it must run with every later library. */
#include "tests/c/programs/version_1/mimetra.h"
#include "tests/c/programs/take.h"

static void remember(int32_t level, const char* text, void* user) {
  (void)level;
  snprintf(user, 200, "%s", text);
}

int main(void) {
  const mimetra_interface* m = mimetra_get_interface(1);
  CHECK(m && m->struct_size >= sizeof *m && m->version == 1 && strlen(m->toolkit_version) > 0);
  char log[200] = "";
  mimetra_context* context = NULL;
  CHECK(m->new_context(remember, log, &context) == MIMETRA_OK);

  const mimetra_operation* decompose = m->find_operation(context, "decompose");
  CHECK(decompose && decompose->struct_size >= sizeof *decompose && !decompose->run);
  CHECK(decompose->inputs[0]->kind == MIMETRA_SEQUENCE);
  CHECK(decompose->inputs[0]->flags == MIMETRA_WITH_FIELDS);
  CHECK(decompose->outputs[0]->kind == MIMETRA_COMPONENTS);
  const mimetra_parameter* const* parameter = decompose->parameters;
  while (*parameter && strcmp((*parameter)->name, "k") != 0) ++parameter;
  CHECK(*parameter && (*parameter)->kind == MIMETRA_INTEGER && (*parameter)->minimum == 1);
  CHECK(isinf((*parameter)->maximum) && !(*parameter)->choices && !(*parameter)->of_files);
  while (*parameter && strcmp((*parameter)->name, "frames") != 0) ++parameter;
  CHECK(*parameter && (*parameter)->of_files == MIMETRA_READING && !(*parameter)->fallback);
  const char* json = NULL;
  OK(context, m->operations_json(context, &json));
  CHECK(json[0] == '[' && strstr(json, "\"decompose\""));

  mimetra_data *take = take_of(m, context), *result = NULL;
  mimetra_call* call = NULL;
  OK(context, m->new_call(context, "decompose", &call));
  OK(context, m->call_give(call, "sequence", take));
  OK(context, m->call_set(call, "k", "2"));
  OK(context, m->call_run(call));
  CHECK(strstr(m->call_report(call), "\"energies\"") && strlen(m->call_summary(call)) > 0);
  OK(context, m->call_output(call, "out", 0, &result));
  const mimetra_array* const* arrays = NULL;
  OK(context, m->data_arrays(context, result, &arrays));
  while (*arrays && strcmp((*arrays)->name, "displacements") != 0) ++arrays;
  CHECK(*arrays && (*arrays)->struct_size >= sizeof **arrays && (*arrays)->rank == 3);
  CHECK((*arrays)->shape[0] == 2 && (*arrays)->shape[1] == VERTICES && (*arrays)->shape[2] == 3);
  m->free_data(result);
  m->free_call(call);
  m->free_data(take);
  m->free_context(context);
  return 0;
}
