/* Values of all kinds go in as arrays and come out as they went in. */
#include <mimetra/plugins/c/mimetra.h>

#include "tests/c/programs/take.h"

/* All arrays of a value make the same value again. */
static mimetra_data* again(const mimetra_interface* m, mimetra_context* context,
                           const mimetra_data* data) {
  const mimetra_array *const *before = NULL, *const *after = NULL;
  mimetra_data* made = NULL;
  OK(context, m->data_arrays(context, data, &before));
  OK(context, m->new_data(context, m->data_kind(data), m->data_name(data), before, &made));
  OK(context, m->data_arrays(context, made, &after));
  for (; *before && *after; ++before, ++after) {
    size_t count = 1;
    CHECK(strcmp((*before)->name, (*after)->name) == 0 && (*before)->type == (*after)->type);
    CHECK((*before)->rank == (*after)->rank && (*before)->location == (*after)->location);
    for (int d = 0; d < (*before)->rank; ++d) {
      CHECK((*before)->shape[d] == (*after)->shape[d]);
      count *= (size_t)(*before)->shape[d];
    }
    const size_t sizes[] = {0, 8, 4, 4, 1};
    const int type = (*before)->type;
    if (type != MIMETRA_STRING) {
      CHECK(memcmp((*before)->values, (*after)->values, count * sizes[type]) == 0);
    }
    for (size_t i = 0; type == MIMETRA_STRING && i < count; ++i) {
      CHECK(strcmp(((const char* const*)(*before)->values)[i],
                   ((const char* const*)(*after)->values)[i]) == 0);
    }
  }
  CHECK(!*before && !*after);
  return made;
}

static mimetra_data* made_of(const mimetra_interface* m, mimetra_context* context,
                             mimetra_kind kind, const mimetra_array* arrays, int count) {
  const mimetra_array* list[10] = {NULL};
  for (int i = 0; i < count; ++i) list[i] = &arrays[i];
  mimetra_data* data = NULL;
  OK(context, m->new_data(context, kind, "made", list, &data));
  CHECK(m->data_kind(data) == kind && strcmp(m->data_name(data), "made") == 0);
  return data;
}

static void check_round_trips(const mimetra_interface* m, mimetra_context* context) {
  const take_arrays take = sheet();
  double shapes[2 * VERTICES * 3], times[FRAMES], weights[FRAMES * 2], points[FRAMES * 4];
  uint8_t pixels[2 * 3 * 3];
  for (int i = 0; i < 2 * VERTICES * 3; ++i) shapes[i] = 0.01 * i;
  for (int i = 0; i < FRAMES; ++i) times[i] = 0.1 * i;
  for (int i = 0; i < FRAMES * 2; ++i) weights[i] = points[i] = points[FRAMES * 2 + i] = 0.5 * i;
  for (int i = 0; i < 18; ++i) pixels[i] = (uint8_t)(10 * i);
  points[3] = NAN;
  const char* const names[] = {"smile", "frown"};
  const char* const identities[] = {"tall", "wide"};
  const int32_t landmarks[] = {31, 4, 8, 7};
  const double cells[] = {1, NAN, 3};
  mimetra_array neutral = positions_of(&take);
  const int64_t one_pose[] = {VERTICES, 3};
  neutral.rank = 2;
  neutral.name = "neutral";
  memcpy(neutral.shape, one_pose, sizeof one_pose);
#define ARRAY(type, rank, name, values, ...) \
  { sizeof(mimetra_array), type, rank, 0, {__VA_ARGS__}, name, values }
  const mimetra_array model[] = {neutral,
                                 triangles_of(&take),
                                 ARRAY(MIMETRA_F64, 3, "expressions", shapes, 2, VERTICES, 3),
                                 ARRAY(MIMETRA_STRING, 1, "expression_names", names, 2),
                                 ARRAY(MIMETRA_F64, 3, "identities", shapes, 2, VERTICES, 3),
                                 ARRAY(MIMETRA_STRING, 1, "identity_names", identities, 2),
                                 ARRAY(MIMETRA_F64, 2, "weights", weights, FRAMES, 2),
                                 ARRAY(MIMETRA_STRING, 1, "weight_names", names, 2),
                                 ARRAY(MIMETRA_I32, 2, "landmarks", landmarks, 2, 2)};
  const mimetra_array track[] = {ARRAY(MIMETRA_F64, 3, "points", points, FRAMES, 2, 2),
                                 ARRAY(MIMETRA_STRING, 1, "names", names, 2),
                                 ARRAY(MIMETRA_F64, 1, "times", times, FRAMES)};
  const mimetra_array picture[] = {ARRAY(MIMETRA_U8, 3, "pixels", pixels, 2, 3, 3)};
  const mimetra_array document[] = {ARRAY(MIMETRA_STRING, 1, "text", names, 1)};
  const mimetra_array table[] = {ARRAY(MIMETRA_F64, 1, "mpe", cells, 3)};
  mimetra_array fields[] = {positions_of(&take), triangles_of(&take),
                            ARRAY(MIMETRA_F64, 2, "normal", shapes, VERTICES, 3),
                            ARRAY(MIMETRA_I32, 1, "corner", take.triangles, TRIANGLES)};
  fields[2].location = MIMETRA_ON_VERTICES;
  fields[3].location = MIMETRA_ON_TRIANGLES;
  mimetra_data* values[] = {made_of(m, context, MIMETRA_TABLE, table, 1),
                            made_of(m, context, MIMETRA_MODEL, model, 2),
                            made_of(m, context, MIMETRA_MODEL, model, 4),
                            made_of(m, context, MIMETRA_MODEL, model, 6),
                            made_of(m, context, MIMETRA_MODEL, model, 9),
                            made_of(m, context, MIMETRA_LANDMARKS, track, 3),
                            made_of(m, context, MIMETRA_PICTURES, picture, 1),
                            made_of(m, context, MIMETRA_DOCUMENT, document, 1),
                            made_of(m, context, MIMETRA_SEQUENCE, fields, 4),
                            take_of(m, context)};
  const char* json = NULL;
  OK(context, m->data_json(context, values[0], &json));
  CHECK(strstr(json, "\"mpe\": null"));
  const mimetra_array* normal = NULL;
  OK(context, m->data_array(context, values[8], "normal", &normal));
  CHECK(normal->location == MIMETRA_ON_VERTICES && normal->shape[1] == 3);
  for (int i = 0; i < 10; ++i) {
    mimetra_data* copy = again(m, context, values[i]);
    m->free_data(copy);
    m->free_data(values[i]);
  }
}

