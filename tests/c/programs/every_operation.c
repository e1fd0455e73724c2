/* Each operation of the library, run on values that this program makes. */
#include <mimetra/plugins/c/mimetra.h>

#include "tests/c/programs/take.h"

enum { LANDMARKS = 68 };

static mimetra_call* call_on(const mimetra_interface* m, mimetra_context* context,
                             const char* operation, const char* input, const mimetra_data* data) {
  mimetra_call* call = NULL;
  OK(context, m->new_call(context, operation, &call));
  OK(context, m->call_give(call, input, data));
  return call;
}

/* Runs and frees a call; its report holds some words. */
static void reports(const mimetra_interface* m, mimetra_context* context, mimetra_call* call,
                    const char* words) {
  OK(context, m->call_run(call));
  if (!strstr(m->call_report(call), words)) {
    fprintf(stderr, "expected %s, found %s\n", words, m->call_report(call));
    exit(1);
  }
  m->free_call(call);
}

/* Runs a call; what it makes as `out` has an array of this size. Returns that and frees the call.
 */
static mimetra_data* makes(const mimetra_interface* m, mimetra_context* context, mimetra_call* call,
                           const char* name, int64_t rows) {
  mimetra_data* made = NULL;
  const mimetra_array* array = NULL;
  OK(context, m->call_want(call, "out"));
  OK(context, m->call_run(call));
  OK(context, m->call_output(call, "out", 0, &made));
  OK(context, m->data_array(context, made, name, &array));
  CHECK(array->shape[0] == rows);
  m->free_call(call);
  return made;
}

static mimetra_data* flat_sheet(const mimetra_interface* m, mimetra_context* context) {
  const take_arrays take = sheet();
  mimetra_array neutral = positions_of(&take);
  neutral.rank = 2;
  neutral.shape[0] = VERTICES;
  neutral.shape[1] = 3;
  neutral.name = "neutral";
  const mimetra_array triangles = triangles_of(&take);
  const mimetra_array* arrays[] = {&neutral, &triangles, NULL};
  mimetra_data* data = NULL;
  OK(context, m->new_data(context, MIMETRA_MODEL, "flat", arrays, &data));
  return data;
}

/* The landmarks of a model's neutral, seen from the front. */
static mimetra_data* landmarks_of(const mimetra_interface* m, mimetra_context* context,
                                  const char* mapping, const mimetra_array* neutral) {
  double points[LANDMARKS][2];
  char texts[LANDMARKS][4];
  const char* names[LANDMARKS];
  for (int i = 0; i < LANDMARKS; ++i) {
    points[i][0] = points[i][1] = NAN;
    snprintf(texts[i], sizeof texts[i], "%d", i);
    names[i] = texts[i];
  }
  FILE* file = fopen(mapping, "r");
  CHECK(file);
  char line[200];
  int landmark = 0, vertex = 0;
  while (fgets(line, sizeof line, file)) {
    if (sscanf(line, "%d = %d", &landmark, &vertex) != 2) continue;
    const double* p = (const double*)neutral->values + 3 * vertex;
    points[landmark - 1][0] = 300 + p[0];
    points[landmark - 1][1] = 300 - p[1];
  }
  fclose(file);
  const mimetra_array seen = {sizeof seen, MIMETRA_F64, 3, 0, {1, LANDMARKS, 2}, "points", points};
  const mimetra_array named = {sizeof named, MIMETRA_STRING, 1, 0, {LANDMARKS}, "names", names};
  const mimetra_array* arrays[] = {&seen, &named, NULL};
  mimetra_data* data = NULL;
  OK(context, m->new_data(context, MIMETRA_LANDMARKS, "neutral", arrays, &data));
  return data;
}

static void fit(const mimetra_interface* m, mimetra_context* context, const char* head,
                const char* mapping) {
  mimetra_call* call = NULL;
  mimetra_data* model = NULL;
  const mimetra_array* neutral = NULL;
  OK(context, m->load_data(context, MIMETRA_MODEL, head, NULL, &model));
  OK(context, m->data_array(context, model, "neutral", &neutral));
  mimetra_data* landmarks = landmarks_of(m, context, mapping, neutral);
  call = call_on(m, context, "fit", "landmarks", landmarks);
  OK(context, m->call_read(call, "model", head));
  m->free_data(makes(m, context, call, "positions", 1));
  m->free_data(landmarks);
  m->free_data(model);
}

