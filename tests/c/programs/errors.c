/* Every wrong use is a status and a message. */
#include <mimetra/plugins/c/mimetra.h>

#include "tests/c/programs/take.h"

static void check_null_handles(const mimetra_interface* m) {
  mimetra_data* data = (mimetra_data*)m;
  CHECK(m->new_context(NULL, NULL, NULL) == MIMETRA_USAGE);
  CHECK(m->set_threads(NULL, 1) == MIMETRA_USAGE &&
        m->set_progress(NULL, NULL, NULL) != MIMETRA_OK);
  CHECK(*m->operations(NULL) == NULL && m->find_operation(NULL, "transfer") == NULL);
  CHECK(m->new_data(NULL, MIMETRA_TABLE, "", NULL, &data) == MIMETRA_USAGE && data == NULL);
  const mimetra_array *array = (const mimetra_array*)m, *const *arrays = &array;
  const char *json = "", *operations = "";
  CHECK(m->data_arrays(NULL, NULL, &arrays) == MIMETRA_USAGE && arrays == NULL);
  CHECK(m->data_array(NULL, NULL, "rest", &array) == MIMETRA_USAGE && array == NULL);
  CHECK(m->data_json(NULL, NULL, &json) == MIMETRA_USAGE && json == NULL);
  CHECK(m->operations_json(NULL, &operations) == MIMETRA_USAGE && operations == NULL);
  data = (mimetra_data*)m;
  CHECK(m->load_data(NULL, MIMETRA_TABLE, "", NULL, &data) == MIMETRA_USAGE && data == NULL);
  CHECK(m->data_kind(NULL) == 0 && strcmp(m->data_name(NULL), "") == 0);
  CHECK(m->call_set(NULL, "k", "3") == MIMETRA_USAGE && m->call_run(NULL) == MIMETRA_USAGE);
  CHECK(m->call_output_count(NULL, "out") == 0 && strcmp(m->call_report(NULL), "") == 0);
  CHECK(m->job_context(NULL) == NULL && m->job_input(NULL, "in", 0) == NULL);
  CHECK(m->job_progress(NULL, 0.5) == MIMETRA_USAGE && isnan(m->job_number(NULL, "k")));
  CHECK(strlen(m->message(NULL)) > 0);
  m->free_data(NULL);
  m->free_call(NULL);
  m->free_context(NULL);
}

static void check_null_arguments(const mimetra_interface* m, mimetra_context* context) {
  mimetra_data* data = NULL;
  FAILS(context, MIMETRA_USAGE, "'arrays' is NULL",
        m->new_data(context, MIMETRA_SEQUENCE, "take", NULL, &data));
  FAILS(context, MIMETRA_USAGE, "'text' is NULL",
        m->load_data(context, MIMETRA_SEQUENCE, NULL, NULL, &data));
  FAILS(context, MIMETRA_USAGE, "'data' is NULL", m->save_data(context, NULL, "a.npy", NULL));
  FAILS(context, MIMETRA_USAGE, "'operation' is NULL", m->new_call(context, NULL, NULL));
}

static mimetra_status make(const mimetra_interface* m, mimetra_context* context,
                           const mimetra_array* positions, const mimetra_array* triangles,
                           const mimetra_array* third) {
  const mimetra_array* arrays[] = {positions, triangles, third, NULL};
  mimetra_data* data = NULL;
  const mimetra_status status = m->new_data(context, MIMETRA_SEQUENCE, "take", arrays, &data);
  CHECK(status == MIMETRA_OK || data == NULL);
  m->free_data(data);
  return status;
}

static void check_arrays(const mimetra_interface* m, mimetra_context* context) {
  take_arrays take = sheet();
  const mimetra_array positions = positions_of(&take), triangles = triangles_of(&take);
  OK(context, make(m, context, &positions, &triangles, NULL));
  FAILS(context, MIMETRA_USAGE, "needs the array 'triangles'",
        make(m, context, &positions, NULL, NULL));
  mimetra_array wrong = positions;
  wrong.shape[2] = 2;
  FAILS(context, MIMETRA_USAGE, "is 8 x 81 x 2, expected F x N x 3",
        make(m, context, &wrong, &triangles, NULL));
  wrong = positions;
  wrong.type = 9;
  FAILS(context, MIMETRA_USAGE, "the type 9", make(m, context, &wrong, &triangles, NULL));
  wrong = positions;
  wrong.shape[0] = INT64_MAX;
  FAILS(context, MIMETRA_USAGE, "no memory holds", make(m, context, &wrong, &triangles, NULL));
  wrong = positions;
  wrong.values = NULL;
  FAILS(context, MIMETRA_USAGE, "has no values", make(m, context, &wrong, &triangles, NULL));
  wrong = positions;
  wrong.name = "postions";
  FAILS(context, MIMETRA_USAGE, "'postions' is not known",
        make(m, context, &positions, &triangles, &wrong));
  const double times[] = {0, 1, 2};
  const mimetra_array few = {sizeof few, MIMETRA_F64, 1, 0, {3}, "times", times};
  FAILS(context, MIMETRA_MISMATCH, "with F = 8 as in 'positions'",
        make(m, context, &positions, &triangles, &few));
  take.triangles[7] = VERTICES;
  FAILS(context, MIMETRA_BAD_INPUT, "81", make(m, context, &positions, &triangles, NULL));
  take.triangles[7] = 0;
  take.positions[3 * (VERTICES + 4) + 1] = NAN;
  FAILS(context, MIMETRA_BAD_INPUT, "nan at [1, 4, 1], expected a finite number",
        make(m, context, &positions, &triangles, NULL));
}