static mimetra_data* output_of(const mimetra_interface* m, mimetra_context* context,
                               const char* operation, const mimetra_data* take) {
  mimetra_call* call = NULL;
  mimetra_data* result = NULL;
  OK(context, m->new_call(context, operation, &call));
  OK(context, m->call_give(call, "sequence", take));
  OK(context, m->call_set(call, "k", "2"));
  OK(context, m->call_run(call));
  OK(context, m->call_output(call, "out", 0, &result));
  m->free_call(call);
  return result;
}

/* Components and regions serve as inputs when they are made of their own arrays. */
static void check_results(const mimetra_interface* m, mimetra_context* context) {
  mimetra_data* take = take_of(m, context);
  mimetra_data* components = output_of(m, context, "decompose", take);
  mimetra_data* regions = output_of(m, context, "regions", take);
  mimetra_data* same_components = again(m, context, components);
  const mimetra_array *masks = NULL, *again_masks = NULL;
  OK(context, m->data_array(context, regions, "masks", &masks));
  mimetra_call* call = NULL;
  mimetra_data* found = NULL;
  OK(context, m->new_call(context, "regions", &call));
  OK(context, m->call_give(call, "sequence", take));
  OK(context, m->call_give(call, "components", same_components));
  OK(context, m->call_run(call));
  OK(context, m->call_output(call, "out", 0, &found));
  OK(context, m->data_array(context, found, "masks", &again_masks));
  CHECK(masks->shape[0] == again_masks->shape[0] && masks->shape[1] == VERTICES);
  CHECK(memcmp(masks->values, again_masks->values, (size_t)masks->shape[0] * VERTICES) == 0);
  mimetra_data* same_regions = NULL;
  const mimetra_array* const* arrays = NULL;
  OK(context, m->data_arrays(context, regions, &arrays));
  OK(context, m->new_data(context, MIMETRA_REGIONS, "regions", arrays, &same_regions));
  mimetra_data* all[] = {take, components, regions, same_components, found, same_regions};
  for (int i = 0; i < 6; ++i) m->free_data(all[i]);
  m->free_call(call);
}

/* Derived: other positions, the same polygons. */
static void check_deriving(const mimetra_interface* m, mimetra_context* context) {
  take_arrays take = sheet();
  mimetra_data *data = take_of(m, context), *moved = NULL;
  for (int i = 0; i < FRAMES * VERTICES * 3; ++i) take.positions[i] *= 2;
  const mimetra_array positions = positions_of(&take);
  const mimetra_array* changes[] = {&positions, NULL};
  OK(context, m->derive_data(context, data, changes, &moved));
  const mimetra_array *found = NULL, *faces = NULL;
  OK(context, m->data_array(context, moved, "positions", &found));
  OK(context, m->data_array(context, moved, "corners", &faces));
  CHECK(memcmp(found->values, take.positions, sizeof take.positions) == 0);
  CHECK(memcmp(faces->values, take.triangles, sizeof take.triangles) == 0);
  m->free_data(moved);
  m->free_data(data);
}