/* The sample's head with all of its expressions, on itself. */
static void rig(const mimetra_interface* m, mimetra_context* context, const char* head) {
  enum { EXPRESSIONS = 12 };
  mimetra_data* model = NULL;
  OK(context, m->load_data(context, MIMETRA_MODEL, head, NULL, &model));
  mimetra_call* call = call_on(m, context, "rig", "source", model);
  OK(context, m->call_read(call, "target", head));
  m->free_data(makes(m, context, call, "expressions", EXPRESSIONS));
  m->free_data(model);
}

/* Weights of the sample's head become those of the same head. */
static void retarget(const mimetra_interface* m, mimetra_context* context, const char* head) {
  enum { WEIGHTED = 3 };
  const double opening[WEIGHTED] = {0, 0.25, 0.5};
  const mimetra_array jaw = {sizeof jaw, MIMETRA_F64, 1, 0, {WEIGHTED}, "jawOpen", opening};
  const mimetra_array* arrays[] = {&jaw, NULL};
  mimetra_data* weights = NULL;
  OK(context, m->new_data(context, MIMETRA_TABLE, "opening", arrays, &weights));
  mimetra_call* call = call_on(m, context, "retarget", "weights", weights);
  OK(context, m->call_read(call, "source", head));
  OK(context, m->call_read(call, "target", head));
  mimetra_data* made = makes(m, context, call, "jawOpen", WEIGHTED);
  const mimetra_array* found = NULL;
  OK(context, m->data_array(context, made, "jawOpen", &found));
  for (int f = 0; f < WEIGHTED; ++f) {
    CHECK(fabs(((const double*)found->values)[f] - opening[f]) < 1e-6);
  }
  m->free_data(made);
  m->free_data(weights);
}

/* argv: a model's folder, and its mapping of landmarks. */
int main(int argc, char** argv) {
  CHECK(argc == 3);
  const mimetra_interface* m = mimetra_get_interface(MIMETRA_INTERFACE_VERSION);
  mimetra_context* context = NULL;
  CHECK(m && m->new_context(NULL, NULL, &context) == MIMETRA_OK);
  mimetra_data *take = take_of(m, context), *flat = flat_sheet(m, context);
  mimetra_call* call = NULL;

  reports(m, context, call_on(m, context, "info", "sequence", take), "\"frames\":8");
  reports(m, context, call_on(m, context, "check", "sequence", take), "\"usable\":true");
  call = call_on(m, context, "align", "sequence", take);
  m->free_data(makes(m, context, call, "positions", FRAMES));
  call = call_on(m, context, "convert", "sequence", take);
  m->free_data(makes(m, context, call, "positions", FRAMES));
  call = call_on(m, context, "simplify", "sequence", take);
  OK(context, m->call_set(call, "share", "0.5"));
  m->free_data(makes(m, context, call, "positions", FRAMES));
  call = call_on(m, context, "subdivide", "sequence", take);
  m->free_data(makes(m, context, call, "positions", FRAMES));
  call = call_on(m, context, "geodesic", "mesh", take);
  OK(context, m->call_set(call, "source", "0"));
  m->free_data(makes(m, context, call, "distance", VERTICES));
  call = call_on(m, context, "decompose", "sequence", take);
  OK(context, m->call_set(call, "k", "2"));
  m->free_data(makes(m, context, call, "displacements", 2));
  call = call_on(m, context, "regions", "sequence", take);
  OK(context, m->call_set(call, "k", "2"));
  m->free_data(makes(m, context, call, "masks", 2));
  call = call_on(m, context, "transfer", "source", take);
  OK(context, m->call_give(call, "target", flat));
  OK(context, m->call_set(call, "full", "true"));
  m->free_data(makes(m, context, call, "positions", FRAMES));
  call = call_on(m, context, "evaluate", "source", take);
  OK(context, m->call_give(call, "target", flat));
  OK(context, m->call_set(call, "k", "1,2"));
  m->free_data(makes(m, context, call, "de_all", 3));
  rig(m, context, argv[1]);
  retarget(m, context, argv[1]);
  OK(context, m->new_call(context, "sample", &call));
  m->free_data(makes(m, context, call, "weights", 120));
  fit(m, context, argv[1], argv[2]);

  m->free_data(flat);
  m->free_data(take);
  m->free_context(context);
  return 0;
}