/* A struct of a header that ended before its last field: that field counts as zero. */
static void check_short_structs(const mimetra_interface* m, mimetra_context* context) {
  const take_arrays take = sheet();
  const mimetra_array triangles = triangles_of(&take);
  mimetra_array positions = positions_of(&take);
  positions.struct_size = offsetof(mimetra_array, values);
  FAILS(context, MIMETRA_USAGE, "has no values", make(m, context, &positions, &triangles, NULL));
  positions.struct_size = 0;
  FAILS(context, MIMETRA_USAGE, "its struct_size", make(m, context, &positions, &triangles, NULL));
  struct {
    mimetra_array known;
    double of_a_newer_header;
  } longer = {positions_of(&take), 1};
  longer.known.struct_size = sizeof longer;
  OK(context, make(m, context, &longer.known, &triangles, NULL));
}

static void check_calls(const mimetra_interface* m, mimetra_context* context) {
  mimetra_call* call = NULL;
  mimetra_data *take = take_of(m, context), *data = NULL;
  const mimetra_array* array = NULL;
  FAILS(context, MIMETRA_USAGE, "no operation 'transfr'; there are info,",
        m->new_call(context, "transfr", &call));
  CHECK(call == NULL);
  OK(context, m->new_call(context, "regions", &call));
  FAILS(context, MIMETRA_USAGE, "no parameter 'kk'", m->call_set(call, "kk", "3"));
  FAILS(context, MIMETRA_USAGE, "option 'k': expected a whole number", m->call_set(call, "k", "0"));
  FAILS(context, MIMETRA_USAGE, "no input 'source'", m->call_give(call, "source", take));
  FAILS(context, MIMETRA_USAGE, "expected the kind 'components', found 'sequence'",
        m->call_give(call, "components", take));
  FAILS(context, MIMETRA_USAGE, "no output 'outt'", m->call_want(call, "outt"));
  FAILS(context, MIMETRA_USAGE, "needs its input 'sequence'", m->call_run(call));
  FAILS(context, MIMETRA_USAGE, "has 0 values", m->call_output(call, "out", 0, &data));
  OK(context, m->call_read(call, "sequence", "no/such/take.npy"));
  FAILS(context, MIMETRA_BAD_INPUT, "no/such/take.npy", m->call_run(call));
  OK(context, m->call_give(call, "sequence", take));
  OK(context, m->call_set(call, "k", "82"));
  FAILS(context, MIMETRA_MISMATCH, "the mesh has 81 vertices", m->call_run(call));
  OK(context, m->call_set(call, "k", "2"));
  OK(context, m->call_run(call));
  FAILS(context, MIMETRA_USAGE, "none of index -1", m->call_output(call, "out", -1, &data));
  OK(context, m->call_output(call, "out", 0, &data));
  FAILS(context, MIMETRA_USAGE, "there are masks, ", m->data_array(context, data, "roii", &array));
  FAILS(context, MIMETRA_BAD_OUTPUT, "no/such",
        m->save_data(context, take, "/proc/no/such/a.npy", NULL));
  const char* const settings[] = {"speed=3", NULL};
  FAILS(context, MIMETRA_USAGE, "setting 'speed=3'",
        m->save_data(context, take, "a.npy", settings));
  m->free_data(data);
  m->free_data(take);
  m->free_call(call);
}

