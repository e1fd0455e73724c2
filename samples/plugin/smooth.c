/* A plugin in C: `smooth` moves every vertex towards the mean of its neighbours, in every frame. */
#include <stdlib.h>
#include <string.h>

#include <mimetra/plugins/c/mimetra.h>

/* Smooths one frame of n vertices once. `mean` is scratch space for 4 n numbers: the sum of each
 * vertex's neighbours and their count. */
static void smooth(double* xyz, int64_t n, const mimetra_array* triangles, double strength,
                   double* mean) {
  const int32_t* corners = triangles->values;
  memset(mean, 0, 4 * (size_t)n * sizeof *mean);
  for (int64_t t = 0; t < triangles->shape[0]; ++t, corners += 3) {
    for (int i = 0; i < 6; ++i) {
      double* sum = mean + 4 * corners[i % 3];
      const double* neighbour = xyz + 3 * corners[(i % 3 + 1 + i / 3) % 3];
      for (int axis = 0; axis < 3; ++axis) sum[axis] += neighbour[axis];
      sum[3] += 1;
    }
  }
  for (int64_t i = 0; i < 3 * n; ++i) {
    const double* sum = mean + 4 * (i / 3);
    if (sum[3] > 0) xyz[i] += strength * (sum[i % 3] / sum[3] - xyz[i]);
  }
}

static mimetra_status run(const mimetra_interface* m, mimetra_job* job, void* user) {
  mimetra_context* context = m->job_context(job);
  const mimetra_data* sequence = m->job_input(job, "sequence", 0);
  const mimetra_array *positions, *triangles;
  mimetra_status status = m->data_array(context, sequence, "positions", &positions);
  if (!status) status = m->data_array(context, sequence, "triangles", &triangles);
  if (status) return status;
  const int64_t frames = positions->shape[0], n = positions->shape[1];
  double* xyz = malloc((size_t)(3 * frames * n) * sizeof *xyz);
  double* mean = malloc((size_t)(4 * n) * sizeof *mean);
  if (!xyz || !mean) status = m->job_fail(job, MIMETRA_FAILED, "not enough memory");
  if (!status) memcpy(xyz, positions->values, (size_t)(3 * frames * n) * sizeof *xyz);
  for (int64_t f = 0; f < frames && !status; ++f) {
    for (int i = 0; i < (int)m->job_number(job, "iterations"); ++i)
      smooth(xyz + 3 * f * n, n, triangles, m->job_number(job, "strength"), mean);
    status = m->job_progress(job, (double)(f + 1) / (double)frames);
  }
  mimetra_data* smoothed = NULL;
  mimetra_array moved = *positions; /* the same name and shape */
  const mimetra_array* changes[] = {&moved, NULL};
  moved.struct_size = sizeof moved;
  moved.values = xyz;
  if (!status) status = m->derive_data(context, sequence, changes, &smoothed);
  if (!status) status = m->job_output(job, "out", smoothed);
  m->free_data(smoothed);
  free(mean);
  free(xyz);
  (void)user;
  return status;
}

#define SIZE(name) .struct_size = sizeof(mimetra_##name)
static const mimetra_port input = {SIZE(port), MIMETRA_SEQUENCE, "sequence", "what is smoothed"};
static const mimetra_port output = {SIZE(port), MIMETRA_SEQUENCE, "out", "the smoothed sequence"};
static const mimetra_parameter strength = {
    SIZE(parameter), MIMETRA_NUMBER, "strength",  "share of the way to the neighbours' mean",
    "0.5",           .minimum = 0,   .maximum = 1};
static const mimetra_parameter iterations = {
    SIZE(parameter), MIMETRA_INTEGER, "iterations", "how often", "1", .minimum = 1, .maximum = 1e6};
static const mimetra_operation operation = {
    SIZE(operation),
    .name = "smooth",
    .summary = "Smooth a sequence's surface in every frame",
    .inputs = (const mimetra_port* const[]){&input, NULL},
    .outputs = (const mimetra_port* const[]){&output, NULL},
    .parameters = (const mimetra_parameter* const[]){&strength, &iterations, NULL},
    .examples = (const char* const[]){"smooth take.npy --strength 0.3 -o smoothed.npy", NULL},
    .run = run};
static const mimetra_plugin plugin = {SIZE(plugin), MIMETRA_INTERFACE_VERSION, "smooth sample",
                                      (const mimetra_operation* const[]){&operation, NULL}, NULL};

MIMETRA_EXPORT const mimetra_plugin* mimetra_get_plugin(void) {
  return &plugin;
}