/* Saved and loaded again, with settings. */
static void check_files(const mimetra_interface* m, mimetra_context* context) {
  mimetra_data *take = take_of(m, context), *part = NULL;
  const char* const replace[] = {"force=true", NULL};
  const char* const frames[] = {"frames=2:6:2", NULL};
  OK(context, m->save_data(context, take, "values_take.npy", replace));
  FAILS(context, MIMETRA_BAD_OUTPUT, "values_take.npy",
        m->save_data(context, take, "values_take.npy", NULL));
  OK(context, m->load_data(context, MIMETRA_SEQUENCE, "values_take.npy", frames, &part));
  const mimetra_array *all = NULL, *some = NULL;
  OK(context, m->data_array(context, take, "positions", &all));
  OK(context, m->data_array(context, part, "positions", &some));
  CHECK(some->shape[0] == 2 && some->shape[1] == VERTICES);
  CHECK(memcmp(some->values, (const double*)all->values + 2 * VERTICES * 3,
               VERTICES * 3 * sizeof(double)) == 0);
  m->free_data(part);
  m->free_data(take);
}

static long size_of(const char* path) {
  FILE* file = fopen(path, "rb");
  if (!file) return -1;
  fseek(file, 0, SEEK_END);
  const long size = ftell(file);
  fclose(file);
  return size;
}

/* A call writes its output and the manifest, by which another call gives the motion back. */
static void check_writing(const mimetra_interface* m, mimetra_context* context) {
  mimetra_data *take = take_of(m, context), *still = NULL, *moving = NULL;
  mimetra_call* call = NULL;
  OK(context, m->new_call(context, "align", &call));
  OK(context, m->call_give(call, "sequence", take));
  OK(context, m->call_set(call, "on", "all"));
  OK(context, m->call_set(call, "single", "true"));
  FAILS(context, MIMETRA_USAGE, "'single' is about files", m->call_run(call));
  OK(context, m->call_set(call, "single", NULL));
  FAILS(context, MIMETRA_USAGE, "no output 'none'", m->call_write(call, "none", "a.npy", 0));
  OK(context, m->call_write(call, "out", "values_still.npy", 1));
  OK(context, m->call_write(call, NULL, "values_align.json", 1));
  OK(context, m->call_run(call));
  OK(context, m->call_output(call, "out", 0, &still));
  m->free_call(call);
  CHECK(size_of("values_still.npy") > 0 && size_of("values_still.run.json") > 0);
  CHECK(size_of("values_align.json") > 0);

  OK(context, m->new_call(context, "align", &call));
  OK(context, m->call_read(call, "sequence", "values_still.npy"));
  OK(context, m->call_set(call, "undo", "values_align.json"));
  OK(context, m->call_run(call));
  OK(context, m->call_output(call, "out", 0, &moving));
  const mimetra_array *before = NULL, *between = NULL, *after = NULL;
  OK(context, m->data_array(context, take, "positions", &before));
  OK(context, m->data_array(context, still, "positions", &between));
  OK(context, m->data_array(context, moving, "positions", &after));
  double moved = 0, error = 0;
  for (int64_t i = 0; i < before->shape[0] * before->shape[1] * 3; ++i) {
    const double x = ((const double*)before->values)[i];
    moved = fmax(moved, fabs(((const double*)between->values)[i] - x));
    error = fmax(error, fabs(((const double*)after->values)[i] - x));
  }
  CHECK(moved > 1e-3 && error < 1e-12);
  OK(context, m->call_write(call, "out", "values_still.npy", 0));
  FAILS(context, MIMETRA_BAD_OUTPUT, "values_still.npy", m->call_run(call));
  m->free_call(call);
  m->free_data(moving);
  m->free_data(still);
  m->free_data(take);
}

int main(void) {
  const mimetra_interface* m = mimetra_get_interface(MIMETRA_INTERFACE_VERSION);
  mimetra_context* context = NULL;
  CHECK(m && m->new_context(NULL, NULL, &context) == MIMETRA_OK);
  check_round_trips(m, context);
  check_results(m, context);
  check_deriving(m, context);
  check_files(m, context);
  check_writing(m, context);
  m->free_context(context);
  return 0;
}