/* Regions and components that do not go with what they are used for. */
static void check_other_meshes(const mimetra_interface* m, mimetra_context* context) {
  const take_arrays take = sheet();
  const mimetra_array triangles = triangles_of(&take);
  const int32_t one_triangle[] = {0, 1, 2}, center = 0;
  const uint8_t inside[VERTICES] = {1};
  double zeros[3 * VERTICES] = {0}, weights[FRAMES] = {0, 1};
  const mimetra_array masks = {sizeof masks, MIMETRA_U8, 2, 0, {1, VERTICES}, "masks", inside};
  const mimetra_array other = {sizeof other, MIMETRA_I32, 2, 0, {1, 3}, "triangles", one_triangle};
  const mimetra_array* const region_arrays[] = {&masks, &other, NULL};
  zeros[0] = 1;
  const mimetra_array rest = {sizeof rest, MIMETRA_F64, 2, 0, {VERTICES, 3}, "rest", zeros};
  const mimetra_array moved = {sizeof moved,     MIMETRA_F64,     3,    0,
                               {1, VERTICES, 3}, "displacements", zeros};
  const mimetra_array shares = {sizeof shares, MIMETRA_F64, 2, 0, {FRAMES, 1}, "weights", weights};
  const mimetra_array centers = {sizeof centers, MIMETRA_I32, 1, 0, {1}, "centers", &center};
  const mimetra_array* const component_arrays[] = {&rest,   &triangles, &moved,
                                                   &shares, &centers,   NULL};
  mimetra_array neutral = rest;
  neutral.name = "neutral";
  const mimetra_array* const mesh_arrays[] = {&neutral, &triangles, NULL};
  mimetra_data *data = take_of(m, context), *mesh = NULL, *regions = NULL, *components = NULL;
  mimetra_call* call = NULL;
  OK(context, m->new_data(context, MIMETRA_REGIONS, "few", region_arrays, &regions));
  OK(context, m->new_call(context, "transfer", &call));
  OK(context, m->call_give(call, "source", data));
  OK(context, m->call_give(call, "regions", regions));
  OK(context, m->new_data(context, MIMETRA_MODEL, "mesh", mesh_arrays, &mesh));
  OK(context, m->call_give(call, "target", mesh));
  FAILS(context, MIMETRA_MISMATCH, "few: regions of a mesh with 81 vertices and 1 triangles",
        m->call_run(call));
  OK(context, m->call_set(call, "frames", "0:2"));
  FAILS(context, MIMETRA_USAGE, "'frames' is about files", m->call_run(call));
  m->free_call(call);
  OK(context, m->new_data(context, MIMETRA_COMPONENTS, "bare", component_arrays, &components));
  OK(context, m->new_call(context, "regions", &call));
  OK(context, m->call_give(call, "sequence", data));
  OK(context, m->call_give(call, "components", components));
  OK(context, m->call_set(call, "component-fields", "true"));
  FAILS(context, MIMETRA_MISMATCH, "bare: holds no support maps", m->call_run(call));
  m->free_call(call);
  m->free_data(components);
  m->free_data(mesh);
  m->free_data(regions);
  m->free_data(data);
}

static int32_t stop_half_way(double share, void* user) {
  ++*(int*)user;
  return share < 0.5;
}

static void check_cancelling(const mimetra_interface* m, mimetra_context* context) {
  mimetra_call* call = NULL;
  mimetra_data* take = take_of(m, context);
  int reports = 0;
  OK(context, m->new_call(context, "decompose", &call));
  OK(context, m->call_give(call, "sequence", take));
  OK(context, m->call_set(call, "k", "2"));
  OK(context, m->set_progress(context, stop_half_way, &reports));
  FAILS(context, MIMETRA_CANCELLED, "cancelled", m->call_run(call));
  CHECK(reports > 0 && m->call_output_count(call, "out") == 0);
  OK(context, m->set_progress(context, NULL, NULL));
  OK(context, m->call_run(call));
  CHECK(m->call_output_count(call, "out") == 1);
  m->free_call(call);
  m->free_data(take);
}

int main(void) {
  CHECK(mimetra_get_interface(0) == NULL);
  CHECK(mimetra_get_interface(MIMETRA_INTERFACE_VERSION + 1) == NULL);
  const mimetra_interface* m = mimetra_get_interface(MIMETRA_INTERFACE_VERSION);
  CHECK(m && m->version == MIMETRA_INTERFACE_VERSION && m->struct_size == sizeof *m);
  CHECK(MIMETRA_HAS(m, job_report));
  mimetra_context* context = NULL;
  check_null_handles(m);
  CHECK(m->new_context(NULL, NULL, &context) == MIMETRA_OK);
  check_null_arguments(m, context);
  check_arrays(m, context);
  check_short_structs(m, context);
  check_calls(m, context);
  check_cancelling(m, context);
  check_other_meshes(m, context);
  FAILS(context, MIMETRA_USAGE, "threads: expected 0 or more", m->set_threads(context, -1));
  OK(context, m->set_threads(context, INT32_MAX));
  m->free_context(context);
  return 0;
}
